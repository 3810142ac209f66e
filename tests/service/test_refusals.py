"""Every route of every face is behind the one edge: what may not come in comes in nowhere.

The routes are those of the application itself, so that a face which is added is tried as well.
"""

from __future__ import annotations

import socket
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import httpx
import pytest
from fastapi.routing import APIRoute
from starlette.routing import BaseRoute, Mount, Route, WebSocketRoute
from tests.service.conftest import JUDGE
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from adamo_vh.service.app import FACES, create_app, serving
from adamo_vh.service.hosting import Host
from adamo_vh.serving.admission import Rules
from adamo_vh.serving.rate import Rate

TOKEN = "token-of-the-tests"
LOCKED = Rules(2000, token=TOKEN, judge_token=JUDGE, rate=Rate(per_s=0))
KEY = {"authorization": f"Bearer {TOKEN}"}
JSON = {"content-type": "application/json"}
FOREIGN = [
    {"host": "evil.example"},
    {"host": "localhost.evil.example:80"},
    {"origin": "https://evil.example"},
    {"origin": "null"},
    {"origin": "http://localhost:1"},
    {"sec-fetch-site": "cross-site"},
    {"sec-fetch-site": "same-site"},
]
"""Headers of pages that have no business here, and of names that are not this machine's."""


def walked(routes: Any, before: str = "") -> Iterator[tuple[str, str]]:
    """Method and path of every route, also within what is mounted; WS for a WebSocket."""
    for route in routes:
        inner = getattr(getattr(route, "original_router", None), "routes", None)
        if isinstance(route, WebSocketRoute):
            yield "WS", before + route.path
        elif isinstance(route, Mount):
            yield "GET", before + route.path
            yield "POST", before + route.path
            yield from walked(route.routes or (), before + route.path)
        elif isinstance(route, Route | APIRoute):
            for method in route.methods or {"GET", "POST"}:
                yield method, before + route.path
        elif inner is not None:
            yield from walked(inner, before)
        else:
            assert not isinstance(route, BaseRoute), f"a route of a new kind: {route}"


def filled(path: str) -> str:
    return path.replace("{session}", "none").replace("{name}", "none").replace("{path:path}", "x")


@pytest.fixture(scope="module")
def locked(standing_host: Host) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    app: Any = create_app(standing_host, LOCKED).app
    routes = sorted({(method, filled(path)) for method, path in walked(app.routes)})
    assert len(routes) >= 20 and {"WS", "GET", "POST", "DELETE"} <= {m for m, _ in routes}
    with serving(standing_host, rules=LOCKED) as url:
        yield url, routes


def status(client: httpx.Client, method: str, path: str, headers: dict[str, str]) -> int:
    body = b"{}" if method in ("POST", "PUT", "PATCH") else None
    return client.request(method, path, content=body, headers=headers).status_code


def knocked(url: str, path: str, headers: dict[str, str]) -> int:
    """The status with which a WebSocket is answered; 101 if it is let in."""
    host, port = url.removeprefix("http://").split(":")
    sent = {**headers}
    name = sent.pop("host", f"{host}:{port}")
    with ExitStack() as stack:
        wire = stack.enter_context(socket.create_connection((host, int(port)), timeout=10))
        try:
            stack.enter_context(connect(f"ws://{name}{path}", sock=wire, additional_headers=sent))
        except InvalidStatus as refused:
            return refused.response.status_code
    return 101


def test_nothing_foreign_comes_in_anywhere(locked: tuple[str, list[tuple[str, str]]]) -> None:
    url, routes = locked
    let_in = []
    with httpx.Client(base_url=url, timeout=30) as client:
        for method, path in routes:
            for headers in FOREIGN:
                sent = {**KEY, **JSON, **headers}
                if method == "WS":
                    found = knocked(url, path, {**KEY, **headers})
                else:
                    found = status(client, method, path, sent)
                if found != 403:
                    let_in.append((method, path, headers, found))
    assert let_in == []


@pytest.mark.parametrize(
    "token", ["", "Bearer", "Bearer wrong", f"Basic {TOKEN}", f"Bearer {TOKEN}x"]
)
def test_nobody_comes_in_without_a_token(
    locked: tuple[str, list[tuple[str, str]]], token: str
) -> None:
    url, routes = locked
    brought = {"authorization": token} if token else {}
    with httpx.Client(base_url=url, timeout=30) as client:
        found = {
            (method, path): (
                knocked(url, path, brought)
                if method == "WS"
                else status(client, method, path, {**JSON, **brought})
            )
            for method, path in routes
        }
    assert {where: number for where, number in found.items() if number != 401} == {}


def test_what_is_too_large_or_of_another_kind_comes_in_nowhere(
    locked: tuple[str, list[tuple[str, str]]],
) -> None:
    url, routes = locked
    roomy = {path for face in FACES for path, _ in face.max_bytes}
    wrong: list[Any] = []
    with httpx.Client(base_url=url, timeout=30) as client:
        for method, path in routes:
            if method == "WS":
                continue
            long = client.request(method, path + "?" + "x" * 9000, headers={**KEY, **JSON})
            many = {f"x-{number}": "y" for number in range(120)}
            wrong += [(method, path, 414)] if long.status_code not in (414, 415) else []
            found = client.request(method, path, headers={**KEY, **JSON, **many}).status_code
            wrong += [(method, path, found)] if found != 431 else []
            if method in ("POST", "PUT", "PATCH"):
                for kind in ("text/plain", "multipart/form-data", ""):
                    found = status(client, method, path, {**KEY, "content-type": kind})
                    wrong += [(method, path, kind, found)] if found != 415 else []
                if path not in roomy:
                    large = client.request(
                        method, path, content=b"[" + b"1," * 1500, headers={**KEY, **JSON}
                    )
                    wrong += [(method, path, large.status_code)] if large.status_code != 413 else []
    assert wrong == []


def test_no_route_takes_a_method_that_it_does_not_have(
    locked: tuple[str, list[tuple[str, str]]],
) -> None:
    url, routes = locked
    own = {path: {method for method, at in routes if at == path} for _, path in routes}
    with httpx.Client(base_url=url, timeout=30) as client:
        for path, methods in own.items():
            for method in ("TRACE", "CONNECT", "PROPFIND"):
                assert status(client, method, path, KEY) in (400, 404, 405), (method, path)
            if "WS" not in methods:
                for method in {"GET", "PUT", "PATCH", "DELETE"} - methods:
                    found = status(client, method, path, {**KEY, **JSON})
                    assert found in (404, 405, 406), (method, path, found)


def test_who_asks_too_often_waits_on_every_route(make_host: Any) -> None:
    rules = Rules(2000, rate=Rate(per_s=0.01, burst=2))
    host: Host = make_host()
    with serving(host, rules=rules) as url, httpx.Client(base_url=url, timeout=30) as client:
        assert [client.get("/v1").status_code for _ in range(3)] == [200, 200, 429]
        for path in ("/v1", "/openapi.json", "/nothing", "/v1/sessions/none/view"):
            assert client.get(path).status_code == 429
        assert knocked(url, "/v1/session", {}) == 429


def test_answers_tell_nothing_of_the_machine(locked: tuple[str, list[tuple[str, str]]]) -> None:
    url, routes = locked
    with httpx.Client(base_url=url, timeout=30, headers=KEY) as client:
        for method, path in routes:
            if method != "WS":
                answer = client.request(method, path, headers=JSON, content=b"{}")
                assert "Traceback" not in answer.text and "/src/" not in answer.text
                assert answer.status_code < 500, (method, path, answer.text)
