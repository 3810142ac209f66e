"""The face that moves: lips that part, a mouth behind them, and shapes with ARKit's names.

The figures' heads are one closed surface. For a page that shows somebody speak, the surface is cut
along the line between the lips, a dark mouth with teeth is put behind it, and for every shape it is
said how far each vertex goes. At rest all of it looks as before. Names and meanings of the shapes
are those of ARKit's blend shapes (Apple, ARFaceAnchor.BlendShapeLocation).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array
from adamo_vh.runtime.assets.asset import Material
from adamo_vh.runtime.human.looks import LIDS_CLOSED_RAD, Figure, Garment
from adamo_vh.runtime.human.rotations import about_y, about_z
from adamo_vh.runtime.human.skeleton import INDEX, REST

SHAPES = (
    "jawOpen",
    "mouthFunnel",
    "mouthPucker",
    "mouthSmileLeft",
    "mouthSmileRight",
    "mouthFrownLeft",
    "mouthFrownRight",
    "mouthRollLower",
    "eyeBlinkLeft",
    "eyeBlinkRight",
    "eyeLookUpLeft",
    "eyeLookUpRight",
    "eyeLookDownLeft",
    "eyeLookDownRight",
    "eyeLookInLeft",
    "eyeLookInRight",
    "eyeLookOutLeft",
    "eyeLookOutRight",
    "browInnerUp",
    "browOuterUpLeft",
    "browOuterUpRight",
    "browDownLeft",
    "browDownRight",
)
"""The shapes of a face; left is the person's own."""

_MOUTH_Z = 1.5295
_LINE_Y = np.array([0.0, 0.009, 0.018, 0.0262])
_LINE_Z = _MOUTH_Z + np.array([-0.0002, -0.0002, 0.0014, 0.0052])
_HALF_WIDTH_M = 0.0235
"""From the middle of the mouth to where the lips stay together."""
_BEYOND_M = 0.005
"""So far the cut goes on where the lips stay together: no triangle may tear at its end."""
_LIPS_X = 0.074
"""What is behind is no lip."""
_HINGE = np.array([0.004, 0.0, 1.563])
"""The jaw turns about a line through this, from ear to ear."""
_JAW_RAD = 0.24
_EYE_Y = 0.0335
_LASHES_RAD = 0.60
MOST_LOOK_RAD = math.radians(25.0)
"""So far an eye turns from straight ahead."""
LOOKS: Mapping[str, Mapping[str, Array]] = {
    side: {
        f"eyeLookUp{side}": about_y(-MOST_LOOK_RAD),
        f"eyeLookDown{side}": about_y(MOST_LOOK_RAD),
        f"eyeLookOut{side}": about_z(out * MOST_LOOK_RAD),
        f"eyeLookIn{side}": about_z(-out * MOST_LOOK_RAD),
    }
    for side, out in (("Left", 1.0), ("Right", -1.0))
}
"""How an eye is turned where a shape is gone into as a whole, by side; in is towards the nose."""
_MOUTH_SKIN = (0.23, 0.07, 0.07, 1.0)
_TEETH = (0.93, 0.91, 0.86, 1.0)


@dataclass(frozen=True, slots=True, eq=False)
class Face:
    """A figure whose face can move."""

    figure: Figure
    """With the lips cut apart and a mouth behind them."""
    shapes: Mapping[str, Mapping[str, NDArray[np.float32]]]
    """By garment and name of the shape: (N, 3) how far its vertices go, metres, body frame."""


def moving_face(figure: Figure) -> Face:
    """A figure with a face that moves; the figure that is given stays as it is."""
    if figure.shapes is not None:
        return Face(figure, figure.shapes)
    head, is_above = _cut(figure["head"])
    others = tuple(garment for garment in figure.garments if garment.name != "head")
    garments = (head, _mouth(), _teeth(), *others)
    shapes: dict[str, Mapping[str, NDArray[np.float32]]] = {}
    for garment in garments:
        points = garment.vertices.astype(float)
        above = is_above if garment is head else _height(points) > 0
        moves = _moves(garment.name, points, above)
        if kept := {n: m.astype(np.float32) for n, m in moves.items() if np.abs(m).max() > 1e-6}:
            shapes[garment.name] = kept
    return Face(Figure(figure.variant, garments), shapes)


