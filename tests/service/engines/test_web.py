"""A tab of Chromium carries the scenes: it keeps the contract, and tasks are done in it."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from tests.dialled import open_door
from tests.programs import need

import adamo_vh
from adamo_vh.benchmark.tasks import task
from adamo_vh.benchmark.verify import verify_tasks
from adamo_vh.engine import acting_body
from adamo_vh.perception import Labeling
from adamo_vh.service.conformance import Verdict, conform
from adamo_vh.service.engines.remote import RemoteWorld
from adamo_vh.session.builtin import export

pytestmark = pytest.mark.extras

SOURCE = Path(__file__).resolve().parents[3] / "engines" / "web"
CHROMIUM = ["chromium", "--headless=new", "--no-sandbox", "--no-first-run"]
SOFTWARE = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the page's source with its libraries."""
    need(["chromium", "node", "npm"], ["chromium", "nodejs", "npm"])
    folder = tmp_path_factory.mktemp("web") / "web"
    shutil.copytree(SOURCE, folder, ignore=shutil.ignore_patterns("node_modules", "dist"))
    npm(folder, "ci", "--no-audit", "--no-fund")
    return folder


@pytest.fixture(scope="module")
def page(source: Path) -> Path:
    """The built page, with both scenes."""
    npm(source, "run", "build")
    for name in ("s1", "s2"):
        export(name, 0, source / "dist" / "scenes" / name)
    return source / "dist"


def npm(folder: Path, *words: str) -> None:
    done = subprocess.run(
        ["npm", *words], cwd=folder, check=False, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, done.stdout + done.stderr


@contextmanager
def tab(page: Path, profile: Path, scene: str) -> Iterator[RemoteWorld]:
    """A world in a tab, with no screen."""
    with open_door(answer_s=300.0, page=page) as (door, url):
        address = url.replace("ws:", "http:").removesuffix("engine")
        command = [*CHROMIUM, *SOFTWARE, f"--user-data-dir={profile}", address]
        with subprocess.Popen(command, stderr=subprocess.DEVNULL) as browser:
            try:
                line = door.take(120.0)
                yield RemoteWorld(line, scene)
                line.hang_up("The test is over.")
            finally:
                browser.terminate()


def test_its_logic_is_right(source: Path) -> None:
    npm(source, "test")


def test_the_lock_names_no_place_to_load_from() -> None:
    text = (SOURCE / "package-lock.json").read_text(encoding="utf-8")
    assert '"resolved"' not in text
    assert '"integrity"' in text


@pytest.mark.parametrize("scene", ["s1", "s2"])
def test_it_keeps_the_contract(page: Path, tmp_path: Path, scene: str) -> None:
    with tab(page, tmp_path, scene) as world:
        report = conform(world)
    wrong = {i.name: i.found for i in report.findings if i.verdict is Verdict.FAILED}
    assert wrong == {}
    lacks = {i.name for i in report.findings if i.verdict is Verdict.MISSING}
    assert lacks == {"events-sound", "events-refused", "events-gone"}
    assert report.count(Verdict.PASSED) >= len(report.findings) - 5


def test_a_view_has_the_right_things_in_the_right_places(page: Path, tmp_path: Path) -> None:
    engine = adamo_vh.create_engine("s1")
    try:
        with tab(page, tmp_path, "s1") as world:
            far, near = acting_body(world).see(640, 360), acting_body(engine).see(640, 360)
            assert far.rgb.std() > 20
            assert set(far.objects) == set(near.objects)
            both = (far.id_layers[0] >= 0) & (near.id_layers[0] >= 0)
            either = (far.id_layers[0] >= 0) | (near.id_layers[0] >= 0)
            assert both.sum() > 0.9 * either.sum()
            same = far.id_layers[0][both] == near.id_layers[0][both]
            assert same.mean() > 0.97
            # Light and paint are about those of the built-in room.
            assert abs(far.rgb.mean() - near.rgb.mean()) < 25
    finally:
        engine.close()


def test_tasks_are_done_in_it(page: Path, tmp_path: Path) -> None:
    names = ("T1", "T5", "T8", "T10", "T15")
    with tab(page, tmp_path / "browser", "s1") as world:
        proofs = list(verify_tasks(world, Labeling.SEM, [task(name) for name in names]))
        assert [row.oracle for row in proofs] == [1.0] * 5, proofs
        result = adamo_vh.run_episode(
            task="T1", engine=world, resolution=(640, 360), out=tmp_path / "T1"
        )
        assert result.completion == 1.0
        replayed = adamo_vh.replay_episode(tmp_path / "T1", engine=world)
        assert not replayed.mismatches
