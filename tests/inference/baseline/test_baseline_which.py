"""Which thing is meant where a place, a distance or a comparison tells, and what "it" means."""

from __future__ import annotations

import pytest
from tests.inference.baseline.meaning import parts, read
from tests.inference.baseline.room import TextRoom

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import Relation
from adamo_vh.inference.baseline.language.requests import understand
from adamo_vh.inference.baseline.mind.beliefs import told_by_text
from adamo_vh.inference.baseline.mind.choosing import _from_there, thing_of
from adamo_vh.inference.baseline.mind.memory import Memory
from adamo_vh.inference.baseline.mind.notes import Entry, apply
from adamo_vh.inference.baseline.sight.kinds import class_of
from adamo_vh.inference.baseline.tags import parts_of

SENTENCES = {
    "Pick the object left of the plate": ["from-left hold"],
    "Pick the cup left of the plate": ["Cup from-left hold"],
    "Pick the thing next to the plant": ["from-near hold"],
    "Take the cup from the table and put it on the floor": ["Cup from-surface floor"],
    "Pick up the nearest lock": ["Lock nearest hold"],
    "Pick the object that is closest to the plate": ["nearest hold"],
    "Pick the farthest object": ["farthest hold"],
    "Put three objects on the floor": ["all x3 floor"],
    "Put all non-red things on the floor": ["all but(all red) floor"],
    "Pick something blue": ["blue hold"],
    "Could I have the glass?": ["Glass hold"],
    "Hand the plate over": ["Plate hold"],
    "Put the cup as far from the plate as possible": ["Cup far(Plate)"],
    "Is the cup bigger than the glass?": ["? is Cup Cup largest"],
    "Which is bigger, the cup or the glass?": ["? which Cup largest"],
    "Which of the batteries is smaller?": ["? which Battery smallest"],
    "Which object is closest to the plate?": ["? which nearest"],
    "How far is the plant from the plate?": ["? distance IndoorPlant at near(Plate)"],
    "Where are you?": ["? stand"],
    "Go two metres forward": ["! walk ahead 2"],
    "step back": ["! walk back 0.6"],
    "one step to the left": ["! walk left 0.6"],
    "Turn right 90 degrees": ["! look right"],
    "Turn around by 180 degrees": ["! look back"],
}

REFUSED = {
    "Put the cup beside the plate and the glass": "which of the two",
    "Put the cup on another table": "one from another",
    "Pick the empty glass": "empty",
    "Turn left by 45 degrees": "90 or 180",
    "Put the cup somewhere else": "else",
}

AFTER = {
    "Put it on the floor": ["cup_45 floor"],
    "Put them on the floor": ["plate_57 floor", "cup_45 floor"],
    "Put the object on the floor": ["cup_45 floor"],
    "Put these objects on the floor": ["plate_57 floor", "cup_45 floor"],
    "Put everything on the floor": ["all floor"],
    "Put everything else on the floor": ["all but(plate_57) but(cup_45) floor"],
    "Pick the object left of the plate": ["from-left hold"],
    "How many objects are there?": ["? count all"],
    "Go two metres forward": ["! walk ahead 2"],
}


@pytest.mark.parametrize(("text", "meaning"), SENTENCES.items())
def test_places_and_comparisons_are_read(text, meaning):
    assert read(text) == meaning


@pytest.mark.parametrize(("text", "named"), REFUSED.items())
def test_what_cannot_be_told_apart_is_refused(text, named):
    plan = understand(text)
    assert named in plan.problem
    assert not plan.goals


@pytest.mark.parametrize(("text", "meaning"), AFTER.items())
def test_what_was_handled_before_is_meant_only_where_it_is_pointed_at(text, meaning):
    assert parts(understand(text, ("Cup_45", "Plate_57"))) == meaning


@pytest.mark.parametrize(
    ("text", "held"),
    [
        ("Pick the object closest to the plate", "Binoculars_21"),
        ("Pick the object to the left of the plate", "Binoculars_21"),
        ("Pick the cup on the shelf", ""),
        ("Pick the cup on the desk", ""),
        ("Pick the cup on the table", "Cup_45"),
    ],
)
def test_a_thing_is_told_by_its_place(text, held):
    assert (TextRoom(text).run().held or "") == held


@pytest.mark.parametrize(
    ("text", "says", "never"),
    [
        ("How many objects are on the table?", "19", "none"),
        ("Is the cup bigger than the key?", "Yes", "No"),
        ("Is the key larger than the cup?", "No", "Yes"),
        ("Which is smaller, the cup or the key?", "Key_34", "Cup_45"),
        ("Where are you?", "I stand at (", "nothing"),
    ],
)
def test_questions_are_answered_by_what_is_known(text, says, never):
    answer = TextRoom(text).run().answer
    assert says in answer
    assert never not in answer


@pytest.mark.parametrize(
    ("tag", "name", "number", "kind"),
    [
        ("Plate_57", "Plate", "57", "Plate"),
        ("57", "", "57", None),
        ("Wine_Bottle_36", "Wine_Bottle", "36", "WineBottle"),
        ("blue_cup", "blue_cup", "", "Cup"),
        ("thing-a", "thing-a", "", None),
    ],
)
def test_a_tag_has_a_name_and_a_number(tag, name, number, kind):
    assert parts_of(tag) == (name, number)
    assert class_of(tag) == kind


def test_the_other_one_is_of_the_kind_that_was_asked_for_before():
    former = "Pick the battery"
    assert parts(understand("Not that one, the other one", ("30",), former)) == [
        "Battery other but(30) hold"]  # fmt: skip
    assert "which other one" in understand("Pick the other one", ("30",), "Pick 30").problem
    assert parts(understand("And the glass too", ("45",), "Put it next to the plate")) == [
        "Glass near(Plate)"]  # fmt: skip


def test_what_is_held_can_be_let_go_though_no_list_tells_of_it():
    room = TextRoom("Put Key_34 on the floor", held="Key_34", heading_rad=3.1)
    assert "34" in room.run(4).on_floor()


def test_what_is_left_out_is_told_by_looks_where_tags_do_not_tell():
    (goal,) = understand("Put everything except the cup on the floor").goals
    assert told_by_text(goal.target, "Plate_57")
    assert not told_by_text(goal.target, "57")
    (goal,) = understand("Put everything on the floor").goals
    assert told_by_text(goal.target, "57")


def test_distances_survive_a_note():
    memory = Memory()
    apply(Entry(1, items=["seen from m: 0 2.1, Plate_57 1.6"]), memory)
    assert memory.seen_m == {"0": 2.1, "Plate_57": 1.6}


def test_what_stands_on_another_level_is_next_to_nothing() -> None:
    plant = thing_of("IndoorPlant_50", Vec3(1.86, 2.74, 1.1), 9000.0)
    above = thing_of("Flashlight_2", Vec3(1.81, 2.65, 1.75), 300.0)
    beside = thing_of("Binoculars_21", Vec3(1.62, 2.66, 1.0), 900.0)
    near = (Relation.NEAR, ("IndoorPlant",))
    fits = [_from_there(near, thing, [plant, above, beside], None) for thing in (above, beside)]
    assert fits[0] < 0.5 < fits[1]
