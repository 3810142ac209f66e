"""What the prompt tells is read back as it was written, in every layout of it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from adamo_vh.geometry import Camera, Vec3
from adamo_vh.inference.baseline.prompt.reading import Event, Prompt, Room, read_prompt
from adamo_vh.inference.baseline.prompt.state_text import StateReader, first_point
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
from adamo_vh.perception import TextForm
from adamo_vh.perception.writer import SymbolicState, Told, Wording, view_now

CAMERA = Camera(Vec3(0.0, 0.0, 1.6), 0.0, 0.0, 1.0, 64, 36)

# --- the state ------------------------------------------------------------------------------

metres = st.floats(-9.0, 9.0)
places = st.builds(Vec3, metres, metres, st.floats(0.0, 3.0))
boxes = st.tuples(*[st.integers(0, 1920)] * 4)
numbers = st.lists(st.integers(0, 99), unique=True, max_size=8)
volumes = st.floats(1e-6, 0.05)


@st.composite
def views(draw: st.DrawFn) -> Observation:
    """Any view: objects, reference points, and a body that may hold one of the objects."""
    objects = tuple(
        ObservedObject(f"Thing_{n}", draw(places), draw(volumes), draw(boxes), 9, str(n))
        for n in draw(numbers)
    )
    anchors = draw(st.lists(places, max_size=4))
    points = tuple(ReferencePoint(f"P{i}", p, (1.0, 2.0)) for i, p in enumerate(anchors))
    held = draw(st.sampled_from([None, "Held_7"]))
    agent = AgentState(draw(places), draw(st.floats(-7, 7)), draw(places), draw(places), held)
    return Observation(Frame(b"", "image/png", 64, 36), objects, points, agent, CAMERA)


def about(one: Vec3, other: Vec3, rounding: float) -> bool:
    return all(
        abs(a - b) <= rounding
        for a, b in zip((one.x, one.y, one.z), (other.x, other.y, other.z), strict=True)
    )


def check_body(reader: StateReader, agent: AgentState, form: TextForm) -> None:
    assert about(reader.body.position, agent.position, 0.0051)
    if form is TextForm.PAPER:
        assert (reader.body.heading_rad, reader.body.gaze, reader.body.hand) == (None, None, None)
        return
    assert reader.body.heading_rad is not None and reader.body.gaze is not None
    off = math.remainder(reader.body.heading_rad - agent.heading_rad, 2 * math.pi)
    assert abs(off) <= math.radians(0.51)
    assert about(reader.body.gaze, agent.gaze, 0.0051)
    assert reader.body.hand == (agent.held or "empty")


@settings(max_examples=40, deadline=None)
@given(views(), st.sampled_from(TextForm))
def test_a_whole_state_is_read_as_it_was_written(view: Observation, form: TextForm) -> None:
    reader = StateReader()
    assert reader.read_whole(SymbolicState(view, Wording(form)).text(view.agent))
    assert [thing.tag for thing in reader.things()] == [item.tag for item in view.objects]
    for thing, item in zip(reader.things(), view.objects, strict=True):
        assert about(thing.position, item.position, 0.00051)
        assert thing.volume_cm3 == pytest.approx(item.volume_m3 * 1e6, abs=0.051)
        assert thing.box_px == (item.box_px if form is TextForm.FULL else None)
    assert len(reader.points) == len(view.points)
    assert all(
        about(p, q.position, 0.0051) for p, q in zip(reader.points, view.points, strict=True)
    )
    check_body(reader, view.agent, form)


@settings(max_examples=40, deadline=None)
@given(st.lists(views(), min_size=1, max_size=3), st.sampled_from(TextForm), st.booleans())
def test_changes_add_up_to_the_latest_state(
    seen: list[Observation], form: TextForm, terse: bool
) -> None:
    wording = Wording(form, terse)
    told, reader = Told(wording), StateReader()
    for view in seen:
        text = f"{told.changes(view, view.agent)}\n\n{view_now(view, wording)}"
        assert reader.read_changes(text)
    last = seen[-1]
    assert [thing.tag for thing in reader.things()] == [item.tag for item in last.objects]
    for thing, item in zip(reader.things(), last.objects, strict=True):
        assert about(thing.position, item.position, 0.0051 if terse else 0.00051)
        assert thing.volume_cm3 == pytest.approx(item.volume_m3 * 1e6, abs=0.51)
        boxed = form is TextForm.FULL and not terse
        assert thing.box_px == (item.box_px if boxed else None)
    assert len(reader.points) == len(last.points)
    assert reader.views == len(seen)
    check_body(reader, last.agent, form)


@settings(max_examples=30, deadline=None)
@given(views(), views())
def test_what_went_out_of_view_stays_told_where_it_was(one: Observation, two: Observation) -> None:
    told, reader = Told(Wording(TextForm.FULL)), StateReader()
    for view in (one, two):
        reader.read_changes(told.changes(view, view.agent) + "\n\n" + view_now(view, told.wording))
    assert set(reader.told) == {item.tag for view in (one, two) for item in view.objects}
    latest = {item.tag: item.position for view in (one, two) for item in view.objects}
    assert all(about(reader.told[tag].position, at, 0.00051) for tag, at in latest.items())


@pytest.mark.parametrize(
    ("text", "first", "last"),
    [
        ("Done: walked 1.00 m to (1.00, 2.00, 0.00).", (1, 2, 0), (1, 2, 0)),
        ("Corrected: (9.00, 0.00, 0.00) is not reachable; stopped at (-1.50, 0.25, 0.00), 2 m",
         (9, 0, 0), (-1.5, 0.25, 0)),
        ("- Cup_45 (0.33,-0.60,0.80), 1875 cm3", (0.33, -0.6, 0.8), (0.33, -0.6, 0.8)),
        ("( 1 , 2 , 3 )", (1, 2, 3), (1, 2, 3)),
    ],
)  # fmt: skip
def test_points_are_found_in_sentences(
    text: str, first: tuple[float, ...], last: tuple[float, ...]
) -> None:
    assert first_point(text) == Vec3.of(first)
    assert first_point(text, last=True) == Vec3.of(last)


@pytest.mark.parametrize("text", ["", "(1, 2)", "(a, b, c)", "1, 2, 3", "(1.2.3, 4, 5)"])
def test_what_is_no_point_is_none(text: str) -> None:
    assert first_point(text) is None


# --- the conversation -----------------------------------------------------------------------

FRAME = ImagePart(b"first", "image/png", 64, 36)
SECOND = ImagePart(b"second", "image/png", 64, 36)
CLOSE_UP = ImagePart(b"close", "image/png", 64, 36)
STATE = """## Visible objects
- Cup_45: center (0.100, 0.200, 0.850), volume 2050.0 cm3