def look_shares(left_rad: float, down_rad: float) -> dict[str, float]:
    """How far to go into each shape of the eyes, 0 to 1, so that they are turned so in the head."""
    left, down = (float(np.clip(a / MOST_LOOK_RAD, -1.0, 1.0)) for a in (left_rad, down_rad))
    shares: dict[str, float] = {}
    for side, out in (("Left", left), ("Right", -left)):
        for way, share in (("Up", -down), ("Down", down), ("Out", out), ("In", -out)):
            shares[f"eyeLook{way}{side}"] = max(0.0, share)
    return shares


def eye_shapes(garment: Garment) -> dict[str, NDArray[np.float32]]:
    """By shape, (N, 3) how far the vertices of a figure's eyeballs go; empty for all else."""
    if garment.name != "eyes":
        return {}
    return {n: m.astype(np.float32) for n, m in _looks(garment.vertices.astype(float)).items()}


def _height(points: Array) -> Array:
    """(N,) how far points are above the line between the lips."""
    return np.asarray(points[:, 2] - np.interp(np.abs(points[:, 1]), _LINE_Y, _LINE_Z))


def _cut(head: Garment) -> tuple[Garment, NDArray[np.bool_]]:
    """The head with its surface cut along the line between the lips.

    Returns:
        The head; and (N,) which of its points are above the cut.
    """
    points = head.vertices.astype(float)
    height = _height(points)
    near = (np.abs(points[:, 1]) < _HALF_WIDTH_M + _BEYOND_M) & (points[:, 0] > _LIPS_X)
    above = height > 0
    sides = above[head.faces]
    crossed = near[head.faces].all(axis=1) & (sides.any(axis=1) != sides.all(axis=1))
    cutter = _Cutter(head, height)
    faces = [*head.faces[~crossed].tolist()]
    for face in head.faces[crossed]:
        faces.extend(cutter.parts(face, above[face]))
    made = np.array([side for _, _, side in cutter.made], bool)
    return cutter.garment(np.array(faces, np.int32)), np.concatenate([above, made])


class _Cutter:
    """Cuts triangles where a height is 0; each side gets edge points of its own."""

    def __init__(self, garment: Garment, height: Array) -> None:
        self._garment, self._height = garment, height
        self.made: dict[tuple[int, int, bool], int] = {}
        """Numbers of the points that were made, in order, by their edge and side."""

    def parts(self, face: NDArray[np.int32], above: NDArray[np.bool_]) -> list[list[int]]:
        """The triangles of both sides of one that is crossed."""
        found: list[list[int]] = []
        for side in (True, False):
            ring: list[int] = []
            for i in range(3):
                a, b = int(face[i]), int(face[(i + 1) % 3])
                if above[i] == side:
                    ring.append(a)
                if above[i] != above[(i + 1) % 3]:
                    ring.append(self._edge(a, b, side))
            found += [[ring[0], ring[k], ring[k + 1]] for k in range(1, len(ring) - 1)]
        return found

    def _edge(self, a: int, b: int, side: bool) -> int:
        a, b = min(a, b), max(a, b)
        return self.made.setdefault((a, b, side), len(self._garment.vertices) + len(self.made))

    def garment(self, faces: NDArray[np.int32]) -> Garment:
        """The garment with the points that were made."""
        old = self._garment
        a = np.array([edge[0] for edge in self.made], int)
        b = np.array([edge[1] for edge in self.made], int)
        t = (self._height[a] / (self._height[a] - self._height[b]))[:, None]
        nearer = np.where(t[:, 0] < 0.5, a, b)

        def between(values: NDArray[Any]) -> NDArray[np.float32]:
            return np.concatenate([values, values[a] * (1 - t) + values[b] * t]).astype(np.float32)

        normals = between(old.normals)
        return replace(
            old,
            vertices=between(old.vertices),
            normals=normals / np.linalg.norm(normals, axis=1, keepdims=True),
            uvs=between(old.uvs),
            faces=faces,
            bone_ids=np.concatenate([old.bone_ids, old.bone_ids[nearer]]),
            weights=np.concatenate([old.weights, old.weights[nearer]]),
        )


