"""The files of the page: served with their types, and nothing else is."""

from __future__ import annotations

import gzip
import hashlib
from functools import lru_cache
from pathlib import Path, PurePosixPath

from adamo_vh.studio.meshes import Packed

PAGE = Path(__file__).parent / "page"
"""The built page; `web/` holds its source."""
_KINDS = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".json": "application/json",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".jpg": "image/jpeg",
    ".ico": "image/x-icon",
    ".woff2": "font/woff2",
    ".wasm": "application/wasm",
    ".webmanifest": "application/manifest+json",
}
"""What is served, by the end of its name."""
CSP = (
    "default-src 'self'; img-src 'self' blob: data:; connect-src 'self' blob: data:; "
    "worker-src 'self' blob:; media-src 'self' blob:; "
    "object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""What the page may load: nothing from elsewhere."""
SAFE = {
    "content-security-policy": CSP,
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cache-control": "no-cache",
}
"""Headers of everything that the page is made of."""


def page_file(path: str, folder: Path = PAGE) -> tuple[str, Packed] | None:
    """A file of the page with its type; None if it is none.

    Args:
        path: Relative to the folder; empty for the page itself.
        folder: Where the built page lies.
    """
    parts = PurePosixPath(path or "index.html").parts
    if not parts or ".." in parts or "\0" in path or parts[0] == "/" or "\\" in path:
        return None
    root = folder.resolve()
    file = root.joinpath(*parts).resolve()
    kind = _KINDS.get(file.suffix)
    if kind is None or not file.is_relative_to(root) or not file.is_file():
        return None
    stat = file.stat()
    return kind, _packed(str(file), stat.st_mtime_ns, stat.st_size)


@lru_cache(maxsize=64)
def _packed(file: str, mtime: int, size: int) -> Packed:
    content = Path(file).read_bytes()
    return Packed(gzip.compress(content, 9), f'"{hashlib.sha256(content).hexdigest()[:24]}"')
