"""What the baseline takes from feedback and carries in its notes: all that was said, no more."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from adamo_vh.action import Code, Outcome
from adamo_vh.action_server.feedback import dropped, picked
from adamo_vh.engine import BodyInfo, BodyReport
from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import Plan
from adamo_vh.inference.baseline.language.requests import understand
from adamo_vh.inference.baseline.mind import notes
from adamo_vh.inference.baseline.mind.answering import finish
from adamo_vh.inference.baseline.mind.choosing import thing_of
from adamo_vh.inference.baseline.mind.happenings import MAX_TRIES, happened, imagined
from adamo_vh.inference.baseline.mind.memory import (
    Job,
    Memory,
    Move,
    Search,
    Stand,
    Status,
    to_point,
)
from adamo_vh.inference.baseline.mind.searching import Stage
from adamo_vh.inference.baseline.prompt.reading import Event, Prompt, Room

BODY = BodyInfo("mara", 0.25, 1.6, math.radians(65), 0.7, 2.0, 0.5)
ROOM = Room(-3.0, 3.0, -5.0, 3.0)
FLOOR_PLAN = understand("Put the cup on the floor")
HOLD_PLAN = understand("Pick the cup")
CUP_AT = Vec3(0.1, 0.2, 0.85)


def memory_of_cup() -> Memory:
    """The cup is known, means the first wish, and is not handled yet."""
    return Memory(
        things={"Cup_45": thing_of("Cup_45", CUP_AT, 2050.0)},
        jobs=[Job(0, "Cup_45")],
        fits={("goal", 0): {"Cup_45": 1.0}},
    )


def event(name: str, text: str, **arguments: object) -> Event:
    return Event(name, {"object": "Cup_45", **arguments}, text)


def pick_event(outcome: Outcome, code: str, point: Vec3 | None = None) -> Event:
    return event("Pick", picked(BodyReport(outcome, code, point), "Cup_45").text)


def drop_event(
    outcome: Outcome, code: str = Code.OK, at: Vec3 | None = None, on: str = "on the floor"
) -> Event:
    said = dropped(BodyReport(outcome, code, at), "Cup_45", Vec3(1, 1, 0), on, BODY)
    return event("Drop", said.text, x=1, y=1, z=0)


def after(*events: Event, plan: Plan = FLOOR_PLAN) -> Memory:
    memory = memory_of_cup()
    for one in events:
        happened(one, Search.NONE, memory, plan, ROOM)
    return memory


TAKEN = pick_event(Outcome.DONE, Code.OK)


def test_what_was_taken_is_in_the_hand_and_came_from_its_place() -> None:
    memory = after(TAKEN)
    assert memory.hand == "Cup_45"
    assert memory.came_from == {"Cup_45": CUP_AT}


@pytest.mark.parametrize("code", [Code.UNREACHABLE, Code.GONE, "arm_broken"], ids=str)
def test_a_refused_pick_leaves_the_hand_as_it_was(code: str) -> None:
    memory = after(pick_event(Outcome.REFUSED, code))
    assert memory.hand == ""
    assert memory.refusals["Cup_45"].startswith("Refused: ")
    assert memory.jobs == [Job(0, "Cup_45", Status.TODO, 1)]


def test_a_full_hand_is_learnt_from_the_refusal() -> None:
    told = event("Pick", "Refused: your hand already holds Plate_57; drop it first.")
    assert after(told).hand == "Plate_57"


def test_in_vain_for_too_often_it_is_given_up() -> None:
    tries = [pick_event(Outcome.REFUSED, Code.UNREACHABLE)] * MAX_TRIES
    assert after(*tries[1:]).jobs[0].status is Status.TODO
    assert after(*tries).jobs[0].status is Status.FAILED


@pytest.mark.parametrize(
    ("outcome", "code", "on", "status"),
    [
        (Outcome.DONE, Code.OK, "on the floor", Status.DONE),
        (Outcome.DONE, Code.REPOSITIONED, "on the floor", Status.DONE),
        (Outcome.CORRECTED, Code.PLACED_ELSEWHERE, "on the floor", Status.DONE),
        (Outcome.DONE, Code.OK, "on the table", Status.TODO),
        (Outcome.CORRECTED, Code.PLACED_ELSEWHERE, "on the sideboard", Status.TODO),
        (Outcome.DONE, Code.OK, "on Plate_57", Status.TODO),
        (Outcome.DONE, Code.OK, "and does not rest on anything", Status.TODO),
    ],
)
def test_a_wish_is_met_only_where_feedback_says_so(
    outcome: Outcome, code: str, on: str, status: Status
) -> None:
    memory = after(TAKEN, drop_event(outcome, code, Vec3(1.2, 1.0, 0.07), on))
    assert memory.jobs[0].status is status
    assert memory.hand == ""


def test_where_it_rests_is_what_feedback_said_and_not_what_was_asked() -> None:
    memory = after(TAKEN, drop_event(Outcome.CORRECTED, Code.PLACED_ELSEWHERE, Vec3(1.3, 1, 0.07)))
    assert memory.things["Cup_45"].position == Vec3(1.3, 1, 0.07)
    assert memory.rests == {"Cup_45": "on the floor"}


def test_what_is_taken_again_rests_nowhere() -> None:
    put = drop_event(Outcome.DONE, Code.OK, Vec3(1, 1, 0.07))
    memory = after(TAKEN, put, TAKEN)
    assert memory.rests == {}
    assert memory.came_from["Cup_45"] == CUP_AT


def test_a_refused_drop_leaves_it_in_the_hand_unless_the_hand_was_empty() -> None:
    assert after(TAKEN, drop_event(Outcome.REFUSED, Code.NO_FREE_SPOT)).hand == "Cup_45"
    assert after(TAKEN, drop_event(Outcome.REFUSED, Code.HAND_EMPTY)).hand == ""


@pytest.mark.parametrize("text", ["Not executed: one call at a time.", ""])
def test_what_was_not_executed_changes_nothing(text: str) -> None:
    assert after(event("Pick", text)) == memory_of_cup()


@pytest.mark.parametrize("search", [s for s in Search if s is not Search.NONE])
def test_what_a_call_did_for_the_search_is_counted(search: Search) -> None:
    memory = memory_of_cup()
    happened(
        event("Look", "Done: looking at (0.00, 0.00, 0.00)."), search, memory, FLOOR_PLAN, ROOM
    )
    assert memory.views + memory.visits + memory.aside + memory.acts > 0


def test_thinking_ahead_changes_nothing_now() -> None:
    now, prompt = memory_of_cup(), Prompt("")
    taken_prompt, taken = imagined(
        prompt, now, Move("", "Pick", (("object", "Cup_45"),)), FLOOR_PLAN
    )
    put = (("object", "Cup_45"), *to_point(Vec3(1.0, 1.0, 0.0)))
    _, put_down = imagined(taken_prompt, taken, Move("", "Drop", put), FLOOR_PLAN)
    assert now == memory_of_cup()
    assert taken.hand == "Cup_45" and taken_prompt.body.hand == "Cup_45"
    assert put_down.jobs[0].status is Status.DONE


# --- the answer -----------------------------------------------------------------------------


def answer(*events: Event, plan: Plan = FLOOR_PLAN) -> str:
    memory = after(*events, plan=plan)
    return finish(plan, memory, Prompt("", ROOM), Stage.OVER).answer


def test_done_is_said_of_what_feedback_bore_out() -> None:
    put = drop_event(Outcome.DONE, Code.OK, Vec3(1, 1, 0.07))
    assert answer(TAKEN, put).startswith("Done: Cup_45")
    assert answer(TAKEN, plan=HOLD_PLAN) == "Done: I hold Cup_45."


@pytest.mark.parametrize(
    ("events", "why"),
    [
        ((), "I did not move Cup_45"),
        ((TAKEN,), "I still hold Cup_45"),
        ((TAKEN, drop_event(Outcome.REFUSED, Code.NO_FREE_SPOT)), "no free, supported spot"),
        ((pick_event(Outcome.REFUSED, Code.UNREACHABLE),), "no place to stand has Cup_45"),
        ((TAKEN, drop_event(Outcome.DONE, Code.OK, Vec3(1, 1, 0.8), "on the table")),
         "Cup_45 rests on the table"),
    ],
)  # fmt: skip
def test_what_was_not_reached_is_said_with_the_reason(events: tuple[Event, ...], why: str) -> None:
    said = answer(*events)
    assert said.startswith("Not done: ")
    assert why in said
    assert "Done:" not in said.replace("Not done:", "")


def test_of_what_was_never_found_only_that_is_said() -> None:
    said = finish(HOLD_PLAN, Memory(), Prompt("", ROOM), Stage.OVER)
    assert said.answer == "Not done: I found no cup."
    assert said.verified == "nothing"


def test_one_of_two_wishes_is_partly_done() -> None:
    plan = understand("Put the cup on the floor and pick the plate")
    put = drop_event(Outcome.DONE, Code.OK, Vec3(1, 1, 0.07))
    said = answer(TAKEN, put, plan=plan)
    assert said.startswith("Partly done: Cup_45")
    assert "Not done: I found no plate" in said


# --- the note -------------------------------------------------------------------------------

tags = st.sampled_from(["Cup_45", "Plate_57", "34", "IndoorPlant_50", "<B2>"])
metres = st.floats(-9, 9).map(lambda v: round(v, 3) + 0.0)
coarse = st.floats(-9, 9).map(lambda v: round(v, 2) + 0.0)
fine_places = st.builds(Vec3, metres, metres, metres)
stands = st.builds(
    Stand, st.builds(Vec3, coarse, coarse, coarse), st.integers(0, 359).map(math.radians)
)
jobs = st.builds(Job, st.integers(0, 9), tags, st.sampled_from(Status), st.integers(0, 6))


@st.composite
def memories(draw: st.DrawFn) -> Memory:
    """All that a note may have to carry, with the digits that it carries."""
    memory = Memory(
        views=draw(st.integers(0, 99)),
        visits=draw(st.integers(0, 99)),
        aside=draw(st.integers(0, 9)),
        acts=draw(st.integers(0, 9)),
        decided=draw(st.sampled_from([None, True, False])),
        began=draw(st.none() | stands),
        hand=draw(st.just("") | tags),
        rests=draw(st.dictionaries(tags, st.sampled_from(["on the floor", "on the shelf (top)"]))),
        came_from=draw(st.dictionaries(tags, fine_places)),
        looks=draw(st.dictionaries(tags, st.sampled_from(["red", "orange"]))),
        kinds=draw(st.dictionaries(tags, st.sampled_from(["Cup", "Plate"]))),
        inspected=draw(st.sets(tags)),
        fits={
            ("goal", 0): draw(st.dictionaries(tags, st.integers(10, 100).map(lambda n: n / 100)))
        },
    )
    memory.home = memory.began
    for job in draw(st.lists(jobs, max_size=5)):
        memory.set_job(job)
    for tag in draw(st.sets(tags)):
        volume = draw(st.integers(1, 99999)) / 10
        memory.things[tag] = thing_of(tag, draw(fine_places), volume)
    return memory


@settings(max_examples=80, deadline=None)
@given(memories(), st.text(alphabet="abc (:;)\n", max_size=40))
def test_a_whole_note_carries_all_that_is_known(memory: Memory, before: str) -> None:
    entry = notes.Entry(7, whole=True)
    said = notes.write(memory, Memory(), memory.things, [("goal", 0)], [], entry)
    known = Memory()
    found = notes.read(f"{before}\n{said}")
    assert (found.number, found.whole) == (7, True)
    notes.apply(found, known)
    # The order in which jobs of different wishes are told does not matter.
    assert sorted(known.jobs, key=lambda j: (j.goal, j.tag)) == sorted(
        memory.jobs, key=lambda j: (j.goal, j.tag)
    )
    for name in ("views", "visits", "aside", "acts", "decided", "hand", "rests", "came_from"):
        assert getattr(known, name) == getattr(memory, name), name
    for name in ("looks", "kinds", "inspected"):
        assert getattr(known, name) == getattr(memory, name), name
    assert known.things == memory.things
    chosen = {job.tag for job in memory.jobs if job.goal == 0} or set(memory.fits["goal", 0])
    fits = known.fits.get(("goal", 0), {})
    assert fits == {t: f for t, f in memory.fits["goal", 0].items() if t in chosen}
    if memory.began:
        assert known.began is not None
        assert known.began.position == memory.began.position
        assert known.began.heading_rad == pytest.approx(memory.began.heading_rad)


@settings(max_examples=60, deadline=None)
@given(memories())
def test_nothing_new_is_nothing_said(memory: Memory) -> None:
    said = notes.write(memory, memory, [], [("goal", 0)], [], notes.Entry(8))
    assert said in ("(Memory, step 8)", "(Memory, step 8: )")


@pytest.mark.parametrize(
    "note",
    ["", "I go on.", "(Memory, step x)", "Memory, step 3: hand Cup_45", "(Memory, step 3: hand"],
)
def test_words_that_are_no_memory_carry_nothing(note: str) -> None:
    assert notes.read(note) == notes.Entry()


def test_the_last_memory_of_a_note_counts() -> None:
    note = "(Memory, step 2: hand Cup_45)\nThen:\n(Memory, step 3: hand Plate_57)"
    assert notes.read(note).items == ["hand Plate_57"]
    assert notes.read(note).number == 3
