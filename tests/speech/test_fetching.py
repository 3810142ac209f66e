"""Models are fetched whole or not at all, whatever happens on the way: a hub on loopback."""

from __future__ import annotations

import hashlib
import os
import re
import resource
import subprocess
import sys
import threading
from collections.abc import Iterator
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, ClassVar

import pytest

from adamo_vh.cli.exits import Exit
from adamo_vh.speech.models import known

pytestmark = pytest.mark.extras
MODEL = known("tiny.en")
LARGE = bytes(range(256)) * 4000
FILES = {file: b'{"of": "%s"}' % file.encode() for file in MODEL.files} | {"model.bin": LARGE}


class Hub(BaseHTTPRequestHandler):
    """As the hub answers, with a fault in how it hands out the large file."""

    protocol_version = "HTTP/1.1"
    fault = ""
    asked: ClassVar[list[str]] = []

    def log_message(self, *_: Any) -> None:
        """Say nothing."""

    def do_HEAD(self) -> None:
        self.answer()

    def do_GET(self) -> None:
        type(self).asked.append(self.path)
        self.answer()

    def answer(self) -> None:
        file = self.path.rpartition("/")[2]
        fault = self.fault if file == "model.bin" else ""
        content = FILES.get(file)
        if content is None or fault == "404" or "/resolve/" not in self.path:
            self.send_response(404)
            self.send_header("X-Error-Code", "EntryNotFound")
            self.send_header("content-length", "0")
            self.end_headers()
            return
        git = hashlib.sha1(b"blob %d\0" % len(content) + content).hexdigest()
        digest = hashlib.sha256(content).hexdigest() if file == "model.bin" else git
        start = int((re.findall(r"\d+", self.headers.get("range", "")) or ["0"])[0])
        if fault == "changed":
            content = content[::-1]
        self.send_response(206 if start else 200)
        self.send_header("ETag", f'"{digest}"')
        self.send_header("X-Repo-Commit", "c" * 40)
        self.send_header("content-length", str(len(content) - start))
        self.end_headers()
        if self.command == "GET":
            rest = content[start:]
            self.wfile.write(rest[: len(rest) // 2] if fault == "cut" else rest)
            self.close_connection = fault == "cut"


@pytest.fixture
def hub() -> Iterator[type[Hub]]:
    Hub.fault, Hub.asked = "", []
    server = ThreadingHTTPServer(("127.0.0.1", 0), Hub)
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    os.environ["HF_ENDPOINT"] = f"http://127.0.0.1:{server.server_address[1]}"
    yield Hub
    del os.environ["HF_ENDPOINT"]
    server.shutdown()
    server.server_close()


def fetch(data: Path, most_bytes: int = 0) -> tuple[int, str]:
    """As a user does it; how it ended, and what was said last."""
    least = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (most_bytes, most_bytes))
    done = subprocess.run(
        [sys.executable, "-m", "adamo_vh", "speech", "fetch", MODEL.name, "--yes"],
        env={**os.environ, "ADAMO_VH_DATA_DIR": str(data), "HF_HOME": str(data / "hf")},
        preexec_fn=least if most_bytes else None,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    return done.returncode, (done.stderr + done.stdout).strip()


def kept(data: Path) -> set[str]:
    folder = data / "speech" / MODEL.name
    return {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()}


def test_a_model_is_fetched_once(hub: type[Hub], tmp_path: Path) -> None:
    code, said = fetch(tmp_path)
    assert code == 0, said
    assert kept(tmp_path) == set(MODEL.files)
    assert (tmp_path / "speech" / MODEL.name / "model.bin").read_bytes() == LARGE
    hub.asked.clear()
    assert fetch(tmp_path)[0] == 0
    assert hub.asked == []


@pytest.mark.parametrize(
    ("fault", "why"),
    [
        ("404", "cannot be fetched from the Hugging Face Hub: .*404"),
        ("changed", "model.bin came otherwise than it is .* Fetch it again"),
        ("cut", "cannot be fetched from the Hugging Face Hub: "),
        ("full", "cannot be kept in .*: .*It takes 75 MB; make room"),
    ],
)
def test_what_goes_wrong_is_said_and_leaves_nothing_half(
    hub: type[Hub], tmp_path: Path, fault: str, why: str
) -> None:
    hub.fault = fault
    code, said = fetch(tmp_path, 300_000 if fault == "full" else 0)
    assert code == Exit.WRONG
    (line,) = [line for line in said.splitlines() if not line.startswith((MODEL.name, "Systran"))]
    assert re.search(why, line)
    assert kept(tmp_path) == {"config.json"}
    hub.fault = ""
    hub.asked.clear()
    assert fetch(tmp_path)[0] == 0
    assert kept(tmp_path) == set(MODEL.files)
    assert not any(path.endswith("config.json") for path in hub.asked)
