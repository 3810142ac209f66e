"""The door for engines: who comes in, who waits, and who is sent away, over real sockets."""

from __future__ import annotations

import http.client
import json
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from tests.dialled import Passing, open_door
from typer.testing import CliRunner
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from adamo_vh.abilities import Abilities
from adamo_vh.cli.app import app
from adamo_vh.errors import ConfigError, EngineError
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.service.engines import door as door_module
from adamo_vh.service.engines.answering import hello_of
from adamo_vh.service.engines.dialing import dial
from adamo_vh.service.engines.remote import RemoteWorld
from adamo_vh.service.engines.waiting import dialled_in
from adamo_vh.serving.loopback import listen

HELLO = json.dumps(hello_of("Mine", Abilities()))


def free_port() -> int:
    with listen("127.0.0.1", 0) as opened:
        port: int = opened.getsockname()[1]
        return port


def soon(holds: Callable[[], Any]) -> None:
    for _ in range(200):
        if holds():
            return
        time.sleep(0.05)
    raise AssertionError("it never happened")


def dialling(port: int, engine: BuiltinEngine, able: Abilities | None = None) -> threading.Thread:
    """An engine that tries until somebody waits for it."""

    def run() -> None:
        for _ in range(200):
            try:
                url = f"ws://127.0.0.1:{port}/engine"
                dial(url, lambda *_: Passing(engine), "Mine 3", able)
                return
            except ConfigError:
                time.sleep(0.1)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    return thread


def test_engines_are_handed_out_in_the_order_in_which_they_came() -> None:
    with open_door() as (door, url), connect(url) as first, connect(url) as second:
        first.send(HELLO)
        soon(lambda: door._idle)
        second.send(HELLO.replace("Mine", "Other"))
        assert [door.take(10.0).name, door.take(10.0).name] == ["Mine", "Other"]


def test_an_engine_that_left_is_not_handed_out() -> None:
    with open_door() as (door, url):
        with connect(url) as socket:
            socket.send(HELLO)
            soon(lambda: door._idle)
        soon(lambda: not door._idle)
        with pytest.raises(EngineError, match="none dialled in at /engine"):
            door.take(0.0)


def test_who_sends_more_than_anybody_asked_for_is_sent_away() -> None:
    with open_door() as (door, url), connect(url) as socket:
        socket.send(HELLO)
        line = door.take(10.0)
        for _ in range(40):
            with suppress(ConnectionClosed):
                socket.send('{"id": 1}')
        with pytest.raises(ConnectionClosed, match="more than it was asked for"):
            socket.recv(timeout=10.0)
        with pytest.raises(EngineError, match="Mine"):
            line.ask("state")


