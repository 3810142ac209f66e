"""The C# client compiles, and dials in to a real door; all outside of Unity."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from tests.dialled import open_door
from tests.programs import need

from adamo_vh.errors import EngineError
from adamo_vh.geometry import Vec3
from adamo_vh.service.conformance import Verdict, conform
from adamo_vh.service.engines.remote import RemoteWorld

pytestmark = pytest.mark.extras

FOLDER = Path(__file__).resolve().parents[3] / "engines" / "unity"


@pytest.fixture(scope="module")
def stub(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The compiled console program."""
    need(["mcs", "mono"], ["mono-mcs", "mono-runtime", "libmono-system4.0-cil"])
    program = tmp_path_factory.mktemp("csharp") / "stub.exe"
    files = sorted(str(path) for path in FOLDER.glob("*/*.cs"))
    order = ["mcs", "-langversion:7", "-warnaserror", f"-out:{program}", *files]
    done = subprocess.run(order, check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return program


@contextmanager
def running(stub: Path, token: str = "") -> Iterator[RemoteWorld]:
    with open_door(token=token) as (door, url):
        env = {**os.environ, "ADAMO_VH_TOKEN": token}
        program = subprocess.Popen(["mono", str(stub), url], env=env)
        try:
            line = door.take(20.0)
            yield RemoteWorld(line, "s1")
            line.hang_up("The test is over.")
            assert program.wait(10.0) == 0
        finally:
            program.kill()
            program.wait()


def test_the_stub_keeps_what_needs_no_eyes(stub: Path) -> None:
    with running(stub) as world:
        report = conform(world, ["scene", "body", "state", "reset", "look", "walk", "say"])
    faults = [f"{f.name}: {f.found}" for f in report.findings if f.verdict is Verdict.FAILED]
    assert faults == []
    assert report.count(Verdict.PASSED) >= 17


def test_pictures_and_rays_go_over_the_wire(stub: Path) -> None:
    with running(stub) as world:
        body = world.bodies["agent"]
        percept = body.see(32, 18)
        assert percept.rgb.shape == (18, 32, 3) and (percept.rgb == 128).all()
        down, up = body.rays(Vec3(0, 0, 1.5), Vec3(0, 0, 1).array()[None] * [[-1], [1]])
        assert (down, up) == (Vec3(0, 0, 0), None)


def test_what_the_engine_refuses_is_told_and_it_goes_on(stub: Path) -> None:
    with running(stub) as world:
        with pytest.raises(EngineError, match="there is no object 7"):
            world.bodies["agent"].pick(7)
        assert world.state().object(1).class_name == "cube"


def test_it_brings_its_token(stub: Path) -> None:
    with running(stub, token="a-long-enough-token") as world:
        assert world.scene.name == "s1"
