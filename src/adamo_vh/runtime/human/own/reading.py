"""Read an own figure: a GLB or VRM of a rigged humanoid."""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from adamo_vh.errors import FileError
from adamo_vh.files import naming
from adamo_vh.geometry import Array
from adamo_vh.readable import readable
from adamo_vh.runtime.human.looks import Figure
from adamo_vh.runtime.human.own.bones import Bones, bones_of
from adamo_vh.runtime.human.own.conformance import Conformance
from adamo_vh.runtime.human.own.container import MOST_BYTES, Container, opened
from adamo_vh.runtime.human.own.expressions import meaning_of_missing, shapes_of
from adamo_vh.runtime.human.own.faults import AGAIN, Broken
from adamo_vh.runtime.human.own.fields import Document
from adamo_vh.runtime.human.own.fitting import Fit, fit_of
from adamo_vh.runtime.human.own.licence import licence_of
from adamo_vh.runtime.human.own.making import BY_BONE, Making, garments_of
from adamo_vh.runtime.human.own.numbers import Numbers
from adamo_vh.runtime.human.own.skins import Piece, pieces_of
from adamo_vh.runtime.human.own.stature import Stature, stature_of
from adamo_vh.runtime.human.own.surfaces import Surfaces
from adamo_vh.runtime.human.own.tree import Tree, tree_of

_OURS = "ADAMO"
"""The generator of our own files, whose materials are two-sided for others alone."""
_FARTHEST_M = 3.5
"""From where it stands to the farthest point of wings, a train or a staff."""
_DAMAGE = (
    ValueError, TypeError, KeyError, IndexError, ArithmeticError, AttributeError, struct.error,
    RecursionError, MemoryError, np.linalg.LinAlgError, ValidationError,
)  # fmt: skip
"""What reading a damaged file may raise that nobody foresaw."""


@dataclass(frozen=True, slots=True, eq=False)
class Own:
    """A figure that was read, and what was found."""

    figure: Figure
    report: Conformance


