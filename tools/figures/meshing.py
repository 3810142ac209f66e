"""From soft shapes to triangles: sparse marching cubes, smoothing, decimation, shading."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tools.figures.shapes import Point, Shape

from adamo_vh.geometry import Array

_BLOCK = 6
"""Cells in the edge of a block; blocks far from the surface are not sampled finely."""
_SHADE_REACH_M = 0.07
_SHADE_STEPS = 6


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """A triangle mesh, body frame, metres."""

    vertices: Array
    """(N, 3)."""
    faces: NDArray[np.int64]
    """(M, 3), counter-clockwise from outside."""

    def normals(self) -> Array:
        """(N, 3) unit normals, weighted by area."""
        return vertex_normals(self.vertices, self.faces)


def vertex_normals(vertices: Array, faces: NDArray[np.int64]) -> Array:
    """(N, 3) unit normals, weighted by area; places that lie together share theirs."""
    _, same = np.unique(np.round(vertices, 7), axis=0, return_inverse=True)
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    across = np.cross(b - a, c - a)
    total = np.zeros((int(same.max()) + 1, 3))
    for corner in range(3):
        np.add.at(total, same[faces[:, corner]], across)
    normals = total[same]
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(length > 1e-12, normals / np.maximum(length, 1e-12), [0.0, 0.0, 1.0])


def polygonize(
    shape: Shape, low: Point, high: Point, cell_m: float, triangles: int, smoothing: int = 6
) -> Mesh:
    """Mesh a shape inside a box.

    Args:
        shape: What to mesh.
        low: Corner of the box.
        high: Opposite corner.
        cell_m: Edge of a marching cube.
        triangles: How many to keep.
        smoothing: Passes of shrink-free (Taubin) smoothing before the decimation.
    """
    import fast_simplification
    from skimage import measure

    marching_cubes: Any = measure.marching_cubes

    field = _sampled(shape, np.array(low), np.array(high), cell_m)
    vertices, faces, _, _ = marching_cubes(field, 0.0, spacing=(cell_m,) * 3)
    vertices = np.asarray(vertices, np.float64) + np.array(low)
    # The field is negative inside, so scikit-image winds the faces the other way round.
    mesh = Mesh(vertices, np.asarray(faces[:, ::-1], np.int64))
    if _volume(mesh) < 0:
        mesh = Mesh(mesh.vertices, mesh.faces[:, ::-1])
    mesh = smoothed(mesh, smoothing)
    if len(mesh.faces) > triangles:
        points, cells = fast_simplification.simplify(
            mesh.vertices, mesh.faces.astype(np.int32), target_count=triangles, agg=4
        )[:2]
        mesh = Mesh(np.asarray(points, np.float64), np.asarray(cells, np.int64))
    return mesh


def _volume(mesh: Mesh) -> float:
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def _sampled(shape: Shape, low: Array, high: Array, cell_m: float) -> Array:
    """(X, Y, Z) distances on a grid; far from the surface only their sign is right."""
    blocks = np.ceil((high - low) / (cell_m * _BLOCK)).astype(int)
    edge_m = cell_m * _BLOCK
    centers = np.stack(
        np.meshgrid(*(np.arange(n) for n in blocks), indexing="ij"), axis=-1
    ).reshape(-1, 3)
    coarse = shape(low + (centers + 0.5) * edge_m)
    field = np.repeat(np.repeat(np.repeat(coarse.reshape(blocks), _BLOCK, 0), _BLOCK, 1), _BLOCK, 2)
    inner = np.stack(np.meshgrid(*(np.arange(_BLOCK),) * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    for block in centers[np.abs(coarse) < edge_m * 1.6]:
        at = block * _BLOCK
        values = shape(low + (at + inner) * cell_m)
        x, y, z = (slice(i, i + _BLOCK) for i in at)
        field[x, y, z] = values.reshape(_BLOCK, _BLOCK, _BLOCK)
    return field


def smoothed(mesh: Mesh, passes: int) -> Mesh:
    """Taubin smoothing: a step in and a slightly larger step out."""
    from scipy.sparse import coo_matrix, diags

    count = len(mesh.vertices)
    i = mesh.faces[:, [0, 1, 2]].ravel()
    j = mesh.faces[:, [1, 2, 0]].ravel()
    links = coo_matrix((np.ones(len(i)), (i, j)), shape=(count, count)).tocsr()
    links = ((links + links.T) > 0).astype(float)
    mean = diags(1.0 / np.maximum(np.asarray(links.sum(axis=1)).ravel(), 1.0)) @ links
    points = mesh.vertices
    for _ in range(passes):
        for step in (0.5, -0.53):
            points = points + step * (mean @ points - points)
    return Mesh(points, mesh.faces)


def without_hidden(mesh: Mesh, cover: Shape, depth_m: float) -> Mesh:
    """Drop the triangles that lie deeper than this under something else."""
    hidden = cover(mesh.vertices) < -depth_m
    return compact(Mesh(mesh.vertices, mesh.faces[~hidden[mesh.faces].all(axis=1)]))


def largest(mesh: Mesh) -> Mesh:
    """Drop everything that is not connected to the largest piece."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    i, j = mesh.faces[:, [0, 1]].ravel(), mesh.faces[:, [1, 2]].ravel()
    count = len(mesh.vertices)
    _, piece = connected_components(coo_matrix((np.ones(len(i)), (i, j)), shape=(count, count)))
    keep = piece[mesh.faces[:, 0]] == np.bincount(piece[mesh.faces[:, 0]]).argmax()
    return compact(Mesh(mesh.vertices, mesh.faces[keep]))


