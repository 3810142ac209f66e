"""What the feedback says became of a thing."""

from __future__ import annotations

import pytest
from tests.tabletop import tabletop

from adamo_vh.action import Code, Feedback, Outcome
from adamo_vh.action_server import feedback
from adamo_vh.engine import BodyInfo, BodyReport
from adamo_vh.geometry import Vec3
from adamo_vh.observation import AgentState
from adamo_vh.record.trajectory import Acted
from adamo_vh.report.whereabouts import Whereabouts, followed

BODY = tabletop().body
INFO = BodyInfo("mara", 0.3, 1.6, 1.2, 0.7, 2.0, 0.5)


def acted(step: int, name: str, held: str | None, said: Feedback) -> Acted:
    agent = AgentState(BODY.position, 0.0, BODY.gaze, BODY.eyes, held)
    return Acted(step, name, name, {}, said, agent, "hash", "{}", 0.1)


def picked(step: int, tag: str) -> Acted:
    return acted(step, "Pick", tag, feedback.picked(BodyReport(Outcome.DONE, Code.OK), tag))


def dropped(step: int, tag: str, support: str, *, off_m: float = 0.0) -> Acted:
    point = Vec3(-1.5, 2.25, 0.78)
    outcome = Outcome.CORRECTED if off_m else Outcome.DONE
    report = BodyReport(outcome, Code.OK, point, None, 1.2)
    said = feedback.dropped(report, tag, point + Vec3(off_m, 0, 0), support, INFO)
    return acted(step, "Drop", None, said)


def test_what_is_picked_is_in_the_hand() -> None:
    (item,) = followed([picked(1, "Tape_4")]).values()
    assert item == Whereabouts("Tape_4", 1, "in the hand")
    assert item.is_held and item.support == ""


@pytest.mark.parametrize("off_m", [0.0, 0.31])
@pytest.mark.parametrize(
    ("support", "name"),
    [
        ("on the tall shelf (lower)", "tall shelf"),
        ("on the floor", "floor"),
        ("on Plate_57", "Plate_57"),
        ("and does not rest on anything", ""),
    ],
)
def test_what_is_put_down_rests_where_the_feedback_says(
    off_m: float, support: str, name: str
) -> None:
    acts = [picked(1, "Tape_4"), dropped(2, "Tape_4", support, off_m=off_m)]
    (item,) = followed(acts).values()
    assert (item.step, item.place, item.plan) == (2, support, (-1.5, 2.25))
    assert item.support == name


def test_things_are_followed_from_one_instruction_to_the_next() -> None:
    before = followed([picked(1, "4"), dropped(2, "4", "on the table"), picked(3, "57")])
    after = followed([dropped(4, "57", "on the floor")], before)
    assert {tag: item.place for tag, item in after.items()} == {
        "4": "on the table",
        "57": "on the floor",
    }


def test_what_left_the_hand_untold_is_nowhere() -> None:
    odd = acted(2, "Throw", None, Feedback(Outcome.DONE, "ok", "Done: thrown."))
    assert followed([picked(1, "4"), odd]) == {}


def test_feedback_about_another_thing_is_not_taken_for_this_one() -> None:
    said = Feedback(Outcome.DONE, "ok", "Done: Plate_57 rests at (1, 2, 3) on the floor.")
    assert followed([picked(1, "4"), acted(2, "Drop", None, said)]) == {}


def test_a_point_that_is_none_is_left_out() -> None:
    said = Feedback(Outcome.DONE, "ok", "Done: 4 rests at (here) on the floor.")
    assert followed([picked(1, "4"), acted(2, "Drop", None, said)]) == {}
