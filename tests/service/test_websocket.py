"""The body over a WebSocket: the same messages, and pictures as bytes."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from tests.service.conftest import Serve
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from adamo_vh.service.hosting import Host

LOOK = {"type": "act", "name": "Look", "arguments": {"x": 0.5, "y": -1.0, "z": 0.8}}


@contextmanager
def wire_to(url: str) -> Iterator[ClientConnection]:
    address = url.replace("http", "ws", 1) + "/v1/session"
    with connect(address, max_size=None, open_timeout=60) as wire:
        yield wire


def asked(wire: ClientConnection, **message: Any) -> Any:
    wire.send(json.dumps(message))
    return json.loads(wire.recv(timeout=60))


def test_an_episode_over_one_connection(serve: Serve) -> None:
    url, host = serve()
    with wire_to(url) as wire:
        welcome = asked(wire, type="create", task="T1", profile="lean")
        first = wire.recv(timeout=60)
        assert isinstance(first, bytes) and first[:2] == b"\xff\xd8"
        looked = asked(wire, **LOOK)
        assert looked["view"]["picture"]["name"] and isinstance(wire.recv(timeout=60), bytes)
        tag = looked["view"]["objects"][0]["tag"]
        close = asked(wire, type="act", name="Inspect", arguments={"object": tag})
        assert len(close["pictures"]) == 1 and isinstance(wire.recv(timeout=60), bytes)
        assert asked(wire, type="think", note="No.")["type"] == "noted"
        assert asked(wire, type="finish", answer="No.")["ended"] is True
        assert asked(wire, **LOOK)["error"]["type"] == "episode_over"
    assert host.find(welcome["session"]).body.ended


def test_who_was_cut_off_comes_back(serve: Serve) -> None:
    url, host = serve()
    with wire_to(url) as wire:
        session = asked(wire, type="create", task="T1")["session"]
        wire.recv(timeout=60)
        looked = asked(wire, **LOOK, request="r1")
    with wire_to(url) as wire:
        back = asked(wire, type="attach", session=session)
        assert isinstance(wire.recv(timeout=60), bytes)
        assert back["seen"]["state_hash"] == looked["state_hash"]
        assert asked(wire, **LOOK, request="r1") == looked  # Answered again, not done again.
        assert isinstance(wire.recv(timeout=60), bytes)
    assert host.find(session).body.steps == 1


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[" * 5000,
        '{"type": "fly"}',
        '{"type": "observe"}',
        '{"type": "attach", "session": "none"}',
        '{"type": "create", "task": "T99"}',
        b"\xff\xd8",
    ],
)
def test_what_cannot_be_done_is_told_and_the_wire_stays(serve: Serve, text: Any) -> None:
    url, _ = serve()
    with wire_to(url) as wire:
        wire.send(text)
        failed = json.loads(wire.recv(timeout=60))
        assert failed["type"] == "failed" and failed["error"]["message"]
        assert asked(wire, type="create", instruction="Look around.")["type"] == "welcome"


def test_a_session_that_was_closed_is_gone(serve: Serve) -> None:
    url, host = serve()
    with wire_to(url) as wire:
        session = asked(wire, type="create", task="T1")["session"]
        wire.recv(timeout=60)
        host.close(session)
        assert asked(wire, type="observe")["error"]["type"] == "not_found"


def test_a_server_that_ends_says_so(make_host: Any) -> None:
    from adamo_vh.service.app import serving

    host: Host = make_host()
    with serving(host) as url, wire_to(url) as wire:
        asked(wire, type="create", task="T1")
        folder = host.sessions()[0].folder
        stop = wire
    host.close_all()
    assert isinstance(stop.recv(timeout=5), bytes)
    with pytest.raises(ConnectionClosed):
        stop.recv(timeout=5)
    assert (folder / "episode.html").is_file() and (folder / "events.jsonl").is_file()
