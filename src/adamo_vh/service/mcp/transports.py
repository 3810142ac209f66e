"""How MCP clients reach the server: over the standard streams, or over HTTP."""

from __future__ import annotations

import os
import signal
import socket
import sys
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager
from typing import Any

import anyio
import anyio.to_thread
from mcp.server import Server
from mcp.server.stdio import stdio_server
from mcp.server.streamable_http_manager import StreamableHTTPASGIApp, StreamableHTTPSessionManager
from starlette.applications import Starlette
from starlette.routing import Route

from adamo_vh.serving.admission import Rules
from adamo_vh.serving.edge import App, Edge
from adamo_vh.serving.loopback import listen
from adamo_vh.serving.running import running

PATH = "/mcp"
MAX_BODY_BYTES = 1_000_000
"""Of a request; a call of a tool is far smaller."""
_MOST_CLIENTS = 64


def http_route(server: Server[Any]) -> tuple[Route, StreamableHTTPSessionManager]:
    """The route at which MCP is spoken, and its manager, whose `run` must be open while it is.

    Args:
        server: As of `create_server`.
    """
    manager = StreamableHTTPSessionManager(
        server,
        json_response=True,
        max_request_body_size=MAX_BODY_BYTES,
        max_sessions=_MOST_CLIENTS,
    )
    endpoint, methods = StreamableHTTPASGIApp(manager), ["GET", "POST", "DELETE"]
    return Route(PATH, endpoint, methods=methods, include_in_schema=False), manager


def create_app(server: Server[Any]) -> App:
    """A web application with MCP at `PATH` alone; it wants its lifespan to be run, and an edge.

    Args:
        server: As of `create_server`.
    """
    route, manager = http_route(server)

    @asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[None]:
        async with manager.run():
            yield

    return Starlette(routes=[route], lifespan=lifespan)


@contextmanager
def serve_http(
    server: Server[Any], port: int = 0, *, host: str = "127.0.0.1", token: str = ""
) -> Iterator[str]:
    """Serve on a loopback address while the block runs.

    Args:
        server: As of `create_server`.
        port: The port; 0 for a free one.
        host: A loopback address.
        token: What each request must bring as its bearer token; empty for none.

    Yields:
        The address for clients.

    Raises:
        ConfigError: The port cannot be had, or others could reach the host.
    """
    with listen(host, port) as opened, serve_socket(server, opened, token=token):
        shown = f"[{host}]" if ":" in host else host
        yield f"http://{shown}:{opened.getsockname()[1]}{PATH}"


@contextmanager
def serve_socket(server: Server[Any], opened: socket.socket, *, token: str = "") -> Iterator[None]:
    """Serve on a socket that listens already, while the block runs; it is closed at the end.

    Args:
        server: As of `create_server`.
        opened: Of this machine alone.
        token: What each request must bring as its bearer token; empty for none.
    """
    app = Edge(create_app(server), Rules(MAX_BODY_BYTES, token=token))
    with opened, running(app, opened, "adamo-vh-mcp", has_lifespan=True):
        yield


def serve_stdio(server: Server[Any], stop: Callable[[], None]) -> None:
    """Serve the one client at the standard streams, until it hangs up.

    Args:
        server: As of `create_server`.
        stop: Is called when the process is told to end, and ends all that must be; then it ends.
    """

    async def wait_for_signal() -> None:
        with anyio.open_signal_receiver(signal.SIGTERM, signal.SIGINT) as signals:
            async for _ in signals:
                await anyio.to_thread.run_sync(stop)
                sys.stderr.flush()
                # The thread that waits for the client's next line hears of nothing else.
                os._exit(0)

    async def main() -> None:
        async with anyio.create_task_group() as group:
            group.start_soon(wait_for_signal)
            async with stdio_server() as (incoming, outgoing):
                await server.run(incoming, outgoing, server.create_initialization_options())
            group.cancel_scope.cancel()

    anyio.run(main)
