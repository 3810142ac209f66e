"""An OpenAI-compatible chat-completions server on a real loopback socket, with faults on demand."""

from __future__ import annotations

import json
import socket
import struct
import threading
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import TracebackType
from typing import Any

Json = dict[str, Any]


@dataclass(frozen=True)
class Canned:
    """One response of the server."""

    body: Json | bytes = b""
    status: int = 200
    headers: Mapping[str, str] = field(default_factory=dict)
    delay_s: float = 0.0
    cut: bool = False
    """Reset the connection instead of answering."""


def call(name: str, arguments: Json | str, id: str | None = "call_a") -> Json:
    """A native tool call, as in a completion; a string of arguments is sent as it is."""
    raw = arguments if isinstance(arguments, str) else json.dumps(arguments)
    found: Json = {"type": "function", "function": {"name": name, "arguments": raw}}
    return found if id is None else {"id": id, **found}


def completion(
    text: str | None, calls: Sequence[Json] = (), cached: int = 0, **message: Any
) -> Canned:
    """A completion with a text, calls, and whatever else the message carries."""
    content: Json = {"role": "assistant", "content": text, **message}
    if calls:
        content["tool_calls"] = list(calls)
    usage: Json = {"prompt_tokens": 1200, "completion_tokens": 34, "total_tokens": 1234}
    if cached:
        usage["prompt_tokens_details"] = {"cached_tokens": cached}
    return Canned(
        {
            "id": "chatcmpl-1",
            "object": "chat.completion",
            "created": 1,
            "model": "tiny-vlm",
            "choices": [
                {
                    "index": 0,
                    "finish_reason": "tool_calls" if calls else "stop",
                    "message": content,
                }
            ],
            "usage": usage,
        }
    )


def fault(
    status: int, message: str = "no", headers: Mapping[str, str] | None = None, **error: Any
) -> Canned:
    """An error in OpenAI's shape."""
    return Canned({"error": {"message": message, **error}}, status, headers or {})


class _Server(ThreadingHTTPServer):
    daemon_threads = True

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Stay silent: clients that give up waiting are part of the tests."""


Answers = Iterable[Canned] | Callable[[Json], Canned]


class FakeProvider:
    """Serves canned responses in order, or those that a function makes of each request."""

    def __init__(self, answers: Answers) -> None:
        self.requests: list[Json] = []
        self.headers: list[dict[str, str]] = []
        self.raw: list[bytes] = []
        self.paths: list[str] = []
        self._answer = answers if callable(answers) else _in_order(answers)
        self._server = _Server(("127.0.0.1", 0), self._handler())
        self._thread = threading.Thread(
            target=self._server.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True
        )

    @property
    def base_url(self) -> str:
        """Address of the API."""
        return f"http://127.0.0.1:{self._server.server_address[1]}/v1"

    def uri(self, model: str = "tiny-vlm") -> str:
        """Model URI of this server."""
        return f"openai:{model}@{self.base_url}"

    def __enter__(self) -> FakeProvider:
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._server.shutdown()
        self._server.server_close()

    def _handler(self) -> type[BaseHTTPRequestHandler]:
        provider = self

        class Handler(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_POST(self) -> None:
                raw = self.rfile.read(int(self.headers["Content-Length"]))
                request: Json = json.loads(raw)
                provider.raw.append(raw)
                provider.requests.append(request)
                provider.paths.append(self.path)
                provider.headers.append({k.lower(): v for k, v in self.headers.items()})
                self._send(provider._answer(request))

            def _send(self, canned: Canned) -> None:
                time.sleep(canned.delay_s)
                if canned.cut:
                    linger = struct.pack("ii", 1, 0)
                    self.connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, linger)
                    self.connection.close()
                    self.close_connection = True
                    return
                body = canned.body
                data = body if isinstance(body, bytes) else json.dumps(body).encode()
                self.send_response(canned.status)
                headers = {"Content-Type": "application/json", **canned.headers}
                for name, value in headers.items():
                    self.send_header(name, value)
                self.send_header("Content-Length", str(len(data)))
                self.end_headers()
                self.wfile.write(data)

            def log_message(self, format: str, *args: Any) -> None:
                """Stay silent: the log belongs to what is tested."""

        return Handler


def _in_order(answers: Iterable[Canned]) -> Callable[[Json], Canned]:
    waiting = iter(answers)
    lock = threading.Lock()

    def answer(request: Json) -> Canned:
        with lock:
            return next(waiting, fault(418, "the server ran out of canned responses"))

    return answer
