"""The door of every server: real requests on a loopback socket."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from adamo_vh.serving.edge import Edge, Rules
from adamo_vh.serving.loopback import is_loopback, listen
from adamo_vh.serving.running import running

TOKEN = "hush-hush-token"


async def app(scope: Any, receive: Any, send: Any) -> None:
    """Gives back what it was sent."""
    message = await receive()
    start = {"type": "http.response.start", "status": 200, "headers": []}
    await send(start)
    await send({"type": "http.response.body", "body": message["body"]})


@pytest.fixture(scope="module")
def open_door() -> Iterator[str]:
    with listen("127.0.0.1", 0) as opened:
        port = opened.getsockname()[1]
        with running(Edge(app, Rules(1000)), opened, "test-edge"):
            yield f"http://127.0.0.1:{port}/"


@pytest.fixture(scope="module")
def locked_door() -> Iterator[str]:
    with listen("127.0.0.1", 0) as opened:
        port = opened.getsockname()[1]
        with running(Edge(app, Rules(1000, token=TOKEN)), opened, "test-edge"):
            yield f"http://127.0.0.1:{port}/"


def post(url: str, body: bytes = b"{}", **headers: str) -> httpx.Response:
    sent = {name.replace("_", "-"): value for name, value in headers.items()}
    return httpx.post(url, content=body, headers={"content-type": "application/json", **sent})


def test_a_plain_request_comes_in(open_door: str) -> None:
    answer = post(open_door, b'{"a": 1}')
    assert (answer.status_code, answer.content) == (200, b'{"a": 1}')
    with_charset = post(open_door, content_type="application/json; charset=utf-8")
    assert with_charset.status_code == 200
    own = open_door.rstrip("/")
    assert post(open_door, origin=own, sec_fetch_site="same-origin").status_code == 200


@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "https://evil.example"},
        {"origin": "null"},
        {"origin": "http://localhost:3000"},
        {"origin": ""},
        {"sec_fetch_site": "cross-site"},
        {"sec_fetch_site": "same-site"},
        {"host": "evil.example"},
        {"host": "127.0.0.1.evil.example"},
        {"host": "[::1"},
        {"host": ""},
    ],
    ids=str,
)
def test_a_foreign_page_stays_outside(open_door: str, headers: dict[str, str]) -> None:
    answer = post(open_door, b"{}", **headers)
    assert answer.status_code in (400, 403)
    if answer.status_code == 403:
        assert answer.json()["error"]["message"]
    assert httpx.get(open_door, headers={"origin": "https://evil.example"}).status_code == 403


@pytest.mark.parametrize(
    "kind", ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data", ""]
)
def test_a_body_says_what_it_is(open_door: str, kind: str) -> None:
    answer = post(open_door, content_type=kind)
    assert answer.status_code == 415 and "application/json" in answer.json()["error"]["message"]


def test_a_body_that_is_too_large_is_refused_with_words(open_door: str) -> None:
    assert post(open_door, b"x" * 1000).status_code == 200
    for size in (1001, 5000):
        answer = post(open_door, b"x" * size)
        assert answer.status_code == 413 and "1000 bytes" in answer.json()["error"]["message"]


def test_a_header_without_end_is_refused(open_door: str) -> None:
    host, port = open_door.removeprefix("http://").rstrip("/").split(":")
    with socket.create_connection((host, int(port)), timeout=10) as wire:
        try:
            wire.sendall(b"GET / HTTP/1.1\r\nhost: 127.0.0.1\r\nx: " + b"y" * 300_000)
            answer = wire.recv(100)
        except OSError:
            answer = b""  # Cut off while it was sending.
    assert not answer or b" 400 " in answer or b" 431 " in answer


def test_a_token_opens_a_locked_door(locked_door: str) -> None:
    assert post(locked_door).status_code == 401
    assert post(locked_door, authorization="Bearer wrong").status_code == 401
    assert post(locked_door, authorization=f"Bearer {TOKEN}").status_code == 200


def test_a_server_ends_with_its_block() -> None:
    with listen("127.0.0.1", 0) as opened:
        port = opened.getsockname()[1]
        with running(Edge(app, Rules(10)), opened, "test-edge"):
            assert post(f"http://127.0.0.1:{port}/").status_code == 200
    with pytest.raises(httpx.ConnectError):
        post(f"http://127.0.0.1:{port}/")


@pytest.mark.parametrize(
    ("host", "own"),
    [
        ("127.0.0.1", True),
        ("::1", True),
        ("::ffff:127.0.0.1", True),
        ("LocalHost", True),
        ("0.0.0.0", False),
        ("10.0.0.1", False),
        ("localhost.evil.example", False),
        ("", False),
    ],
)
def test_only_this_machine_is_loopback(host: str, own: bool) -> None:
    assert is_loopback(host) is own
