"""The studio over HTTP and WebSocket, under ``/studio``: the page, and all that it asks."""

from __future__ import annotations

import asyncio
import gzip
import json
from collections.abc import AsyncIterator
from contextlib import AbstractAsyncContextManager, asynccontextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from fastapi import APIRouter, FastAPI, Query, Request, Response, WebSocket
from fastapi.responses import RedirectResponse

from adamo_vh.errors import AdamoError
from adamo_vh.record.run_folder import FRAMES, SCENE
from adamo_vh.record.trajectory import frame_type
from adamo_vh.service.app import Face
from adamo_vh.service.hosting import NoSessionError
from adamo_vh.serving.admission import COOKIE
from adamo_vh.session.editing import catalog
from adamo_vh.studio.editing import Draft, Editor
from adamo_vh.studio.files import PAGE, SAFE, page_file
from adamo_vh.studio.library import Library, figure_of, scene_of
from adamo_vh.studio.live import Connection
from adamo_vh.studio.meshes import Meshes, Packed
from adamo_vh.studio.offer import Offer
from adamo_vh.studio.rooms import Asked, Rooms
from adamo_vh.studio.talk import MOST_WAV_BYTES, Talk, talk_routes

if TYPE_CHECKING:
    from adamo_vh.service.hosting import Host

AT = "/studio"
"""Where the studio is found."""
CONTENT_TYPES = ("application/json", "audio/wav")
"""What visitors may send."""
_UNBUILT = "The page is not built: run npm ci && npm run build in web/."
_AGAIN_S = "1"


@dataclass(frozen=True, slots=True, eq=False)
class Studio:
    """All that a studio serves."""

    offer: Offer
    library: Library
    rooms: Rooms
    meshes: Meshes
    editor: Editor
    talk: Talk = field(default_factory=Talk)
    page: Path = PAGE
    """The built page."""

    def warm(self) -> None:
        """Make what is always needed, so that the first visitor does not wait for it."""
        with suppress(AdamoError):
            self.talk.warm()
        with suppress(AdamoError):
            self.meshes.figure(*_versioned(self.offer.figure(self.offer.figures()[0])))
            self.meshes.scene(self.offer.scenes()[0], 0)

    def close(self) -> None:
        """Close every room; every record is whole."""
        self.rooms.close_all()
        self.library.close()


def studio_face(studio: Studio) -> Face:
    """The face at which the page is served."""

    def add(app: FastAPI, _: Host) -> AbstractAsyncContextManager[None]:
        for router in (
            _page(studio),
            _choices(studio),
            _drafts(studio),
            _rooms(studio),
            _runs(studio),
            talk_routes(studio.talk, f"{AT}/api"),
        ):
            app.include_router(router)

        @asynccontextmanager
        async def open_while_serving() -> AsyncIterator[None]:
            yield
            await asyncio.to_thread(studio.close)

        return open_while_serving()

    return Face("studio", add, ((f"{AT}/api/hear", MOST_WAV_BYTES),))


def _page(studio: Studio) -> APIRouter:
    router = APIRouter(include_in_schema=False)

    @router.get("/")
    @router.get(AT)
    async def beside() -> Response:
        return RedirectResponse(f"{AT}/", 307)

    @router.get(f"{AT}/")
    async def page(request: Request) -> Response:
        token = request.query_params.get("token")
        if token is not None:
            # Out of the address, where it would stay in the browser's history.
            answer = RedirectResponse(f"{AT}/", 303, {"cache-control": "no-store"})
            answer.set_cookie(COOKIE, token, path=AT, httponly=True, samesite="strict")
            return answer
        return await _file(request, studio, "")

    @router.get(f"{AT}/assets/{{path:path}}")
    async def asset(request: Request, path: str) -> Response:
        return await _file(request, studio, f"assets/{path}")

    return router


async def _file(request: Request, studio: Studio, path: str) -> Response:
    found = await asyncio.to_thread(page_file, path, studio.page)
    if found is not None:
        return _packed(request, found[1], found[0], SAFE)
    if not path:
        return Response(_UNBUILT, 503, SAFE, "text/plain")
    raise NoSessionError("There is no such file of the page.")


def _packed(
    request: Request, packed: Packed, kind: str, headers: dict[str, str] | None = None
) -> Response:
    """A packed file; unpacked for who cannot do it, and nothing for who has it already."""
    told = {"cache-control": "no-cache", **(headers or {}), "etag": packed.etag}
    told |= {"vary": "accept-encoding", "x-content-type-options": "nosniff"}
    if packed.etag in request.headers.get("if-none-match", ""):
        return Response(None, 304, told)
    if "gzip" in request.headers.get("accept-encoding", ""):
        return Response(packed.data, 200, {**told, "content-encoding": "gzip"}, kind)
    return Response(gzip.decompress(packed.data), 200, told, kind)


