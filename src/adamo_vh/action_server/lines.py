"""How a client reaches a served body: over a WebSocket, or else over HTTP."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import ExitStack
from typing import Any, Protocol
from urllib.parse import urlsplit

from adamo_vh.action_server.wire import (
    Act,
    Answer,
    Attach,
    Create,
    Described,
    DescribeState,
    Failed,
    Finish,
    Load,
    Observe,
    Picture,
    Request,
    Say,
    Think,
    pictures_of,
    read,
    to_json,
)
from adamo_vh.errors import ConfigError, EngineError
from adamo_vh.extras import missing
from adamo_vh.observation import Frame
from adamo_vh.serving.loopback import is_loopback

_MAX_BYTES = 64_000_000
_KEPT = 8
"""Pictures that are not asked for again."""
Answered = tuple[Answer, Mapping[str, Frame]]


class CutError(Exception):
    """The connection was cut, or could not be made; it may work later."""


class Line(Protocol):
    """Carries requests to a server, and its answers with their pictures."""

    def ask(self, request: Request, session: str) -> Answered:
        """Ask, and wait for the answer.

        Args:
            request: What is asked.
            session: In which session; empty before there is one.

        Raises:
            CutError: It is not known whether the server has heard.
            ConfigError: The server lets nobody in with this token, or is none.
        """
        ...

    def close(self) -> None:
        """Hang up; the session stays."""
        ...


def open_line(url: str, token: str, transport: str, timeout_s: float) -> Line:
    """A line to a server.

    Args:
        url: Of the server, "http://HOST:PORT".
        token: What it asks for; empty for none.
        transport: "websocket", "http", or "auto": the first one, where its library is installed.
        timeout_s: For an answer to come.

    Raises:
        ConfigError: The URL or the transport is wrong, or the extra `serve` is missing.
    """
    parts = urlsplit(url)
    if parts.scheme not in ("http", "https") or not parts.hostname:
        raise ConfigError(f"{url!r} is no address of a server; write http://HOST:PORT.")
    if transport not in ("auto", "websocket", "http"):
        raise ConfigError(f"transport {transport!r}: use auto, websocket or http.")
    headers = {"authorization": f"Bearer {token}"} if token else {}
    if transport != "http":
        try:
            import websockets.sync.client  # noqa: F401

            return WebSocketLine(url, headers, timeout_s)
        except ImportError:
            if transport == "websocket":
                raise missing("serve", "A WebSocket", "websockets") from None
    return HttpLine(url, headers, timeout_s)


class WebSocketLine:
    """One connection, made when it is needed, and again after it was cut."""

    def __init__(self, url: str, headers: Mapping[str, str], timeout_s: float) -> None:
        """Prepare; nothing is connected yet.

        Args:
            url: Of the server.
            headers: Of the first request.
            timeout_s: For an answer to come.
        """
        self._url = url.rstrip("/").replace("http", "ws", 1) + "/v1/session"
        self._headers = dict(headers)
        self._timeout_s = timeout_s
        self._wire: Any = None
        self._hanging_up = ExitStack()

    def ask(self, request: Request, session: str) -> Answered:
        """Ask, and wait for the answer and its pictures."""
        from websockets.exceptions import InvalidStatus, WebSocketException

        try:
            if self._wire is None:
                self._connect()
                if session and not isinstance(request, Attach):
                    back = self._asked(Attach(session))
                    if isinstance(back[0], Failed):
                        return back
            return self._asked(request)
        except InvalidStatus as error:
            response = error.response
            raise refused(response.status_code, bytes(response.body or b"")) from None
        except (OSError, WebSocketException, TimeoutError) as error:
            self.close()
            raise CutError(f"{type(error).__name__}: {error}") from None

    def _connect(self) -> None:
        from websockets.sync.client import connect

        opening = connect(
            self._url,
            additional_headers=self._headers,
            max_size=_MAX_BYTES,
            compression=None,
            open_timeout=self._timeout_s,
            **({"proxy": None} if is_loopback(urlsplit(self._url).hostname or "") else {}),
        )
        self._wire = self._hanging_up.enter_context(opening)

    def _asked(self, request: Request) -> Answered:
        self._wire.send(to_json(request))
        answer = _read(self._wire.recv(timeout=self._timeout_s))
        frames = {}
        for picture in pictures_of(answer):
            data = self._wire.recv(timeout=self._timeout_s)
            frames[picture.name] = _frame(picture, data)
        return answer, frames

    def close(self) -> None:
        """Hang up."""
        self._wire = None
        self._hanging_up.close()


class HttpLine:
    """A request for each question, and one for each picture that is new."""

    def __init__(self, url: str, headers: Mapping[str, str], timeout_s: float) -> None:
        """Prepare; nothing is connected yet.

        Args:
            url: Of the server.
            headers: Of every request.
            timeout_s: For an answer to come.
        """
        import httpx

        on_loopback = is_loopback(urlsplit(url).hostname or "")
        self._client = httpx.Client(
            base_url=url.rstrip("/"),
            headers=dict(headers),
            timeout=timeout_s,
            trust_env=not on_loopback,
        )
        self._frames: dict[str, Frame] = {}

    def ask(self, request: Request, session: str) -> Answered:
        """Ask, and fetch the pictures of the answer."""
        import httpx

        try:
            method, path = _route(request, session)
            body = to_json(request) if method == "POST" else None
            kind = {"content-type": "application/json"} if body else {}
            response = self._client.request(method, path, content=body, headers=kind)
            if response.status_code >= 400 and b'"failed"' not in response.content:
                raise refused(response.status_code, response.content)
            if isinstance(request, DescribeState) and response.is_success:
                return Described(response.text), {}
            answer = _read(response.content)
            return answer, {one.name: self._frame(one) for one in pictures_of(answer)}
        except httpx.TransportError as error:
            raise CutError(f"{type(error).__name__}: {error}") from None

    def _frame(self, picture: Picture) -> Frame:
        if picture.name not in self._frames:
            response = self._client.get(picture.href)
            if not response.is_success:
                raise refused(response.status_code, response.content)
            self._frames[picture.name] = _frame(picture, response.content)
            while len(self._frames) > _KEPT:
                del self._frames[next(iter(self._frames))]
        return self._frames[picture.name]

    def close(self) -> None:
        """Close the connections."""
        self._client.close()


def _route(request: Request, session: str) -> tuple[str, str]:
    """Where a request goes over HTTP."""
    here = f"/v1/sessions/{session}"
    match request:
        case Create():
            return "POST", "/v1/sessions"
        case Attach():
            return "GET", f"/v1/sessions/{request.session}"
        case Observe():
            return "GET", f"{here}/view"
        case DescribeState():
            return "GET", f"{here}/state-text"
        case Act() | Think() | Say() | Finish() | Load():
            return "POST", f"{here}/{request.type}"


def _read(text: str | bytes) -> Answer:
    try:
        answer: Answer = read(Answer, text)
    except ConfigError as error:
        raise EngineError(f"The server does not speak as this client does: {error}") from None
    return answer


def _frame(picture: Picture, data: object) -> Frame:
    if not isinstance(data, bytes):
        raise EngineError("The server does not speak as this client does: a picture is no bytes.")
    return Frame(data, picture.media_type, picture.width_px, picture.height_px)


def refused(status: int, body: bytes) -> Exception:
    """What a server says that lets nobody in."""
    try:
        said = str(json.loads(body)["error"]["message"])
    except (ValueError, LookupError, TypeError):
        said = f"it answers {status}, which no server of a body does."
    if status in (429, 502, 503, 504):
        return CutError(said)
    return ConfigError(f"The server: {said}")