def test_who_says_nothing_is_sent_away(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(door_module, "_HELLO_S", 0.1)
    with (
        open_door() as (_, url),
        connect(url) as socket,
        pytest.raises(ConnectionClosed, match="No hello came"),
    ):
        socket.recv(timeout=10.0)


def test_only_so_many_engines_come_in(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(door_module, "MOST_ENGINES", 1)
    with open_door() as (door, url), connect(url) as socket:
        socket.send(HELLO)
        soon(lambda: door._idle)
        with pytest.raises(InvalidStatus):
            connect(url)


def test_the_door_is_no_page() -> None:
    with open_door() as (_, url):
        connection = http.client.HTTPConnection(urlsplit(url).netloc, timeout=10)
        connection.request("GET", "/engine")
        answer = connection.getresponse()
        assert answer.status == 404 and b"for engines" in answer.read()


@pytest.mark.parametrize(
    ("header", "value"), [("Origin", "https://evil.example"), ("Host", "evil.example")]
)
def test_pages_and_names_from_elsewhere_stay_out(header: str, value: str) -> None:
    with open_door() as (door, url):
        with pytest.raises(InvalidStatus):
            connect(url, additional_headers={header: value})
        assert not door._idle


def test_nobody_waits_there(engine: BuiltinEngine) -> None:
    with pytest.raises(ConfigError, match="takes no engine"):
        dial(f"ws://127.0.0.1:{free_port()}/engine", lambda *_: Passing(engine), "Mine")
    with pytest.raises(ConfigError, match="takes no engine"):
        dial("nonsense", lambda *_: Passing(engine), "Mine")


def test_one_waits_for_an_engine_and_says_so(engine: BuiltinEngine) -> None:
    told: list[str] = []
    port = free_port()
    thread = dialling(port, engine, Abilities(closeup=False))
    with dialled_in("s1", port=port, wait_s=20.0, tell=told.append) as world:
        assert world.state().hash() == engine.state().hash()
    thread.join(10.0)
    assert not thread.is_alive()
    assert told[0] == f"waiting for an engine at ws://127.0.0.1:{port}/engine"
    assert told[1:] == ["Mine 3 dialled in", "note: it draws no close-ups"]


def test_one_does_not_wait_for_ever() -> None:
    with (
        pytest.raises(EngineError, match="No engine is free"),
        dialled_in("s1", port=0, wait_s=0.1, tell=lambda text: None),
    ):
        raise AssertionError("nobody came")


def test_the_command_line_waits_for_an_engine(
    engine: BuiltinEngine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    port = free_port()
    where = ["--engine", "remote", "--engine-port", str(port)]
    dialling(port, engine)
    first = CliRunner().invoke(
        app,
        ["run", "--task", "T2", "--resolution", "320x180", "--out", "run", "--json", *where],
        catch_exceptions=False,
    )
    found = json.loads(first.stdout)
    assert (found["task"], found["scene"]) == ("T2", "s1")
    manifest = json.loads((tmp_path / "run" / "manifest.json").read_text())
    assert manifest["engine"] == "RemoteWorld"
    assert manifest["initial"]["scene"]["source"] == "dialled in: Mine 3"


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--engine", "unreal"], "use built-in or remote"),
        (["--engine", "remote", "--engine-port", "99999"], "99999 is no port"),
    ],
)
def test_a_wrong_engine_option_is_told(options: list[str], told: str) -> None:
    result = CliRunner().invoke(app, ["run", "--task", "T2", *options])
    assert isinstance(result.exception, ConfigError)
    assert told in str(result.exception)


def test_a_closed_world_gives_its_engine_to_the_next(engine: BuiltinEngine) -> None:
    with open_door() as (door, url):
        port = urlsplit(url).port
        assert port is not None
        thread = dialling(port, engine)
        for _ in range(3):
            world = RemoteWorld(door.take(20.0), "S1")
            assert world.scene.name == "s1"
            world.close()
        world.line.hang_up("over")
        thread.join(10.0)


def test_the_token_of_the_environment_is_asked_for(
    engine: BuiltinEngine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ADAMO_VH_TOKEN", "s3cret")
    told: list[str] = []
    port = free_port()

    def run(token: str) -> None:
        soon(lambda: told)
        with suppress(ConfigError):
            dial(f"ws://127.0.0.1:{port}/engine", lambda *_: Passing(engine), "Mine", token=token)

    for token in ("wrong", "s3cret"):
        threading.Thread(target=run, args=(token,), daemon=True).start()
    with dialled_in("s1", port=port, wait_s=20.0, tell=told.append) as world:
        assert world.scene.name == "s1"
    assert told[0].endswith("/engine (with the token)")


def test_an_engine_that_dials_in_is_looked_over(engine: BuiltinEngine) -> None:
    port = free_port()
    dialling(port, engine)
    target = f"ws://127.0.0.1:{port}/engine"
    done = CliRunner().invoke(app, ["conformance", target, "--only", "drop-empty", "--json"])
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert (found["engine"], found["conforms"]) == ("dialled in: Mine 3", True)
    assert [item["verdict"] for item in found["checks"]] == ["passed"]
