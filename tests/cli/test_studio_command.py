"""`adamo-vh studio`: what is wrong is said in one line, before anything is served."""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from contextlib import suppress
from pathlib import Path

import pytest
from typer.testing import CliRunner

from adamo_vh.cli.app import app
from adamo_vh.errors import ConfigError


def told(*words: str) -> str:
    """What the command says to somebody who calls it wrongly."""
    with pytest.raises(ConfigError) as fault:
        CliRunner().invoke(app, ["studio", *words], catch_exceptions=False)
    assert "\n" not in str(fault.value)
    return str(fault.value)


def test_a_folder_without_runs_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "holds no run" in told(str(tmp_path))
    assert "is no folder" in told(str(tmp_path / "nothing"))


def test_a_port_that_is_taken_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        said = told("--port", port, "--out", str(tmp_path))
    assert f"Port {port}" in said and "Try another" in said


def test_others_need_a_token_and_a_long_one(
    tmp_path: Path,
) -> None:
    assert "token" in told("--host", "0.0.0.0", "--port", "0", "--out", str(tmp_path))
    assert "at least 12" in told("--token", "short", "--out", str(tmp_path))


def test_help_names_what_it_is() -> None:
    said = CliRunner().invoke(app, ["studio", "--help"])
    assert said.exit_code == 0 and "--rooms" in said.output


@pytest.mark.slow
def test_it_prints_its_address_serves_and_stops_cleanly(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "adamo_vh", "studio", "--port", "0", "--token", "new"]
    process = subprocess.Popen(
        [*command, "--out", str(tmp_path)],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1", "COLUMNS": "300"},
    )
    try:
        assert process.stdout is not None
        line = process.stdout.readline()
        url = re.search(r"http://\S+/studio/\?token=\S+", line)
        assert url is not None, line
        opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
        with suppress(urllib.error.HTTPError):  # The page itself may not be built here.
            opener.open(url[0], timeout=30).close()
        offer = url[0].partition("?")[0] + "api/offer"
        with opener.open(offer, timeout=30) as answer:
            assert b"baseline" in answer.read()
    finally:
        process.send_signal(signal.SIGINT)
        said, _ = process.communicate(timeout=60)
    assert process.returncode == 0 and "every record is whole" in said
