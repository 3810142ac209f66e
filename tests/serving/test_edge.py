"""The door of every server: real requests on a loopback socket."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any
from urllib.parse import urlsplit

import httpx
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from adamo_vh.serving import edge, prompt_clients
from adamo_vh.serving.admission import Rules
from adamo_vh.serving.edge import Edge, role_of
from adamo_vh.serving.loopback import is_loopback, listen
from adamo_vh.serving.rate import Rate
from adamo_vh.serving.running import running

TOKEN, JUDGE = "hush-hush-token", "the-judge's-token"


async def app(scope: Any, receive: Any, send: Any) -> None:
    """Gives back what it was sent; on a WebSocket, after the role of who sent it."""
    message = await receive()
    if scope["type"] == "websocket":
        await send({"type": "websocket.accept"})
        while (message := await receive())["type"] == "websocket.receive":
            text = f"{role_of(scope)}: {message.get('text')}"
            await send({"type": "websocket.send", "text": text})
        return
    start = {"type": "http.response.start", "status": 200, "headers": []}
    await send(start)
    await send({"type": "http.response.body", "body": message["body"]})


@contextmanager
def door(rules: Rules) -> Iterator[str]:
    with listen("127.0.0.1", 0) as opened:
        port = opened.getsockname()[1]
        with running(Edge(app, rules), opened, "test-edge", max_message_bytes=5000):
            yield f"http://127.0.0.1:{port}/"


@pytest.fixture(scope="module")
def open_door() -> Iterator[str]:
    with door(Rules(1000, max_message_bytes=1000)) as url:
        yield url


@pytest.fixture(scope="module")
def locked_door() -> Iterator[str]:
    with door(Rules(1000, token=TOKEN, judge_token=JUDGE, hosts=("Lab.Example",))) as url:
        yield url


def socket_of(url: str, **headers: str) -> ClientConnection:
    sent = {name.replace("_", "-"): value for name, value in headers.items()}
    address = urlsplit(url)
    wire = socket.create_connection((address.hostname, address.port), timeout=10)
    host = sent.pop("host", address.netloc)
    return connect(f"ws://{host}/", sock=wire, additional_headers=sent, compression=None)


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


def test_a_host_that_is_allowed_is_let_in(locked_door: str, open_door: str) -> None:
    key = f"Bearer {TOKEN}"
    assert post(locked_door, authorization=key, host="lab.example:80").status_code == 200
    assert post(locked_door, authorization=key, host="other.example").status_code == 403
    assert post(open_door, host="lab.example").status_code == 403


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"origin": "https://evil.example"}, 403),
        ({"sec_fetch_site": "cross-site"}, 403),
        ({"host": "evil.example"}, 403),
        ({"authorization": "Bearer wrong"}, 401),
        ({}, 401),
    ],
    ids=str,
)
def test_a_socket_is_judged_as_a_request_is(
    locked_door: str, headers: dict[str, str], status: int
) -> None:
    with pytest.raises(InvalidStatus) as caught, socket_of(locked_door, **headers):
        pass
    assert caught.value.response.status_code == status
    assert b'"message"' in caught.value.response.body


@pytest.mark.parametrize(("token", "role"), [(TOKEN, "player"), (JUDGE, "judge")])
def test_a_token_says_who_comes(locked_door: str, token: str, role: str) -> None:
    with socket_of(locked_door, authorization=f"Bearer {token}") as wire:
        wire.send("hello")
        assert wire.recv() == f"{role}: hello"


def test_a_wrong_token_is_no_players_where_there_is_a_judge() -> None:
    with door(Rules(1000, judge_token=JUDGE)) as url:
        assert post(url).status_code == 200
        assert post(url, authorization="Bearer wrong").status_code == 401
        assert post(url, authorization=f"Bearer {JUDGE}").status_code == 200


@pytest.mark.parametrize("size", [1001, 4000, 9000])
def test_a_message_that_is_too_large_ends_its_socket(open_door: str, size: int) -> None:
    with socket_of(open_door) as wire:
        wire.send("x" * 1000)
        assert str(wire.recv()).endswith("x")
        wire.send("x" * size)
        with pytest.raises(ConnectionClosed) as caught:
            wire.recv()
    assert caught.value.rcvd is not None and caught.value.rcvd.code == 1009


def test_who_asks_too_often_is_told_to_wait() -> None:
    with door(Rules(1000, rate=Rate(per_s=0.02, burst=3), max_message_bytes=1000)) as url:
        *answers, refused = [post(url) for _ in range(4)]
        assert [answer.status_code for answer in answers] == [200] * 3
        assert refused.status_code == 429
        wait_s = int(refused.headers["retry-after"])
        assert 1 <= wait_s <= 50 and f"again in {wait_s} s" in refused.text
    slow = Rules(1000, rate=Rate(per_s=2.0, burst=1), max_message_bytes=1000)
    with door(slow) as url, socket_of(url) as wire:
        begun = time.monotonic()
        for _ in range(3):
            wire.send("hello")
            wire.recv()
        assert time.monotonic() - begun > 0.5  # It is slowed down, and loses nothing.


def test_an_address_and_headers_have_their_limits(open_door: str) -> None:
    assert httpx.get(f"{open_door}?{'x' * 9000}").status_code == 414
    many = {f"x-{number}": "y" for number in range(120)}
    assert httpx.get(open_door, headers=many).status_code == 431
    assert httpx.get(open_door, headers={"x": "y" * 40_000}).status_code == 431


def test_a_client_that_is_too_slow_is_dropped(
    open_door: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(prompt_clients, "HEAD_S", 0.3)
    monkeypatch.setattr(prompt_clients, "UNREAD_S", 0.3)
    monkeypatch.setattr(edge, "_BODY_S", 0.3)
    host, port = open_door.removeprefix("http://").rstrip("/").split(":")
    head = f"POST / HTTP/1.1\r\nhost: {host}\r\ncontent-type: application/json\r\n"
    for sent, answer in ((head, b""), (f"{head}content-length: 9\r\n\r\n", b"HTTP/1.1 408")):
        with socket.create_connection((host, int(port)), timeout=10) as wire:
            wire.sendall(sent.encode())
            assert _all_of(wire).startswith(answer)


def test_a_client_that_does_not_read_is_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(prompt_clients, "UNREAD_S", 0.3)
    ended = threading.Event()

    async def floods(scope: Any, receive: Any, send: Any) -> None:
        await send({"type": "http.response.start", "status": 200, "headers": []})
        try:
            for _ in range(100):
                body = {"type": "http.response.body", "body": b"x" * 1_000_000, "more_body": True}
                await send(body)
        finally:
            ended.set()

    with (
        listen("127.0.0.1", 0) as opened,
        running(Edge(floods, Rules(10)), opened, "test-edge"),
        socket.create_connection(opened.getsockname(), timeout=10) as wire,
    ):
        wire.sendall(b"GET / HTTP/1.1\r\nhost: localhost\r\n\r\n")
        assert ended.wait(10)  # Else the answer waits for the reader for ever.


def _all_of(wire: socket.socket) -> bytes:
    read = bytearray()
    with suppress(OSError):
        while part := wire.recv(1000):
            read += part
    return bytes(read)


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
