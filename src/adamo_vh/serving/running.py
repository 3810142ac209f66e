"""Run a web application in a thread, on a socket that listens already."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import socket

    from adamo_vh.serving.edge import App

_STOP_S = 20.0
_MAX_HEADER_BYTES = 64 * 1024


@contextmanager
def running(
    app: App,
    opened: socket.socket,
    name: str,
    protocol: Any = None,
    *,
    max_message_bytes: int = 0,
    has_lifespan: bool = False,
) -> Iterator[None]:
    """Serve while the block runs; stops and waits for the end.

    Args:
        app: The application, behind its `Edge`.
        opened: Whoever connects before the server runs waits for it.
        name: Of the thread.
        protocol: How HTTP is spoken; a class that is built on `PromptHttp`, which is the default.
        max_message_bytes: The largest message of any WebSocket; 0 to serve none.
        has_lifespan: Whether the application is to be told when the server starts and ends.
    """
    import uvicorn

    from adamo_vh.serving.prompt_clients import PromptHttp, PromptWebSocket

    # Its log is left alone: what happened is told to those who watch.
    config = uvicorn.Config(
        app,
        http=protocol or PromptHttp,
        ws=PromptWebSocket if max_message_bytes else "none",
        ws_max_size=max_message_bytes or 1,
        ws_per_message_deflate=False,  # Pictures are packed already, and a bomb is no message.
        loop="asyncio",
        lifespan="on" if has_lifespan else "off",
        log_config=None,
        log_level="critical",
        access_log=False,
        h11_max_incomplete_event_size=_MAX_HEADER_BYTES,
        timeout_graceful_shutdown=1,
    )
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, args=([opened],), name=name, daemon=True)
    thread.start()
    try:
        yield
    finally:
        server.should_exit = True
        thread.join(_STOP_S)
