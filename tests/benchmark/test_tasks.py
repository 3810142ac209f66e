"""The fifteen tasks: every row of the paper's table, the computed levels, and the oracle."""

from __future__ import annotations

import pytest
from tests.benchmark.half_plan import first_half
from tests.tabletop import BODY, OBJECTS, carried_out, held, resting, tabletop

from adamo_vh.action import Drop, Look, Pick, Walk
from adamo_vh.benchmark.checkers import Score, score
from adamo_vh.benchmark.conditions import Condition, Holds, Near, OnFloor
from adamo_vh.benchmark.oracle import PATIENCE, Oracle
from adamo_vh.benchmark.tasks import TASKS, Family, Task, task
from adamo_vh.benchmark.taxonomy import Act, Difficulty
from adamo_vh.engine import WorldState
from adamo_vh.errors import ConfigError

STEP_CAP = 60

# id, prompt, printed (ACT, REF, REL, level), computed (ACT, REF, REL, level), conditions
ROWS = [
    ("T1", "Pick the object tagged as 34", (1, 0, 0, 1), (1, 0, 0, 1), "holds 34"),
    ("T2", "Pick the plate", (1, 1, 0, 2), (1, 1, 0, 2), "holds 57"),
    ("T3", "Pick the blue circular object", (1, 1, 0, 2), (1, 3, 0, 4), "holds 4"),
    (
        "T4",
        "Pick the plate and place it on the floor",
        (2, 1, 1, 4),
        (2, 1, 1, 4),
        "57 on floor",
    ),
    (
        "T5",
        "Pick the object tagged as 4 and place it near the indoor plant",
        (2, 1, 2, 5),
        (2, 1, 2, 5),
        "4 near 50",
    ),
    (
        "T6",
        "Pick the smallest object then place it on the floor",
        (2, 3, 1, 6),
        (2, 3, 1, 6),
        "34 on floor",
    ),
    (
        "T7",
        "Pick the flashlight and place it on the floor in a corner of the room",
        (2, 1, 4, 7),
        (2, 1, 4, 7),
        "2 in a corner area",
    ),
    (
        "T8",
        "Pick the glass and the plate then put them on the floor",
        (4, 2, 2, 8),
        (4, 2, 2, 8),
        "37 on floor; 57 on floor",
    ),
    (
        "T9",
        "Pick object tagged as 37 then place it next to the plate, then go pick object tagged as 30"
        " and place it next to object tagged as 3",
        (4, 1, 4, 9),
        (4, 1, 4, 9),
        "37 near 57; 30 near 3",
    ),
    (
        "T10",
        "Pick the glass then place it next to the plate, moreover pick the binoculars and place it"
        " next to the screwdriver",
        (4, 4, 4, 11),
        (4, 4, 4, 12),
        "37 near 57; 21 near 5",
    ),
    (
        "T11",
        "Pick object tagged as 4 and place it near the indoor plant, then pick the glass and place"
        " it next to the plate",
        (4, 3, 4, 12),
        (4, 3, 4, 11),
        "4 near 50; 37 near 57",
    ),
    (
        "T12",
        "Pick the cup, peanut butter, and pills and place them on the floor",
        (6, 3, 3, 12),
        (6, 3, 3, 12),
        "45 on floor; 8 on floor; 20 on floor",
    ),
    (
        "T13",
        "Pick the cylindrical can and place it next to the indoor plant, and pick the binoculars"
        " and place it next to the screwdriver",
        (4, 4, 4, 12),
        (4, 5, 4, 13),
        "19 near 50; 21 near 5",
    ),
    (
        "T14",
        "Pick all objects with white parts and place them on the floor",
        (10, 3, 5, 15),
        (10, 3, 5, 18),
        "57 on floor; 19 on floor; 20 on floor; 23 on floor; 36 on floor",
    ),
    (
        "T15",
        "Pick all objects that have a printed product label and place them on the floor",
        (10, 5, 5, 20),
        (10, 5, 5, 20),
        "8 on floor; 19 on floor; 20 on floor; 23 on floor; 36 on floor",
    ),
]

FAMILIES = {
    Family.SINGLE: {"T1", "T2", "T3", "T4", "T5"},
    Family.RELATIONAL: {"T6", "T7", "T10"},
    Family.SEVERAL: {"T8", "T9", "T11", "T12", "T13"},
    Family.LONG: {"T14", "T15"},
}

every_task = pytest.mark.parametrize("item", TASKS, ids=lambda item: item.id)


def play(
    conditions: tuple[Condition, ...],
    seen: set[int] | None = None,
    hidden: frozenset[int] = frozenset(),
) -> tuple[WorldState, list[Look | Walk | Pick | Drop]]:
    """Let the oracle play on the tabletop.

    Args:
        conditions: What the oracle is to bring about.
        seen: Ids seen before the first action; all by default.
        hidden: Ids that only a Look after a Walk shows.
    """
    state, actions = tabletop(), list[Look | Walk | Pick | Drop]()
    known = set(OBJECTS) if seen is None else set(seen)
    oracle = Oracle(conditions, str, BODY)
    while (action := oracle.next_action(state, known)) is not None:
        assert len(actions) < STEP_CAP
        if isinstance(action, Pick):
            assert int(action.object) in known
        actions.append(action)
        state = carried_out(state, action)
        if isinstance(action, Look):
            walked = any(isinstance(done, Walk) for done in actions)
            known |= set(OBJECTS) - (frozenset() if walked else hidden)
    return state, actions


