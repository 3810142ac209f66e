"""Keep built assets on disk, so that only the first run pays for the modelling.

A set's key covers the sources of the assets and the libraries they are made with: a change of
either builds anew, and removes the sets that no running process uses.
"""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import io
import json
import os
import re
import shutil
import zipfile
import zlib
from collections.abc import Callable
from dataclasses import asdict
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from adamo_vh.errors import FileError
from adamo_vh.files import cache_folder, write_whole
from adamo_vh.runtime.assets import catalog
from adamo_vh.runtime.assets.asset import Asset, Collider, Looks, Material, Part, Surface

_LIBRARIES = ("manifold3d", "numpy", "pillow", "scipy", "trimesh")
_MESH_ARRAYS = ("vertices", "normals", "uvs", "faces")
_SET = re.compile(r"[0-9a-f]{16}")
_LOCK = "in-use.lock"
_DAMAGE = (
    OSError,
    EOFError,
    ValueError,
    KeyError,
    TypeError,
    # From zipfile: a flipped bit may ask for a compression or an encryption it does not know.
    RuntimeError,
    zipfile.BadZipFile,
    zlib.error,
)
"""What reading a missing, damaged or foreign file may raise."""


def load_asset(name: str) -> Asset:
    """Return an asset from the cache, or build and cache it.

    A missing, damaged or unwritable cache only costs time.

    Args:
        name: A key of `catalog.OBJECTS` or `catalog.FURNITURE`.

    Raises:
        KeyError: If no asset has this name.
    """
    return load_built(name, lambda: catalog.build(name))


def load_built(name: str, build: Callable[[], Asset]) -> Asset:
    """Return what a builder made before, or build and cache it.

    Args:
        name: Names the asset and everything that the builder depends on; a file name.
        build: Makes it.
    """
    path = cache_file(name)
    _hold(path.parent)
    with contextlib.suppress(*_DAMAGE):
        return _read(path)
    asset = build()
    with contextlib.suppress(FileError):
        _write(asset, path)
        _remove_old_sets(path.parent)
    return asset


def cached(name: str, make: Callable[[], bytes]) -> bytes:
    """Return a file that was made of the assets before, or make and keep it.

    Args:
        name: Names the file and everything but the assets that it depends on.
        make: Makes it.
    """
    path = cache_file("").with_name(name)
    _hold(path.parent)
    with contextlib.suppress(OSError):
        return path.read_bytes()
    content = make()
    with contextlib.suppress(FileError):
        write_whole(path, content)
        _remove_old_sets(path.parent)
    return content


def cache_file(name: str) -> Path:
    """Where the baked asset lies, or will lie."""
    return cache_folder() / "assets" / _key() / f"{name}.npz"


@cache
def _key() -> str:
    """Hash of everything a baked asset depends on."""
    digest = hashlib.sha256()
    sources = Path(__file__).parent
    for path in sorted(sources.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            digest.update(path.relative_to(sources).as_posix().encode())
            digest.update(path.read_bytes())
    for library in _LIBRARIES:
        digest.update(f"{library} {version(library)}".encode())
    return digest.hexdigest()[:16]


@cache
def _hold(folder: Path) -> int | None:
    """Show other processes that a set is in use: the file stays open until this one ends."""
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        held = os.open(folder / _LOCK, os.O_CREAT | os.O_RDWR, 0o666)
        fcntl.flock(held, fcntl.LOCK_SH | fcntl.LOCK_NB)
        return held
    return None


@cache
def _remove_old_sets(current: Path) -> None:
    """Remove what earlier versions baked, unless a process that runs now still uses it."""
    for folder in current.parent.iterdir():
        if folder == current or not _SET.fullmatch(folder.name) or folder.is_symlink():
            continue
        with contextlib.suppress(OSError), (folder / _LOCK).open("ab") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            shutil.rmtree(folder)


def _write(asset: Asset, path: Path) -> None:
    arrays: dict[str, Any] = {}
    materials = []
    for i, part in enumerate(asset.parts):
        arrays |= {f"{key}{i}": getattr(part, key) for key in _MESH_ARRAYS}
        material = {f: getattr(part.material, f) for f in Material.__dataclass_fields__}
        texture = material.pop("texture")
        if texture is not None:
            arrays[f"texture{i}"] = texture
        materials.append(material)
    facts = {
        "class_name": asset.class_name,
        "size": asset.size,
        "mass_kg": asset.mass_kg,
        "materials": materials,
        "colliders": [asdict(collider) for collider in asset.colliders],
        "surfaces": [asdict(surface) for surface in asset.surfaces],
        "looks": asdict(asset.looks),
    }
    packed = io.BytesIO()
    np.savez(packed, facts=np.array(json.dumps(facts)), **arrays)
    write_whole(path, packed.getvalue())


def _read(path: Path) -> Asset:
    with path.open("rb") as raw, np.load(raw, allow_pickle=False) as file:
        facts = json.loads(str(file["facts"]))
        parts = []
        for i, material in enumerate(facts["materials"]):
            texture = file.get(f"texture{i}")
            arrays = {key: file[f"{key}{i}"] for key in _MESH_ARRAYS}
            parts.append(Part(**arrays, material=Material(**_frozen(material), texture=texture)))
    return Asset(
        class_name=facts["class_name"],
        size=_frozen(facts["size"]),
        parts=tuple(parts),
        colliders=tuple(Collider(**_frozen(c)) for c in facts["colliders"]),
        mass_kg=facts["mass_kg"],
        looks=Looks(**_frozen(facts["looks"])),
        surfaces=tuple(Surface(**_frozen(s)) for s in facts["surfaces"]),
    )


def _frozen(value: Any) -> Any:
    """JSON's lists back to the tuples they were."""
    if isinstance(value, list):
        return tuple(_frozen(item) for item in value)
    if isinstance(value, dict):
        return {key: _frozen(item) for key, item in value.items()}
    return value
