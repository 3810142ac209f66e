"""Where the baseline puts things, looks for them and goes, and how it words its turns."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from adamo_vh.action import Drop, Inspect, Look, Pick, Walk, parse, tool_schema
from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import Description, Goal, Relation
from adamo_vh.inference.baseline.language.requests import understand
from adamo_vh.inference.baseline.mind import placing, searching
from adamo_vh.inference.baseline.mind.choosing import targets, thing_of
from adamo_vh.inference.baseline.mind.evidence import claim
from adamo_vh.inference.baseline.mind.memory import (
    Decision,
    Finish,
    Job,
    Memory,
    Move,
    Search,
    Stand,
    Thing,
    to_point,
)
from adamo_vh.inference.baseline.mind.searching import (
    SURVEY,
    SearchStep,
    Stage,
    aim,
    next_step,
    stage,
)
from adamo_vh.inference.baseline.prompt.reading import Prompt, Room
from adamo_vh.inference.baseline.prompt.speaking import Manner, manner_of, say
from adamo_vh.inference.baseline.prompt.state_text import Body
from adamo_vh.inference.messages import SystemMessage

ROOM = Room(-3.0, 3.0, -5.0, 3.0)
HERE = Body(Vec3(-2.0, -1.0, 0.0), 0.0, Vec3(0.0, -1.0, 0.8), "Cup_45")
PROMPT = Prompt("", ROOM, body=HERE)
TABLE_M = 0.78


def thing(tag: str, x: float, y: float, volume_cm3: float, on_m: float = TABLE_M) -> Thing:
    new = thing_of(tag, Vec3(x, y, 0.0), volume_cm3)
    return replace(new, position=Vec3(x, y, on_m + new.height_m / 2))


CUP = thing("Cup_45", -0.4, -0.4, 2050.0)
PLATE, GLASS, LOCK = (
    thing("Plate_57", 0.3, -0.6, 1875.0),
    thing("Glass_37", 0.3, -1.1, 1430.0),
    thing("Lock_0", 0.0, -1.3, 69.0),
)


def known(*others: Thing) -> Memory:
    """The cup is in the hand and came from its place; the plate and the glass stand on a table."""
    return Memory(
        hand="Cup_45",
        began=Stand(HERE.position, 0.0),
        jobs=[Job(0, "Cup_45")],
        things={t.tag: t for t in (CUP, PLATE, GLASS, LOCK, *others)},
        rests={t.tag: "on the table" for t in (PLATE, GLASS, LOCK)},
        came_from={"Cup_45": CUP.position},
        fits={("place", 0): {"Plate_57": 1.0}, ("second", 0): {"Glass_37": 1.0}},
    )


WISHES = [
    "Put the cup on the floor",
    "Put the cup in a corner",
    "Put the cup near the plate",
    "Put the cup to the left of the plate",
    "Put the cup to the right of the plate",
    "Put the cup in front of the plate",
    "Put the cup behind the plate",
    "Put the cup between the plate and the glass",
    "Put the cup far from the plate",
    "Put the cup back where it was",
    "Move the cup 20 cm to the left",
]


def put(goal: Goal, memory: Memory) -> Vec3 | None:
    anchor = memory.things["Plate_57"] if goal.anchor else None
    return placing.spot(PROMPT, memory, goal, memory.jobs[0], CUP, anchor)


@pytest.mark.parametrize("wish", WISHES)
@pytest.mark.parametrize("tries", [0, 1, 2])
def test_put_where_it_is_meant_to_go_the_wish_is_met(wish: str, tries: int) -> None:
    (goal,) = understand(wish).goals
    memory = known()
    memory.jobs = [Job(0, "Cup_45", tries=tries)]
    spot = put(goal, memory)
    assert spot is not None
    assert ROOM.x_min < spot.x < ROOM.x_max and ROOM.y_min < spot.y < ROOM.y_max
    rest = replace(CUP, position=spot + Vec3(0.0, 0.0, CUP.height_m / 2))
    memory.things["Cup_45"], memory.hand = rest, ""
    memory.rests["Cup_45"] = "on the floor" if spot.z < 0.1 else "on the table"
    assert claim(goal, 0, "Cup_45", memory, ROOM) is not None


@pytest.mark.parametrize("wish", ["Put the cup on the floor", "Put the cup near the plate"])
def test_another_try_is_another_spot(wish: str) -> None:
    (goal,) = understand(wish).goals
    spots = []
    for tries in range(4):
        memory = known()
        memory.jobs = [Job(0, "Cup_45", tries=tries)]
        spots.append(put(goal, memory))
    assert len(set(spots)) == 4


def test_a_spot_by_a_thing_keeps_off_its_neighbours() -> None:
    neighbour = thing("Cup_46", 0.3, -0.85, 2050.0)
    (goal,) = understand("Put the cup near the plate").goals
    spot = put(goal, known(neighbour))
    assert spot is not None
    assert spot.horizontal_distance(neighbour.position) > 0.1
    assert spot.horizontal_distance(PLATE.position) <= ROOM.near_m


def test_a_spot_on_the_floor_keeps_off_what_lies_there() -> None:
    (goal,) = understand("Put the cup on the floor").goals
    first = put(goal, known())
    assert first is not None
    lying = thing("Plate_58", first.x, first.y, 1875.0, on_m=0.0)
    second = put(goal, known(lying))
    assert second is not None
    assert second.horizontal_distance(first) > 0.15


@pytest.mark.parametrize("relation", [Relation.HOME, Relation.SHIFT, Relation.EDGE])
def test_what_came_from_nowhere_has_no_place_to_go_back_to(relation: Relation) -> None:
    memory = known()
    memory.came_from.clear()
    assert put(Goal(Description("it"), relation), memory) is None


def test_beside_nothing_is_nowhere() -> None:
    goal = Goal(Description("it"), Relation.NEAR)
    assert placing.spot(PROMPT, known(), goal, Job(0, "Cup_45"), CUP, None) is None


# --- which things ---------------------------------------------------------------------------


def chosen(wish: str, fits: dict[str, float], at: Stage) -> list[str] | None:
    memory = known(thing("Lock_18", 0.1, -1.4, 98.0))
    memory.jobs, memory.fits = [], {("goal", 0): fits}
    return targets(understand(wish).goals[0], 0, memory, at)


BOTH = {"Lock_0": 1.0, "Lock_18": 1.0}


@pytest.mark.parametrize(
    ("wish", "fits", "at", "tags"),
    [
        ("Pick the plate", {"Plate_57": 1.0}, Stage.BEGUN, ["Plate_57"]),
        ("Pick the plate", {}, Stage.BEGUN, None),
        ("Pick the plate", {}, Stage.OVER, []),
        ("Pick the plate", {"Glass_37": 0.35, "Plate_57": 0.4}, Stage.BEGUN, None),
        ("Pick the plate", {"Glass_37": 0.35, "Plate_57": 0.4}, Stage.CLOSE, ["Plate_57"]),
        ("Pick the plate", {"Glass_37": 0.05}, Stage.OVER, []),
        ("Put both locks on the floor", BOTH, Stage.BEGUN, None),
        ("Put both locks on the floor", BOTH, Stage.CLOSE, ["Lock_0", "Lock_18"]),
        ("Put both locks on the floor", {"Lock_0": 1.0}, Stage.CLOSE, None),
        ("Put both locks on the floor", {"Lock_0": 1.0}, Stage.OVER, ["Lock_0"]),
        ("Pick the smaller lock", BOTH, Stage.BEGUN, None),
        ("Pick the smaller lock", BOTH, Stage.CLOSE, ["Lock_0"]),
        ("Pick the larger lock", BOTH, Stage.CLOSE, ["Lock_18"]),
    ],
)
def test_the_more_was_searched_the_less_must_fit(
    wish: str, fits: dict[str, float], at: Stage, tags: list[str] | None
) -> None:
    found = chosen(wish, fits, at)
    assert (found if found is None else sorted(found)) == tags


# --- the way round the room -----------------------------------------------------------------


def test_the_search_ends_and_looks_from_all_over_the_room() -> None:
    memory, prompt = Memory(), PROMPT
    steps: list[SearchStep] = []
    while stage(prompt, memory) is not Stage.OVER:
        step = next_step(prompt, memory)
        steps.append(step)
        assert len(steps) < 60
        memory.views += 1
        at = prompt.body.position
        if step.name == "Walk":
            prompt = replace(prompt, body=replace(prompt.body, position=step.point))
        else:
            yaw = math.atan2(step.point.y - at.y, step.point.x - at.x)
            prompt = replace(prompt, body=replace(prompt.body, heading_rad=yaw))
    assert [step.name for step in steps[:SURVEY]] == ["Look"] * SURVEY
    walks = [step.point for step in steps if step.name == "Walk"]
    assert set(walks) == set(searching.places(ROOM))
    assert all(step.search is Search.ROUND for step in steps)


def test_the_first_round_shows_all_directions() -> None:
    prompt, seen = PROMPT, [0.0]
    for views in range(SURVEY):
        step = next_step(prompt, Memory(views=views))
        here = prompt.body.position
        yaw = math.atan2(step.point.y - here.y, step.point.x - here.x)
        seen.append(yaw)
        prompt = replace(prompt, body=replace(prompt.body, heading_rad=yaw))
    quarters = sorted(round(yaw / (math.pi / 2)) % 4 for yaw in seen)
    assert quarters == [0, 1, 2, 3]


def test_what_was_seen_from_afar_is_gone_to_and_looked_at() -> None:
    far = thing("Key_34", 2.5, 2.5, 2.6)
    memory = Memory(views=SURVEY, things={"Key_34": far}, seen_m={"Key_34": 5.0})
    assert stage(PROMPT, memory) is Stage.ROUND
    walk = next_step(PROMPT, memory)
    assert (walk.name, walk.search) == ("Walk", Search.APPROACH)
    assert walk.point == Vec3(2.5, 2.5, 0.0)
    memory.visits = 1
    look = next_step(PROMPT, memory)
    assert (look.name, look.search, look.point) == ("Look", Search.NEARER, far.position)


@settings(max_examples=50, deadline=None)
@given(st.floats(-2.9, 2.9), st.floats(-4.9, 2.9), st.floats(-3.2, 3.2), st.integers(0, 27))
def test_every_step_of_the_search_is_in_the_room(
    x: float, y: float, heading: float, views: int
) -> None:
    prompt = replace(PROMPT, body=Body(Vec3(x, y, 0.0), heading))
    step = next_step(prompt, Memory(views=views))
    assert ROOM.x_min <= step.point.x <= ROOM.x_max
    assert ROOM.y_min <= step.point.y <= ROOM.y_max


@pytest.mark.parametrize(
    ("text", "dx", "dy"),
    [
        ("Look left", 0, 1), ("Look right", 0, -1), ("Look behind you", -1, 0),
        ("Look up", 1, 0), ("Look down", 1, 0), ("Walk left 1 m", 0, 1), ("Walk back 1 m", -1, 0),
    ],
)  # fmt: skip
def test_a_direction_is_that_of_the_body(text: str, dx: int, dy: int) -> None:
    (act,) = understand(text).acts
    prompt = replace(PROMPT, body=replace(HERE, position=Vec3(0.0, 0.0, 0.0)))
    point = aim(act, prompt, Memory())
    assert point is not None
    length = math.hypot(point.x, point.y)
    assert (point.x / length, point.y / length) == pytest.approx((dx, dy), abs=0.01)
    assert (point.z > 1.6) == (text == "Look up")


def test_back_is_where_it_came_from() -> None:
    (act,) = understand("Go back").acts
    begun, home = Stand(Vec3(1.0, 1.0, 0.0), 0.0), Stand(Vec3(-2.0, -1.0, 0.0), 0.0)
    assert aim(act, PROMPT, Memory(began=begun, home=home)) == begun.position
    here = Stand(HERE.position, 0.0)
    assert aim(act, PROMPT, Memory(began=here, home=home)) == home.position
    assert aim(act, PROMPT, Memory()) is None


# --- words of a turn ------------------------------------------------------------------------

TOOLS = [tool_schema(action) for action in (Look, Walk, Pick, Drop)]
PICK = Move("It is the plate.", "Pick", (("object", "Plate_57"),))
LOOK = Move("I look.", "Look", to_point(Vec3(0.0, 0.0, 1.0)))


@pytest.mark.parametrize(
    ("system", "calls"),
    [
        ("One call at a time.", 1),
        ("You may make several calls in one turn, up to 3.", 3),
        ("You may make several calls in one turn.", 4),
    ],
)
def test_several_calls_are_made_only_where_they_are_welcome(system: str, calls: int) -> None:
    assert manner_of([SystemMessage(system)], TOOLS).plan == calls


def test_the_tools_on_offer_are_those_of_the_schemas() -> None:
    manner = manner_of([], [*TOOLS, tool_schema(Inspect)])
    assert manner.inspects and not manner.finishes
    assert not manner_of([], TOOLS).inspects


def test_calls_are_valid_and_carry_the_note_as_text() -> None:
    said = say(Decision("I see it.", (LOOK, PICK)), Manner(), "Pick the plate")
    assert said.text == "I see it."
    assert [call.name for call in said.calls] == ["Look", "Pick"]
    assert len({call.id for call in said.calls}) == 2
    for call in said.calls:
        parse(call.name, call.arguments, (Look, Walk, Pick, Drop))


def test_where_tools_take_notes_the_first_call_has_it() -> None:
    manner = Manner(notes=frozenset({"Look", "Pick"}))
    said = say(Decision("I see it.", (LOOK, PICK)), manner, "")
    assert said.text == ""
    notes = [(call.arguments or {})["note"] for call in said.calls]
    assert notes[0] == "I see it."
    assert notes[1] != notes[0]
    assert all(0 <= (call.arguments or {})["confidence"] <= 1 for call in said.calls)


def test_a_tool_that_is_missing_is_said_and_nothing_is_called() -> None:
    said = say(Decision("", (PICK,)), Manner(tools=frozenset({"Look"})), "Pick the plate")
    assert said.calls == ()
    assert said.text == "I cannot go on: I have no tool named Pick."


def test_the_end_is_text_or_a_finish_where_there_is_one() -> None:
    end = Decision(finish=Finish("Done: I hold Plate_57.", "by the feedback", "nothing", 0.9))
    assert say(end, Manner(), "").text == "Done: I hold Plate_57."
    manner = Manner(tools=frozenset({"Finish"}), notes=frozenset({"Finish"}))
    (call,) = say(end, manner, "Pick the plate").calls
    assert call.name == "Finish"
    told = call.arguments or {}
    assert told["answer"] == "Done: I hold Plate_57."
    assert (told["asked"], told["verified"]) == ("Pick the plate", "by the feedback")


def test_the_same_step_is_said_in_the_same_words() -> None:
    step = Decision("I see it.", (LOOK, PICK))
    assert say(step, Manner(), "x") == say(step, Manner(), "x")