def content_of(path: Path) -> bytes:
    """The bytes of a figure's file.

    Raises:
        FileError: It cannot be read, or is too large.
    """
    with naming("read", path), path.open("rb") as file:
        content = file.read(MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise FileError(
            f"{_shown(path)}: it has more than {MOST_BYTES // 1_000_000} MB. Export it with "
            "smaller textures."
        )
    return content


def own_figure(path: Path) -> Own:
    """Read an own figure from a file; it is kept for the next time while it stays the same.

    Raises:
        FileError: It cannot be read, or is no humanoid that can be used; names the fix.
    """
    return own_figure_of(content_of(path), path.name)


def own_figure_of(content: bytes, name: str) -> Own:
    """Read an own figure; see `own_figure`.

    Args:
        content: The file.
        name: What it is called.
    """
    key = hashlib.sha256(content).hexdigest(), name
    if (known := _kept.get(key)) is not None:
        return known
    try:
        with np.errstate(all="ignore"):
            made = _read(content, name)
    except Broken as fault:
        raise FileError(f"{_shown(name)}: {fault}") from None
    except _DAMAGE as error:
        raise FileError(f"{_shown(name)} is damaged ({type(error).__name__}). {AGAIN}") from error
    while len(_kept) >= _MOST_KEPT:
        _kept.pop(next(iter(_kept)), None)
    _kept[key] = made
    return made


_MOST_KEPT = 3
_kept: dict[tuple[str, str], Own] = {}
"""Figures by digest and name; to read one takes a second."""


def _shown(name: str | Path) -> str:
    return readable(str(name))[:120]


def _read(content: bytes, name: str) -> Own:
    container: Container = opened(content)
    document = container.document
    numbers, tree = Numbers(container), tree_of(document)
    bones = bones_of(document, tree)
    notes: list[str] = []
    pieces = _held(pieces_of(document, tree, numbers, notes), bones, tree, notes)
    stature, nodes = _stature(bones, tree, pieces, notes)
    owners = owners_of(nodes, tree, pieces)
    crown = max((_crown(piece, owners, stature) for piece in pieces), default=0.0)
    fit = fit_of(stature, crown, bones.spine)
    surfaces = Surfaces(document, numbers, notes)
    shapes = shapes_of(document)
    turning = {
        bone: (fit.maps[bone] @ [*stature.places[bone], 1.0])[:3]
        for bone, stand_for in BY_BONE.items()
        if bone in nodes and not stand_for.keys() & shapes.keys()
    }
    making = Making(stature, fit, owners, shapes, numbers, surfaces, turning)
    patches = [making.patch(piece) for piece in pieces]
    if hidden := sum(not patch.surface.is_seen for patch in patches):
        notes.append(f"{hidden} see-through meshes are not drawn")
    garments, moves = garments_of(patches, ours=document.asset.generator == _OURS)
    if not garments:
        raise Broken("nothing of it can be seen. Export the character with its meshes.")
    far = max(float(np.abs(garment.vertices).max()) for garment in garments)
    if not far <= _FARTHEST_M:
        raise Broken(
            f"a part of it lies {far:.3g} m away from its body as it is drawn. Remove what "
            "does not belong to it, and export it again."
        )
    figure = Figure(Path(name).stem, garments, moves, hashlib.sha256(content).hexdigest())
    told = _report(name, (document, bones), (stature, fit), figure, (pieces, surfaces.pictures))
    return Own(figure, replace(told, notes=tuple(dict.fromkeys(notes))))


def owners_of(nodes: Mapping[str, int], tree: Tree, pieces: Sequence[Piece] = ()) -> list[str]:
    """The bone that each node is or belongs to; empty where there is none above it.

    Args:
        nodes: The bones.
        tree: All nodes.
        pieces: Meshes whose loose bones, below none of the body, go with the nearest one.
    """
    told = {node: bone for bone, node in nodes.items() if bone not in _WORDS}
    found = [""] * len(tree.names)
    for node in tree.order:
        parent = tree.parents[node]
        found[node] = told.get(node) or (found[parent] if parent >= 0 else "")
    roots = {*tree.above(nodes["hips"])}
    loose = {n for piece in pieces if piece.is_skinned for n in piece.nodes.tolist()}
    below = [n for n in loose if not found[n] and n not in roots]
    for node, bone in zip(below, _nearest(below, told, tree), strict=True):
        found[node] = bone
    return found


def _nearest(nodes: Sequence[int], bones: Mapping[int, str], tree: Tree) -> list[str]:
    """For each node, the bone that passes nearest to it on its way to those right below it."""
    ways = [(node, node) for node in bones]
    ways += [(tree.parents[node], node) for node in bones if tree.parents[node] in bones]
    begins = np.array([tree.place(begin) for begin, _ in ways])
    lines = np.array([tree.place(end) for _, end in ways]) - begins
    squares = np.maximum((lines * lines).sum(axis=1), 1e-12)
    found = []
    for node in nodes:
        arm = tree.place(node) - begins
        share = np.clip((arm * lines).sum(axis=1) / squares, 0.0, 1.0)
        away = np.linalg.norm(arm - share[:, None] * lines, axis=1)
        found.append(bones[ways[int(away.argmin())][0]])
    return found


_WORDS = frozenset({"spine", "chest", "upperChest"})
"""Of the trunk, which is numbered from below."""


def _held(pieces: Sequence[Piece], bones: Bones, tree: Tree, notes: list[str]) -> tuple[Piece, ...]:
    """Pieces that bones move; a stage or a lamp in the same file is left out."""
    owners = owners_of(bones.nodes, tree)
    kept = []
    for piece in pieces:
        if any(owners[node] for node in piece.nodes.tolist()):
            kept.append(piece)
        else:
            notes.append(f"{piece.name} hangs on no bone of the body and is left out")
    if not kept:
        raise Broken("no mesh hangs on its bones. Export the meshes with their skin.")
    return tuple(kept)


def _stature(
    bones: Bones, tree: Tree, pieces: Sequence[Piece], notes: list[str]
) -> tuple[Stature, Mapping[str, int]]:
    owners = owners_of(bones.nodes, tree)
    points = [piece.placed() for piece in pieces]
    soles: list[Array] = [np.zeros((0, 3))]
    for piece, at in zip(pieces, points, strict=True):
        feet = np.array([owners[n].endswith(("Foot", "Toes")) for n in piece.nodes.tolist()], float)
        soles.append(at[(feet[piece.slots] * piece.weights).sum(axis=1) > 0.5])
    stature, nodes = stature_of(bones, tree, np.concatenate(points), np.concatenate(soles))
    if nodes["leftHand"] != bones.nodes["leftHand"]:
        notes.append("its names have left and right exchanged; they were taken the other way round")
    return stature, nodes


def _crown(piece: Piece, owners: Sequence[str], stature: Stature) -> float:
    """How far what hangs on the head goes above its joint, units of the file."""
    is_head = np.array([owners[node] == "head" for node in piece.nodes.tolist()], float)
    share = (is_head[piece.slots] * piece.weights).sum(axis=1)
    heights = stature.local(piece.placed())[share > 0.5, 2]
    return float(heights.max(initial=0.0) - stature.places["head"][2]) if len(heights) else 0.0


def _report(
    name: str,
    skeleton: tuple[Document, Bones],
    fitted: tuple[Stature, Fit],
    figure: Figure,
    drawn: tuple[Sequence[Piece], int],
) -> Conformance:
    (document, bones), (stature, fit), (pieces, pictures) = skeleton, fitted, drawn
    shapes = sorted({shape for moves in (figure.shapes or {}).values() for shape in moves})
    names = [node.name for node in document.nodes]
    return Conformance(
        name=_shown(name),
        sha256=figure.sha256,
        source=bones.source,
        bones={
            bone: readable(names[node])[:60]
            for bone, node in bones.nodes.items()
            if bone not in _WORDS
        },
        missing=bones.lacking(),
        height=stature.height,
        unit=stature.unit,
        scale=stature.scale,
        drawn_m=float(max(garment.vertices[:, 2].max() for garment in figure.garments)),
        up=stature.up,
        facing=stature.facing,
        rest_pose=stature.rest_pose,
        stretches=fit.stretches,
        shapes=tuple(shapes),
        without=tuple(meaning_of_missing(dict.fromkeys(shapes))),
        triangles=figure.triangle_count,
        parts=len(figure.garments),
        materials=len({piece.material for piece in pieces}),
        pictures=pictures,
        skinned=sum(piece.is_skinned for piece in pieces),
        attached=sum(not piece.is_skinned for piece in pieces),
        notes=(),
        licence=licence_of(document),
    )
