"""The meshes of a file, with what moves each of their vertices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array
from adamo_vh.readable import readable
from adamo_vh.runtime.human.own.faults import AGAIN, Broken
from adamo_vh.runtime.human.own.fields import Document, Mesh, Node, Primitive
from adamo_vh.runtime.human.own.numbers import Numbers
from adamo_vh.runtime.human.own.tree import Tree

MOST_TRIANGLES = 250_000
MOST_VERTICES = 500_000
MOST_PIECES = 2000
_TRIANGLES = 4
_MOST_SETS = 4
"""Of four influences each."""


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """Triangles of one material, as the file has them."""

    mesh: int
    primitive: int
    name: str
    material: int | None
    points: Array
    """(N, 3) in the frame of the mesh."""
    normals: Array | None
    """(N, 3); None if the file has none."""
    uvs: Array
    """(N, 2), v down."""
    colours: Array | None
    """(N, 3) linear; None if the file has none."""
    faces: NDArray[np.int64]
    """(M, 3)."""
    nodes: NDArray[np.int64]
    """(B,) the nodes that move it."""
    matrices: Array
    """(B, 4, 4) world_from_mesh by each of them, as the file stands."""
    slots: NDArray[np.int64]
    """(N, K) places in `nodes`."""
    weights: Array
    """(N, K) shares; they sum to 1."""
    is_skinned: bool
    targets: tuple[int | None, ...]
    """The array of each morph target's moves."""
    rows: NDArray[np.int64]
    """(N,) which of the file's vertices these are: primitives may share one array."""

    def blended(self, maps: Array) -> Array:
        """(N, 3, 4) for each vertex, the mean of maps that are given for each node, (B, 4, 4)."""
        found = np.zeros((len(self.points), 3, 4))
        for k in range(self.slots.shape[1]):
            found += self.weights[:, k, None, None] * maps[self.slots[:, k], :3]
        return found

    def placed(self) -> Array:
        """(N, 3) where the vertices are in the world, as the file stands."""
        return moved(self.blended(self.matrices), self.points)


def moved(maps: Array, points: Array) -> Array:
    """(N, 3) points by a map for each, (N, 3, 4)."""
    return np.asarray(np.einsum("nij,nj->ni", maps[:, :, :3], points) + maps[:, :, 3])


def pieces_of(
    document: Document, tree: Tree, numbers: Numbers, notes: list[str]
) -> tuple[Piece, ...]:
    """All triangles of a file.

    Args:
        document: The file.
        tree: Its nodes.
        numbers: Its arrays.
        notes: Takes what is left out, in words.

    Raises:
        Broken: A mesh is wrong, or there are too many triangles.
    """
    _check_size(document, numbers)
    found: list[Piece] = []
    for number, node in enumerate(document.nodes):
        if node.mesh is None:
            continue
        if node.mesh >= len(document.meshes):
            raise Broken(f"mesh {node.mesh} is missing. {AGAIN}")
        mesh = document.meshes[node.mesh]
        moving = _moving(document, tree, numbers, number, node)
        for place, primitive in enumerate(mesh.primitives):
            name = readable(mesh.name or node.name or f"mesh {node.mesh}")[:60]
            if primitive.mode != _TRIANGLES:
                notes.append(f"{name}: lines, points or strips of triangles are left out")
                continue
            found.append(_piece(document, numbers, (node, place, primitive), name, moving))
    if sum(len(piece.faces) for piece in found) == 0:
        raise Broken("it has no triangles. Export the character with its meshes.")
    if sum(len(piece.faces) for piece in found) > MOST_TRIANGLES:
        raise Broken(_too_many(sum(len(piece.faces) for piece in found)))
    return tuple(found)


def _too_many(count: int) -> str:
    return (
        f"it has {count:,} triangles, and {MOST_TRIANGLES:,} is the most. Reduce them, for "
        "instance with Blender's Decimate."
    )


