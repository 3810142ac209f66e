"""The way of the bytes: each request straight or through its proxy, each answer read to a limit."""

from __future__ import annotations

import json
import zlib
from functools import cache
from typing import TYPE_CHECKING, Any

from adamo_vh.inference.remote.exchange import (
    Exchange,
    current_exchange,
    note_answer,
    note_request,
)
from adamo_vh.inference.remote.mended import mended, read_json
from adamo_vh.inference.remote.routes import proxy_for

if TYPE_CHECKING:
    import ssl
    from collections.abc import AsyncIterable

    import httpx2

MAX_ANSWER_BYTES = 16_000_000
"""Of an answer, unpacked; the longest that a model gives has some hundred thousand."""
_MAX_ERROR_BYTES = 200_000
"""Of an error; the rest is not read."""
_CONNECT_S = 10.0
"""A server that takes longer to accept a connection is not there."""
_ENCODINGS = ("", "identity", "gzip", "x-gzip", "deflate")


class AnswerRefusedError(RuntimeError):
    """An answer is not taken: too large, or packed in a way that was not asked for."""


def watching_client(timeout_s: float, *, secure: bool = True) -> httpx2.AsyncClient:
    """Make an HTTP client that notes what it sends and gets.

    It follows no redirect, and takes nothing from the environment but what `routes` takes.

    Args:
        timeout_s: Seconds at most for one request.
        secure: Whether it may have to do with certificates; reading them takes a while.
    """
    import httpx2

    class Watching(httpx2.AsyncBaseTransport):
        """Notes each exchange, on its way."""

        def __init__(self) -> None:
            self._ways: dict[str | None, httpx2.AsyncHTTPTransport] = {}

        async def handle_async_request(self, request: httpx2.Request) -> httpx2.Response:
            way = self._way(proxy_for(str(request.url)))
            exchange = current_exchange()
            if exchange is None:
                return await way.handle_async_request(request)
            # A scalar time-out, as the libraries send it, would allow as long to connect alone.
            timeout = request.extensions.get("timeout")
            if isinstance(timeout, dict):
                timeout["connect"] = min(timeout.get("connect") or _CONNECT_S, _CONNECT_S)
            note_request(exchange, await request.aread(), str(request.url))
            response = await way.handle_async_request(request)
            try:
                body = await _read(response, exchange)
            finally:
                await response.aclose()
            return _response(response, body, request)

        def _way(self, proxy: str | None) -> httpx2.AsyncHTTPTransport:
            if proxy not in self._ways:
                self._ways[proxy] = httpx2.AsyncHTTPTransport(
                    verify=_trusted() if secure else False,
                    proxy=proxy,
                    limits=httpx2.Limits(max_connections=None, max_keepalive_connections=20),
                    trust_env=False,
                )
            return self._ways[proxy]

        async def aclose(self) -> None:
            for way in self._ways.values():
                await way.aclose()

    return httpx2.AsyncClient(
        transport=Watching(),
        timeout=httpx2.Timeout(timeout_s, connect=min(timeout_s, _CONNECT_S), pool=None),
        headers={"accept-encoding": "gzip"},
        trust_env=False,
    )


@cache
def _trusted() -> ssl.SSLContext:
    """Whom to trust, for all clients: reading the certificates takes longer than a local call."""
    import httpx2

    return httpx2.create_ssl_context()


async def _read(response: httpx2.Response, exchange: Exchange) -> bytes:
    """The body, unpacked, up to a limit; noted with its status."""
    headers = {name.lower(): value for name, value in response.headers.items()}
    encoding = headers.get("content-encoding", "").strip().lower()
    failed = response.status_code >= 300
    limit = _MAX_ERROR_BYTES if failed else MAX_ANSWER_BYTES
    if encoding not in _ENCODINGS:
        exchange.fault = f"The answer is packed as {encoding[:40]!r}, which was not asked for."
        raise AnswerRefusedError(exchange.fault)
    stream: Any = response.stream
    body = await _unpacked(stream, limit, packed=encoding not in ("", "identity"))
    note_answer(exchange, response.status_code, headers, body[:limit])
    if len(body) > limit and not failed:
        exchange.fault = (
            f"The answer has more than {limit / 1e6:g} MB and was not read to its end; no model "
            "says so much. Is this the address of a model?"
        )
        raise AnswerRefusedError(exchange.fault)
    return body[:limit]


async def _unpacked(stream: AsyncIterable[bytes], limit: int, *, packed: bool) -> bytes:
    """The beginning of a stream, and one byte more than the limit if it is longer."""
    unpack = zlib.decompressobj(zlib.MAX_WBITS | 32) if packed else None
    body = bytearray()
    async for chunk in stream:
        rest = limit + 1 - len(body)
        try:
            body += chunk[:rest] if unpack is None else unpack.decompress(chunk, rest)
        except zlib.error:
            break  # What was read up to here is judged as it is.
        if len(body) > limit:
            break
    return bytes(body)


def _response(response: httpx2.Response, body: bytes, request: httpx2.Request) -> httpx2.Response:
    """The answer for the client library: plain, and mended where it would stumble."""
    import httpx2

    if response.status_code == 200 and isinstance(value := read_json(body), dict):
        body = json.dumps(mended(value), ensure_ascii=True).encode()
    dropped = ("content-encoding", "content-length", "transfer-encoding")
    headers = [(n, v) for n, v in response.headers.multi_items() if n.lower() not in dropped]
    return httpx2.Response(response.status_code, headers=headers, content=body, request=request)