def _choices(studio: Studio) -> APIRouter:
    router = APIRouter(prefix=f"{AT}/api", include_in_schema=False)

    @router.get("/offer")
    async def offer() -> dict[str, Any]:
        told = await asyncio.to_thread(studio.offer.told)
        runs = await asyncio.to_thread(studio.library.told)
        return {**told, "speech": studio.talk.told(), "runs": runs}

    @router.get("/scenes/{scene}.glb")
    async def scene(
        request: Request, scene: str, variation: Annotated[int, Query(ge=0, le=999_999)] = 0
    ) -> Response:
        file, version = _versioned(studio.offer.scene(scene))
        packed = await asyncio.to_thread(studio.meshes.scene, file, variation, version)
        return _packed(request, packed, "model/gltf-binary")

    @router.get("/scenes/{scene}")
    async def shown(scene: str) -> dict[str, Any]:
        return await asyncio.to_thread(studio.editor.show, scene)

    @router.get("/figures/{figure}.glb")
    async def figure(request: Request, figure: str) -> Response:
        who = _versioned(studio.offer.figure(figure))
        packed = await asyncio.to_thread(studio.meshes.figure, *who)
        return _packed(request, packed, "model/gltf-binary")

    return router


def _versioned(name: str) -> tuple[str, str]:
    """A name or a file, and of a file when it was changed."""
    path = Path(name)
    return name, str(path.stat().st_mtime_ns) if path.is_file() else ""


def _drafts(studio: Studio) -> APIRouter:
    router = APIRouter(prefix=f"{AT}/api", include_in_schema=False)

    @router.post("/scenes/check")
    async def check(draft: Draft) -> dict[str, Any]:
        return await asyncio.to_thread(studio.editor.check, draft)

    @router.post("/scenes", status_code=201)
    async def save(draft: Draft) -> dict[str, Any]:
        return await asyncio.to_thread(studio.editor.save, draft)

    @router.get("/catalog")
    async def everything() -> dict[str, Any]:
        return await asyncio.to_thread(catalog)

    @router.get("/assets/{asset}.glb")
    async def asset(request: Request, asset: str) -> Response:
        packed = await asyncio.to_thread(studio.meshes.asset, asset)
        return _packed(request, packed, "model/gltf-binary")

    return router


def _rooms(studio: Studio) -> APIRouter:
    router = APIRouter(prefix=f"{AT}/api/rooms", include_in_schema=False)

    @router.post("", status_code=201)
    async def begin(asked: Asked) -> dict[str, str]:
        room = await asyncio.to_thread(studio.rooms.open, asked)
        return {"room": room.name}

    @router.delete("/{room}", status_code=204)
    async def end(room: str) -> None:
        await asyncio.to_thread(studio.rooms.close, room)

    @router.get("/{room}/frames/{name}")
    async def frame(room: str, name: str) -> Response:
        return await _frame(studio.rooms.find(room).folder, name)

    @router.websocket("/{room}/live")
    async def live(
        wire: WebSocket, room: str, after: Annotated[int, Query(alias="from", ge=0)] = 0
    ) -> None:
        await wire.accept()
        try:
            found = studio.rooms.find(room)
        except NoSessionError as error:
            await wire.close(4404, str(error)[:100])
            return
        await Connection(wire, found, after).go_on()

    return router


def _runs(studio: Studio) -> APIRouter:
    router = APIRouter(prefix=f"{AT}/api/runs", include_in_schema=False)

    @router.get("/{run:path}/track")
    async def track(request: Request, run: str) -> Response:
        packed = await asyncio.to_thread(studio.library.track, run)
        if packed is None:
            making = json.dumps({"making": True}).encode()
            return Response(making, 202, {"retry-after": _AGAIN_S}, "application/json")
        if "gzip" in request.headers.get("accept-encoding", ""):
            return Response(packed, 200, {"content-encoding": "gzip"}, "application/json")
        return Response(gzip.decompress(packed), 200, None, "application/json")

    @router.get("/{run:path}/scene.glb")
    async def scene(request: Request, run: str) -> Response:
        found = await asyncio.to_thread(studio.library.find, run)
        file, variation = scene_of(found)
        version = str(found.when) if file.endswith(SCENE) else ""
        packed = await asyncio.to_thread(studio.meshes.scene, file, variation, version)
        return _packed(request, packed, "model/gltf-binary")

    @router.get("/{run:path}/figure.glb")
    async def figure(request: Request, run: str) -> Response:
        found = await asyncio.to_thread(studio.library.find, run)
        packed = await asyncio.to_thread(studio.meshes.figure, figure_of(found), str(found.when))
        return _packed(request, packed, "model/gltf-binary")

    @router.get("/{run:path}/frames/{name}")
    async def frame(run: str, name: str) -> Response:
        return await _frame((await asyncio.to_thread(studio.library.find, run)).folder, name)

    return router


async def _frame(folder: Path, name: str) -> Response:
    """A picture of a record; its name must be one, and lead nowhere else."""
    kind = frame_type(name)
    file = folder / FRAMES / name
    if not kind or not file.is_file() or file.is_symlink():
        raise NoSessionError("There is no such picture.")
    headers = {"cache-control": "private, max-age=86400", "x-content-type-options": "nosniff"}
    return Response(await asyncio.to_thread(file.read_bytes), 200, headers, kind)
