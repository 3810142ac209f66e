"""`adamo-vh serve`: what it says, what it refuses, and how it ends."""

from __future__ import annotations

import os
import re
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

import adamo_vh
from adamo_vh.cli.serve import serve
from adamo_vh.episode.result import read_result
from adamo_vh.errors import ConfigError, SceneError
from adamo_vh.session.lending import LentWorld

ALONE: dict[str, Any] = {"token": "", "judge": "", "hosts": []}


@pytest.fixture(autouse=True)
def _handlers() -> Iterator[None]:
    """Ctrl+C is pytest's again afterwards."""
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.fixture
def in_lent_engine(lent: LentWorld, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "adamo_vh.session.pooling.create_engine", lambda *_: lent.lender.lend(), raising=True
    )


def told(capfd: pytest.CaptureFixture[str], what: str, seen: list[str]) -> str:
    """What a line of the server says."""
    until = time.monotonic() + 30
    while time.monotonic() < until:
        seen.append(capfd.readouterr().out)
        if found := re.search(rf"^{what} +(\S+)$", "".join(seen), re.MULTILINE):
            return found[1]
        time.sleep(0.05)
    raise AssertionError("".join(seen))


@pytest.mark.usefixtures("in_lent_engine")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_it_serves_until_it_is_told_to_stop(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], number: int
) -> None:
    seen: list[str] = []
    found: dict[str, Any] = {}

    def play() -> None:
        try:
            url = told(capfd, "serving", seen).removesuffix("/v1")
            judge, key = told(capfd, "judge", seen), told(capfd, "token", seen)
            with adamo_vh.connect(url, task="T1", token=key) as body:
                found["hash"] = body.observe().state_hash
                found["session"] = body.session
                body.call("Look", {"x": 0, "y": 0, "z": 1})
            bearer = {"authorization": f"Bearer {judge}"}
            found["score"] = httpx.get(
                f"{url}/v1/sessions/{body.session}/score", headers=bearer, timeout=30
            ).json()
            done = adamo_vh.connect(url, task="T1", token=key)
            done.finish("No.")
        finally:
            os.kill(os.getpid(), number)

    player = threading.Thread(target=play)
    player.start()
    serve(
        "127.0.0.1",
        0,
        tmp_path / "out",
        token="new",
        judge="new",
        hosts=[],
        resolution="320x180",
    )
    player.join()
    assert found["score"] == {"completion": 0.0} and len(found["hash"]) == 64
    left, ended = sorted((tmp_path / "out").iterdir())
    for folder in (left, ended):
        assert (folder / "episode.html").is_file() and (folder / "manifest.json").is_file()
    assert read_result(left) is None
    result = read_result(ended)
    assert result is not None and result.answer == "No."
    assert "every record is whole" in "".join(seen) + capfd.readouterr().out


@pytest.mark.parametrize("token", ["short", "with a\nline and more", "ümläute-in-it", "x" * 11])
def test_a_token_that_keeps_nobody_out_is_refused(tmp_path: Path, token: str) -> None:
    for which in ("token", "judge"):
        with pytest.raises(ConfigError, match=f"--{which}: use at least 12"):
            serve("127.0.0.1", 0, tmp_path, **{**ALONE, which: token})


@pytest.mark.parametrize("address", ["0.0.0.0", "::", "192.0.2.1"])
def test_others_are_let_in_with_a_token_alone(tmp_path: Path, address: str) -> None:
    with pytest.raises(ConfigError, match="nothing is locked"):
        serve(address, 0, tmp_path, **ALONE)
    with pytest.raises(ConfigError, match="nothing is locked"):
        serve(address, 0, tmp_path, **{**ALONE, "judge": "a-judge-alone-locks-nothing"})


def test_a_port_that_is_taken_or_none_is_told(tmp_path: Path) -> None:
    for port in (-1, 70_000):
        with pytest.raises(ConfigError, match="is no port"):
            serve("127.0.0.1", port, tmp_path, **ALONE)


@pytest.mark.parametrize(
    ("terms", "said"),
    [
        ({"scene": "s3"}, "no scene"),
        ({"labeling": "both"}, "sem, opaq"),
        ({"profile": "fast"}, "no profile"),
        ({"resolution": "9x9"}, "64x64"),
        ({"figure": "bob"}, "mara"),
    ],
)
def test_a_wrong_setting_is_told_before_anybody_plays(
    tmp_path: Path, terms: dict[str, Any], said: str
) -> None:
    with pytest.raises((ConfigError, SceneError), match=said):
        serve("127.0.0.1", 0, tmp_path, **ALONE, **terms)
    assert list(tmp_path.iterdir()) == []
