"""The modelling kit's mesh: triangles with crease-angle normals, moved, merged and cut.

Shapes come from `adamo_vh.runtime.assets.kit`. Metres, Z up, faces counter-clockwise from outside.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from adamo_vh.runtime.assets.asset import Material, Part

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

WELD_M = 1e-6
"""Points closer than this are one point."""
DEFAULT_CREASE_DEG = 38.0
"""Edges sharper than this stay hard."""
_AXES = {"x": 0, "y": 1, "z": 2}


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """A triangle mesh; every method returns a new one."""

    vertices: Floats
    """(N, 3) metres."""
    normals: Floats
    """(N, 3) unit vectors."""
    uvs: Floats
    """(N, 2); v up."""
    faces: Ints
    """(M, 3) vertex indices."""

    @property
    def lower(self) -> Floats:
        """(3,) lower corner of the bounding box."""
        return np.asarray(self.vertices.min(axis=0), dtype=np.float64)

    @property
    def upper(self) -> Floats:
        """(3,) upper corner of the bounding box."""
        return np.asarray(self.vertices.max(axis=0), dtype=np.float64)

    def moved(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Mesh:
        """Translate by metres."""
        return replace(self, vertices=self.vertices + np.array((x, y, z)))

    def turned(self, axis: str, degrees: float) -> Mesh:
        """Rotate about the x, y or z axis through the origin, right-handed."""
        first, second = (_AXES[axis] + 1) % 3, (_AXES[axis] + 2) % 3
        angle = np.deg2rad(degrees)
        turn = np.eye(3)
        turn[first, first] = turn[second, second] = np.cos(angle)
        turn[first, second], turn[second, first] = -np.sin(angle), np.sin(angle)
        return replace(self, vertices=self.vertices @ turn.T, normals=self.normals @ turn.T)

    def scaled(self, x: float = 1.0, y: float = 1.0, z: float = 1.0) -> Mesh:
        """Stretch along the axes; an odd number of negative factors mirrors."""
        factors = np.array((x, y, z))
        normals = self.normals / factors
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        faces = self.faces if factors.prod() > 0 else self.faces[:, ::-1]
        return replace(self, vertices=self.vertices * factors, normals=normals, faces=faces)

    def textured(self, uvs: Floats) -> Mesh:
        """Replace the texture coordinates, (N, 2)."""
        return replace(self, uvs=np.asarray(uvs, dtype=np.float64))

    def projected(self, axis: str) -> Mesh:
        """Spread a picture over the bounding box, seen upright when looking against `axis`.

        "-y" is a front label read by someone standing at negative y, "z" one read from above.
        """
        right, up = {
            "x": ((0, 1, 0), (0, 0, 1)),
            "-x": ((0, -1, 0), (0, 0, 1)),
            "y": ((-1, 0, 0), (0, 0, 1)),
            "-y": ((1, 0, 0), (0, 0, 1)),
            "z": ((1, 0, 0), (0, 1, 0)),
        }[axis]
        uvs = self.vertices @ np.array((right, up), dtype=np.float64).T
        span = np.maximum(np.ptp(uvs, axis=0), WELD_M)
        return self.textured((uvs - uvs.min(axis=0)) / span)

    def shaded(self, crease_deg: float) -> Mesh:
        """Recompute the normals: smooth below the crease angle, hard above it."""
        return shade(self.vertices, self.faces, self.uvs, crease_deg)

    def part(self, material: Material) -> Part:
        """Paint it."""
        return Part(
            vertices=self.vertices.astype(np.float32),
            normals=self.normals.astype(np.float32),
            uvs=self.uvs.astype(np.float32),
            faces=self.faces.astype(np.int32),
            material=material,
        )


def shade(
    points: ArrayLike,
    faces: ArrayLike,
    uvs: ArrayLike | None = None,
    crease_deg: float = DEFAULT_CREASE_DEG,
) -> Mesh:
    """Make a mesh from triangles: drop degenerate ones, add normals, split vertices at creases.

    Args:
        points: (N, 3) metres; several points may share a place (texture seams).
        faces: (M, 3) indices.
        uvs: (N, 2) texture coordinates; zero when missing.
        crease_deg: Neighbouring faces at a smaller angle are shaded as one smooth surface.
    """
    vertices = np.asarray(points, dtype=np.float64)
    triangles = np.asarray(faces, dtype=np.int64)
    texture = np.zeros((len(vertices), 2)) if uvs is None else np.asarray(uvs, dtype=np.float64)
    place = _welded(vertices)
    corners = place[triangles]
    distinct = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    triangles, corners = triangles[distinct], corners[distinct]
    normals = _corner_normals(vertices[triangles], corners, crease_deg)
    flat = triangles.ravel()
    keys = np.column_stack(
        (corners.ravel(), np.rint(texture[flat] * 1e5), np.rint(normals * 500))
    ).astype(np.int64)
    kept, index = _unique_rows(keys)
    return Mesh(vertices[flat[kept]], normals[kept], texture[flat[kept]], index.reshape(-1, 3))


def merge(meshes: Iterable[Mesh]) -> Mesh:
    """Join meshes of one material into one."""
    pieces = list(meshes)
    offsets = np.cumsum([0] + [len(piece.vertices) for piece in pieces[:-1]])
    return Mesh(
        vertices=np.concatenate([piece.vertices for piece in pieces]),
        normals=np.concatenate([piece.normals for piece in pieces]),
        uvs=np.concatenate([piece.uvs for piece in pieces]),
        faces=np.concatenate([p.faces + start for p, start in zip(pieces, offsets, strict=True)]),
    )


def fit(parts: Sequence[Part], size: tuple[float, float, float]) -> tuple[Part, ...]:
    """Stretch and centre parts so that together they span exactly `size` about the origin."""
    everything = np.concatenate([part.vertices for part in parts]).astype(np.float64)
    lower, upper = everything.min(axis=0), everything.max(axis=0)
    factors = np.array(size) / (upper - lower)
    fitted = []
    for part in parts:
        vertices = (part.vertices - (lower + upper) / 2) * factors
        normals = part.normals / factors
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        fitted.append(
            replace(
                part,
                vertices=vertices.astype(np.float32),
                normals=normals.astype(np.float32),
            )
        )
    return tuple(fitted)


def difference(mesh: Mesh, *tools: Mesh, crease_deg: float = DEFAULT_CREASE_DEG) -> Mesh:
    """Cut solids out of a solid. Texture coordinates are lost: project them again."""
    return _boolean("Subtract", (mesh, *tools), crease_deg)


def union(*meshes: Mesh, crease_deg: float = DEFAULT_CREASE_DEG) -> Mesh:
    """Fuse solids, dropping what lies inside. Texture coordinates are lost."""
    return _boolean("Add", meshes, crease_deg)


def intersection(*meshes: Mesh, crease_deg: float = DEFAULT_CREASE_DEG) -> Mesh:
    """Keep what all solids share. Texture coordinates are lost."""
    return _boolean("Intersect", meshes, crease_deg)


def _boolean(operation: str, meshes: Sequence[Mesh], crease_deg: float) -> Mesh:
    import manifold3d

    solids = []
    for mesh in meshes:
        place = _welded(mesh.vertices)
        _, first = np.unique(place, return_index=True)
        solid = manifold3d.Manifold(
            manifold3d.Mesh(
                vert_properties=mesh.vertices[first].astype(np.float32),
                tri_verts=place[mesh.faces].astype(np.uint32),
            )
        )
        if solid.status() != manifold3d.Error.NoError:
            raise ValueError(f"{operation} needs closed solids, got one with {solid.status()}")
        solids.append(solid)
    result = manifold3d.Manifold.batch_boolean(solids, getattr(manifold3d.OpType, operation))
    raw = result.to_mesh()
    return shade(raw.vert_properties[:, :3], raw.tri_verts, crease_deg=crease_deg)


def _welded(points: Floats) -> Ints:
    """(N,) for every point the number of its place; places are numbered 0, 1, ..."""
    _, place = _unique_rows(np.rint(points / WELD_M).astype(np.int64))
    return place


def _unique_rows(rows: Ints) -> tuple[Ints, Ints]:
    """Index of the first of each distinct row, and for every row the number of its distinct one.

    As `np.unique(axis=0)`, several times faster.
    """
    order = np.lexsort(rows.T)
    ordered = rows[order]
    new = np.ones(len(rows), dtype=bool)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    index = np.empty(len(rows), dtype=np.int64)
    index[order] = np.cumsum(new) - 1
    return order[new], index


def _corner_normals(triangles: Floats, corners: Ints, crease_deg: float) -> Floats:
    """(3 M, 3) unit normal of every face corner: angle-weighted mean over faces within the crease.

    Vectorised over all pairs of corners that meet in a place: a Python loop over vertices is what
    makes smooth shading slow.
    """
    edges = np.roll(triangles, -1, axis=1) - triangles
    face_normals = np.cross(edges[:, 0], edges[:, 1])
    length = np.linalg.norm(face_normals, axis=1, keepdims=True)
    face_normals /= np.maximum(length, 1e-30)
    along = edges / np.maximum(np.linalg.norm(edges, axis=2, keepdims=True), 1e-30)
    cosine = -(along * np.roll(along, 1, axis=1)).sum(axis=2)
    # A sliver's corner counts for nothing: its normal is noise.
    weight = (np.arccos(np.clip(cosine, -1.0, 1.0)) * (length > 1e-13)).ravel()
    weighted = np.repeat(face_normals, 3, axis=0) * weight[:, None]
    own = np.repeat(face_normals, 3, axis=0)

    order = np.argsort(corners.ravel(), kind="stable")
    _, start, count = np.unique(corners.ravel()[order], return_index=True, return_counts=True)
    group_size, group_start = np.repeat(count, count), np.repeat(start, count)
    left = np.repeat(np.arange(len(order)), group_size)
    offset = np.arange(len(left)) - np.repeat(np.cumsum(group_size) - group_size, group_size)
    right = group_start[left] + offset
    left, right = order[left], order[right]
    near = np.einsum("ij,ij->i", own[left], own[right]) >= np.cos(np.deg2rad(crease_deg))
    left, right = left[near], right[near]
    total = np.column_stack(
        [np.bincount(left, weighted[right, k], minlength=len(order)) for k in range(3)]
    )
    norm = np.linalg.norm(total, axis=1, keepdims=True)
    up = np.array((0.0, 0.0, 1.0))
    return np.asarray(np.where(norm > 1e-12, total / np.maximum(norm, 1e-12), up))
