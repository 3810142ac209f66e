"""One port with all faces, behind one edge."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable, Iterator, Sequence
from contextlib import (
    AbstractAsyncContextManager,
    AsyncExitStack,
    asynccontextmanager,
    contextmanager,
)
from dataclasses import dataclass, replace
from importlib.metadata import version
from typing import Any

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.routing import Match

from adamo_vh.action_server.wire import Failed, Problem, to_json
from adamo_vh.errors import AdamoError
from adamo_vh.readable import readable
from adamo_vh.service import http, websocket
from adamo_vh.service.hosting import Host
from adamo_vh.service.mcp import face as mcp
from adamo_vh.service.openenv import face as openenv
from adamo_vh.service.problems import told
from adamo_vh.serving.admission import Rules
from adamo_vh.serving.edge import Edge
from adamo_vh.serving.loopback import listen
from adamo_vh.serving.running import running

MAX_BODY_BYTES = 1_000_000
Add = Callable[[FastAPI, Host], AbstractAsyncContextManager[None] | None]
"""Adds a face to an application; what it gives back is open while the server runs."""


@dataclass(frozen=True, slots=True)
class Face:
    """One way in which a program from outside takes part."""

    name: str
    add: Add
    max_bytes: tuple[tuple[str, int], ...] = ()
    """Paths whose bodies and messages may be larger than others', and how large."""


FACES: Sequence[Face] = (
    Face("http", http.add),
    Face("websocket", websocket.add),
    Face("mcp", mcp.add),
    Face("openenv", openenv.add),
)
"""All faces of a server."""


def create_app(host: Host, rules: Rules | None = None, faces: Sequence[Face] = FACES) -> Edge:
    """Make the web application of a server, behind its edge.

    Args:
        host: The sessions.
        rules: Who may come in; whoever is on this machine, by default.
        faces: What is served.
    """
    rules = rules or Rules(MAX_BODY_BYTES)
    roomy = dict(size for face in faces for size in face.max_bytes)
    return Edge(create_api(host, faces), replace(rules, roomy={**rules.roomy, **roomy}))


def create_api(host: Host, faces: Sequence[Face] = FACES) -> FastAPI:
    """Make the application itself, which nothing guards.

    Args:
        host: The sessions.
        faces: What is served.
    """
    opened: list[AbstractAsyncContextManager[None]] = []

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        async with AsyncExitStack() as stack:
            for face in opened:
                await stack.enter_async_context(face)
            yield

    app = FastAPI(
        title="ADAMO",
        summary="A body in a 3D room, for minds from outside.",
        version=version("adamo-vh"),
        docs_url=None,  # Its pages load scripts from elsewhere.
        redoc_url=None,
        lifespan=lifespan,
        responses={"4XX": {"model": Failed}, "5XX": {"model": Failed}},
    )
    _tell_faults(app)
    for face in faces:
        if (open_while_serving := face.add(app, host)) is not None:
            opened.append(open_while_serving)
    return app


def _tell_faults(app: FastAPI) -> None:
    """Answer every fault with the same JSON."""

    def answer(status: int, failed: Failed, headers: dict[str, str] | None = None) -> Response:
        if status == 503:
            headers = {"retry-after": "5"}
        return Response(to_json(failed), status, headers, "application/json")

    @app.exception_handler(HTTPException)
    async def missing(request: Request, error: HTTPException) -> Response:
        text = f"{readable(str(error.detail))}: {request.method} {readable(request.url.path)[:200]}"
        kind = "not_found" if error.status_code == 404 else "invalid_request_error"
        headers = dict(error.headers or {})
        if error.status_code == 405:
            # Starlette tells the methods of the first route of the path alone.
            headers["allow"] = ", ".join(sorted(_methods_at(app, request)))
        return answer(
            error.status_code, Failed(Problem(f"{text}. See GET /openapi.json.", kind)), headers
        )

    @app.exception_handler(RequestValidationError)
    async def wrong(_: Request, error: RequestValidationError) -> Response:
        first: Any = error.errors()[0]
        where = readable(".".join(str(part) for part in first["loc"]))[:100]
        text = f"The request is wrong: {where}: {readable(str(first['msg']))[:200]}."
        return answer(422, Failed(Problem(text, param=where)))

    @app.exception_handler(AdamoError)
    async def ours(_: Request, error: AdamoError) -> Response:
        return answer(*told(error))

    @app.exception_handler(Exception)
    async def unforeseen(_: Request, error: Exception) -> Response:
        return answer(*told(error))


def _methods_at(app: FastAPI, request: Request) -> set[str]:
    """The methods of all routes of a path."""
    found: set[str] = set()
    for method in ("GET", "POST", "PUT", "PATCH", "DELETE"):
        scope = {**request.scope, "method": method, "path_params": {}}
        if any(route.matches(scope)[0] is Match.FULL for route in app.routes):
            found.add(method)
    return found


@contextmanager
def serving(
    host: Host,
    *,
    address: str = "127.0.0.1",
    port: int = 0,
    rules: Rules | None = None,
    faces: Sequence[Face] = FACES,
) -> Iterator[str]:
    """Serve while the block runs; the sessions are the caller's to close.

    Args:
        host: The sessions.
        address: Where to listen: a loopback address, or any with a token.
        port: The port; 0 for a free one.
        rules: Who may come in.
        faces: What is served.

    Yields:
        The address, as a URL.

    Raises:
        ConfigError: The address may not be served without a token, or the port is taken.
    """
    edge = create_app(host, rules, faces)
    most = max(edge.rules.max_message_bytes, *edge.rules.roomy.values(), 0)
    with (
        listen(address, port, locked=bool(edge.rules.token)) as opened,
        running(edge, opened, "adamo-vh-serve", max_message_bytes=most, has_lifespan=True),
    ):
        shown = f"[{address}]" if ":" in address else address
        yield f"http://{shown}:{opened.getsockname()[1]}"
