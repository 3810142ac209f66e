"""Make a figure of a file's triangles: each vertex into the rest pose, and onto our joints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.face import LOOKS
from adamo_vh.runtime.human.looks import HEAD_GARMENTS, Garment
from adamo_vh.runtime.human.own.colours import painted
from adamo_vh.runtime.human.own.cutting import cut
from adamo_vh.runtime.human.own.expressions import BOTH, LEFT, Share
from adamo_vh.runtime.human.own.fitting import Fit
from adamo_vh.runtime.human.own.numbers import Numbers
from adamo_vh.runtime.human.own.skins import MOST_TRIANGLES, Piece, moved
from adamo_vh.runtime.human.own.stature import Stature
from adamo_vh.runtime.human.own.surfaces import Surface, Surfaces
from adamo_vh.runtime.human.rotations import about_y
from adamo_vh.runtime.human.skeleton import INDEX, JOINTS

_OF_HEAD = [INDEX[joint] for joint in ("neck", "head", "eyelids")]
_OUR_HEAD = HEAD_GARMENTS | {"mouth", "teeth"}
_INFLUENCES = 4
_JAW_RAD = 0.22
BY_BONE: Mapping[str, Mapping[str, Array]] = {
    "jaw": {"jawOpen": about_y(_JAW_RAD)},
    "leftEye": LOOKS["Left"],
    "rightEye": LOOKS["Right"],
}
"""The turns of a bone that shapes stand for, by bone and shape."""
_MIDLINE_M = 0.012
"""So far to both sides of the middle, a shape of one half fades."""
Moves = Mapping[str, NDArray[np.float32]]


@dataclass(frozen=True, slots=True, eq=False)
class Patch:
    """A piece that is fitted: vertices in the rest pose with weights on our joints."""

    points: Array
    normals: Array
    uvs: Array
    faces: NDArray[np.int64]
    weights: NDArray[np.floating[Any]]
    """(N, J) shares of our joints."""
    moves: Mapping[str, Array]
    """(N, 3) by shape."""
    surface: Surface


@dataclass(frozen=True, slots=True, eq=False)
class Making:
    """What all pieces are fitted with."""

    stature: Stature
    fit: Fit
    owners: Sequence[str]
    """The bone that each node is, or belongs to; empty for those that belong to none."""
    shapes: Mapping[str, tuple[Share, ...]]
    numbers: Numbers
    surfaces: Surfaces
    turning: Mapping[str, Array]
    """(3,) places in the rest pose of bones of the face that take the place of shapes."""

    def patch(self, piece: Piece) -> Patch:
        """Fit a piece."""
        bones = [self.owners[node] or "hips" for node in piece.nodes.tolist()]
        maps = self._maps(piece, bones)
        linear = maps[:, :, :3]
        cofactors = np.stack(
            [np.cross(linear[:, i - 2], linear[:, i - 1]) for i in range(3)], axis=1
        )
        sign = np.sign(np.einsum("ni,ni->n", linear[:, 0], cofactors[:, 0]))
        faces = piece.faces
        normals = piece.normals if piece.normals is not None else _flat_normals(piece)
        normals = np.einsum("nij,nj->ni", cofactors, normals) * sign[:, None]
        size = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = np.where(size > 1e-12, normals / np.maximum(size, 1e-12), [0.0, 0.0, 1.0])
        if len(sign) and np.median(sign) < 0:
            faces = faces[:, ::-1]
        points = moved(maps, piece.points)
        joints = np.array([self.fit.joints[bone] for bone in bones])
        weights = np.zeros((len(points), len(JOINTS)), np.float32)
        rows = np.arange(len(points))
        for k in range(piece.slots.shape[1]):
            weights[rows, joints[piece.slots[:, k]]] += piece.weights[:, k]
        surface = self.surfaces.surface(piece.material)
        uvs = piece.uvs @ surface.shift[:, :2].T + surface.shift[:, 2]
        moves = dict(self._moves(piece, linear, points))
        for bone, place in self.turning.items():
            if (share := _share_of(piece, bones, bone)).any():
                arm = points - place
                for shape, turn in BY_BONE[bone].items():
                    moves[shape] = (arm @ turn.T - arm) * share[:, None]
        patch = Patch(points, normals, uvs, faces, weights, moves, surface)
        if piece.colours is None or surface.material.texture is not None:
            return patch
        return _painted(patch, piece.colours)

    def _maps(self, piece: Piece, bones: Sequence[str]) -> Array:
        """(N, 3, 4) from the mesh's frame to the rest pose, for each vertex."""
        local = np.eye(4)
        local[:3, :3], local[:3, 3] = self.stature.turn, -self.stature.origin
        into = local @ piece.matrices
        upper = np.stack([self.fit.maps[bone] for bone in bones]) @ into
        found = piece.blended(upper)
        if "hips" in bones:
            hem = np.stack(
                [self.fit.hem if bone == "hips" else self.fit.maps[bone] for bone in bones]
            )
            low = self.stature.local(piece.placed())[:, 2] < self.fit.hips_z
            found = np.where(low[:, None, None], piece.blended(hem @ into), found)
        return found

    def _moves(self, piece: Piece, linear: Array, points: Array) -> Iterator[tuple[str, Array]]:
        left = np.clip(0.5 + points[:, 1] / (2 * _MIDLINE_M), 0.0, 1.0)
        for shape, shares in self.shapes.items():
            total = np.zeros_like(points)
            for share in shares:
                if share.mesh != piece.mesh or share.target >= len(piece.targets):
                    continue
                array = piece.targets[share.target]
                if array is None or self.numbers.count(array) <= piece.rows.max(initial=-1):
                    continue
                steps = self.numbers.floats(array, 3)[piece.rows]
                steps = np.einsum("nij,nj->ni", linear, steps)
                half = 1.0 if share.half == BOTH else left if share.half == LEFT else 1.0 - left
                total += share.weight * steps * np.broadcast_to(half, len(points))[:, None]
            if np.abs(total).max(initial=0.0) > 1e-5:
                yield shape, total