def _check_size(document: Document, numbers: Numbers) -> None:
    """Refuse what is too much before memory is taken for it."""
    corners = vertices = pieces = 0
    counted: set[int] = set()
    for node in document.nodes:
        if node.mesh is None or node.mesh >= len(document.meshes):
            continue
        for primitive in document.meshes[node.mesh].primitives:
            if "POSITION" not in primitive.attributes:
                raise Broken(f"a mesh has no positions. {AGAIN}")
            count = numbers.count(primitive.attributes["POSITION"])
            pieces += 1
            if primitive.attributes["POSITION"] not in counted:
                counted.add(primitive.attributes["POSITION"])
                vertices += count
            corners += count if primitive.indices is None else numbers.count(primitive.indices)
    if pieces > MOST_PIECES:
        raise Broken(f"it has {pieces:,} meshes, and {MOST_PIECES:,} is the most. Join them.")
    if corners > 3 * MOST_TRIANGLES:
        raise Broken(_too_many(corners // 3))
    if vertices > MOST_VERTICES:
        raise Broken(f"it has {vertices:,} vertices, and {MOST_VERTICES:,} is the most. Reduce it.")


def _moving(
    document: Document, tree: Tree, numbers: Numbers, number: int, node: Node
) -> tuple[NDArray[np.int64], Array, bool]:
    """The nodes that move a mesh, its matrices by each, and whether it has a skin."""
    if node.skin is None:
        return np.array([number]), tree.matrices[[number]], False
    if node.skin >= len(document.skins):
        raise Broken(f"skin {node.skin} is missing. {AGAIN}")
    skin = document.skins[node.skin]
    joints = np.array(skin.joints, np.int64)
    if not len(joints) or int(joints.max()) >= len(document.nodes):
        raise Broken(f"skin {node.skin} has no bones, or one that is missing. {AGAIN}")
    matrices = tree.matrices[joints]
    if skin.inverse is not None:
        inverse = numbers.floats(skin.inverse, 16)
        if len(inverse) < len(joints):
            raise Broken(f"skin {node.skin} has fewer matrices than bones. {AGAIN}")
        matrices = matrices @ inverse[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1)
    return joints, matrices, True


def _piece(
    document: Document,
    numbers: Numbers,
    told: tuple[Node, int, Primitive],
    name: str,
    moving: tuple[NDArray[np.int64], Array, bool],
) -> Piece:
    node, place, primitive = told
    attributes = primitive.attributes
    points = numbers.floats(attributes["POSITION"], 3)
    count = len(points)
    if np.abs(points).max(initial=0.0) > 1e9:
        raise Broken(f"{name} is infinitely large. {AGAIN}")

    def attribute(key: str, width: int) -> Array | None:
        if key not in attributes:
            return None
        values = numbers.floats(attributes[key], width)
        if len(values) != count:
            raise Broken(f"{name} has another number of {key} than of positions. {AGAIN}")
        return values

    if primitive.indices is None:
        faces = np.arange(count - count % 3).reshape(-1, 3)
    else:
        listed = numbers.wholes(primitive.indices, 1)[:, 0]
        faces = listed[: len(listed) - len(listed) % 3].reshape(-1, 3)
    if len(faces) and int(faces.max()) >= count:
        raise Broken(f"{name} has a triangle with a corner that is missing. {AGAIN}")
    if primitive.material is not None and primitive.material >= len(document.materials):
        raise Broken(f"material {primitive.material} is missing. {AGAIN}")
    slots, weights = _influences(numbers, attributes, count, len(moving[0]), moving[2])
    normals = attribute("NORMAL", 3)
    uvs = attribute(f"TEXCOORD_{_channel(document, primitive)}", 2)
    colours = None
    if (number := attributes.get("COLOR_0")) is not None and numbers.width(number) in (3, 4):
        colours = attribute("COLOR_0", numbers.width(number))
    rows, corners = np.unique(faces, return_inverse=True)
    return Piece(
        mesh=node.mesh if node.mesh is not None else -1,
        primitive=place,
        name=name,
        material=primitive.material,
        points=points[rows],
        normals=None if normals is None else normals[rows],
        uvs=np.zeros((len(rows), 2)) if uvs is None else uvs[rows],
        colours=None if colours is None else colours[rows, :3],
        faces=corners.reshape(-1, 3),
        nodes=moving[0],
        matrices=moving[1],
        slots=slots[rows],
        weights=weights[rows],
        is_skinned=moving[2],
        targets=tuple(target.get("POSITION") for target in primitive.targets),
        rows=rows,
    )


def _channel(document: Document, primitive: Primitive) -> int:
    """Which set of texture coordinates shows the picture."""
    if primitive.material is None:
        return 0
    texture = document.materials[primitive.material].metallic.texture
    return 0 if texture is None else texture.channel


def _influences(
    numbers: Numbers, attributes: dict[str, int], count: int, nodes: int, is_skinned: bool
) -> tuple[NDArray[np.int64], Array]:
    """(N, K) which nodes move each vertex, and their shares."""
    sets = [k for k in range(_MOST_SETS) if f"JOINTS_{k}" in attributes] if is_skinned else []
    slots = [np.zeros((count, 1), np.int64)]
    weights = [np.zeros((count, 1))]
    for k in sets:
        joints = numbers.wholes(attributes[f"JOINTS_{k}"], 4)
        key = f"WEIGHTS_{k}"
        shares = numbers.floats(attributes[key], 4) if key in attributes else np.zeros((0, 4))
        if len(joints) != count or len(shares) != count:
            raise Broken(f"a skin has bones without weights, or too few of both. {AGAIN}")
        shares = np.maximum(shares, 0.0)
        joints = np.where(shares > 0, joints, 0)
        if count and int(joints.max()) >= nodes:
            raise Broken(f"a vertex hangs on a bone that its skin does not have. {AGAIN}")
        slots.append(joints)
        weights.append(shares)
    together = np.concatenate(weights, axis=1)
    total = together.sum(axis=1, keepdims=True)
    # What hangs on nothing hangs on the first bone.
    together[:, :1] += total <= 1e-9
    return np.concatenate(slots, axis=1), together / np.maximum(
        together.sum(1, keepdims=True), 1e-9
    )


def target_names(mesh: Mesh, primitive: Primitive) -> list[str]:
    """Names of the morph targets of a mesh, as far as it tells them."""
    for extras in (mesh.extras, primitive.extras):
        names: Any = extras.get("targetNames") if isinstance(extras, dict) else None
        if isinstance(names, list):
            return [str(name)[:200] for name in names]
    return []
