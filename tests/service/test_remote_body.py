"""The Python client: an action server that is elsewhere, over either transport."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import pytest
from tests.service.conftest import Serve

import adamo_vh
from adamo_vh.action import Look, Outcome
from adamo_vh.action_server import ActionServer, execute_call
from adamo_vh.action_server.remote import RemoteBody
from adamo_vh.errors import ConfigError, EngineError, EpisodeOverError
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.serving.admission import Rules

TRANSPORTS = ("websocket", "http")
LOOK = {"x": 0.5, "y": -1.0, "z": 0.8}


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_a_body_elsewhere_answers_as_one_here(serve: Serve, transport: str) -> None:
    url, host = serve()
    with adamo_vh.connect(url, task="T1", profile="lean", transport=transport) as body:
        here = host.find(body.session).body
        server: ActionServer = body
        assert server.actions == here.actions and body.tools == here.tools
        assert (body.instruction, body.system_prompt) == (here.instruction, here.system_prompt)
        assert server.observe().observation == here.observe().observation
        looked = server.execute(Look(**LOOK))
        assert looked.observation == here.observe().observation
        assert (looked.state_hash, looked.agent) == (here.state().hash(), here.observe().agent)
        assert body.state_text() == here.state_text()
        tag = looked.observation.objects[0].tag if looked.observation else ""
        (closeup,) = body.call("Inspect", {"object": tag}).pictures
        assert closeup.data[:2] == b"\xff\xd8" and closeup.width_px > 100
        refused = execute_call(server, "Fly", {"up": True})
        assert refused.feedback.outcome is Outcome.REFUSED and "Fly" in refused.feedback.text
        assert body.load(refused.saved) == refused.state_hash
        with pytest.raises(ConfigError, match="where it stands"):
            body.load("saved-1")
        body.think("I know enough.")
        body.say("Nothing here.")
        body.finish("Nothing here.", "budget", "my own")
        assert body.ended
        with pytest.raises(EpisodeOverError):
            body.observe()
        body.say("Nobody hears this.")
    acts = read_trajectory(host.find(body.session).folder).acts
    assert [act.name for act in acts] == ["Look", "Inspect", "Fly"]


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_a_wrong_setting_is_told(serve: Serve, transport: str) -> None:
    url, _ = serve(Rules(10_000, token="the-token-of-all"))
    key: dict[str, Any] = {"token": "the-token-of-all", "transport": transport}
    for more, said in (
        ({"task": "T99"}, "There is no task"),
        ({"task": "T1", "wings": 2}, "wings"),
        ({"task": "T1", "seed": object()}, "cannot be sent"),
        ({"session": "none"}, "no such session"),
        ({"session": "none", "task": "T1"}, "leave task out"),
    ):
        with pytest.raises(ConfigError, match=said):
            adamo_vh.connect(url, **key, **more)
    with pytest.raises(ConfigError, match="token is missing or wrong"):
        adamo_vh.connect(url, task="T1", transport=transport)
    for address, said in (("localhost", "write http://"), ("ftp://x", "write http://")):
        with pytest.raises(ConfigError, match=said):
            adamo_vh.connect(address, task="T1")
    with pytest.raises(ConfigError, match="auto, websocket or http"):
        adamo_vh.connect(url, task="T1", transport="pigeon")


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_a_server_that_is_not_there_is_told(transport: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    with pytest.raises(EngineError, match="cannot be reached"):
        adamo_vh.connect(f"http://127.0.0.1:{port}", task="T1", transport=transport, retry_s=0.2)


class Wire:
    """A way to a server that can be cut: before the server hears, or before it is heard."""

    def __init__(self, url: str) -> None:
        host, port = url.removeprefix("http://").split(":")
        self._server = (host, int(port))
        self._door = socket.create_server(("127.0.0.1", 0))
        self.url = f"http://127.0.0.1:{self._door.getsockname()[1]}"
        self.cut_answers = 0
        """So many answers are lost, each with its connection."""
        self._open: list[socket.socket] = []
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                near, _ = self._door.accept()
                far = socket.create_connection(self._server)
                self._open += [near, far]
                for one, other, heard in ((near, far, False), (far, near, True)):
                    args = (one, other, heard)
                    threading.Thread(target=self._carry, args=args, daemon=True).start()

    def _carry(self, one: socket.socket, other: socket.socket, heard: bool) -> None:
        with suppress(OSError):
            while data := one.recv(65536):
                if heard and self.cut_answers and b"feedback" in data:
                    self.cut_answers -= 1
                    break
                other.sendall(data)
        self._shut(one, other)

    def cut(self) -> None:
        """Cut all connections."""
        self._shut(*self._open)
        self._open.clear()

    @staticmethod
    def _shut(*ends: socket.socket) -> None:
        for end in ends:
            with suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
            end.close()

    def close(self) -> None:
        self._door.close()
        self.cut()


@contextmanager
def cuttable(url: str) -> Iterator[Wire]:
    wire = Wire(url)
    try:
        yield wire
    finally:
        wire.close()


@pytest.mark.parametrize("transport", TRANSPORTS)
def test_what_was_cut_goes_on_and_nothing_is_done_twice(serve: Serve, transport: str) -> None:
    url, host = serve()
    with cuttable(url) as wire:
        body = adamo_vh.connect(wire.url, task="T1", transport=transport)
        body.call("Look", LOOK)
        wire.cut()
        walked = body.call("Walk", {"x": 0, "y": 0, "z": 0})  # The server had not heard of it.
        wire.cut_answers = 2
        again = body.call("Look", LOOK)  # The server did it, and its answer was lost, twice.
        body.close()
    here = host.find(body.session).body
    assert here.steps == 3 and here.observe().state_hash == again.state_hash != walked.state_hash


def test_a_client_that_was_killed_goes_on_by_its_id(serve: Serve) -> None:
    url, host = serve()
    killed = adamo_vh.connect(url, task="T1")
    killed.call("Look", LOOK)
    killed._line._wire.socket.close()  # type: ignore[attr-defined]
    with adamo_vh.connect(url, session=killed.session) as body:
        assert isinstance(body, RemoteBody) and body.instruction == killed.instruction
        body.call("Walk", {"x": 0, "y": 0, "z": 0})
        assert host.find(body.session).body.steps == 2
        host.close(body.session)
        with pytest.raises(ConfigError, match="no such session"):
            body.observe()


def test_a_server_of_something_else_is_told(tmp_path: Any) -> None:
    from adamo_vh.model_server.model_serving import serve_model

    with serve_model("baseline") as served:
        url = served.base_url.removesuffix("/v1")
        for transport in TRANSPORTS:
            with pytest.raises((ConfigError, EngineError)):
                adamo_vh.connect(url, task="T1", transport=transport, retry_s=0.1)
