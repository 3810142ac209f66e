"""MCP as one of the faces of a server, at `PATH`; left out where the extra `mcp` is missing."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from importlib.util import find_spec
from typing import TYPE_CHECKING

from adamo_vh.service.mcp.episodes import Episodes
from adamo_vh.service.mcp.offer import Offer

if TYPE_CHECKING:
    from fastapi import FastAPI

    from adamo_vh.service.hosting import Host


def add(app: FastAPI, host: Host) -> AbstractAsyncContextManager[None] | None:
    """Add the face to an application.

    Args:
        app: The application.
        host: Whose terms and engines hold here too.

    Returns:
        What must be open while the server runs; None if nothing was added.
    """
    if find_spec("mcp") is None:
        return None
    import anyio

    from adamo_vh.service.mcp.server import create_server
    from adamo_vh.service.mcp.transports import http_route

    episodes = Episodes(_offer(host), engines=host.engines, seats=host.seats)
    route, manager = http_route(create_server(episodes))
    app.router.routes.append(route)

    @asynccontextmanager
    async def serving() -> AsyncIterator[None]:
        try:
            async with manager.run():
                yield
        finally:
            # What is cut off here is written down, which takes a moment.
            with anyio.CancelScope(shield=True):
                await anyio.to_thread.run_sync(episodes.close)

    return serving()


def _offer(host: Host) -> Offer:
    terms = host.terms
    settings = {
        "scene": terms.scene,
        "labeling": terms.labeling,
        "figure": terms.figure,
        "profile": terms.profile,
        "resolution": terms.resolution,
        "limits": terms.limits,
    }
    return Offer(settings, host.out, most=terms.most_sessions, idle_s=terms.idle_s)
