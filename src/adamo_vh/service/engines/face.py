"""Engines at a server: they dial in at `/engine`, and its sessions are played in them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from adamo_vh.engine import World
from adamo_vh.errors import ConfigError, EngineError
from adamo_vh.service.app import Face
from adamo_vh.service.engines.door import MOST_ENGINES, PATH, EngineDoor
from adamo_vh.service.engines.reading import MAX_BINARY
from adamo_vh.service.engines.remote import RemoteWorld
from adamo_vh.session.pooling import BusyError, Engines

if TYPE_CHECKING:
    from fastapi import FastAPI

    from adamo_vh.service.hosting import Host


def engine_face(door: EngineDoor) -> Face:
    """The face at which engines dial in."""

    def add(app: FastAPI, _: Host) -> None:
        from starlette.routing import Route, WebSocketRoute

        app.router.routes.append(WebSocketRoute(PATH, door, name="engine"))
        if door.page is not None:
            app.router.routes.append(Route("/{path:path}", door, include_in_schema=False))

    return Face("engines", add, ((PATH, MAX_BINARY),))


def dialled_engines(door: EngineDoor) -> Engines:
    """Engines for sessions: each place gets one that waits at the door."""

    def made(scene: str, figure: str, variation: int) -> World:
        if variation:
            raise ConfigError(
                f"variation is {variation}: engines that dial in have their scenes as they stand; "
                "use 0."
            )
        try:
            line = door.take()
        except EngineError as error:
            raise BusyError(str(error)) from None
        try:
            world = RemoteWorld(line, scene, figure)
            world.reset(0)
        except EngineError:
            line.released()
            raise
        return world

    return Engines(MOST_ENGINES, MOST_ENGINES, make=made)
