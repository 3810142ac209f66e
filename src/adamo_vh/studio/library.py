"""The recorded runs of a studio: found in folders, listed, and made into tracks once."""

from __future__ import annotations

import gzip
import json
import threading
from collections import OrderedDict
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import quote

from adamo_vh.episode.result import read_manifest
from adamo_vh.errors import ConfigError, FileError
from adamo_vh.files import read_json
from adamo_vh.readable import readable
from adamo_vh.record.run_folder import EVENTS, MANIFEST, RESULT, SCENE, read_head
from adamo_vh.service.hosting import NoSessionError
from adamo_vh.session.figures import recorded_figure
from adamo_vh.studio.messages import Href, Places
from adamo_vh.studio.tracks import Track, track_of
from adamo_vh.study.store import EPISODES, is_study

MOST_RUNS = 500
"""So many are listed, the newest ones."""
_MOST_TRACKS = 8
_MOST_BYTES = 50_000_000
_FIRST_LINE_BYTES = 200_000
Make = Callable[[Path, str, Href, Places], Track]


@dataclass(frozen=True, slots=True)
class Run:
    """One run folder, as the list shows it."""

    name: str
    folder: Path
    when: float
    """When it was last written, seconds since 1970."""


class Library:
    """The runs in some folders; may be used from any threads."""

    def __init__(self, folders: Sequence[Path], make: Make = track_of) -> None:
        """Begin.

        Args:
            folders: Run folders, studies, and folders with either in them.
            make: Makes a track of a run folder.
        """
        self._folders = tuple(folders)
        self._make = make
        self._tracks: OrderedDict[tuple[str, float], Future[bytes]] = OrderedDict()
        self._lock = threading.Lock()
        # One at a time: each has an engine of its own.
        self._maker = ThreadPoolExecutor(1, "adamo-track")

    def close(self) -> None:
        """Make no more tracks."""
        self._maker.shutdown(wait=False, cancel_futures=True)

    def add(self, folder: Path) -> None:
        """Look in another folder too."""
        if folder not in self._folders:
            self._folders = (*self._folders, folder)

    def runs(self) -> list[Run]:
        """All runs, the newest first."""
        found: dict[str, Run] = {}
        for folder in self._folders:
            for name, path in _runs_in(folder):
                number, unused = 1, name
                while unused in found and found[unused].folder != path:
                    number += 1
                    unused = f"{name}-{number}"
                found[unused] = Run(unused, path, _written(path))
        newest = sorted(found.values(), key=lambda run: (-run.when, run.name))
        return newest[:MOST_RUNS]

    def told(self) -> list[dict[str, Any]]:
        """All runs as JSON."""
        return [_told(run) for run in self.runs()]

    def find(self, name: str) -> Run:
        """A run by its name.

        Raises:
            NoSessionError: There is none.
        """
        for run in self.runs():
            if run.name == name:
                return run
        raise NoSessionError(f"There is no run {readable(name)[:80]!r} here.")

    def track(self, name: str) -> bytes | None:
        """A run as a track, packed JSON; None while it is being made.

        Raises:
            NoSessionError: There is no such run.
            RecordError: It cannot be shown.
        """
        run = self.find(name)
        key = (run.name, run.when)
        with self._lock:
            future = self._tracks.get(key)
            if future is None:
                future = self._tracks[key] = self._maker.submit(self._packed, run)
                while len(self._tracks) > _MOST_TRACKS:
                    self._tracks.popitem(last=False)[1].cancel()
        return future.result() if future.done() else None

    def _packed(self, run: Run) -> bytes:
        at = f"/studio/api/runs/{quote(run.name)}"
        track = self._make(run.folder, run.name, lambda frame: f"{at}/frames/{frame}", places(run))
        told = {"hello": track.hello, "messages": track.messages}
        return gzip.compress(json.dumps(told, separators=(",", ":")).encode(), 6)


def places(run: Run) -> Places:
    """Where the page finds the meshes of a run."""
    at = f"/studio/api/runs/{quote(run.name)}"
    return Places(f"{at}/scene.glb", f"{at}/figure.glb")


def figure_of(run: Run) -> str:
    """The figure of a run: its own file, or one that comes with the package.

    Where the file of an own one is missing or was changed, the default stands in, as on replay.

    Raises:
        RecordError: The folder holds no run.
    """
    return recorded_figure(run.folder, read_manifest(run.folder), elsewhere=False).who


def scene_of(run: Run) -> tuple[str, int]:
    """The scene of a run and its variation: its own file, or a built-in one.

    Raises:
        ConfigError: Neither is to be had.
    """
    own = run.folder / SCENE
    if own.is_file():
        return str(own), 0
    config = read_head(run.folder).get("config")
    told = config if isinstance(config, dict) else {}
    scene, variation = told.get("scene", ""), told.get("variation", 0)
    # Any other name would be read as a path.
    if not isinstance(scene, str) or Path(scene).suffix or not isinstance(variation, int):
        raise ConfigError("The scene of this run is not here: its file is missing.")
    return scene, variation


def _is_run(folder: Path) -> bool:
    return (folder / MANIFEST).is_file() and (folder / EVENTS).is_file()


def _runs_in(folder: Path) -> Iterator[tuple[str, Path]]:
    """The runs of a folder, by name."""
    name = folder.resolve().name
    if _is_run(folder):
        yield name, folder
    elif is_study(folder):
        yield from ((f"{name}/{key}", path) for key, path in _children(folder / EPISODES))
    else:
        for _, path in _children(folder, every=True):
            if _is_run(path):
                yield path.name, path
            elif is_study(path):
                yield from ((f"{path.name}/{key}", p) for key, p in _children(path / EPISODES))


def _children(folder: Path, *, every: bool = False) -> Iterator[tuple[str, Path]]:
    if not folder.is_dir():
        return
    for path in sorted(folder.iterdir()):
        # A link ("latest") would show the same run twice.
        if path.is_dir() and not path.is_symlink() and (every or _is_run(path)):
            yield path.name, path


def _written(folder: Path) -> float:
    try:
        return max((folder / EVENTS).stat().st_mtime, (folder / MANIFEST).stat().st_mtime)
    except OSError:
        return 0.0


def _told(run: Run) -> dict[str, Any]:
    head = read_head(run.folder)
    config = head.get("config") if isinstance(head.get("config"), dict) else {}
    assert isinstance(config, dict)
    said = _first_said(run.folder) or str(config.get("instruction", ""))
    return {
        "name": run.name,
        "instruction": readable(said)[:300],
        "model": readable(str(head.get("model_name", "")))[:100],
        "task": readable(str(config.get("task") or ""))[:60] or None,
        "completion": _completion(run.folder),
        "when": readable(str(head.get("started_at", "")))[:40],
    }


def _first_said(folder: Path) -> str:
    """The first instruction on record."""
    try:
        with (folder / EVENTS).open("rb") as file:
            told = json.loads(file.readline(_FIRST_LINE_BYTES))
    except (OSError, ValueError, RecursionError):
        return ""
    said = told.get("instruction") if isinstance(told, dict) else None
    return said if isinstance(said, str) else ""


def _completion(folder: Path) -> float | None:
    try:
        told = read_json(folder / RESULT, max_bytes=_MOST_BYTES)
    except FileError:
        return None
    score = told.get("score") if isinstance(told, dict) else None
    found = score.get("completion") if isinstance(score, dict) else None
    return float(found) if isinstance(found, int | float) else None
