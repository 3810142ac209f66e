"""`adamo-vh cache` and `adamo-vh cache clear`: what is kept because it can be made again."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from adamo_vh.cli.terminal import put_json, say
from adamo_vh.files import CACHE_DIR, cache_folder, naming

_KINDS = {
    "assets": (
        re.compile(r"[0-9a-f]{16}/[^/]+\.(npz|part|lock)"),
        "modelled objects, furniture and rooms; made again in seconds",
    ),
    "models": (
        re.compile(r"([0-9a-f]{16}\.json|\.[0-9a-f]+\.part)"),
        "what models can do; asked again when a model is next used",
    ),
}
"""Each folder: what of it is ours, by its path below, and what it is for."""


@dataclass(frozen=True, slots=True)
class Entry:
    """What one folder of the cache holds."""

    folder: str
    files: int
    megabytes: float
    what: str


def show(*, as_json: bool) -> None:
    """Say where the cache is, what it holds and what each folder is for."""
    found = [_entry(name) for name in _KINDS]
    if as_json:
        put_json({"cache": str(cache_folder()), "folders": [asdict(entry) for entry in found]})
        return
    say(f"{cache_folder()} ({CACHE_DIR} chooses another)")
    for entry in found:
        say(f"{entry.folder:<8} {entry.files:5d} files {entry.megabytes:8.1f} MB  {entry.what}")


def clear(*, as_json: bool) -> None:
    """Remove what ADAMO made there, and nothing else: the folder may be anybody's."""
    found = [_entry(name) for name in _KINDS]
    for name in _KINDS:
        for path in _files(name):
            with naming("removed", path), suppress(FileNotFoundError):
                path.unlink()
            for folder in (path.parent, cache_folder() / name):
                with suppress(OSError):  # Not empty, or gone already.
                    folder.rmdir()
    files, megabytes = sum(k.files for k in found), sum(k.megabytes for k in found)
    if as_json:
        put_json({"cache": str(cache_folder()), "files": files, "megabytes": megabytes})
    else:
        say(f"{cache_folder()}: removed {files} files, {megabytes:.1f} MB")


def _entry(name: str) -> Entry:
    sizes = []
    for path in _files(name):
        with suppress(OSError):
            sizes.append(path.stat().st_size)
    return Entry(name, len(sizes), round(sum(sizes) / 1e6, 3), _KINDS[name][1])


def _files(name: str) -> Iterator[Path]:
    """What of a folder is ours."""
    ours, top = _KINDS[name][0], cache_folder() / name
    for folder, _, files in os.walk(top):
        for file in files:
            path = Path(folder, file)
            if ours.fullmatch(path.relative_to(top).as_posix()):
                yield path
