"""Every sentence of feedback, word for word: what was done, and nothing more."""

from __future__ import annotations

import math
from itertools import product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from adamo_vh.action import Code, Feedback, Outcome
from adamo_vh.action_server.feedback import dropped, looked, moved_inside, picked, shown, walked
from adamo_vh.engine import BodyInfo, BodyReport
from adamo_vh.geometry import Vec3

HERE, THERE = Vec3(1.0, 2.0, 0.0), Vec3(1.0, 2.5, 0.0)
BODY = BodyInfo("mara", 0.25, 1.6, math.radians(65), 0.7, 2.0, 0.5)
DONE, CORRECTED, REFUSED = Outcome.DONE, Outcome.CORRECTED, Outcome.REFUSED


def report(
    outcome: Outcome, code: str, point: Vec3 | None = HERE, walked_m: float = 0.0
) -> BodyReport:
    return BodyReport(outcome, code, point, None, walked_m)


LOOKED = [
    (report(DONE, Code.OK), "Done: looking at (1.00, 2.00, 0.00)."),
    (
        report(CORRECTED, Code.GAZE_LIMITED),
        "Corrected: the neck does not turn that far; looking at (1.00, 2.00, 0.00).",
    ),
    (
        report(CORRECTED, Code.CANCELLED),
        "Corrected: stopped on request before the end, at (1.00, 2.00, 0.00).",
    ),
]

WALKED = [
    (report(DONE, Code.OK, walked_m=1.234), "Done: walked 1.23 m to (1.00, 2.00, 0.00)."),
    (report(DONE, Code.OK, walked_m=0.004), "Done: you already stand at (1.00, 2.00, 0.00)."),
    (
        report(CORRECTED, Code.STOPPED_SHORT, walked_m=1.0),
        "Corrected: (1.00, 2.50, 0.00) is not reachable; stopped at (1.00, 2.00, 0.00), "
        "0.50 m from it.",
    ),
    (
        report(CORRECTED, Code.CANCELLED, walked_m=1.0),
        "Corrected: stopped on request before the end, at (1.00, 2.00, 0.00).",
    ),
    (report(REFUSED, Code.UNREACHABLE, None), "Refused: no way leads there."),
    (
        report(REFUSED, Code.UNREACHABLE),
        "Refused: no way leads there; the nearest is at (1.00, 2.00, 0.00).",
    ),
    (
        report(REFUSED, "legs_tied", None),
        "Refused: the body cannot do that (legs tied).",
    ),
    (report(REFUSED, "", None), "Refused: the body cannot do that (no reason given)."),
]

PICKED = [
    (report(DONE, Code.OK), "Done: Cup_45 is in your hand."),
    (
        report(DONE, Code.REPOSITIONED, walked_m=0.5),
        "Done: walked 0.50 m closer; Cup_45 is in your hand.",
    ),
    (
        report(REFUSED, Code.UNREACHABLE),
        "Refused: no place to stand has Cup_45 within reach; the nearest is at (1.00, 2.00, 0.00).",
    ),
    (report(REFUSED, Code.GONE, None), "Refused: it is not in the room any more."),
    (report(REFUSED, Code.HAND_FULL, None), "Refused: your hand is full."),
    (
        report(CORRECTED, Code.CANCELLED),
        "Corrected: stopped on request before the end, at (1.00, 2.00, 0.00).",
    ),
]

DROPPED = [
    (report(DONE, Code.OK), "Done: Cup_45 rests at (1.00, 2.00, 0.00) on the floor."),
    (
        report(DONE, Code.REPOSITIONED, walked_m=2.0),
        "Done: walked 2.00 m closer; Cup_45 rests at (1.00, 2.00, 0.00) on the floor.",
    ),
    (
        report(CORRECTED, Code.PLACED_ELSEWHERE),
        "Corrected: the very point was not free or not supported; Cup_45 rests at "
        "(1.00, 2.00, 0.00) on the floor, 0.50 m from it.",
    ),
    (
        report(CORRECTED, Code.PLACED_ELSEWHERE, walked_m=0.25),
        "Corrected: walked 0.25 m closer; the very point was not free or not supported; Cup_45 "
        "rests at (1.00, 2.00, 0.00) on the floor, 0.50 m from it.",
    ),
    (
        report(REFUSED, Code.NO_FREE_SPOT, None),
        "Refused: no free, supported spot within 0.5 m of that point.",
    ),
    (
        report(REFUSED, Code.UNREACHABLE),
        "Refused: no place to stand has that point within reach; the nearest is at "
        "(1.00, 2.00, 0.00).",
    ),
    (report(REFUSED, Code.HAND_EMPTY, None), "Refused: your hand is empty."),
    (report(REFUSED, Code.GONE, None), "Refused: it is not in the room any more."),
    (
        report(CORRECTED, Code.CANCELLED),
        "Corrected: stopped on request before the end, at (1.00, 2.00, 0.00).",
    ),
]


