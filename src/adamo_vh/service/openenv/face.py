"""OpenEnv's routes: at `/openenv` beside the other faces, or at the root of a server of its own."""

from __future__ import annotations

import asyncio
import json
from contextlib import AbstractAsyncContextManager
from importlib.metadata import version
from typing import Annotated, Any

from fastapi import Body, FastAPI, Response, WebSocket
from fastapi.exceptions import RequestValidationError
from starlette.websockets import WebSocketDisconnect

from adamo_vh.errors import AdamoError, ConfigError
from adamo_vh.readable import readable
from adamo_vh.service.hosting import Host
from adamo_vh.service.openenv import catalog, json_rpc
from adamo_vh.service.openenv.messages import (
    Action,
    Fault,
    Reset,
    StepRequest,
    TaskAt,
    TasksFrom,
    TasksOf,
    plain,
    read,
    schemas,
)
from adamo_vh.service.openenv.rooms import Payload, Room, Rooms
from adamo_vh.service.problems import told

PREFIX = "/openenv"
_DESCRIPTION = (
    "A body in a 3D room: look, walk, pick and drop by tool calls, with annotated first-person "
    "views. The reward of a step is the completion of the task that it gained."
)


def add(app: FastAPI, host: Host) -> AbstractAsyncContextManager[None] | None:
    """Add the face to an application, at `/openenv`."""
    own = FastAPI(
        title="ADAMO as an OpenEnv environment",
        version="1.0.0",
        docs_url=None,
        redoc_url=None,
        responses={"4XX": {"model": Fault}, 422: {"model": Fault}, "5XX": {"model": Fault}},
    )
    _tell_faults(own)
    add_at_root(own, host)
    app.mount(PREFIX, own)

    @app.get(PREFIX, include_in_schema=False)
    def about() -> dict[str, str]:
        return {"name": catalog.NAME, "see": f"{PREFIX}/openapi.json"}

    return None


def add_at_root(app: FastAPI, host: Host) -> AbstractAsyncContextManager[None] | None:
    """Add the face to an application that has no other one, where its clients look for it."""
    rooms = Rooms(host)
    _add_about(app)
    _add_tasks(app)
    _add_episodes(app, rooms)

    @app.websocket("/ws")
    async def session(wire: WebSocket) -> None:
        await wire.accept()
        room = rooms.alone()
        try:
            await _Conversation(wire, room, rooms).go_on()
        except WebSocketDisconnect:
            pass
        finally:
            await asyncio.to_thread(room.close)

    return None


def _add_about(app: FastAPI) -> None:
    @app.get("/health")
    def health() -> dict[str, str]:
        return {"status": "healthy"}

    @app.get("/metadata")
    def metadata() -> dict[str, Any]:
        return {
            "name": catalog.NAME,
            "description": _DESCRIPTION,
            "version": version("adamo-vh"),
            "author": None,
            "documentation_url": None,
            "readme_content": None,
        }

    @app.get("/schema")
    def schema() -> dict[str, Any]:
        return schemas()


def _add_tasks(app: FastAPI) -> None:
    @app.get("/list_environments")
    def environments() -> list[str]:
        return [catalog.NAME]

    @app.get(f"/{catalog.NAME}/splits")
    def splits() -> list[dict[str, str]]:
        return catalog.splits()

    @app.post(f"/{catalog.NAME}/tasks")
    def tasks(asked: TasksOf) -> dict[str, Any]:
        return {"tasks": catalog.tasks_of(asked.split), "env_name": catalog.NAME}

    @app.post(f"/{catalog.NAME}/num_tasks")
    def num_tasks(asked: TasksOf) -> dict[str, int]:
        return {"num_tasks": len(catalog.tasks_of(asked.split))}

    @app.post(f"/{catalog.NAME}/task")
    def task(asked: TaskAt) -> dict[str, Any]:
        catalog.chosen(asked.split, asked.index)
        return {"task": catalog.tasks_of(asked.split)[asked.index]}

    @app.post(f"/{catalog.NAME}/task_range")
    def task_range(asked: TasksFrom) -> dict[str, Any]:
        return {"tasks": catalog.tasks_of(asked.split)[asked.start : asked.stop]}


