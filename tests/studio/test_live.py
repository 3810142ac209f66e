"""A live room over real sockets: talk, stop, undo, drag, consent, and a person as the mind."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest
from tests.studio.conftest import Served
from tests.studio.visitor import Visitor

from adamo_vh.episode.result import read_result
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.session.runs import replay_episode


@pytest.fixture
def room(served: Served) -> Iterator[str]:
    name = served.room(scene="s1", model="baseline")
    yield name
    served.studio.rooms.close(name)


def folder_of(served: Served, room: str):
    return served.studio.rooms.find(room).folder


def test_a_conversation_leads_to_a_done_task(served):
    room = served.room(scene="s1", model="baseline", task="T2")
    with Visitor(served.url, room) as visitor:
        hello = visitor.next()
        assert hello["type"] == "hello" and hello["live"] and hello["room"] == room
        assert hello["settings"]["instruction"] == "Pick the plate"
        visitor.ask("speed", factor=4)
        assert visitor.say("Pick the plate")["reason"] == "answered"
        assert visitor.doing("idle")["can_undo"]
        assert visitor.say("What do you hold?")["reason"] == "answered"
    kinds = {m["type"] for m in visitor.told}
    assert {"hello", "pose", "event", "status"} <= kinds
    serials = [m["n"] for m in visitor.told]
    assert serials == list(range(len(serials)))
    poses = [m for m in visitor.told if m["type"] == "pose"]
    assert len(poses) > 30 and any(p["held"] is not None for p in poses)
    frame = next(m["frame"] for m in visitor.told if m.get("frame"))
    status, headers, picture = served.get(frame)
    assert status == 200 and headers["content-type"] == "image/jpeg" and picture[:2] == b"\xff\xd8"
    folder = folder_of(served, room)
    served.close(room)
    result = read_result(folder)
    assert result is not None and result.completion == 1.0 and not result.assisted
    assert (folder / "episode.html").is_file()
    assert replay_episode(folder).mismatches == ()


def test_that_she_was_heard_is_told_before_anything_else(served, room):
    with Visitor(served.url, room) as visitor:
        visitor.doing("idle")
        visitor.ask("say", text="Pick the plate")
        first = visitor.next()
        assert (first["type"], first["doing"]) == ("status", "seeing")
        assert visitor.event("started")["instruction"] == "Pick the plate"


def test_stop_cuts_the_action_at_the_moment_that_is_shown(served, room):
    with Visitor(served.url, room) as visitor:
        visitor.doing("idle")
        visitor.ask("say", text="Pick the plate")
        visitor.doing("acting")
        for _ in range(10):
            visitor.until(lambda m: m["type"] == "pose")
        shown = visitor.told[-1]
        visitor.ask("stop")
        acted = visitor.event("acted")
        assert acted["feedback"]["code"] == "cancelled"
        assert visitor.event("ended")["reason"] == "stopped"
        at = acted["agent"]["position"]
        assert abs(at["x"] - shown["body"][0]) < 0.6 and abs(at["y"] - shown["body"][1]) < 0.6
        visitor.doing("idle")
        visitor.ask("stop")
        assert "could be stopped" in visitor.notice()["text"]
    result = read_result(folder_of(served, room))
    assert result is not None and result.assisted


def test_what_was_done_is_undone_and_what_is_dragged_is_on_record(served, room):
    with Visitor(served.url, room) as visitor:
        first = visitor.until(lambda m: m["type"] == "pose")
        visitor.ask("undo")
        assert "nothing to undo" in visitor.notice()["text"].lower()
        visitor.ask("move", object_id=4, point=[0.2, 0.1, 0.8])
        happened = visitor.event("happened")
        assert happened["event"]["object_id"] == 4 and happened["by_user"]
        visitor.ask("move", object_id=9999, point=[0.2, 0.1, 0.8])
        assert "no object 9999" in visitor.notice()["text"]
        visitor.ask("speed", factor=4)
        visitor.say("Look at the cup")
        visitor.until(lambda m: m["type"] == "status" and m["can_undo"])
        visitor.ask("undo")
        visitor.event("restored")
        last = [m for m in visitor.told if m["type"] == "pose"][-1]
        assert last["body"] == first["body"]
        assert not visitor.doing("idle")["can_undo"]
    events = [event.type for event in read_trajectory(folder_of(served, room)).events]
    assert events[0] == "happened" and "restored" in events


def test_a_step_waits_for_consent_and_a_veto_comes_back(served, room):
    with Visitor(served.url, room) as visitor:
        visitor.ask("speed", factor=4)
        visitor.ask("approval", on=True)
        visitor.ask("say", text="Pick the plate")
        asked = visitor.until(lambda m: m["type"] == "asked")
        assert asked["calls"] and asked["calls"][0]["name"]
        visitor.doing("asking")
        visitor.ask("move", object_id=4, point=[0.2, 0.1, 0.8])
        visitor.event("happened")
        visitor.ask("veto", why="Not while I look.")
        assert visitor.event("vetoed")["why"] == "Not while I look."
        told = visitor.until(lambda m: m["type"] in ("asked",) or m.get("event", {}).get("reason"))
        if told["type"] == "asked":
            visitor.ask("approve")
            visitor.event("acted")
        visitor.ask("approval", on=False)
        visitor.ask("stop")
        visitor.doing("idle")


def test_nothing_is_approved_that_was_not_asked(served, room):
    with Visitor(served.url, room) as visitor:
        visitor.ask("approve")
        assert visitor.notice()["text"].startswith("Nothing is asked")
        visitor.ask("act", name="Look", arguments={})
        assert "Somebody else is the mind" in visitor.notice()["text"]
        visitor.wire.send("nonsense")
        bad = visitor.notice()
        assert bad["n"] == 0 and bad["level"] == "error"
        visitor.wire.send(b"bytes")
        assert "JSON text" in visitor.notice()["text"]
        visitor.wire.send(json.dumps({"type": "say", "text": "x" * 70_000}))
        assert "at most" in visitor.notice()["text"]
        visitor.ask("ping")


def test_who_comes_later_gets_everything_from_where_he_was(served, room):
    with Visitor(served.url, room) as first:
        first.ask("speed", factor=4)
        first.say("Look at the cup")
        first.doing("idle")
    known = [m for m in first.told if m["n"]]
    with Visitor(served.url, room) as second:
        again = [second.next() for _ in range(len(first.told))]
    assert [m for m in again if m["n"]][: len(known)] == known
    with Visitor(served.url, room, after=known[3]["n"]) as third:
        assert third.next() == known[3]


def test_a_person_plays_with_the_same_tools(served):
    room = served.room(scene="s1", model="human", task="T2")
    with Visitor(served.url, room) as visitor:
        assert {"act", "finish"} <= set(visitor.next()["controls"])
        visitor.ask("speed", factor=4)
        visitor.ask("say", text="Pick the plate")
        visitor.doing("waiting_for_you")
        visitor.ask("act", name="Pick", arguments={"object": "Plate_57"})
        assert visitor.event("acted")["feedback"]["outcome"] == "done"
        visitor.ask("act", name="Fly", arguments={})
        assert visitor.event("acted")["feedback"]["code"] == "unknown_tool"
        visitor.ask("finish", answer="I hold the plate.")
        assert visitor.event("ended")["answer"] == "I hold the plate."
        visitor.doing("idle")
    folder = folder_of(served, room)
    served.close(room)
    result = read_result(folder)
    assert result is not None and result.model_kind == "human" and result.completion == 1.0
    assert not result.is_ranked  # A person on the page sees the whole room.


def test_two_rooms_at_once_do_not_meet(served):
    names = [served.room(scene="s1"), served.room(scene="s1", figure="jonas")]
    visitors = [Visitor(served.url, name) for name in names]
    for visitor, text in zip(visitors, ("Pick the plate", "Pick the glass"), strict=True):
        visitor.ask("speed", factor=4)
        visitor.ask("say", text=text)
    answers = [visitor.event("ended")["answer"] for visitor in visitors]
    held = [[m for m in v.told if m["type"] == "pose"][-1]["held"] for v in visitors]
    assert "late" in answers[0] and "lass" in answers[1] and held[0] != held[1]
    for visitor, name in zip(visitors, names, strict=True):
        visitor.close()
        served.close(name)


def test_what_is_said_meanwhile_takes_the_place_of_what_is_done(served, room):
    with Visitor(served.url, room) as visitor:
        visitor.ask("speed", factor=4)
        visitor.ask("say", text="Pick the plate")
        visitor.doing("acting")
        visitor.ask("say", text="No, pick the glass")
        assert visitor.event("ended")["reason"] == "stopped"
        assert visitor.event("started")["instruction"] == "No, pick the glass"
        visitor.ask("stop")
        visitor.event("ended")


def test_a_room_in_which_nothing_happened_leaves_no_run(served):
    empty, used = served.room(scene="s1"), served.room(scene="s1")
    folders = [folder_of(served, room) for room in (empty, used)]
    with Visitor(served.url, used) as visitor:
        visitor.ask("move", object_id=4, point=[0.2, 0.1, 0.8])
        visitor.event("happened")
    for room in (empty, used):
        served.close(room)
    assert [folder.exists() for folder in folders] == [False, True]
    assert read_trajectory(folders[1]).events[0].type == "happened"


def test_a_room_that_closes_tells_who_is_in_it(serve):
    served = serve(most=1)
    room = served.room(scene="s1")
    status, headers, body = served.get("/studio/api/rooms", "POST", {"scene": "s1"})
    assert status == 503 and headers["retry-after"] and b"open already" in body
    with Visitor(served.url, room) as visitor:
        visitor.doing("idle")
        visitor.ask("say", text="Pick the plate")
        visitor.doing("acting")
        served.close(room)
        assert visitor.doing("closed")
    served.room(scene="s1")
    (first, *_) = sorted(path for path in served.out.iterdir() if (path / "result.json").exists())
    assert read_trajectory(first).ended is not None