def _grid(rows: int, columns: int) -> NDArray[np.int32]:
    i = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])
    return faces.reshape(-1, 3).astype(np.int32)


def _inside(name: str, points: Array, columns: int, colour: tuple[float, ...]) -> Garment:
    """A part of the inside of the head: a grid of points that is seen from the front."""
    rows = len(points) // columns
    faces = _grid(rows, columns)
    corners = points[faces]
    normals = np.zeros_like(points)
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    if flat[:, 0].sum() < 0:
        faces, flat = faces[:, ::-1].copy(), -flat
    for k in range(3):
        np.add.at(normals, faces[:, k], flat)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    bones = np.zeros((len(points), 4), np.uint8)
    bones[:, 0] = INDEX["head"]
    weights = np.zeros((len(points), 4), np.float32)
    weights[:, 0] = 1.0
    red, green, blue, _ = colour
    return Garment(
        name,
        points.astype(np.float32),
        normals.astype(np.float32),
        np.zeros((len(points), 2), np.float32),
        faces,
        bones,
        weights,
        Material(name, (red, green, blue, 1.0), shininess=0.3),
    )


def _mouth() -> Garment:
    """A dark hollow behind the lips."""
    rows, columns = 9, 13
    up, side = np.meshgrid(
        np.radians(np.linspace(-88, 88, rows)), np.radians(np.linspace(-88, 88, columns)),
        indexing="ij",
    )  # fmt: skip
    points = np.stack(
        [
            0.0800 - 0.028 * np.cos(up) * np.cos(side),
            0.0215 * np.sin(side) * np.cos(up * 0.6),
            _MOUTH_Z + 0.0006 + 0.0065 * np.sin(up),
        ],
        axis=-1,
    ).reshape(-1, 3)
    return _inside("mouth", points, columns, _MOUTH_SKIN)


def _teeth() -> Garment:
    """The upper row of teeth, which the lips hide at rest."""
    columns = 11
    y = np.linspace(-0.0140, 0.0140, columns)
    x = 0.0855 - 0.030 * (np.abs(y) / 0.0225) ** 2
    edges = (_MOUTH_Z + 0.0060, _MOUTH_Z - 0.0030)
    rows = [np.stack([x, y, np.full(columns, z)], 1) for z in edges]
    return _inside("teeth", np.concatenate(rows), columns, _TEETH)


def _smooth(value: Array, low: float, high: float) -> Array:
    """0 up to `low`, 1 from `high` on, and smooth between."""
    t = np.clip((value - low) / (high - low), 0.0, 1.0)
    return np.asarray(t * t * (3 - 2 * t))


def _about(points: Array, center: tuple[float, float, float], radius_m: float) -> Array:
    """(N, 1) how much of a move around a place each point takes part in."""
    distance = np.linalg.norm((points - center) * [0.6, 1.0, 1.0], axis=1)
    return np.asarray(1.0 - _smooth(distance, 0.0, radius_m))[:, None]


def _turned(points: Array, pivot: Array, angle_rad: float) -> Array:
    """(N, 3) how far points go when they turn about a line along Y."""
    x, z = points[:, 0] - pivot[0], points[:, 2] - pivot[2]
    c, s = np.cos(angle_rad) - 1.0, np.sin(angle_rad)
    return np.stack([x * c + z * s, np.zeros(len(points)), z * c - x * s], axis=1)


def _jaw_share(name: str, p: Array, above: NDArray[np.bool_]) -> Array:
    """(N, 1) how far each point goes with the jaw."""
    if name == "teeth":
        return np.zeros((len(p), 1))
    if name == "mouth":
        return _smooth(-_height(p), -0.004, 0.004)[:, None]
    # The cheeks are drawn along, ever more from the nose down to the chin.
    cheek = _smooth(-p[:, 2], -1.560, -1.505) * _smooth(p[:, 0], 0.0, 0.05)
    lip = (1.0 - _smooth(np.abs(p[:, 1]), 0.0, _HALF_WIDTH_M)) * _smooth(p[:, 0], 0.064, 0.080)
    share = np.where(above, cheek * (1.0 - lip), cheek + (1.0 - cheek) * lip)
    return np.asarray(share * _smooth(p[:, 2], 1.455, 1.490))[:, None]


