"""The HTTP face is behind the edge of every server, and the standard streams carry MCP alone."""

from __future__ import annotations

import http.client
import json
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from adamo_vh.episode.result import read_result
from adamo_vh.errors import ConfigError
from adamo_vh.record.termination import TerminationReason
from adamo_vh.service.mcp.episodes import Episodes
from adamo_vh.service.mcp.offer import Offer
from adamo_vh.service.mcp.server import create_server
from adamo_vh.service.mcp.transports import MAX_BODY_BYTES, serve_http

TOKEN = "a-token-of-its-own"
GOOD = {
    "Content-Type": "application/json",
    "Accept": "application/json, text/event-stream",
    "Authorization": f"Bearer {TOKEN}",
}
HELLO = {
    "jsonrpc": "2.0",
    "id": 1,
    "method": "initialize",
    "params": {
        "protocolVersion": "2025-06-18",
        "capabilities": {},
        "clientInfo": {"name": "plain", "version": "1"},
    },
}


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    offer = Offer(root=tmp_path_factory.mktemp("runs"))
    with Episodes(offer) as episodes, serve_http(create_server(episodes), token=TOKEN) as address:
        yield address


def _ask(
    url: str, method: str, path: str, headers: Mapping[str, str], body: bytes = b""
) -> tuple[int, bytes]:
    parts = urlsplit(url)
    connection = http.client.HTTPConnection(parts.hostname or "", parts.port or 0, timeout=10)
    try:
        connection.request(method, path, body or None, dict(headers))
        answer = connection.getresponse()
        return answer.status, answer.read()
    finally:
        connection.close()


def test_a_client_without_the_sdk_is_let_in(url: str) -> None:
    status, body = _ask(url, "POST", "/mcp", GOOD, json.dumps(HELLO).encode())
    assert status == 200
    answer = json.loads(body)["result"]
    assert answer["serverInfo"]["name"] == "adamo-vh" and "new_episode" in answer["instructions"]


@pytest.mark.parametrize("method", ["POST", "GET", "DELETE"])
@pytest.mark.parametrize(
    ("change", "status"),
    [
        ({"Host": "evil.example"}, 403),
        ({"Origin": "http://evil.example"}, 403),
        ({"Sec-Fetch-Site": "cross-site"}, 403),
        ({"Authorization": ""}, 401),
        ({"Authorization": "Bearer wrong"}, 401),
        ({"Authorization": f"Basic {TOKEN}"}, 401),
    ],
)
def test_who_may_not_come_in_is_refused(
    url: str, method: str, change: dict[str, str], status: int
) -> None:
    body = json.dumps(HELLO).encode() if method == "POST" else b""
    assert _ask(url, method, "/mcp", {**GOOD, **change}, body)[0] == status


def test_what_is_too_large_or_no_json_is_refused(url: str) -> None:
    assert _ask(url, "POST", "/mcp", GOOD, b"x" * (MAX_BODY_BYTES + 1))[0] == 413
    assert _ask(url, "POST", "/mcp", {**GOOD, "Content-Type": "text/plain"}, b"{}")[0] == 415
    assert _ask(url, "POST", "/mcp", GOOD, b"{")[0] == 400
    deep = b"[" * 100_000 + b"]" * 100_000
    assert _ask(url, "POST", "/mcp", GOOD, deep)[0] == 400


def test_there_is_nothing_else(url: str) -> None:
    assert _ask(url, "GET", "/", GOOD)[0] == 404
    assert _ask(url, "GET", "/mcp/other", GOOD)[0] == 404
    assert _ask(url, "PUT", "/mcp", GOOD, b"{}")[0] == 405
    session = {**GOOD, "Mcp-Session-Id": "0" * 32}
    assert _ask(url, "POST", "/mcp", session, json.dumps(HELLO).encode())[0] == 404


def test_others_cannot_reach_it() -> None:
    with (
        Episodes(Offer()) as episodes,
        pytest.raises(ConfigError, match="can be reached from other machines"),
        serve_http(create_server(episodes), host="0.0.0.0"),
    ):
        pass


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_what_is_unfinished_is_written_down_when_the_process_is_told_to_end(
    tmp_path: Path, number: int
) -> None:
    command = [sys.executable, "-m", "adamo_vh", "mcp", "--task", "T8", "--resolution", "160x90"]
    pipe = subprocess.PIPE
    with subprocess.Popen(
        [*command, "--out", str(tmp_path / "one")], stdin=pipe, stdout=pipe, stderr=pipe
    ) as process:
        assert process.stdin is not None and process.stdout is not None
        call = {"name": "observe", "arguments": {"episode": "one"}}
        for message in (
            HELLO,
            {"jsonrpc": "2.0", "method": "notifications/initialized"},
            {"jsonrpc": "2.0", "id": 2, "method": "tools/call", "params": call},
        ):
            process.stdin.write(json.dumps(message).encode() + b"\n")
            process.stdin.flush()
        assert b"adamo-vh" in process.stdout.readline()
        assert b"Symbolic state" in process.stdout.readline()
        process.send_signal(number)
        assert process.wait(30) == 0
    result = read_result(tmp_path / "one")
    assert result is not None and result.termination is TerminationReason.BROKEN


def test_the_standard_streams_carry_mcp_alone_and_end_with_the_client(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "adamo_vh", "mcp", "--out", str(tmp_path)]
    said = json.dumps(HELLO).encode() + b"\nthis is no message\n"
    done = subprocess.run(command, input=said, capture_output=True, timeout=60, check=False)
    assert done.returncode == 0
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    assert answers[0]["result"]["serverInfo"]["name"] == "adamo-vh"
    assert b"MCP on the standard streams" in done.stderr and b"Traceback" not in done.stderr
