"""A studio on a real socket, whose rooms show small pictures."""

from __future__ import annotations

import json
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from adamo_vh.service.app import MAX_BODY_BYTES, serving
from adamo_vh.service.hosting import Host, Terms
from adamo_vh.serving.admission import Rules
from adamo_vh.studio.editing import Editor
from adamo_vh.studio.face import AT, CONTENT_TYPES, Studio, studio_face
from adamo_vh.studio.library import Library
from adamo_vh.studio.meshes import Meshes
from adamo_vh.studio.offer import Offer
from adamo_vh.studio.rooms import Rooms, RoomTerms
from adamo_vh.studio.talk import Talk

TOKEN = "a-token-for-tests"


@dataclass(frozen=True)
class Served:
    """A studio and how to ask it."""

    url: str
    studio: Studio
    out: Path

    def get(self, path: str, method: str = "GET", body: Any = None, **headers: str) -> Any:
        """Status, headers and body of an answer."""
        data = None if body is None else json.dumps(body).encode()
        asked = urllib.request.Request(self.url + path, data, headers, method=method)
        if data is not None:
            asked.add_header("content-type", "application/json")
        try:
            with urllib.request.urlopen(asked, timeout=60) as answer:
                return answer.status, answer.headers, answer.read()
        except urllib.error.HTTPError as error:
            return error.code, error.headers, error.read()

    def room(self, **wishes: Any) -> str:
        """Open a room; its name."""
        status, _, body = self.get("/studio/api/rooms", "POST", wishes)
        assert status == 201, body
        name: str = json.loads(body)["room"]
        return name

    def close(self, room: str) -> None:
        assert self.get(f"/studio/api/rooms/{room}", "DELETE")[0] == 204


def made(folder: Path, terms: RoomTerms, runs: list[Path], models: list[str], talk: Talk) -> Studio:
    offer = Offer(models)
    page = folder / "page"
    (page / "assets").mkdir(parents=True)
    (page / "index.html").write_text("<!doctype html><title>Studio</title>")
    (page / "assets" / "main.js").write_text("export const x = 1;\n" * 50)
    (page / "source.txt").write_text("0")
    (folder / "secret.js").write_text("no")
    library = Library([*runs, folder / "runs"])
    editor = Editor(folder / "runs" / "scenes", offer)
    rooms = Rooms(folder / "runs", offer, terms)
    return Studio(offer, library, rooms, Meshes(), editor, talk, page)


@pytest.fixture(scope="session")
def serve(
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[Callable[..., Any]]:
    """Makes a studio that is served while a block runs."""
    from contextlib import ExitStack

    with ExitStack() as stack:

        def begin(
            *, runs: list[Path] | None = None, models: list[str] | None = None, token: str = "",
            talk: Talk | None = None, **terms: Any,
        ) -> Served:  # fmt: skip
            folder = tmp_path_factory.mktemp("studio")
            chosen = RoomTerms(**{"resolution": "160x90", **terms})
            studio = made(folder, chosen, runs or [], models or [], talk or Talk())
            host = Host(folder / "served", Terms(resolution="160x90"))
            stack.callback(host.close_all)
            stack.callback(studio.close)
            rules = Rules(MAX_BODY_BYTES, content_types=CONTENT_TYPES, token=token, browsed=AT)
            faces = (studio_face(studio),)
            url = stack.enter_context(serving(host, rules=rules, faces=faces))
            return Served(url, studio, folder / "runs")

        yield begin


@pytest.fixture(scope="session")
def served(serve: Callable[..., Served]) -> Served:
    """A studio for all tests of a worker."""
    return serve()
