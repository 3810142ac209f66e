"""A folder with a page that is an engine, offered at the port where engines dial in.

A page may only open a WebSocket to where it came from, so it has to come from there.
"""

from __future__ import annotations

import asyncio
from pathlib import Path, PurePosixPath
from typing import Any

from adamo_vh.errors import ConfigError
from adamo_vh.serving.admission import Refusal
from adamo_vh.serving.edge import Send, refusal_body

PAGE = "ADAMO_VH_ENGINE_PAGE"
"""Environment variable with the folder."""
_KINDS = {
    ".html": b"text/html; charset=utf-8",
    ".js": b"text/javascript; charset=utf-8",
    ".json": b"application/json",
    ".wasm": b"application/wasm",
    ".glb": b"model/gltf-binary",
}
"""What is offered, by the end of its name; nothing else is."""


def page_folder(told: str) -> Path | None:
    """The folder of a page, or None for an empty name.

    Raises:
        ConfigError: There is no page in it.
    """
    if not told:
        return None
    folder = Path(told)
    if not (folder / "index.html").is_file():
        raise ConfigError(f"{PAGE}: {told} has no index.html; build the page (engines/web).")
    return folder.resolve()


async def offer(scope: Any, send: Send, folder: Path | None) -> None:
    """Answer a request with a file of the page, or say that there is none."""
    file = _file(scope["path"], folder) if scope["method"] in ("GET", "HEAD") else None
    if file is None:
        refusal = Refusal(404, "Nothing is here but the WebSocket /engine, for engines.")
        await _send(send, 404, b"application/json", refusal_body(refusal))
        return
    content = await asyncio.to_thread(file.read_bytes)
    await _send(send, 200, _KINDS[file.suffix], b"" if scope["method"] == "HEAD" else content)


def _file(path: str, folder: Path | None) -> Path | None:
    parts = PurePosixPath(path.lstrip("/") or "index.html").parts
    if folder is None or ".." in parts or "\0" in path:
        return None
    file = folder.joinpath(*parts).resolve()
    inside = file.is_relative_to(folder)
    return file if inside and file.suffix in _KINDS and file.is_file() else None


async def _send(send: Send, status: int, kind: bytes, content: bytes) -> None:
    headers = [
        (b"content-type", kind),
        (b"content-length", str(len(content)).encode()),
        (b"x-content-type-options", b"nosniff"),
        (b"cache-control", b"no-cache"),
    ]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": content})
