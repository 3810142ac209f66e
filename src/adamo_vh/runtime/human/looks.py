"""The looks of the virtual human: skinned garments, read from the data shipped with the package."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.errors import ConfigError
from adamo_vh.runtime.assets.asset import Material

VARIANTS = ("mara", "jonas", "amina", "ken")
"""The people there are; the first is the default."""
OWN = (".glb", ".vrm")
"""How files of own figures end."""
HEAD_GARMENTS = frozenset({"head", "eyes", "lids", "lashes", "brows", "hair"})
"""Garments that a camera between the eyes would see from inside."""
LIDS_CLOSED_RAD = 0.72
"""Turn of the joint `eyelids` about +Y that closes the eyes; 0 is open."""


@dataclass(frozen=True, slots=True, eq=False)
class Garment:
    """A skinned triangle mesh of one material, in the rest pose, body frame."""

    name: str
    """head, hair, brows, eyes, lids, lashes, hands, top, collar, trousers or shoes; the name of the
    material says whether eyes look out of it."""
    vertices: NDArray[np.float32]
    """(N, 3) metres."""
    normals: NDArray[np.float32]
    """(N, 3) unit vectors."""
    uvs: NDArray[np.float32]
    """(N, 2) in [0, 1]; v up."""
    faces: NDArray[np.int32]
    """(M, 3) vertex indices, counter-clockwise from outside."""
    bone_ids: NDArray[np.uint8]
    """(N, 4) numbers of joints in `skeleton.JOINTS`."""
    weights: NDArray[np.float32]
    """(N, 4) shares of these joints; they sum to 1."""
    material: Material


@dataclass(frozen=True, slots=True, eq=False)
class Figure:
    """A person: all garments, the skin among them."""

    variant: str
    garments: tuple[Garment, ...]
    shapes: Mapping[str, Mapping[str, NDArray[np.float32]]] | None = None
    """Of an own figure, its face: by garment and shape, (N, 3) how far each vertex goes, metres."""
    sha256: str = ""
    """Of the file of an own figure."""

    @property
    def triangle_count(self) -> int:
        """Of all garments together."""
        return sum(len(garment.faces) for garment in self.garments)

    def __getitem__(self, name: str) -> Garment:
        """The garment of this name."""
        return next(garment for garment in self.garments if garment.name == name)


def is_own(variant: str) -> bool:
    """Whether a figure is named by its file."""
    return variant.lower().endswith(OWN)


def load_figure(variant: str = VARIANTS[0]) -> Figure:
    """Read a person from the package.

    Args:
        variant: One of `VARIANTS`, or the path of an own figure: FILE.glb or FILE.vrm.

    Raises:
        ConfigError: No person has this name.
        FileError: An own figure cannot be used.
    """
    if is_own(variant):
        from adamo_vh.runtime.human.own.reading import own_figure

        return own_figure(Path(variant)).figure
    if variant not in VARIANTS:
        raise ConfigError(
            f"There is no figure {variant!r}; choose one of {', '.join(VARIANTS)}, or name a "
            "file of your own: FILE.glb or FILE.vrm."
        )
    path = files("adamo_vh.runtime.human") / "data" / f"{variant}.npz"
    with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as file:
        facts = json.loads(str(file["facts"]))
        return Figure(
            variant, tuple(_garment(fact, file, i) for i, fact in enumerate(facts["garments"]))
        )


def _garment(fact: dict[str, Any], file: Any, i: int) -> Garment:
    from PIL import Image

    picture = Image.open(io.BytesIO(file[f"texture{i}"].tobytes()))
    material = Material(
        fact["name"],
        (1.0, 1.0, 1.0, 1.0),
        np.asarray(picture.convert("RGB")),
        specular=fact["specular"],
        shininess=fact["shininess"],
    )
    weights = file[f"weights{i}"].astype(np.float32)
    normals = file[f"normals{i}"].astype(np.float32)
    return Garment(
        fact["name"],
        file[f"vertices{i}"].astype(np.float32) / fact["grid_per_m"],
        normals / np.linalg.norm(normals, axis=1, keepdims=True),
        file[f"uvs{i}"].astype(np.float32) / 65535,
        file[f"faces{i}"].astype(np.int32),
        file[f"bone_ids{i}"],
        weights / weights.sum(axis=1, keepdims=True),
        material,
    )
