"""A viewer that does not read what it is told is let go; the room and all others go on."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager
from urllib.parse import urlsplit

import pytest
from tests.studio.conftest import Served
from tests.studio.visitor import Visitor

from adamo_vh.studio import live, messages

_TOLD = 120
_TEXT = "x" * 100_000
"""More in all than any system keeps for a connection."""


@contextmanager
def staring(served: Served, room: str) -> Iterator[socket.socket]:
    """A connection to a room that reads nothing but the answer to its first request."""
    at = urlsplit(served.url)
    wire = socket.socket()
    with wire:
        wire.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        wire.settimeout(30.0)
        wire.connect((at.hostname, at.port))
        head = (
            f"GET /studio/api/rooms/{room}/live?from=0 HTTP/1.1",
            f"Host: {at.netloc}",
            "Connection: Upgrade",
            "Upgrade: websocket",
            "Sec-WebSocket-Version: 13",
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
        )
        wire.sendall("\r\n".join((*head, "", "")).encode())
        assert wire.recv(12) == b"HTTP/1.1 101"
        yield wire


def test_who_does_not_read_is_let_go_and_the_others_go_on(
    served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live, "_SLOW_S", 0.5)
    room = served.room(scene="s1")
    log = served.studio.rooms.find(room).log
    with staring(served, room), Visitor(served.url, room) as visitor:
        visitor.doing("idle")
        assert log.watchers == 2
        began = time.monotonic()
        for _ in range(_TOLD):
            log.append(messages.notice(_TEXT, "info"), 0.0)
        assert time.monotonic() - began < 2.0, "The room waited for a viewer."
        for _ in range(_TOLD):
            assert visitor.notice()["text"] == _TEXT
        end = time.monotonic() + 15.0
        while log.watchers > 1 and time.monotonic() < end:
            time.sleep(0.1)
        assert log.watchers == 1, "Who does not read was kept."
        visitor.ask("move", object_id=4, point=[0.2, 0.1, 0.8])
        assert visitor.event("happened")["by_user"]
    served.close(room)