def _painted(patch: Patch, colours: Array) -> Patch:
    """A patch with the colours of its vertices as a picture."""
    told = painted(patch.faces, colours)
    material = replace(patch.surface.material, texture=told.picture)
    shift = np.eye(2, 3)
    return replace(
        patch,
        points=patch.points[told.rows],
        normals=patch.normals[told.rows],
        uvs=told.uvs,
        faces=told.faces,
        weights=patch.weights[told.rows],
        moves={shape: steps[told.rows] for shape, steps in patch.moves.items()},
        surface=replace(patch.surface, material=material, shift=shift),
    )


def _share_of(piece: Piece, bones: Sequence[str], bone: str) -> Array:
    """(N,) how much of each vertex a bone has."""
    is_it = np.array([name == bone for name in bones], float)
    return np.asarray((is_it[piece.slots] * piece.weights).sum(axis=1))


def _flat_normals(piece: Piece) -> Array:
    a, b, c = (piece.points[piece.faces[:, k]] for k in range(3))
    found = np.zeros_like(piece.points)
    for k in range(3):
        np.add.at(found, piece.faces[:, k], np.cross(b - a, c - a))
    return found


def garments_of(
    patches: Sequence[Patch], *, ours: bool
) -> tuple[tuple[Garment, ...], dict[str, Moves]]:
    """Garments of patches: those of one material together, apart for the head.

    Args:
        patches: What is drawn.
        ours: Whether it is a file of ours: materials then say what is the head, and have no backs.

    Returns:
        The garments, and the moves of their vertices by garment and shape.
    """
    groups: dict[tuple[int, bool], list[Patch]] = {}
    room = MOST_TRIANGLES - sum(len(patch.faces) for patch in patches)
    for patch in patches:
        if not patch.surface.is_seen or not len(patch.faces):
            continue
        solid = patch
        if patch.surface.alpha is not None:
            whole = len(patch.faces)
            solid = _without_gaps(patch, whole + max(room, 0))
            room -= max(0, len(solid.faces) - whole)
        of_head = solid.weights[:, _OF_HEAD].sum(axis=1)
        inside = of_head[solid.faces].mean(axis=1) > 0.25
        if ours:
            inside = np.full(len(solid.faces), solid.surface.material.name in _OUR_HEAD)
        for is_head in (True, False):
            if (chosen := solid.faces[inside == is_head]).size:
                part = _used(replace(solid, faces=chosen))
                groups.setdefault((id(patch.surface), is_head), []).append(part)
    garments: list[Garment] = []
    moves: dict[str, Moves] = {}
    for (_, is_head), parts in groups.items():
        garment, its = _garment(parts, is_head, len(garments), backs=not ours)
        garments.append(garment)
        if its:
            moves[garment.name] = its
    return tuple(garments), moves


