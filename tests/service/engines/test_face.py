"""Sessions of a server are played in engines that dialled in at the same port."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest
from tests.dialled import Passing
from tests.service.engines.test_door import soon

import adamo_vh
from adamo_vh.abilities import Abilities
from adamo_vh.action import Look, Outcome, Pick
from adamo_vh.cli.serve import serve
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import AdamoError, ConfigError
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.service.app import FACES, serving
from adamo_vh.service.engines.dialing import dial
from adamo_vh.service.engines.door import EngineDoor
from adamo_vh.service.engines.face import dialled_engines, engine_face
from adamo_vh.service.hosting import Host, Terms
from adamo_vh.session.pooling import BusyError


@contextmanager
def served(folder: Path, page: Path | None = None) -> Iterator[tuple[str, Host, EngineDoor]]:
    door = EngineDoor(20.0, page=page)
    host = Host(folder, Terms(resolution="160x90"), dialled_engines(door))
    try:
        with serving(host, faces=(*FACES, engine_face(door))) as url:
            yield url, host, door
    finally:
        host.close_all()


def dialling(url: str, engine: BuiltinEngine, able: Abilities | None = None) -> threading.Thread:
    address = f"{url.replace('http', 'ws', 1)}/engine"
    thread = threading.Thread(
        target=dial, args=(address, lambda *_: Passing(engine), "Mine 4", able), daemon=True
    )
    thread.start()
    return thread


def test_sessions_are_played_in_an_engine_that_dialled_in(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    with served(tmp_path) as (url, _, door):
        with pytest.raises(AdamoError, match="none dialled in at /engine"):
            adamo_vh.connect(url, task="T2").observe()
        thread = dialling(url, engine)
        soon(lambda: door._idle)
        one, two = adamo_vh.connect(url, task="T2"), adamo_vh.connect(url, task="T2")
        one.observe()
        two.observe()
        assert one.execute(Pick("Plate_57")).feedback.outcome is Outcome.DONE
        assert two.execute(Look(0.0, 0.0, 1.0)).agent.held is None
        assert one.execute(Look(0.0, 0.0, 1.0)).agent.held == "Plate_57"
        manifests = sorted(tmp_path.rglob("manifest.json"))
        assert len(manifests) == 2
        for manifest in manifests:
            told = json.loads(manifest.read_text())
            assert told["engine"] == "RemoteWorld"
            assert told["initial"]["scene"]["source"] == "dialled in: Mine 4"
    thread.join(10.0)


def test_a_place_gets_a_new_engine_when_its_own_has_gone(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    with served(tmp_path) as (url, host, door):
        dialling(url, engine)
        soon(lambda: door._idle)
        config = EpisodeConfig.of("look around", scene="s1")
        first = host.engines.take(config)
        assert host.engines.take(config) is first
        first.world.line.hang_up("gone")  # type: ignore[attr-defined]
        with pytest.raises(BusyError, match="No engine is free"):
            host.engines.take(config)
        dialling(url, engine)
        soon(lambda: door._idle)
        assert host.engines.take(config) is not first


def test_what_an_engine_does_not_have_is_told_and_it_waits_on(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    with served(tmp_path) as (url, host, door):
        dialling(url, engine)
        soon(lambda: door._idle)
        with pytest.raises(ConfigError, match="have their scenes as they stand"):
            host.engines.take(EpisodeConfig.of("look", scene="s1", variation=3))
        assert door._idle


def test_a_wrong_kind_of_engine_is_told(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="--engine unreal: use built-in or remote"):
        serve("127.0.0.1", 0, tmp_path, token="", judge="", hosts=[], engine="unreal")


def test_a_page_that_is_an_engine_is_offered_beside_the_other_faces(tmp_path: Path) -> None:
    page = tmp_path / "page"
    page.mkdir()
    (page / "index.html").write_text("<title>engine</title>")
    with served(tmp_path / "runs", page) as (url, _, _), httpx.Client(base_url=url) as client:
        assert client.get("/").text == "<title>engine</title>"
        assert client.get("/none.html").status_code == 404
        assert client.get("/openapi.json").json()["info"]["title"] == "ADAMO"
        foreign = client.get("/", headers={"origin": "http://example.com"})
        assert foreign.status_code == 403
    with served(tmp_path / "runs") as (url, _, _), httpx.Client(base_url=url) as client:
        assert "See GET /openapi.json" in client.get("/").text
