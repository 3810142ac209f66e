"""The short-term memory: what is cut is cut whole, and the instruction stays."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo.cognition.memory import ShortTermMemory
from adamo.errors import ConfigError
from adamo.inference.messages import (
    AIMessage,
    HumanMessage,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)


def human(text: str) -> HumanMessage:
    return HumanMessage((TextPart(text),))


def filled(k: int, steps: list[tuple[int, bool]]) -> ShortTermMemory:
    memory = ShortTermMemory("rules", k)
    memory.begin(human("do it"), "state 0")
    for number, (calls, has_frame) in enumerate(steps):
        made = tuple(ToolCall(f"{number}.{i}", "Look", {}) for i in range(calls))
        answers = [ToolMessage(call.id, call.name, "ok") for call in made]
        frames = [human(f"frame {number}")] if has_frame else []
        memory.add_step(AIMessage(f"note {number}", made), *answers, *frames)
    return memory


@given(st.integers(1, 8), st.lists(st.tuples(st.integers(1, 3), st.booleans()), max_size=20))
def test_calls_and_results_stay_together(k: int, steps: list[tuple[int, bool]]) -> None:
    prompt = filled(k, steps).messages()
    asked = [c.id for m in prompt if isinstance(m, AIMessage) for c in m.calls]
    answered = [m.call_id for m in prompt if isinstance(m, ToolMessage)]
    assert asked == answered
    assert prompt[0] == SystemMessage("rules")
    assert prompt[1] == SystemMessage("state 0")
    assert prompt[2] == human("do it")
    notes = [m.text for m in prompt if isinstance(m, AIMessage)]
    assert notes == [f"note {i}" for i in range(len(steps))][-k:]


def test_the_state_is_always_the_latest() -> None:
    memory = filled(3, [(1, True)])
    memory.update_state("state 1")
    states = [m.text for m in memory.messages() if isinstance(m, SystemMessage)]
    assert states == ["rules", "state 1"]


def test_a_new_instruction_starts_afresh() -> None:
    memory = filled(3, [(1, True)])
    memory.begin(human("next"), "state")
    assert len(memory.messages()) == 3


def test_a_memory_of_nothing_is_refused() -> None:
    with pytest.raises(ConfigError, match="at least 1"):
        ShortTermMemory("rules", 0)
