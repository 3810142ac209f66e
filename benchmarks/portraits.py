"""Render the people from all sides and in bent poses, to look at.

python benchmarks/portraits.py --out portraits            # all
python benchmarks/portraits.py --out portraits mara       # one
"""

from __future__ import annotations

import argparse
import math
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from adamo_vh.runtime.human.looks import LIDS_CLOSED_RAD, VARIANTS, load_figure
from adamo_vh.runtime.human.skeleton import INDEX, REST, Pose, joint_frames
from adamo_vh.runtime.human.skin_mujoco import add_human, pose_human

if TYPE_CHECKING:
    import mujoco
    from numpy.typing import NDArray

    from adamo_vh.geometry import Array

WIDTH, HEIGHT = 720, 960
Bend = Mapping[str, tuple[float, float, float]]
"""Turns in degrees about X, then Y, then Z of named joints."""

_ARMS_DOWN: Bend = {
    "upper_arm_l": (-27, 0, 0), "upper_arm_r": (27, 0, 0),
    "forearm_l": (0, -14, 0), "forearm_r": (0, -14, 0),
}  # fmt: skip
POSES: dict[str, tuple[Bend, float]] = {
    "rest": ({}, 0.0),
    "stand": (_ARMS_DOWN, 0.0),
    "stride": (
        {
            **_ARMS_DOWN, "thigh_l": (0, -30, 0), "shin_l": (0, 8, 0), "foot_l": (0, 8, 0),
            "thigh_r": (0, 16, 0), "shin_r": (0, 38, 0), "foot_r": (0, 0, 0), "toes_r": (0, -28, 0),
            "upper_arm_l": (-27, 22, 0), "upper_arm_r": (27, -22, 0), "forearm_r": (0, -26, 0),
        }, -0.035,
    ),
    "reach": (
        {
            **_ARMS_DOWN, "spine": (0, 10, 0), "upper_arm_l": (-34, -72, 0),
            "forearm_l": (0, -18, 0), "upper_arm_r": (27, 10, 0),
            "fingers_l": (-25, 0, 0), "head": (0, 12, 0),
        }, 0.0,
    ),
    "crouch": (
        {
            **_ARMS_DOWN, "pelvis": (0, 24, 0), "spine": (0, 16, 0),
            "thigh_l": (0, -112, 0), "thigh_r": (0, -112, 0),
            "shin_l": (0, 118, 0), "shin_r": (0, 118, 0),
            "foot_l": (0, -30, 0), "foot_r": (0, -30, 0),
            "upper_arm_l": (-27, -75, 0), "upper_arm_r": (27, -75, 0), "neck": (0, -20, 0),
        }, -0.40,
    ),
    "bent_elbow": (
        {
            "upper_arm_l": (-30, -12, 0), "forearm_l": (0, -112, 0), "fingers_l": (-70, 0, 0),
            "upper_arm_r": (-50, 0, 0), "head": (0, 0, 30),
            "eyelids": (0, math.degrees(LIDS_CLOSED_RAD), 0),
        }, 0.0,
    ),
}  # fmt: skip
SHOTS: dict[str, tuple[str, float, float, float, float]] = {
    # name: pose, azimuth and elevation in degrees, height and extent of the view in metres
    "front": ("stand", 180, -4, 0.87, 1.9),
    "side": ("stand", 90, -4, 0.87, 1.9),
    "back": ("stand", 0, -4, 0.87, 1.9),
    "three_quarter": ("stand", 142, -10, 0.87, 1.9),
    "rest": ("rest", 180, -4, 0.87, 1.9),
    "face": ("stand", 172, -3, 1.585, 0.36),
    "face_three_quarter": ("stand", 138, -2, 1.585, 0.36),
    "face_side": ("stand", 90, -2, 1.585, 0.36),
    "stride": ("stride", 105, -6, 0.87, 1.9),
    "reach": ("reach", 130, -8, 0.87, 1.9),
    "crouch": ("crouch", 125, -12, 0.6, 1.6),
    "bent_elbow": ("bent_elbow", 160, -4, 1.25, 1.0),
    "hand": ("rest", 215, -5, 0.90, 0.36),
    "eyes_closed": ("bent_elbow", 150, -2, 1.585, 0.36),
    "feet": ("stand", 130, -25, 0.1, 0.6),
}