def _moves(name: str, p: Array, above: NDArray[np.bool_]) -> dict[str, Array]:
    """How far the points of a garment go, by shape."""
    if name in ("lids", "lashes"):
        return _blinks(name, p)
    if name == "eyes":
        return _looks(p)
    if name == "brows":
        return _brows(p)
    if name not in ("head", "mouth", "teeth"):
        return {}
    jaw = _jaw_share(name, p, above) * _turned(p, _HINGE, _JAW_RAD)
    if name != "head":
        # Narrow lips must not show what is behind their corners.
        inward = p * [0.0, -1.0, 0.0]
        return {"jawOpen": jaw, "mouthFunnel": 0.35 * inward, "mouthPucker": 0.5 * inward}
    return {"jawOpen": jaw, **_lips(p, above), **_brows(p)}


def _lips(p: Array, above: NDArray[np.bool_]) -> dict[str, Array]:
    lips = _about(p, (0.090, 0.0, _MOUTH_Z), 0.034)
    up = np.where(above, 1.0, -1.0)[:, None]
    inward = p * [0.0, -1.0, 0.0]
    lower = lips * (~above)[:, None] * _smooth(p[:, 2], 1.508, 1.524)[:, None]
    moves = {
        "mouthFunnel": lips * (0.30 * inward + [0.0050, 0.0, 0.0] + up * [0.0, 0.0, 0.0024]),
        "mouthPucker": lips * (0.42 * inward + [0.0065, 0.0, 0.0]),
        "mouthRollLower": lower * [-0.0035, 0.0, 0.0035],
    }
    for side, y in (("Left", 1.0), ("Right", -1.0)):
        corner = _about(p, (0.082, 0.0262 * y, 1.5347), 0.026)
        moves[f"mouthSmile{side}"] = corner * [-0.0030, 0.0052 * y, 0.0068]
        moves[f"mouthFrown{side}"] = corner * [-0.0010, 0.0015 * y, -0.0062]
    return moves


def _brows(p: Array) -> dict[str, Array]:
    moves = {"browInnerUp": np.zeros_like(p)}
    for side, y in (("Left", 1.0), ("Right", -1.0)):
        inner = _about(p, (0.086, 0.018 * y, 1.631), 0.024)
        outer = _about(p, (0.076, 0.042 * y, 1.632), 0.026)
        moves["browInnerUp"] = moves["browInnerUp"] + inner * [0.0, 0.0, 0.0055]
        moves[f"browOuterUp{side}"] = outer * [0.0, 0.0, 0.0050]
        moves[f"browDown{side}"] = inner * [0.0, -0.0018 * y, -0.0040]
    return moves


def _looks(p: Array) -> dict[str, Array]:
    """The eyeballs turn about their middles, each alone."""
    moves: dict[str, Array] = {}
    for turns, y in zip(LOOKS.values(), (_EYE_Y, -_EYE_Y), strict=True):
        arm = p - REST[INDEX["eyelids"]] - [0.0, y, 0.0]
        own = (p[:, 1] * y > 0)[:, None]
        moves |= {shape: own * (arm @ turn.T - arm) for shape, turn in turns.items()}
    return moves


def _blinks(name: str, p: Array) -> dict[str, Array]:
    """The upper lids come down and lie flush with the face; the lashes go with their edge."""
    angle, out_m = (LIDS_CLOSED_RAD, 0.0017) if name == "lids" else (_LASHES_RAD, 0.0022)
    left = (p[:, 1] > 0)[:, None]
    hinge = REST[INDEX["eyelids"]]
    beside = np.array([0.0, _EYE_Y, 0.0])
    eyes = np.where(left, hinge + beside, hinge - beside)
    shut = _turned(p, hinge, angle)
    radial = p + shut - eyes
    shut += out_m * radial / np.linalg.norm(radial, axis=1, keepdims=True)
    return {"eyeBlinkLeft": shut * left, "eyeBlinkRight": shut * ~left}