def played(item: Task, conditions: tuple[Condition, ...]) -> Score:
    return score(tabletop(), play(conditions)[0], item)


@pytest.mark.parametrize(
    ("task_id", "prompt", "printed", "computed", "conditions"), ROWS, ids=[row[0] for row in ROWS]
)
def test_every_row_of_the_table(
    task_id: str,
    prompt: str,
    printed: tuple[int, int, int, int],
    computed: tuple[int, int, int, int],
    conditions: str,
) -> None:
    item = task(task_id)
    assert item.prompt == prompt
    assert item.printed == Difficulty(*printed)
    assert item.computed == Difficulty(*computed)
    assert "; ".join(map(str, item.conditions)) == conditions


def test_there_are_fifteen_tasks_in_order() -> None:
    assert [item.id for item in TASKS] == [f"T{n}" for n in range(1, 16)]
    assert [row[0] for row in ROWS] == [item.id for item in TASKS]


@pytest.mark.parametrize("family", Family)
def test_families_are_the_papers(family: Family) -> None:
    assert {item.id for item in TASKS if item.family is family} == FAMILIES[family]


def test_a_task_is_found_by_its_id_in_either_case() -> None:
    assert task("T7") is task("t7") is TASKS[6]


def test_an_unknown_task_names_the_known_ones() -> None:
    with pytest.raises(ConfigError, match=r"'T16'.*T1, T2, .*T15"):
        task("T16")


@every_task
def test_a_pick_for_every_target_and_a_drop_for_every_placement(item: Task) -> None:
    placements = [c for c in item.conditions if not isinstance(c, Holds)]
    assert item.units.count(Act.PICK) == len(item.targets) == len(item.conditions)
    assert item.units.count(Act.DROP) == len(placements)


@every_task
def test_anchors_are_not_targets(item: Task) -> None:
    anchors = {c.anchor for c in item.conditions if isinstance(c, Near)}
    assert not anchors & item.targets


@every_task
def test_doing_nothing_scores_zero(item: Task) -> None:
    result = score(tabletop(), tabletop(), item)
    assert (result.completion, result.strict, result.violations) == (0.0, 0.0, ())


@every_task
def test_the_oracle_scores_one_strictly(item: Task) -> None:
    result = played(item, item.conditions)
    assert (result.completion, result.strict, result.violations) == (1.0, 1.0, ())


@every_task
def test_half_a_plan_scores_its_fraction(item: Task) -> None:
    count = len(item.conditions)
    result = played(item, first_half(item.conditions))
    assert result.completion == (count // 2) / count
    assert result.strict == 0.0


@every_task
def test_the_oracle_spends_a_pick_and_a_drop_on_each_object(item: Task) -> None:
    _, actions = play(item.conditions)
    assert not any(isinstance(action, Look | Walk) for action in actions)
    assert len(actions) == item.computed.act


@every_task
def test_the_oracle_looks_before_it_picks_what_it_has_not_seen(item: Task) -> None:
    state, actions = play(item.conditions, seen=set())
    assert isinstance(actions[0], Look)
    assert score(tabletop(), state, item).strict == 1.0


@every_task
def test_the_oracle_walks_to_see_what_is_hidden(item: Task) -> None:
    state, actions = play(item.conditions, seen=set(), hidden=item.targets)
    assert [type(action) for action in actions[:3]] == [Look, Walk, Look]
    assert score(tabletop(), state, item).strict == 1.0


def test_the_oracle_gives_up_what_never_comes_into_view() -> None:
    oracle, state = Oracle((Holds(34),), str, BODY), tabletop()
    actions = []
    while (action := oracle.next_action(state, set())) is not None:
        actions.append(action)
        state = carried_out(state, action)
    assert 2 < len(actions) <= PATIENCE
    assert {type(action) for action in actions} == {Look, Walk}


def test_the_oracle_tries_another_spot_when_a_drop_was_refused() -> None:
    state, oracle = held(tabletop(), 57), Oracle((OnFloor(57),), str, BODY)
    drops = [oracle.next_action(state, {57}) for _ in range(4)]
    spots = [(drop.x, drop.y, drop.z) for drop in drops if isinstance(drop, Drop)]
    assert len(set(spots)) == len(drops)
    assert {z for _, _, z in spots} == {0.0}


def test_the_oracle_takes_back_what_was_corrected_to_a_wrong_place() -> None:
    start, oracle = tabletop(), Oracle((Near(37, 57),), str, BODY)
    drop = oracle.next_action(held(start, 37), {37})
    corrected = resting(start, 37, -0.424, -1.0, support="table")
    assert isinstance(drop, Drop)
    assert oracle.next_action(corrected, {37}) == Pick("37")
    again = oracle.next_action(held(corrected, 37), {37})
    assert isinstance(again, Drop)
    assert again != drop


def test_the_oracle_empties_a_wrong_hand_first() -> None:
    action = Oracle((Holds(57),), str, BODY).next_action(held(tabletop(), 34), set(OBJECTS))
    assert isinstance(action, Drop)
    assert action.object == "34"


def test_the_oracle_calls_objects_by_the_tags_of_the_labeling() -> None:
    oracle = Oracle((Holds(57),), lambda object_id: f"Plate_{object_id}", BODY)
    assert oracle.next_action(tabletop(), {57}) == Pick("Plate_57")


def test_half_of_an_odd_plan_only_picks_the_one_in_the_middle() -> None:
    assert first_half(task("T12").conditions) == (OnFloor(45), Holds(8))
    assert first_half(task("T1").conditions) == ()