def _add_episodes(app: FastAPI, rooms: Rooms) -> None:
    @app.post("/reset")
    def reset(asked: Annotated[Reset | None, Body()] = None) -> Payload:
        room = rooms.make()
        try:
            return room.reset(asked or Reset())
        except Exception:
            rooms.close(room.name)
            raise

    @app.post("/step")
    def step(asked: StepRequest) -> Payload:
        return rooms.find(asked.session_id).step(read(Action, asked.action))

    @app.get("/state")
    def state(session_id: str | None = None) -> dict[str, Any]:
        room = rooms.nobody if session_id is None else rooms.find(session_id)
        found: dict[str, Any] = plain(room.state())
        return found

    @app.post("/mcp")
    def mcp(asked: Annotated[Any, Body()] = None) -> dict[str, Any]:
        return json_rpc.answer(rooms, asked)


class _Conversation:
    """One connection of a client, which is its session."""

    def __init__(self, wire: WebSocket, room: Room, rooms: Rooms) -> None:
        self._wire = wire
        self._room = room
        self._rooms = rooms

    async def go_on(self) -> None:
        """Answer until the client leaves."""
        while True:
            message = await self._wire.receive()
            if message["type"] == "websocket.disconnect":
                return
            try:
                asked = json.loads(message.get("text") or "")
            except (ValueError, RecursionError):
                await self._say(_error("A message is one JSON object.", "INVALID_JSON"))
                continue
            kind = asked.get("type") if isinstance(asked, dict) else None
            if kind == "close":
                await self._wire.close()
                return
            await self._say(await asyncio.to_thread(self._answer, kind, asked))

    def _answer(self, kind: object, asked: Any) -> dict[str, Any]:
        try:
            data = asked.get("data", {}) if isinstance(asked, dict) else {}
            match kind:
                case "reset":
                    return {"type": "observation", "data": self._room.reset(read(Reset, data))}
                case "step":
                    return {"type": "observation", "data": self._room.step(read(Action, data))}
                case "state":
                    return {"type": "state", "data": plain(self._room.state())}
                case "mcp":
                    told_back = json_rpc.answer(self._rooms, data, self._room)
                    return {"type": "mcp", "data": told_back}
                case _:
                    return _error("Types: reset, step, state, mcp, close.", "UNKNOWN_TYPE")
        except ConfigError as error:
            return _error(str(error), "VALIDATION_ERROR")
        except Exception as error:
            status, failed = told(error)
            code = "CAPACITY_REACHED" if status == 503 else "EXECUTION_ERROR"
            return _error(failed.error.message, code)

    async def _say(self, message: dict[str, Any]) -> None:
        await self._wire.send_text(json.dumps(message))


def _error(text: str, code: str) -> dict[str, Any]:
    return {"type": "error", "data": {"message": text, "code": code}}


def _tell_faults(app: FastAPI) -> None:
    """Say what is wrong, in OpenEnv's way: as `detail`."""

    def answer(status: int, text: str) -> Response:
        return Response(json.dumps({"detail": text}), status, media_type="application/json")

    @app.exception_handler(RequestValidationError)
    async def wrong(_: Any, error: RequestValidationError) -> Response:
        first: Any = error.errors()[0]
        where = readable(".".join(str(part) for part in first["loc"][1:]))[:100]
        return answer(422, f"{where or 'body'}: {readable(str(first['msg']))[:200]}.")

    @app.exception_handler(AdamoError)
    async def ours(_: Any, error: AdamoError) -> Response:
        status, failed = told(error)
        return answer(422 if isinstance(error, ConfigError) else status, failed.error.message)

    @app.exception_handler(Exception)
    async def unforeseen(_: Any, error: Exception) -> Response:
        status, failed = told(error)
        return answer(status, failed.error.message)
