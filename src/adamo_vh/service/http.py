"""The body over HTTP, under ``/v1``: for any language, and for curl."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Callable
from typing import TYPE_CHECKING, Annotated, Any

from fastapi import APIRouter, FastAPI, Header, Path, Query, Request, Response
from fastapi.responses import StreamingResponse

from adamo_vh.action_server.wire import (
    Act,
    Answer,
    Create,
    DescribeState,
    Done,
    Finish,
    Load,
    Noted,
    Observe,
    Say,
    Seen,
    Step,
    Think,
    Welcome,
    to_json,
)
from adamo_vh.engine import WorldState
from adamo_vh.episode.result import EpisodeResult, read_result
from adamo_vh.errors import RecordError
from adamo_vh.record.trajectory import frame_type
from adamo_vh.service.about import About, Playing, Scored
from adamo_vh.service.hosting import Host, NoSessionError
from adamo_vh.service.problems import JudgeOnlyError
from adamo_vh.service.watching import Happenings
from adamo_vh.serving.admission import Role
from adamo_vh.serving.edge import role_of

if TYPE_CHECKING:
    from contextlib import AbstractAsyncContextManager

_LONGEST_WAIT_S = 30.0
_PICTURE: dict[int | str, dict[str, Any]] = {200: {"content": {"image/jpeg": {}, "image/png": {}}}}
_TEXT: dict[int | str, dict[str, Any]] = {
    200: {"content": {"text/plain": {"schema": {"type": "string"}}}}
}
_STREAM: dict[int | str, dict[str, Any]] = {200: {"content": {"text/event-stream": {}}}}

SessionId = Annotated[str, Path(max_length=100, description="Of the session.")]
Picture = Annotated[str, Path(max_length=100, description="Name of the picture.")]


def add(app: FastAPI, host: Host) -> AbstractAsyncContextManager[None] | None:
    """Add the face to an application."""
    app.include_router(_sessions(host))
    app.include_router(_steps(host))
    app.include_router(_watchers(host))
    app.include_router(_judge(host))
    return None


def _json(answer: Any, status: int = 200) -> Response:
    return Response(to_json(answer), status, media_type="application/json")


def _sessions(host: Host) -> APIRouter:
    router = APIRouter(prefix="/v1", tags=["sessions"])

    @router.get("", response_model=About)
    async def about() -> Response:
        """What the server offers."""
        return _json(About.of(host))

    @router.post("/sessions", status_code=201, response_model=Welcome)
    async def create(asked: Create) -> Response:
        """Begin an episode; the answer holds its instruction, its tools and the first view."""
        sent = await asyncio.to_thread(lambda: host.create(asked).welcome())
        return _json(sent.answer, 201)

    @router.get("/sessions/{session}", response_model=Welcome)
    async def session(session: SessionId) -> Response:
        """A session as it stands, for who comes back to it."""
        sent = await asyncio.to_thread(lambda: host.find(session).welcome())
        return _json(sent.answer)

    @router.delete("/sessions/{session}", status_code=204)
    async def close(session: SessionId) -> Response:
        """Close a session; its record stays on the server."""
        await asyncio.to_thread(host.close, session)
        return Response(status_code=204)

    return router


def _steps(host: Host) -> APIRouter:
    router = APIRouter(prefix="/v1/sessions/{session}", tags=["playing"])

    async def done(session: str, step: Step) -> Answer:
        return (await asyncio.to_thread(lambda: host.find(session).perform(step))).answer

    @router.get("/view", response_model=Seen)
    async def observe(session: SessionId) -> Response:
        """The view from where the body stands; its picture by the link in it."""
        return _json(await done(session, Observe()))

    @router.get("/state-text", response_class=Response, responses=_TEXT)
    async def describe(session: SessionId) -> Response:
        """The symbolic state in words, as a model reads it."""
        described: Any = await done(session, DescribeState())
        return Response(described.text, media_type="text/plain; charset=utf-8")

    @router.get("/frames/{name}", response_class=Response, responses=_PICTURE)
    async def frame(session: SessionId, name: Picture) -> Response:
        """A picture of this session."""
        data = await asyncio.to_thread(lambda: host.find(session).frame(name))
        if data is None:
            raise NoSessionError("There is no such picture in this session.")
        # Its name is the hash of its content.
        kept = {"cache-control": "private, max-age=31536000, immutable"}
        return Response(data, media_type=frame_type(name), headers=kept)

    @router.post("/act", response_model=Done)
    async def act(session: SessionId, step: Act) -> Response:
        """Carry out a tool call; one that is no valid action is refused with a sentence."""
        return _json(await done(session, step))

    @router.post("/think", response_model=Noted)
    async def think(session: SessionId, step: Think) -> Response:
        """Put on record what was thought."""
        return _json(await done(session, step))

    @router.post("/say", response_model=Noted)
    async def say(session: SessionId, step: Say) -> Response:
        """Say something through the body; the episode goes on."""
        return _json(await done(session, step))

    @router.post("/finish", response_model=Noted)
    async def finish(session: SessionId, step: Finish) -> Response:
        """End the episode with an answer."""
        return _json(await done(session, step))

    @router.post("/load", response_model=Noted)
    async def load(session: SessionId, step: Load) -> Response:
        """Go back to a saved state; in a scored episode, only to where it stands."""
        return _json(await done(session, step))

    return router


def _watchers(host: Host) -> APIRouter:
    router = APIRouter(prefix="/v1/sessions/{session}", tags=["watching"])

    @router.get("/happenings", response_model=Happenings)
    async def happenings(
        session: SessionId,
        after: Annotated[int, Query(ge=0, description="The last one that is known.")] = 0,
        wait_s: Annotated[
            float, Query(ge=0, le=_LONGEST_WAIT_S, description="To wait for the next, seconds.")
        ] = 0.0,
    ) -> Response:
        """What happened in a session; waits for the next, if there is none yet."""
        return _json(await host.find(session).watch.wait(after, wait_s))

    @router.get("/stream", response_class=StreamingResponse, responses=_STREAM)
    async def stream(
        request: Request,
        session: SessionId,
        last_event_id: Annotated[int, Header(ge=0, description="The last one known.")] = 0,
    ) -> Response:
        """What happens in a session, as server-sent events."""
        watch = host.find(session).watch

        async def events() -> AsyncIterator[str]:
            known, over = last_event_id, False
            while not (over or await request.is_disconnected()):
                found = await watch.wait(known, 15.0)
                for one in found.happenings:
                    yield f"id: {one.number}\nevent: {one.kind}\ndata: {to_json(one)}\n\n"
                if not found.happenings:
                    yield ": still there\n\n"
                known, over = found.next, found.ended

        quiet = {"cache-control": "no-store"}
        return StreamingResponse(events(), media_type="text/event-stream", headers=quiet)

    return router


def _judge(host: Host) -> APIRouter:
    router = APIRouter(prefix="/v1/sessions", tags=["judging"])

    async def for_judge(request: Request, ask: Callable[[], Any]) -> Response:
        if role_of(request.scope) is not Role.JUDGE:
            raise JudgeOnlyError
        return _json(await asyncio.to_thread(ask))

    def result_of(session: str) -> EpisodeResult:
        folder = host.folder_of(session)
        result = read_result(folder)
        if result is None:
            raise RecordError("The episode has not ended; its result comes then.")
        return result

    @router.get("", response_model=tuple[Playing, ...])
    async def sessions(request: Request) -> Response:
        """All sessions. For a judge."""
        if role_of(request.scope) is not Role.JUDGE:
            raise JudgeOnlyError
        listed = [json.loads(to_json(Playing.of(one))) for one in host.sessions()]
        return Response(json.dumps(listed), media_type="application/json")

    @router.get("/{session}/result", response_model=EpisodeResult)
    async def result(request: Request, session: SessionId) -> Response:
        """What came of an episode, its score above all. For a judge."""
        return await for_judge(request, lambda: result_of(session))

    @router.get("/{session}/state", response_model=WorldState)
    async def state(request: Request, session: SessionId) -> Response:
        """The whole truth about the world now. For a judge."""
        return await for_judge(request, lambda: host.find(session).state())

    @router.get("/{session}/score", response_model=Scored)
    async def score(request: Request, session: SessionId) -> Response:
        """How much of the task is done now. For a judge."""
        return await for_judge(request, lambda: Scored(host.find(session).completion()))

    return router
