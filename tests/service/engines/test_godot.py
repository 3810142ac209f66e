"""Our Godot project carries the scenes: it keeps the contract, and tasks are done in it."""

from __future__ import annotations

import os
import socket
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest
from tests.programs import need

import adamo_vh
from adamo_vh.benchmark.tasks import task
from adamo_vh.benchmark.verify import verify_tasks
from adamo_vh.engine import acting_body
from adamo_vh.perception import Labeling
from adamo_vh.service.conformance import Verdict, conform
from adamo_vh.service.engines.remote import RemoteWorld
from adamo_vh.service.engines.waiting import dialled_in
from adamo_vh.session.builtin import export

pytestmark = pytest.mark.extras

PROJECT = Path(__file__).resolve().parents[3] / "engines" / "godot"
SCREEN = ["xvfb-run", "-a", "-s", "-screen 0 1280x720x24 +extension GLX"]
GODOT = ["godot3-runner", "--path", str(PROJECT), "--video-driver", "GLES3"]


@pytest.fixture(scope="module")
def scenes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    need(["godot3-runner", "xvfb-run"], ["godot3-runner", "xvfb", "xauth"])
    folder = tmp_path_factory.mktemp("scenes")
    for name in ("s1", "s2"):
        export(name, 0, folder / name)
    return folder


@contextmanager
def godot(scenes: Path, scene: str) -> Iterator[RemoteWorld]:
    """A world in Godot, with no screen."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    started: list[subprocess.Popen[bytes]] = []

    def start(told: str) -> None:
        if not started:
            url = f"ws://127.0.0.1:{port}/engine"
            own = {"ADAMO_URL": url, "ADAMO_SCENES": str(scenes), "LC_ALL": "C.UTF-8"}
            command = [*SCREEN, *GODOT, "--audio-driver", "Dummy"]
            started.append(subprocess.Popen(command, env={**os.environ, **own}))

    try:
        with dialled_in(scene, port=port, wait_s=120.0, answer_s=120.0, tell=start) as world:
            yield world
    finally:
        for process in started:
            # It ends by itself when the line is cut.
            with suppress(subprocess.TimeoutExpired):
                process.wait(20)
            process.terminate()
            process.wait(20)


@pytest.mark.parametrize("scene", ["s1", "s2"])
def test_it_keeps_the_contract(scenes: Path, scene: str) -> None:
    with godot(scenes, scene) as world:
        report = conform(world)
    wrong = {i.name: i.found for i in report.findings if i.verdict is Verdict.FAILED}
    assert wrong == {}
    assert report.count(Verdict.MISSING) == 0
    assert report.count(Verdict.PASSED) >= len(report.findings) - 2


def test_a_view_has_the_right_things_in_the_right_places(scenes: Path) -> None:
    engine = adamo_vh.create_engine("s1")
    try:
        with godot(scenes, "s1") as world:
            far, near = acting_body(world).see(640, 360), acting_body(engine).see(640, 360)
            assert far.rgb.std() > 20
            assert set(far.objects) == set(near.objects)
            both = (far.id_layers[0] >= 0) & (near.id_layers[0] >= 0)
            either = (far.id_layers[0] >= 0) | (near.id_layers[0] >= 0)
            assert both.sum() > 0.9 * either.sum()
            same = far.id_layers[0][both] == near.id_layers[0][both]
            assert same.mean() > 0.97
    finally:
        engine.close()


def test_tasks_are_done_in_it(scenes: Path, tmp_path: Path) -> None:
    names = ("T1", "T5", "T8", "T10", "T15")
    with godot(scenes, "s1") as world:
        proofs = list(verify_tasks(world, Labeling.SEM, [task(name) for name in names]))
        assert [row.oracle for row in proofs] == [1.0] * 5, proofs
        for name in names[:3]:
            result = adamo_vh.run_episode(
                task=name, engine=world, resolution=(640, 360), out=tmp_path / name
            )
            assert result.completion == 1.0, name
        replayed = adamo_vh.replay_episode(tmp_path / "T1", engine=world)
        assert not replayed.mismatches
