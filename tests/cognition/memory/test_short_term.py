"""The short-term memory: what is cut is cut whole, and the instruction stays."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.action import Outcome
from adamo_vh.cognition.memory.protocol import Result
from adamo_vh.cognition.memory.short_term import ShortTermMemory
from adamo_vh.cognition.profile import PAPER, PROFILES, BufferUnit, Profile, StateText
from adamo_vh.errors import ConfigError
from adamo_vh.geometry import Camera, Vec3
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.observation import AgentState, Frame, Observation, ObservedObject, ReferencePoint

LEAN = replace(PROFILES["lean"], terse=False)
EYES = Vec3(0.0, 0.0, 1.6)


def agent(x: float = 0.0, held: str | None = None) -> AgentState:
    return AgentState(Vec3(x, 0.0, 0.0), 0.0, Vec3(1.0, 0.0, 1.0), EYES, held)


def thing(tag: str, x: float) -> ObservedObject:
    return ObservedObject(tag, Vec3(x, 1.0, 0.8), 0.001, (1, 2, 30, 40), 500)


def view(name: str, *things: ObservedObject, body: AgentState | None = None) -> Observation:
    return Observation(
        Frame(name.encode(), "image/jpeg", 640, 360),
        things,
        (ReferencePoint("P0", Vec3(0.5, 0.5, 0.0), (10.0, 20.0)),),
        body or agent(),
        Camera(EYES, 0.0, 0.0, 1.1, 640, 360),
    )


def step(number: int, seen: Observation | None, calls: int = 1) -> tuple[AIMessage, list[Result]]:
    made = tuple(ToolCall(f"{number}.{i}", "Look", {}) for i in range(calls))
    body = agent(float(number)) if seen is None else seen.agent
    results = [Result(call.id, call.name, "ok", body, Outcome.DONE) for call in made]
    results[-1] = replace(results[-1], view=seen)
    return AIMessage(f"note {number}", made), results


def filled(
    k: int, steps: list[tuple[int, bool]], profile: Profile = PAPER
) -> tuple[ShortTermMemory, list[Message]]:
    memory = ShortTermMemory("rules", k, profile)
    memory.instruct("do it", view("frame"))
    for number, (calls, has_frame) in enumerate(steps):
        message, results = step(number, view(f"frame {number}") if has_frame else None, calls)
        memory.add_step(message, *results)
    return memory, memory.messages()


def pictures(prompt: list[Message]) -> list[str]:
    found: list[ImagePart] = []
    for message in prompt:
        if isinstance(message, HumanMessage):
            found += [part for part in message.parts if isinstance(part, ImagePart)]
        if isinstance(message, ToolMessage):
            found += message.images
    return [part.data.decode() for part in found]


STEPS = st.lists(st.tuples(st.integers(1, 3), st.booleans()), max_size=20)


@given(st.integers(1, 8), STEPS, st.sampled_from([*PROFILES.values()]))
def test_calls_and_results_stay_together(
    k: int, steps: list[tuple[int, bool]], profile: Profile
) -> None:
    _, prompt = filled(k, steps, profile)
    asked = [c.id for m in prompt if isinstance(m, AIMessage) for c in m.calls]
    answered = [m.call_id for m in prompt if isinstance(m, ToolMessage)]
    assert asked == answered
    assert prompt[0] == SystemMessage("rules")
    human = next(m for m in prompt if isinstance(m, HumanMessage))
    assert human.parts[0] == TextPart("do it")
    notes = [m.text for m in prompt if isinstance(m, AIMessage)]
    assert notes == [f"note {i}" for i in range(len(steps))][-k:]


def test_the_papers_state_stands_second_and_is_the_latest() -> None:
    memory, _ = filled(3, [(1, True)])
    memory.add_step(*_flat(step(1, view("new", thing("Cup_1", 0.2)))))
    states = [m.text for m in memory.messages() if isinstance(m, SystemMessage)]
    assert states[0] == "rules"
    assert len(states) == 2
    assert "Cup_1: center (0.200, 1.000, 0.800)" in states[1]


def _flat(made: tuple[AIMessage, list[Result]]) -> tuple[AIMessage, Result]:
    message, results = made
    return message, results[0]


def test_a_state_at_the_end_leaves_the_beginning_as_it_was() -> None:
    profile = Profile(state=StateText.LAST)
    memory, before = filled(5, [(1, False)], profile)
    memory.add_step(*_flat(step(1, None)))
    after = memory.messages()
    assert isinstance(before[-1], HumanMessage)
    assert after[: len(before) - 1] == before[:-1]


def test_a_prompt_of_changes_only_grows_until_a_picture_is_left_out() -> None:
    memory, before = filled(5, [(1, False)], LEAN)
    memory.add_step(*_flat(step(1, None)))
    assert memory.messages()[: len(before)] == before


def test_changes_say_each_thing_once() -> None:
    memory = ShortTermMemory("rules", 50, LEAN)
    memory.instruct("do it", view("a", thing("Cup_1", 0.2), thing("Mug_2", 0.4)))
    moved = view("b", thing("Cup_1", 0.2), thing("Mug_2", 0.9), body=agent(1.0))
    memory.add_step(*_flat(step(1, moved)))
    held = view("c", thing("Mug_2", 1.3), body=agent(1.0, held="Mug_2"))
    memory.add_step(*_flat(step(2, held)))
    first, second, third = (
        m for m in memory.messages() if not isinstance(m, (SystemMessage, AIMessage))
    )
    assert isinstance(first, HumanMessage)
    assert first.text.count("center") == 2
    assert "New in view:" in first.text
    assert isinstance(second, ToolMessage)
    assert "Moved:\n- Mug_2: center (0.900" in second.text
    assert "Cup_1" not in second.text
    assert isinstance(third, ToolMessage)
    assert "center" not in third.text  # what is in the hand moves with it
    assert "hand: Mug_2" in third.text
    assert "In view: Mug_2 [1, 2, 30, 40]" in third.text


def test_what_fell_out_of_the_buffer_is_told_again() -> None:
    memory = ShortTermMemory("rules", 1, LEAN)
    memory.instruct("do it", view("a"))
    memory.add_step(*_flat(step(1, view("b", thing("Cup_1", 0.2)))))
    memory.add_step(*_flat(step(2, view("c", thing("Cup_1", 0.2)))))
    assert str(memory.messages()).count("Cup_1: center") == 1


@pytest.mark.parametrize(
    ("kept", "expected"),
    [(0, ["frame", "frame 0", "frame 2"]), (1, ["frame 2"]), (2, ["frame 0", "frame 2"])],
)
@pytest.mark.parametrize("inside", [True, False])
def test_only_the_last_pictures_are_kept(kept: int, expected: list[str], inside: bool) -> None:
    profile = Profile(pictures=kept, pictures_in_results=inside)
    _, prompt = filled(50, [(1, True), (2, False), (1, True)], profile)
    assert pictures(prompt) == expected
    left_out = str(prompt).count("An earlier picture")
    assert left_out == 3 - len(expected)


@pytest.mark.parametrize("inside", [True, False])
def test_a_new_picture_is_shown_until_the_next_action(inside: bool) -> None:
    profile = Profile(pictures="new", state=StateText.CHANGES, pictures_in_results=inside)
    memory, prompt = filled(50, [], profile)
    assert pictures(prompt) == ["frame"]
    memory.remark("go on")
    assert pictures(memory.messages()) == ["frame"]
    memory, prompt = filled(50, [(1, False)], profile)
    assert pictures(prompt) == []
    assert str(prompt).count("# The view now") == 1
    memory, prompt = filled(50, [(1, False), (1, True)], profile)
    assert pictures(prompt) == ["frame 1"]
    assert str(prompt).count("# The view now") == 1


def test_pictures_stand_where_the_profile_wants_them() -> None:
    _, paper = filled(50, [(1, True)])
    assert [type(m) for m in paper[-2:]] == [ToolMessage, HumanMessage]
    _, lean = filled(50, [(1, True)], LEAN)
    assert isinstance(lean[-1], ToolMessage)
    assert len(lean[-1].images) == 1


def test_a_later_instruction_is_never_lost() -> None:
    memory, _ = filled(2, [(1, False)])
    memory.instruct("and then this", view("later"))
    for number in range(5, 9):
        memory.add_step(*_flat(step(number, None)))
    texts = [m.parts[0] for m in memory.messages() if isinstance(m, HumanMessage)]
    assert texts == [TextPart("do it"), TextPart("and then this")]


def test_a_remark_is_a_word_of_the_user_without_a_picture() -> None:
    memory, _ = filled(5, [])
    memory.remark("go on")
    assert memory.messages()[-1] == HumanMessage((TextPart("go on"),))


def test_no_steps_at_all_is_refused() -> None:
    with pytest.raises(ConfigError, match="at least 1"):
        ShortTermMemory("rules", 0)


def test_words_in_between_are_no_steps() -> None:
    memory, _ = filled(2, [(1, False), (1, False)])
    for _ in range(3):
        memory.remark("go on")
    notes = [m.text for m in memory.messages() if isinstance(m, AIMessage)]
    assert notes == ["note 0", "note 1"]
    memory.add_step(*_flat(step(2, None)))
    memory.add_step(*_flat(step(3, None)))
    texts = [m.text for m in memory.messages() if isinstance(m, HumanMessage)]
    assert texts == ["do it"]


def test_a_block_is_a_reply_with_its_results_or_any_other_message() -> None:
    blocks = replace(PAPER, buffer_unit=BufferUnit.BLOCK)
    looks = [(1, True), (1, False), (2, True), (1, True)]
    for k, notes in ((7, 4), (6, 3), (5, 3), (4, 2), (3, 1), (2, 1), (1, 1)):
        _, prompt = filled(k, looks, blocks)
        assert sum(isinstance(message, AIMessage) for message in prompt) == notes
    # Where views come inside of results, they are no messages of their own.
    within = replace(blocks, pictures_in_results=True)
    _, prompt = filled(3, looks, within)
    assert sum(isinstance(message, AIMessage) for message in prompt) == 3
