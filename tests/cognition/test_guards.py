"""A loop is the same call again and again, and the reason says what was written."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from adamo_vh.action import Code, Feedback, Outcome
from adamo_vh.cognition.guards import LoopGuard
from adamo_vh.geometry import Vec3
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Reply
from adamo_vh.observation import AgentState
from adamo_vh.record.trajectory import Acted, Thought
from adamo_vh.record.turn import Turn

BODY = AgentState(Vec3(0, 0, 0), 0.0, Vec3(1, 0, 1), Vec3(0, 0, 1.6))
REFUSED = Feedback(Outcome.REFUSED, Code.BAD_ARGUMENT, "Refused: the arguments are no object.")


def hear(guard: LoopGuard, written: Sequence[str]) -> None:
    for number, raw in enumerate(written):
        call = ToolCall(f"c{number}", "Pick", None, raw)
        guard.notify(Thought(number, "", 1, Turn(Reply(AIMessage("n", (call,))))))
        guard.notify(Acted(number, call.id, "Pick", None, REFUSED, BODY, "same", "", 0.0))


@pytest.mark.parametrize(
    ("written", "is_loop"),
    [(["{a", "{b", "{c", "{d"], False), (["{a", "{a", "{a", "{a"], True)],
)
def test_broken_arguments_are_told_apart_by_what_was_written(
    written: list[str], is_loop: bool
) -> None:
    guard = LoopGuard(4)
    hear(guard, written)
    stop = guard.stop()
    assert (stop is not None) is is_loop
    assert stop is None or stop.why == "Pick {a led to the same state 4 times."
