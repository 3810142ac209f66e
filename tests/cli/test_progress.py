"""The live progress: short lines that tell what happens, whatever the model says."""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any

from rich.console import Console

from adamo_vh.action import Code, Feedback, Outcome
from adamo_vh.cli.progress import Progress
from adamo_vh.cognition.profile import PROFILES
from adamo_vh.cognition.turns import read_turn
from adamo_vh.geometry import Vec3
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Reply
from adamo_vh.observation import AgentState
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import (
    Acted,
    Ended,
    Event,
    LeftOut,
    Observed,
    Shown,
    Started,
    Thought,
)

AGENT = AgentState(Vec3(0, 0, 0), 0.0, Vec3(1, 0, 1), Vec3(0, 0, 1.6))
STARTED = Started("Take the key", "You are the mind.", "h", "{}")
SAID = {"asked": "The key.", "verified": "I hold it.", "unseen": "The shelf.", "answer": "Done."}


def thought(step: int, note: str, *calls: ToolCall, unreadable: str = "") -> Thought:
    reply = Reply(AIMessage(note, calls), seconds=1.0, unreadable=unreadable)
    return Thought(step, "state", 3, read_turn(reply, PROFILES["lean"]))


def call(name: str, arguments: Mapping[str, Any] | None, raw: str = "") -> ToolCall:
    return ToolCall(name, name, arguments, raw)


def acted(
    step: int, name: str, arguments: Mapping[str, Any], outcome: Outcome = Outcome.DONE
) -> Acted:
    feedback = Feedback(outcome, Code.OK, f"{outcome.value.title()}: {name}.")
    return Acted(step, name, name, arguments, feedback, AGENT, "h", "{}", 0.1)


def ended(reason: TerminationReason = TerminationReason.ANSWERED) -> Ended:
    return Ended(1, reason, "Done.", "h", 3.0)


def lines(*events: Event, columns: int = 400) -> list[str]:
    """What a terminal that is no terminal shows, with single blanks."""
    out = io.StringIO()
    progress = Progress(Console(file=out, width=columns))
    for event in events:
        progress.notify(event)
    return [" ".join(line.split()) for line in out.getvalue().splitlines()]


def test_a_paper_episode_is_told_as_it_happens() -> None:
    key = {"object": "Key_34"}
    assert lines(
        STARTED,
        Observed(0, "0.png", 64, 36, (), (), AGENT),
        thought(0, "I take it.", call("Pick", key)),
        acted(1, "Pick", key),
        thought(1, "Done."),
        ended(),
    ) == [
        "instruction Take the key",
        "view 0 objects, 0 reference points",
        "step 1 I take it.",
        'call Pick {"object": "Key_34"}',
        "feedback Done: Pick.",
    ]


def test_note_and_confidence_stand_apart_from_the_arguments() -> None:
    wish = call("Pick", {"note": "I take it.", "confidence": 0.9, "object": "Key_34"})
    assert lines(thought(0, "", wish), acted(1, "Pick", {"object": "Key_34"})) == [
        "step 1 I take it.",
        'call Pick {"object": "Key_34"} (confidence 0.9)',
        "feedback Done: Pick.",
    ]


def test_a_plan_says_its_note_once_and_what_was_left_out() -> None:
    looks = [call("Look", {"note": "I search.", "confidence": 1, "x": x}) for x in range(3)]
    told = lines(
        thought(0, "", *looks),
        acted(1, "Look", {"x": 0}),
        acted(2, "Look", {"x": 1}, Outcome.CORRECTED),
        LeftOut(2, "Look", "Look", "a surprise"),
        ended(TerminationReason.LOOP),
    )
    assert told == [
        "step 1 I search.",
        'call Look {"x": 0} (confidence 1)',
        "feedback Done: Look.",
        'call Look {"x": 1} (confidence 1)',
        "feedback Corrected: Look.",
        'not done Look {"x": 2} (confidence 1): a surprise',
    ]


def test_a_doubted_pick_is_not_told_as_done() -> None:
    key = {"object": "Key_34"}
    told = lines(
        thought(0, "", call("Pick", {"note": "Maybe.", "confidence": 0.2, **key})),
        acted(1, "Inspect", key),
        Shown(1, "0.png", 512, 400),
    )
    assert told == [
        "step 1 Maybe.",
        'not done Pick {"object": "Key_34"} (confidence 0.2): too unsure, so shown close up first',
        "feedback Done: Inspect.",
        "close-up 512 x 400 pixels",
    ]


def test_finish_tells_what_was_verified_and_leaves_the_answer_to_the_caller() -> None:
    wish = call("Finish", {"note": "All done.", "confidence": 0.9, **SAID})
    assert lines(thought(1, "", wish), ended()) == [
        "finish All done. (confidence 0.9)",
        "verified I hold it.",
        "not seen The shelf.",
    ]


def test_an_answer_that_does_not_end_the_episode_is_printed() -> None:
    told = lines(thought(0, "The key is gone."), thought(0, "", call("Finish", SAID)), ended())
    assert told[0] == "not ended The key is gone. (asked to go on)"
    assert "Done." not in " ".join(told[1:])


def test_protocol_failures_are_said() -> None:
    told = lines(thought(0, "Action: Pick[", unreadable="it holds half a call."), ended())
    assert told == ["unreadable it holds half a call."]


def test_unreadable_arguments_are_shown_as_written() -> None:
    told = lines(thought(0, "x", call("Pick", None, '{"object": ')), acted(1, "Pick", {}))
    assert 'call Pick {"object":' in told


def test_what_a_model_says_cannot_steer_the_terminal() -> None:
    hostile = "\x1b[2J\x9b1m[bold red]\ud800\nnext"
    out = io.StringIO()
    progress = Progress(Console(file=out, width=400, force_terminal=True, no_color=True))
    progress.notify(thought(0, hostile, call("Pick", {"object": hostile})))
    progress.notify(acted(1, "Pick", {"object": hostile}, Outcome.REFUSED))
    told = out.getvalue()
    told.encode("utf-8")
    assert "\x1b[2J" not in told
    assert "\x9b" not in told
    assert "[bold red]" in told
    assert len(told.splitlines()) == 3