def compact(mesh: Mesh) -> Mesh:
    """Drop the vertices that no triangle uses."""
    used, faces = np.unique(mesh.faces, return_inverse=True)
    return Mesh(mesh.vertices[used], faces.reshape(-1, 3))


def merged(*meshes: Mesh) -> Mesh:
    """Several meshes as one."""
    offsets = np.cumsum([0, *(len(m.vertices) for m in meshes[:-1])])
    return Mesh(
        np.concatenate([m.vertices for m in meshes]),
        np.concatenate([m.faces + o for m, o in zip(meshes, offsets, strict=True)]),
    )


def daylight(points: Array, normals: Array, surroundings: Shape) -> Array:
    """(N,) how open each place is, from 0 in a crease to 1 in the open."""
    shade = np.zeros(len(points))
    total = 0.0
    for step in range(1, _SHADE_STEPS + 1):
        height = _SHADE_REACH_M * (step / _SHADE_STEPS) ** 2
        weight = 0.65**step
        free = surroundings(points + normals * height) / height
        shade += weight * np.clip(1.0 - free, 0.0, 1.0)
        total += weight
    return np.clip(1.0 - shade / total, 0.0, 1.0)


def tube(path: Array, radii: Array, sides: int = 6) -> Mesh:
    """A closed tube along (N, 3) points with (N,) radii that end near zero."""
    tangents = np.gradient(path, axis=0)
    tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
    up = np.cross(tangents, [1.0, 0.0, 0.0])
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    side = np.cross(tangents, up)
    angle = np.arange(sides) * 2 * np.pi / sides
    ring = np.cos(angle)[:, None, None] * up + np.sin(angle)[:, None, None] * side
    points = (path + radii[:, None] * ring).transpose(1, 0, 2).reshape(-1, 3)
    quads = []
    for i in range(len(path) - 1):
        for k in range(sides):
            a, b = i * sides + k, i * sides + (k + 1) % sides
            quads += [(a, b, b + sides), (a, b + sides, a + sides)]
    mesh = Mesh(points, np.array(quads, np.int64))
    return mesh if _volume(mesh) > 0 else Mesh(points, mesh.faces[:, ::-1])
