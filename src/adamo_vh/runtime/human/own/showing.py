"""Draw a figure in a few postures on one sheet: what the check of an own figure shows."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Camera, Vec3
from adamo_vh.runtime.human.gait import gait
from adamo_vh.runtime.human.handling import Handling
from adamo_vh.runtime.human.looks import Figure
from adamo_vh.runtime.human.postures import gazing, standing
from adamo_vh.runtime.human.route import route
from adamo_vh.runtime.human.skeleton import Pose, joint_frames
from adamo_vh.runtime.human.skin_mujoco import add_human, pose_human
from adamo_vh.runtime.rendering import SceneRenderer

_SIZE_PX = (360, 640)
"""Width and height of one picture."""
_AHEAD = np.array([1.0, 0.0, 0.0])
_LIGHTS = ((3.0, 2.0, 3.5), (2.0, -3.0, 2.5), (-3.0, 0.0, 3.0))
Picture = NDArray[np.uint8]


def sheet(figure: Figure) -> Picture:
    """(H, W, 3) the figure standing, from the side, its face, walking, reaching and holding.

    Raises:
        RenderingError: There is no OpenGL.
    """
    import mujoco

    spec = mujoco.MjSpec()
    for place in _LIGHTS:
        light = spec.worldbody.add_light(pos=place, dir=[-place[0], -place[1], 0.9 - place[2]])
        light.diffuse, light.ambient, light.castshadow = [0.45] * 3, [0.12] * 3, False
    add_human(spec, figure)
    model = spec.compile()
    data = mujoco.MjData(model)
    renderer = SceneRenderer(model, np.empty(0, np.int16))
    drawn = []
    try:
        for pose, camera in _views():
            pose_human(model, data, *joint_frames(pose))
            mujoco.mj_forward(model, data)
            picture = renderer.color(data, camera, head=True)
            # Nothing is behind it: what is black all through is the background.
            drawn.append(np.where(picture.max(axis=2, keepdims=True) < 3, 232, picture))
    finally:
        renderer.close()
    return np.concatenate(drawn, axis=1).astype(np.uint8)


def _views() -> Iterator[tuple[Pose, Camera]]:
    still = gazing(standing(), _AHEAD)
    steps = gait(route(0.0, [Vec3(0.0, 0.0, 0.0), Vec3(9.0, 0.0, 0.0)], 0.0))
    walking = gazing(steps.pose(steps.duration_s / 2 + 0.1), _AHEAD)
    hand = Handling(np.array([0.55, -0.10, 0.85]), _AHEAD, takes=True)
    yield still, _from(20.0, 3.0, 0.92)
    yield still, _from(90.0, 3.0, 0.92)
    yield still, _from(20.0, 0.85, 1.58)
    yield walking, _from(60.0, 3.0, 0.92)
    yield hand.pose(hand.event_s), _from(-60.0, 3.0, 0.92)
    yield hand.pose(hand.duration_s - 1e-3), _from(-30.0, 1.7, 1.15)


def _from(degrees: float, away_m: float, height_m: float) -> Camera:
    """A camera around the figure, 0 degrees before it, 90 at its left."""
    angle = math.radians(degrees)
    at = Vec3(away_m * math.cos(angle), away_m * math.sin(angle), height_m + 0.1 * away_m)
    return Camera.towards(at, Vec3(0.0, 0.0, height_m), math.radians(42.0), _SIZE_PX)