def main(arguments: Sequence[str] | None = None) -> None:
    """Parse the command line, render, save."""
    from PIL import Image

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("names", nargs="*", help="people; all when none is named")
    parser.add_argument("--shots", nargs="*", default=list(SHOTS), help="which views")
    parser.add_argument("--out", type=Path, required=True, help="folder for the pictures")
    options = parser.parse_args(arguments)
    # Read when MuJoCo is imported, which happens below.
    os.environ.setdefault("MUJOCO_GL", "egl")
    options.out.mkdir(parents=True, exist_ok=True)
    for name in options.names or VARIANTS:
        pictures = render(name, options.shots)
        for shot, picture in pictures.items():
            Image.fromarray(picture).save(options.out / f"{name}_{shot}.png")
        Image.fromarray(contact_sheet(pictures)).save(options.out / f"{name}.png")


def stage(name: str) -> mujoco.MjSpec:
    """A person on a neutral floor, in the light of a living room."""
    import mujoco

    spec = mujoco.MjSpec()
    spec.visual.global_.offwidth, spec.visual.global_.offheight = WIDTH, HEIGHT
    spec.visual.global_.fovy = 22.0
    spec.visual.quality.shadowsize = 4096
    spec.visual.quality.offsamples = 4
    spec.visual.map.znear, spec.visual.map.zfar = 0.02, 50.0
    spec.visual.headlight.ambient = (0.42, 0.42, 0.42)
    spec.visual.headlight.diffuse = (0.30, 0.30, 0.30)
    spec.visual.headlight.specular = (0.0, 0.0, 0.0)
    spec.add_texture(
        name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, width=64, height=384,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=(0.80, 0.79, 0.77), rgb2=(0.62, 0.60, 0.57),
    )  # fmt: skip
    spec.stat.extent, spec.stat.center = 1.0, (0.0, 0.0, 0.9)
    floor = mujoco.mjtGeom.mjGEOM_PLANE
    spec.worldbody.add_geom(type=floor, size=(20, 20, 0.1), rgba=(0.66, 0.62, 0.57, 1))
    key = spec.worldbody.add_light(
        pos=(2.2, 1.8, 3.6), dir=(-2.2, -1.8, -2.7), diffuse=(0.46, 0.45, 0.43),
        specular=(0.35, 0.35, 0.35), castshadow=True,
    )  # fmt: skip
    key.type = mujoco.mjtLightType.mjLIGHT_SPOT
    key.cutoff, key.exponent = 26.0, 0.0
    add_human(spec, load_figure(name))
    return spec


def pose(bend: Bend, lower_m: float) -> tuple[Array, Array]:
    """World frames of the joints for turns given in degrees."""
    from scipy.spatial.transform import Rotation

    rotations = np.tile(np.eye(3), (len(REST), 1, 1))
    for joint, angles in bend.items():
        rotations[INDEX[joint]] = Rotation.from_euler("xyz", angles, degrees=True).as_matrix()
    return joint_frames(Pose(rotations, np.array([0.0, 0.0, lower_m])))


def render(name: str, shots: Sequence[str]) -> dict[str, NDArray[np.uint8]]:
    """The pictures of one person, (H, W, 3) each."""
    import mujoco

    model = stage(name).compile()
    data = mujoco.MjData(model)
    camera = mujoco.MjvCamera()
    pictures = {}
    with mujoco.Renderer(model, HEIGHT, WIDTH) as renderer:
        for shot in shots:
            bend, azimuth, elevation, height_m, extent_m = SHOTS[shot]
            pose_human(model, data, *pose(*POSES[bend]))
            mujoco.mj_forward(model, data)
            side_m = 0.57 if shot == "hand" else 0.0
            camera.lookat[:] = (0.0, side_m, height_m)
            camera.azimuth, camera.elevation = (
                azimuth + 180 if shot == "side" else azimuth,
                elevation,
            )
            camera.distance = extent_m / 2 / math.tan(math.radians(11.0))
            renderer.update_scene(data, camera)
            pictures[shot] = np.asarray(renderer.render(), dtype=np.uint8).copy()
    return pictures


def contact_sheet(pictures: dict[str, NDArray[np.uint8]]) -> NDArray[np.uint8]:
    """All pictures at half size, side by side."""
    rows = [list(pictures.values())[i : i + 5] for i in range(0, len(pictures), 5)]
    blank = np.zeros((HEIGHT // 2, WIDTH // 2, 3), np.uint8)
    return np.concatenate(
        [
            np.concatenate([*(p[::2, ::2] for p in row), *[blank] * (5 - len(row))], axis=1)
            for row in rows
        ]
    )


if __name__ == "__main__":
    main()