def drop(told: BodyReport) -> Feedback:
    return dropped(told, "Cup_45", THERE, "on the floor", BODY)


@pytest.mark.parametrize(("told", "text"), LOOKED)
def test_after_look(told: BodyReport, text: str) -> None:
    assert looked(told).text == text


@pytest.mark.parametrize(("told", "text"), WALKED)
def test_after_walk(told: BodyReport, text: str) -> None:
    assert walked(told, THERE).text == text


@pytest.mark.parametrize(("told", "text"), PICKED)
def test_after_pick(told: BodyReport, text: str) -> None:
    assert picked(told, "Cup_45").text == text


@pytest.mark.parametrize(("told", "text"), DROPPED)
def test_after_drop(told: BodyReport, text: str) -> None:
    assert drop(told).text == text


def test_a_picture_is_shown() -> None:
    assert shown("Cup_45 close up") == Feedback(DONE, Code.OK, "Done: Cup_45 close up.")


places = st.builds(Vec3, st.floats(-3, 3), st.floats(-5, 3), st.floats(0, 3))
reports = st.builds(
    BodyReport,
    st.sampled_from(Outcome),
    st.sampled_from(Code) | st.text(max_size=20),
    st.none() | places,
    st.none(),
    st.floats(0, 20),
)
SENTENCES = {
    "look": looked,
    "walk": lambda told: walked(told, THERE),
    "pick": lambda told: picked(told, "Cup_45"),
    "drop": drop,
}


@pytest.mark.parametrize("after", SENTENCES)
@settings(max_examples=50, deadline=None)
@given(told=reports)
def test_whatever_an_engine_reports_the_sentence_begins_with_the_outcome(
    after: str, told: BodyReport
) -> None:
    said = SENTENCES[after](told)
    first, _, rest = said.text.partition(": ")
    assert first.lower() in (told.outcome, Outcome.REFUSED)
    assert first.lower() == said.outcome
    assert rest.endswith(".") and rest.strip(" .")
    assert said.code == told.code


@pytest.mark.parametrize(("after", "code"), list(product(SENTENCES, [*Code, "of_its_own"])))
def test_a_refusal_never_reads_as_success(after: str, code: str) -> None:
    said = SENTENCES[after](report(REFUSED, code, HERE if after == "look" else None))
    assert "None" not in said.text
    assert said.text.startswith("Refused: ") or code == Code.CANCELLED
    for success in ("is in your hand", "rests at", "walked", "looking at"):
        assert success not in said.text or after == "look"


@pytest.mark.parametrize(
    ("told", "outcome", "code", "text"),
    [
        (
            report(DONE, Code.OK, walked_m=1.0), CORRECTED, Code.MOVED_INSIDE,
            "Corrected: (1.00, 2.00, -0.20) is outside the room, so (1.00, 2.00, 0.00) was taken; "
            "walked 1.00 m to (1.00, 2.00, 0.00).",
        ),
        (
            report(CORRECTED, Code.STOPPED_SHORT), CORRECTED, Code.STOPPED_SHORT,
            "Corrected: (1.00, 2.00, -0.20) is outside the room, so (1.00, 2.00, 0.00) was taken; "
            "(1.00, 2.50, 0.00) is not reachable; stopped at (1.00, 2.00, 0.00), 0.50 m from it.",
        ),
        (
            report(REFUSED, Code.UNREACHABLE, None), REFUSED, Code.UNREACHABLE,
            "Refused: (1.00, 2.00, -0.20) is outside the room, so (1.00, 2.00, 0.00) was taken; "
            "no way leads there.",
        ),
    ],
)  # fmt: skip
def test_a_point_that_was_moved_inside_is_always_told(
    told: BodyReport, outcome: Outcome, code: str, text: str
) -> None:
    said = moved_inside(walked(told, THERE), Vec3(1.0, 2.0, -0.2), HERE)
    assert (said.outcome, said.code, said.text) == (outcome, code, text)
    assert said.walked_m == (told.walked_m if outcome is not REFUSED else 0.0)


@given(places)
def test_a_point_inside_changes_no_feedback(point: Vec3) -> None:
    said = walked(report(DONE, Code.OK, point, 1.0), point)
    assert moved_inside(said, point, point) is said
