"""A turn as it is read: notes, answers and ends; and the limits that end an episode otherwise."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.errors import ConfigError
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Ending, Reply
from adamo_vh.record.termination import Limits, Stop, Stopwatch, TerminationReason
from adamo_vh.record.turn import Turn, Wish

json_values = st.recursive(
    st.none() | st.booleans() | st.floats(allow_nan=False) | st.integers() | st.text(max_size=9),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=5,
)


def wish(name: str = "Pick", noted: bool = True, **arguments: Any) -> Wish:
    return Wish.of(ToolCall("1", name, arguments), noted=noted, can_finish=True)


def turn(text: str = "", *wishes: Wish) -> Turn:
    return Turn(Reply(AIMessage(text, tuple(w.call for w in wishes))), wishes)


# --- one call -------------------------------------------------------------------------------


def test_the_note_is_no_argument_of_the_action() -> None:
    read = wish(object="Cup_45", note="It is near.", confidence=0.8)
    assert read.arguments == {"object": "Cup_45"}
    assert (read.note, read.confidence) == ("It is near.", 0.8)
    assert read.call.arguments == {"object": "Cup_45", "note": "It is near.", "confidence": 0.8}


def test_where_calls_carry_no_note_all_arguments_are_the_actions() -> None:
    read = wish(noted=False, object="Cup_45", note="mine")
    assert read.arguments == {"object": "Cup_45", "note": "mine"}
    assert (read.note, read.confidence) == ("", None)


@pytest.mark.parametrize(
    ("said", "read"),
    [
        (0, 0.0), (1, 1.0), (0.25, 0.25), (-3, 0.0), (95, 1.0), (10**400, 1.0), (True, None),
        ("0.9", None), (None, None), ([0.9], None), ({}, None),
    ],
)  # fmt: skip
def test_a_confidence_is_a_number_from_0_to_1_or_none(said: object, read: float | None) -> None:
    assert wish(confidence=said).confidence == read


@given(st.none() | st.dictionaries(st.text(max_size=12), json_values, max_size=5), st.booleans())
def test_whatever_a_call_carries_is_read(arguments: dict[str, Any] | None, noted: bool) -> None:
    read = Wish.of(ToolCall("1", "Pick", arguments), noted=noted, can_finish=True)
    assert (read.arguments is None) == (arguments is None)
    assert not read.is_finish
    assert read.confidence is None or 0.0 <= read.confidence <= 1.0
    if arguments is not None and read.arguments is not None:
        left = {"note", "confidence"} if noted else set()
        assert read.arguments == {k: v for k, v in arguments.items() if k not in left}


def test_finish_ends_only_where_it_is_offered() -> None:
    call = ToolCall("1", "Finish", {"answer": "Done."})
    assert Wish.of(call, noted=True, can_finish=True).is_finish
    assert not Wish.of(call, noted=True, can_finish=False).is_finish
    assert not wish("finish").is_finish


# --- a whole turn ---------------------------------------------------------------------------


def test_text_alone_is_the_answer_and_ends() -> None:
    said = turn("I hold the cup.")
    assert (said.is_prose, said.ends, said.answer) == (True, True, "I hold the cup.")
    assert said.stop == Stop(TerminationReason.ANSWERED, answer="I hold the cup.")


def test_a_call_with_text_is_no_answer() -> None:
    said = turn("I take the cup.", wish(object="Cup_45"))
    assert (said.is_prose, said.ends, said.note) == (False, False, "I take the cup.")


def test_without_text_the_notes_of_the_calls_are_the_note_and_none_is_said_twice() -> None:
    said = turn("  ", wish(note="First."), wish(note="First."), wish(note="Then."))
    assert said.note == "First.\nThen."


def test_finish_alone_ends_with_its_answer() -> None:
    said = turn("", wish("Finish", answer="I hold the cup."))
    assert (said.ends, said.answer) == (True, "I hold the cup.")
    assert said.stop.reason is TerminationReason.ANSWERED


def test_finish_beside_another_call_does_not_end() -> None:
    said = turn("", wish(object="Cup_45"), wish("Finish", answer="Done."))
    assert said.finish is None
    assert not said.ends


def test_a_finish_without_an_answer_tells_its_note() -> None:
    assert turn("", wish("Finish", note="All is done.")).answer == "All is done."
    empty = turn("", wish("Finish"))
    assert empty.stop == Stop(TerminationReason.EMPTY_REPLY)


@pytest.mark.parametrize("text", ["", "  ", "\n\t"])
def test_nothing_is_nothing_and_does_not_go_back(text: str) -> None:
    said = turn(text)
    assert said.is_empty
    assert not said.goes_back
    assert said.stop.reason is TerminationReason.EMPTY_REPLY


def test_what_a_filter_refused_does_not_go_back() -> None:
    said = Turn(Reply(AIMessage("half an ans"), ending=Ending.FILTERED))
    assert not said.goes_back
    assert turn("half an answer").goes_back


# --- limits ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("steps", "seconds", "reason"),
    [
        (0, 0.0, None),
        (59, 599.9, None),
        (60, 0.0, TerminationReason.STEP_LIMIT),
        (0, 600.0, TerminationReason.TIME_LIMIT),
        (60, 600.0, TerminationReason.STEP_LIMIT),
    ],
)
def test_a_cap_ends_when_it_is_reached(
    steps: int, seconds: float, reason: TerminationReason | None
) -> None:
    stop = Limits().exceeded(steps, seconds)
    assert (stop.reason if stop else None) is reason


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("max_steps", 0), ("max_steps", -1), ("max_steps", 2.5), ("max_steps", True),
        ("max_steps", "60"), ("max_steps", None), ("max_unreadable", 0), ("max_repeats", -1),
        ("max_repeats", False), ("max_seconds", -0.1), ("max_seconds", math.nan),
        ("max_seconds", math.inf), ("max_seconds", "600"), ("max_seconds", True),
    ],
)  # fmt: skip
def test_what_is_no_cap_is_refused_by_its_name(name: str, value: Any) -> None:
    with pytest.raises(ConfigError, match=f"{name} is .*: use a "):
        Limits(**{name: value})


@pytest.mark.parametrize(("name", "value"), [("max_repeats", 0), ("max_seconds", 0)])
def test_nothing_can_be_a_cap(name: str, value: Any) -> None:
    assert getattr(Limits(**{name: value}), name) == value


def test_only_what_is_nobodys_fault_is_unscored() -> None:
    unscored = {reason for reason in TerminationReason if not reason.is_scored}
    assert unscored == {TerminationReason.BROKEN, TerminationReason.RUN_BUDGET}


def test_what_is_left_out_is_not_counted() -> None:
    watch = Stopwatch()
    watch.leave_out(1000.0)
    assert -1000.0 <= watch.seconds < -900.0
    watch.leave_out(-1000.0)
    assert 0.0 <= watch.seconds < 60.0