def _used(patch: Patch) -> Patch:
    """A patch without the vertices that no triangle has."""
    used, places = np.unique(patch.faces, return_inverse=True)
    return replace(
        patch,
        points=patch.points[used],
        normals=patch.normals[used],
        uvs=patch.uvs[used],
        faces=places.reshape(-1, 3),
        weights=patch.weights[used],
        moves={shape: steps[used] for shape, steps in patch.moves.items()},
    )


def _without_gaps(patch: Patch, most: int) -> Patch:
    """A patch without what its picture shows as transparent."""
    surface = patch.surface
    assert surface.alpha is not None
    left = cut(patch.faces, patch.uvs, surface.alpha, surface.solid_from, most)

    def mixed(values: NDArray[np.floating[Any]]) -> Array:
        return np.asarray(np.einsum("nk,nki->ni", left.shares, values[left.parents]))

    return replace(
        patch,
        points=mixed(patch.points),
        normals=mixed(patch.normals),
        uvs=mixed(patch.uvs),
        faces=left.faces,
        weights=mixed(patch.weights),
        moves={shape: mixed(steps) for shape, steps in patch.moves.items()},
    )


def _garment(
    parts: Sequence[Patch], is_head: bool, number: int, *, backs: bool
) -> tuple[Garment, Moves]:
    """Patches of one surface as one garment, and the moves of its vertices."""
    starts = np.cumsum([0, *(len(part.points) for part in parts)])
    faces = np.concatenate([p.faces + s for p, s in zip(parts, starts[:-1], strict=True)])
    weights = np.concatenate([part.weights for part in parts])
    bones = np.argsort(-weights, axis=1, kind="stable")[:, :_INFLUENCES]
    shares = np.take_along_axis(weights, bones, axis=1)
    shares /= np.maximum(shares.sum(axis=1, keepdims=True), 1e-9)
    uvs = np.concatenate([part.uvs for part in parts])
    normals = np.concatenate([part.normals for part in parts])
    size = np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    surface = parts[0].surface
    told = surface.material.name
    # By this name the engine and the page know what eyes look out of.
    head = told if told in HEAD_GARMENTS else "head"
    role = head if is_head else f"body/{told}"
    garment = Garment(
        f"{number}/{told}",
        np.concatenate([part.points for part in parts]).astype(np.float32),
        (normals / size).astype(np.float32),
        (uvs * [1.0, -1.0] + [0.0, 1.0]).astype(np.float32),
        faces.astype(np.int32),
        bones.astype(np.uint8),
        shares.astype(np.float32),
        replace(surface.material, name=role),
    )
    shapes = {shape for part in parts for shape in part.moves}
    moves = {
        shape: np.concatenate(
            [part.moves.get(shape, np.zeros_like(part.points)) for part in parts]
        ).astype(np.float32)
        for shape in sorted(shapes)
    }
    if not (backs and surface.two_sided):
        return garment, moves
    return _with_back(garment), {shape: np.tile(steps, (2, 1)) for shape, steps in moves.items()}


def _with_back(garment: Garment) -> Garment:
    """A garment whose triangles are seen from both sides; each side has vertices of its own."""
    count = len(garment.vertices)
    return replace(
        garment,
        vertices=np.tile(garment.vertices, (2, 1)),
        normals=np.concatenate([garment.normals, -garment.normals]),
        uvs=np.tile(garment.uvs, (2, 1)),
        faces=np.concatenate([garment.faces, garment.faces[:, ::-1] + count]).astype(np.int32),
        bone_ids=np.tile(garment.bone_ids, (2, 1)),
        weights=np.tile(garment.weights, (2, 1)),
    )
