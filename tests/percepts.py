"""Percepts made by hand, with known pixels, for tests without an engine."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array, Box, Camera, Vec3
from adamo_vh.observation import NOTHING, BodyState, Percept, SeenObject

EYES = Vec3(-2.0, -1.0, 1.6)
GAZE = Vec3(0.51, -1.25, 0.8)
TABLE_TOP_M = 0.78

NAMES = {
    0: "Lock",
    2: "Flashlight",
    3: "Battery",
    4: "Tape",
    5: "Screwdriver",
    8: "PeanutButter",
    18: "Lock",
    19: "TomatoSoup",
    20: "Pills",
    21: "Binoculars",
    23: "Painkiller",
    27: "Lighter",
    30: "Battery",
    34: "Key",
    36: "WineBottle",
    37: "Glass",
    45: "Cup",
    50: "IndoorPlant",
    57: "Plate",
}

PixelBox = tuple[int, int, int, int]


def camera(width_px: int, height_px: int) -> Camera:
    """From the eyes to the table."""
    away = GAZE - EYES
    return Camera(
        position=EYES,
        yaw_rad=math.atan2(away.y, away.x),
        pitch_rad=math.atan2(away.z, math.hypot(away.x, away.y)),
        fov_y_rad=math.radians(65),
        width_px=width_px,
        height_px=height_px,
    )


def ids(width_px: int, height_px: int, boxes: Mapping[int, PixelBox]) -> NDArray[np.int16]:
    """An id layer of filled boxes, later ones in front."""
    layer = np.full((height_px, width_px), NOTHING, dtype=np.int16)
    for object_id, (left, top, right, bottom) in boxes.items():
        layer[top:bottom, left:right] = object_id
    return layer


def percept(
    *layers: NDArray[np.int16],
    boxes: Mapping[int, Box] | None = None,
    held: int | None = None,
) -> Percept:
    """A percept of id layers over a wooden brown; objects without a box get a 10 cm cube."""
    height_px, width_px = layers[0].shape
    cube = Box(Vec3(0.0, -1.0, 0.83), Vec3(0.1, 0.1, 0.1))
    shown = sorted({int(i) for layer in layers for i in np.unique(layer)} - {NOTHING})
    objects = {i: SeenObject(i, NAMES.get(i, "Thing"), (boxes or {}).get(i, cube)) for i in shown}
    rgb = np.full((height_px, width_px, 3), (150, 110, 70), dtype=np.uint8)
    rgb[layers[0] != NOTHING] = (60, 90, 120)
    body = BodyState(Vec3(EYES.x, EYES.y, 0.0), 0.0, GAZE, EYES, held)
    return Percept(rgb, layers, objects, body, camera(width_px, height_px))


def tabletop(width_px: int, height_px: int) -> Percept:
    """All 19 objects on a table, farther ones partly behind nearer ones."""
    rng = np.random.default_rng(7)
    boxes = {}
    for number, object_id in enumerate(NAMES):
        column, row = divmod(number, 4)
        size = Vec3.of(rng.uniform(0.03, 0.2, 3))
        center = Vec3(0.4 - 0.25 * row, -1.75 + 0.35 * column, TABLE_TOP_M + size.z / 2)
        boxes[object_id] = Box(center, size)
    view = camera(width_px, height_px)
    pixels = {}
    for object_id, box in sorted(boxes.items(), key=lambda item: -item[1].center.x):
        uv = view.project(box.corners())[:, :2]
        left, top = np.floor(uv.min(axis=0)).astype(int).clip(0)
        right, bottom = np.ceil(uv.max(axis=0)).astype(int)
        pixels[object_id] = (int(left), int(top), int(right), int(bottom))
    return percept(ids(width_px, height_px, pixels), boxes=boxes)


def floor_hits(origin: Vec3, directions: Array) -> list[Vec3 | None]:
    """A world that is nothing but a floor."""
    return [
        origin + Vec3.of(direction) * (-origin.z / direction[2]) if direction[2] < 0 else None
        for direction in directions
    ]


def sphere_hits(origin: Vec3, directions: Array) -> list[Vec3 | None]:
    """A world in which every ray ends after 4 m."""
    return [origin + Vec3.of(direction) * 4.0 for direction in directions]
