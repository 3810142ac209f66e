"""The seal of a run: a digest of everything that its result rests on, kept within the result.

Whoever changes a file of the record, a picture or the result itself changes a digest, and the check
says where. Nothing is secret in it: who has all of the files can seal them anew. Against that stand
replay, the chain of a study, and a signature.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from adamo_vh.errors import RecordError
from adamo_vh.files import naming
from adamo_vh.record.run_folder import EVENTS, FIGURE, FRAMES, MANIFEST, RESULT, SCENE, SCRIPT
from adamo_vh.record.trajectory import Observed, Shown, Trajectory

SEAL = "seal"
"""The member of the result that holds the seal."""
_FILES = (MANIFEST, EVENTS, SCENE, SCRIPT, FIGURE)
"""Those that are sealed, as far as they are there."""
_MISSING = "missing"


@dataclass(frozen=True, slots=True)
class Signature:
    """Who answers for a digest."""

    key: str
    """Ed25519 public key: 32 bytes in base 64."""
    value: str
    """The signature: 64 bytes in base 64."""


@dataclass(frozen=True, slots=True)
class Seal:
    """What a run's files were when its result was written. All digests are SHA-256 in hex."""

    files: Mapping[str, str]
    """Of each file of the record, by name."""
    frames: str
    """Of all pictures that the events name: one line with name and digest for each, in order."""
    result: str
    """Of the result but for this seal, as JSON with sorted keys and without spaces."""
    digest: str
    """Of the three above together: what is signed, and chained over a study."""
    signature: Signature | None = None


def seal_of(folder: Path, recorded: Trajectory, result: Mapping[str, Any]) -> Seal:
    """The seal of a run as it stands.

    Args:
        folder: The run folder.
        recorded: Its events.
        result: The result as plain data; a seal in it is left out.

    Raises:
        FileError: A file cannot be read.
    """
    return _sealed(folder, _frames(folder, recorded), result)


def _sealed(folder: Path, pictures: Mapping[str, str], result: Mapping[str, Any]) -> Seal:
    files = {name: _digest(folder / name) for name in _FILES if (folder / name).exists()}
    lines = "".join(f"{name} {digest}\n" for name, digest in pictures.items())
    frames = hashlib.sha256(lines.encode()).hexdigest()
    rest = _canonical({name: value for name, value in result.items() if name != SEAL})
    return Seal(files, frames, rest, _whole(files, frames, rest))


def differences(
    folder: Path, recorded: Trajectory, result: Mapping[str, Any], seal: Seal
) -> Iterator[str]:
    """What is not as it was sealed, one line each; nothing, if all is.

    Args:
        folder: The run folder.
        recorded: Its events.
        result: The result as plain data.
        seal: The seal that is on record.
    """
    pictures = _frames(folder, recorded)
    now = _sealed(folder, pictures, result)
    for name in dict.fromkeys((*seal.files, *now.files)):
        if name not in now.files:
            yield f"{name} is missing"
        elif name not in seal.files:
            yield f"{name} was added after the result was written"
        elif now.files[name] != seal.files[name]:
            yield f"{name} was changed after the result was written"
    wrong = list(_wrong_frames(pictures))
    yield from wrong
    if now.frames != seal.frames and not wrong and now.files.get(EVENTS) == seal.files.get(EVENTS):
        yield f"{FRAMES}/ holds other pictures than when the result was written"
    if now.result != seal.result:
        yield f"{RESULT} was changed after it was written"
    if _whole(seal.files, seal.frames, seal.result) != seal.digest:
        yield f"{RESULT}: the digest of the whole is not that of its parts"


def _wrong_frames(pictures: Mapping[str, str]) -> Iterator[str]:
    """Pictures whose content is not the one that they are called by."""
    for name, digest in pictures.items():
        if digest == _MISSING:
            yield f"{FRAMES}/{name} is missing"
        elif not name.startswith(digest[:24]):
            yield f"{FRAMES}/{name} is another picture than the one that was recorded"


def _frames(folder: Path, recorded: Trajectory) -> dict[str, str]:
    """The digest of each picture that the events name, in order of their names."""
    named = {event.frame for event in recorded.events if isinstance(event, Observed | Shown)}
    if odd := next((name for name in named if Path(name).name != name), None):
        raise RecordError(f"{EVENTS} names the picture {odd!r}, which is outside {FRAMES}/.")
    return {name: _digest(folder / FRAMES / name) for name in sorted(named)}


def _digest(path: Path) -> str:
    if not path.exists():
        return _MISSING
    with naming("read", path), path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _canonical(value: Any) -> str:
    text = json.dumps(value, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def _whole(files: Mapping[str, str], frames: str, result: str) -> str:
    return _canonical({"files": dict(files), "frames": frames, "result": result})