## Reference points
none

## You
- position (-2.00, -1.00, 0.00)"""


def call(name: str, **arguments: object) -> ToolCall:
    return ToolCall(f"id-{name}-{len(arguments)}", name, arguments)


def ask(text: str, *more: TextPart | ImagePart) -> HumanMessage:
    return HumanMessage((TextPart(text), *more))


def step(made: ToolCall, feedback: str, note: str = "I go on.") -> list[Message]:
    return [AIMessage(note, (made,)), ToolMessage(made.id, made.name, feedback)]


def paper(*later: Message) -> Prompt:
    """The layout with the whole state in one place."""
    start: list[Message] = [
        SystemMessage("Rules."),
        SystemMessage(STATE),
        ask("Pick the cup", FRAME),
    ]
    return read_prompt([*start, *later])


def test_the_start_of_an_episode() -> None:
    prompt = paper()
    assert prompt.instruction == "Pick the cup"
    assert [thing.tag for thing in prompt.things] == ["Cup_45"]
    assert prompt.body.position == Vec3(-2.0, -1.0, 0.0)
    assert prompt.frame == FRAME
    assert (prompt.turns, prompt.event, prompt.fresh) == ((), None, True)


def test_a_call_and_its_feedback_belong_together() -> None:
    prompt = paper(*step(call("Pick", object="Cup_45"), "Done: Cup_45 is in your hand."))
    assert prompt.event == Event("Pick", {"object": "Cup_45"}, "Done: Cup_45 is in your hand.")
    assert (prompt.event.outcome, prompt.event.executed, prompt.event.tag) == (
        "done",
        True,
        "Cup_45",
    )
    assert not prompt.fresh


@pytest.mark.parametrize(
    ("text", "outcome", "executed"),
    [
        ("Done: looking at (0.00, 0.00, 0.00).", "done", True),
        ("Corrected: stopped at (0.00, 0.00, 0.00).", "corrected", True),
        ("Refused: your hand is empty.", "refused", True),
        ("Not executed: one call at a time.", "not", False),
        ("", "", False),
    ],
)
def test_the_first_word_says_how_it_went(text: str, outcome: str, executed: bool) -> None:
    event = Event("Look", {}, text)
    assert (event.outcome, event.executed) == (outcome, executed)


def test_the_event_is_the_latest_call_that_was_tried() -> None:
    prompt = paper(
        *step(call("Pick", object="Cup_45"), "Done: Cup_45 is in your hand."),
        *step(call("Walk", x=0, y=0, z=0), "Not executed: the body was stopped."),
    )
    assert prompt.event is not None and prompt.event.name == "Pick"
    assert [event.name for turn in prompt.turns for event in turn.events] == ["Pick", "Walk"]


def test_a_new_view_replaces_the_picture_and_not_the_instruction() -> None:
    prompt = paper(
        *step(call("Look", x=0, y=0, z=1), "Done: looking at (0.00, 0.00, 1.00)."),
        ask("New view after your Look.", SECOND),
    )
    assert prompt.instruction == "Pick the cup"
    assert prompt.frame == SECOND
    assert prompt.fresh


def test_a_close_up_belongs_to_its_call_and_is_no_view() -> None:
    prompt = paper(
        *step(call("Inspect", object="Cup_45"), "Done: Cup_45 close up."),
        ask("What Inspect shows.", CLOSE_UP),
    )
    assert prompt.frame == FRAME
    assert prompt.event is not None and prompt.event.pictures == (CLOSE_UP,)


def test_a_second_instruction_begins_anew_and_remembers_what_was_spoken_of() -> None:
    prompt = paper(
        *step(call("Pick", object="Cup_45"), "Done: Cup_45 is in your hand."),
        AIMessage("Done: I hold Cup_45, and left Plate_57."),
        ask("Put it on the floor", SECOND),
    )
    assert prompt.instruction == "Put it on the floor"
    assert (prompt.turns, prompt.event) == ((), None)
    assert len(prompt.earlier) == 2
    assert prompt.spoken_of == ("Cup_45",)


def test_an_answer_by_a_tool_is_an_answer() -> None:
    finish = call("Finish", answer="I hold Cup_45.", verified="hand", unseen="none")
    prompt = paper(*step(finish, "Done."), ask("And now the plate", SECOND))
    assert prompt.earlier[-1].answer == "I hold Cup_45."


def test_results_that_carry_the_view_are_views() -> None:
    """The layout that tells what changed, with pictures in the results."""
    look = call("Look", x=0, y=0, z=1)
    seen = (
        "Done: looking at (0.00, 0.00, 1.00).\n\nNew in view:\n- Plate_57: center (0.500, 0.000, "
        "0.800), volume 1875.0 cm3\nYou: position (-1.00, 0.00, 0.00), heading 90 deg, "
        "gaze (0.00, 0.00, 1.00), hand: empty\n\n# The view now\nIn view: Plate_57 [1, 2, 3, 4]\n"
        "Reference points: none"
    )
    prompt = read_prompt([
        SystemMessage("Rules."),
        ask("Pick the cup", TextPart("New in view:\n- Cup_45: center (0.1, 0.2, 0.85), volume "
                                     "2050.0 cm3\nYou: position (-2.00, -1.00, 0.00)\n\n"
                                     "# The view now\nIn view: Cup_45\nReference points: none"),
            FRAME),
        AIMessage("", (look,)),
        ToolMessage(look.id, "Look", seen, (SECOND,)),
    ])  # fmt: skip
    assert prompt.lasting
    assert prompt.event is not None
    assert prompt.event.text == "Done: looking at (0.00, 0.00, 1.00)."
    assert [(thing.tag, thing.box_px) for thing in prompt.things] == [("Plate_57", (1, 2, 3, 4))]
    assert set(prompt.told) == {"Cup_45", "Plate_57"}
    assert prompt.pinned == {"Cup_45"}
    assert prompt.body.heading_rad == pytest.approx(math.pi / 2)
    assert prompt.frame == SECOND
    assert prompt.began is not None and prompt.began.position == Vec3(-2.0, -1.0, 0.0)


# --- the room -------------------------------------------------------------------------------


def test_the_room_is_what_the_rules_say() -> None:
    rules = (
        "- The room spans x from -2.5 to 4 and y from -1 to 1.5. Its four corner areas are the "
        '0.8 x 0.8 m squares in the corners of the floor.\n- "Near" means: centres within 0.4 m '
        "horizontally, on the same surface."
    )
    room = read_prompt([SystemMessage(rules)]).room
    assert room == Room(-2.5, 4.0, -1.0, 1.5, 0.8, 0.4)
    assert set(room.corners()) == {
        Vec3(-2.1, -0.6, 0.0), Vec3(-2.1, 1.1, 0.0), Vec3(3.6, -0.6, 0.0), Vec3(3.6, 1.1, 0.0),
    }  # fmt: skip


@given(places, st.floats(0.0, 1.0))
def test_a_clamped_point_keeps_off_the_walls_and_a_point_inside_stays(p: Vec3, off: float) -> None:
    room = Room()
    held = room.clamp(p, off)
    assert room.x_min + off <= held.x <= room.x_max - off
    assert room.y_min + off <= held.y <= room.y_max - off
    assert room.clamp(held, off) == held
    assert held.z == p.z


def _some(messages: Sequence[Message]) -> st.SearchStrategy[list[Message]]:
    return st.lists(st.sampled_from(list(messages)), max_size=10)


@given(
    _some(
        [
            SystemMessage(STATE), SystemMessage("Rules."), ask("Pick the cup", FRAME), ask("Hm?"),
            ask("New view after your Look.", SECOND), ask("What Inspect shows.", CLOSE_UP),
            *step(call("Inspect", object="Cup_45"), "Done: Cup_45 close up."),
            *step(call("Look", x=0), "In view: Cup_45\nReference points: none"),
            AIMessage("Done."), ToolMessage("unknown", "Drop", "Refused: no."), HumanMessage(()),
        ]
    )
)  # fmt: skip
def test_messages_in_any_order_are_read(messages: list[Message]) -> None:
    prompt = read_prompt(messages)
    results = [m for m in messages if isinstance(m, ToolMessage)]
    events = [e for turn in (*prompt.earlier, *prompt.turns) for e in turn.events]
    assert len(events) <= len(results)
    assert set(prompt.spoken_of) <= {"Cup_45"}
    assert {thing.tag for thing in prompt.things} <= set(prompt.told) <= {"Cup_45"}
