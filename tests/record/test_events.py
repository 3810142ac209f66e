"""Events are read back as they were written, whatever they hold; damage is told by its line."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from adamo_vh.action import Code, Feedback, Outcome
from adamo_vh.engine import LightChanged, ObjectAdded, ObjectMoved, ObjectTaken
from adamo_vh.errors import RecordError
from adamo_vh.geometry import Vec3
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Ending, Reply, Rung, Usage
from adamo_vh.observation import AgentState, Frame, ObservedObject, ReferencePoint
from adamo_vh.record.run_folder import EVENTS, FRAMES
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import (
    Acted,
    Ended,
    Event,
    Happened,
    LeftOut,
    Observed,
    Shown,
    Started,
    Thought,
    Trajectory,
    codec,
    frame_name,
    read_trajectory,
    shown,
)
from adamo_vh.record.turn import Turn, Wish
from adamo_vh.record.writer import TrajectoryWriter

# What JSON can hold: no lone surrogates, no numbers that are none.
texts = st.text(st.characters(codec="utf-8"), max_size=20)
numbers = st.floats(allow_nan=False, allow_infinity=False)
counts = st.integers(0, 10**9)
points = st.builds(Vec3, numbers, numbers, numbers)
json_values = st.recursive(
    st.none() | st.booleans() | numbers | st.integers(-(2**53), 2**53) | texts,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(texts, inner, max_size=3),
    max_leaves=5,
)
arguments = st.none() | st.dictionaries(texts, json_values, max_size=3)
agents = st.builds(AgentState, points, numbers, points, points, st.none() | texts)
calls = st.builds(ToolCall, texts, texts, arguments, texts, texts)
replies = st.builds(
    Reply,
    st.builds(AIMessage, texts, st.lists(calls, max_size=2).map(tuple), texts),
    usage=st.builds(Usage, counts, counts, counts, counts, st.booleans()),
    ending=st.sampled_from(Ending),
    rung=st.sampled_from(Rung),
)
wishes = st.builds(Wish, calls, arguments, texts, st.none() | st.floats(0, 1), st.booleans())
feedback = st.builds(
    Feedback, st.sampled_from(Outcome), st.sampled_from(Code).map(str), texts, numbers
)
boxes = st.tuples(counts, counts, counts, counts)
seen = st.builds(ObservedObject, texts, points, numbers, boxes, counts, texts)
anchors = st.builds(ReferencePoint, texts, points, st.tuples(numbers, numbers))
happenings = st.one_of(
    st.builds(ObjectMoved, counts, points), st.builds(ObjectTaken, counts),
    st.builds(ObjectAdded, counts, points), st.builds(LightChanged, counts, st.floats(0, 1)),
)  # fmt: skip
events: st.SearchStrategy[Event] = st.one_of(
    st.builds(Started, texts, texts, texts, texts),
    st.builds(Observed, counts, texts, counts, counts, st.lists(seen, max_size=2).map(tuple),
              st.lists(anchors, max_size=2).map(tuple), agents),
    st.builds(Thought, counts, texts, counts,
              st.builds(Turn, replies, st.lists(wishes, max_size=2).map(tuple))),
    st.builds(Acted, counts, texts, texts, arguments, feedback, agents, texts, texts, numbers),
    st.builds(LeftOut, counts, texts, texts, texts),
    st.builds(Shown, counts, texts, counts, counts),
    st.builds(Happened, counts, happenings, texts),
    st.builds(Ended, counts, st.sampled_from(TerminationReason), texts, texts, numbers, texts),
)  # fmt: skip


@settings(max_examples=200, deadline=None)
@given(events)
def test_an_event_is_one_line_and_read_back_the_same(event: Event) -> None:
    line = codec().dump_json(event)
    assert b"\n" not in line
    assert codec().validate_json(line) == event


START = Started("Pick the cup", "You are the mind.", "h0", "{}")
END = Ended(0, TerminationReason.ANSWERED, "I hold it.", "h1", 1.0)
LEFT = LeftOut(0, "c1", "Pick", "one call at a time")


def written(folder: Path, *told: Event) -> Path:
    writer = TrajectoryWriter(folder)
    for event in told:
        writer.notify(event)
    writer.close()
    return folder


def test_a_record_is_read_in_order(tmp_path: Path) -> None:
    read = read_trajectory(written(tmp_path / "run", START, LEFT, END))
    assert read.events == [START, LEFT, END]
    assert read.ended == END
    assert read.instructions == ["Pick the cup"]
    assert (read.thoughts, read.acts) == ([], [])


def test_every_event_is_on_disk_at_once(tmp_path: Path) -> None:
    writer = TrajectoryWriter(tmp_path / "run")
    told: tuple[Event, ...] = (START, LEFT)
    for count, event in enumerate(told, start=1):
        writer.notify(event)
        assert len(read_trajectory(tmp_path / "run").events) == count
    writer.close()


@pytest.mark.parametrize("kept", [1, 10, 50])
def test_a_last_line_that_was_cut_off_is_left_out(tmp_path: Path, kept: int) -> None:
    path = written(tmp_path / "run", START, LEFT) / EVENTS
    whole = path.read_bytes()
    path.write_bytes(whole[: whole.index(b"\n") + 1 + kept])
    read = read_trajectory(tmp_path / "run")
    assert read.events == [START]
    assert read.ended is None


@pytest.mark.parametrize(
    "line",
    [
        b"",
        b"{}",
        b"not json",
        b'{"type": "thought"}',
        b'{"type": "unheard_of"}',
        b"\xff\xfe",
        b"[]",
    ],
)
def test_damage_in_the_middle_is_told_with_its_line(tmp_path: Path, line: bytes) -> None:
    path = written(tmp_path / "run", START, LEFT, END) / EVENTS
    lines = path.read_bytes().split(b"\n")
    lines[1] = line
    path.write_bytes(b"\n".join(lines))
    with pytest.raises(RecordError, match="line 2 is damaged"):
        read_trajectory(tmp_path / "run")


def test_a_folder_without_events_is_no_episode(tmp_path: Path) -> None:
    with pytest.raises(RecordError, match="holds no episode"):
        read_trajectory(tmp_path)


def test_a_record_is_never_written_over(tmp_path: Path) -> None:
    folder = written(tmp_path / "run", START)
    before = (folder / EVENTS).read_bytes()
    with pytest.raises(RecordError, match="already holds an episode"):
        TrajectoryWriter(folder)
    assert (folder / EVENTS).read_bytes() == before


def go_on(folder: Path, *told: Event) -> TrajectoryWriter:
    writer = TrajectoryWriter(folder, known=read_trajectory(folder).events)
    try:
        for event in told:
            writer.notify(event)
    finally:
        writer.close()
    return writer


def test_what_is_known_is_not_written_twice(tmp_path: Path) -> None:
    folder = written(tmp_path / "run", START, LEFT)
    go_on(folder, START, LEFT, END)
    assert read_trajectory(folder).events == [START, LEFT, END]


def test_going_on_drops_the_half_line_of_a_kill(tmp_path: Path) -> None:
    folder = written(tmp_path / "run", START, LEFT)
    with (folder / EVENTS).open("ab") as file:
        file.write(b'{"type": "ended", "st')
    go_on(folder, START, LEFT, END)
    assert read_trajectory(folder).events == [START, LEFT, END]


@pytest.mark.parametrize(
    "otherwise",
    [Started("Pick the cup", "You are the mind.", "another state", "{}"), END, LEFT],
    ids=["state", "end", "kind"],
)
def test_what_comes_out_otherwise_stops_and_changes_nothing(
    tmp_path: Path, otherwise: Event
) -> None:
    folder = written(tmp_path / "run", START, LEFT)
    before = (folder / EVENTS).read_bytes()
    with pytest.raises(RecordError, match=r"difference in line 1 of events\.jsonl"):
        go_on(folder, otherwise)
    assert (folder / EVENTS).read_bytes() == before


def test_pictures_are_named_by_what_they_show_and_kept_once(tmp_path: Path) -> None:
    one, other = Frame(b"one", "image/png", 4, 4), Frame(b"other", "image/jpeg", 4, 4)
    assert frame_name(one) != frame_name(other)
    assert (frame_name(one)[-4:], frame_name(other)[-4:]) == (".png", ".jpg")
    writer = TrajectoryWriter(tmp_path / "run")
    for frame in (one, one, other):
        writer.notify(shown(0, frame), frame)
    writer.close()
    kept = {path.name: path.read_bytes() for path in (tmp_path / "run" / FRAMES).iterdir()}
    assert kept == {frame_name(one): b"one", frame_name(other): b"other"}


def test_a_trajectory_has_no_end_before_its_last_instruction_ended() -> None:
    again: Any = Started("And now the plate", "", "h1", "{}")
    assert Trajectory((START, END)).ended == END
    assert Trajectory((START, END, again)).ended is None
    assert Trajectory(()).ended is None
