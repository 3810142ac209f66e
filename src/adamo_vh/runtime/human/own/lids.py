"""Lids of an own figure in MuJoCo: its face closes them by a shape, not by a joint as ours do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from adamo_vh.runtime.human.looks import LIDS_CLOSED_RAD, Figure
from adamo_vh.runtime.human.skeleton import INDEX, Pose

if TYPE_CHECKING:
    import mujoco

_JOINT = INDEX["eyelids"]
_SHAPES = ("eyeBlinkLeft", "eyeBlinkRight")


@dataclass(frozen=True, slots=True, eq=False)
class Lids:
    """The parts of a model that move when the eyes close."""

    model: mujoco.MjModel
    parts: tuple[tuple[slice, NDArray[np.float32], NDArray[np.float32]], ...]
    """Where the vertices of each are in the model, where they are with open eyes, and how far they
    go until the eyes are shut, (N, 3)."""

    @classmethod
    def of(cls, model: mujoco.MjModel, figure: Figure) -> Lids:
        """The lids of a figure that is in a model; none of a figure whose lids are a joint."""
        parts = []
        for number, garment in enumerate(figure.garments):
            moves = (figure.shapes or {}).get(garment.name, {})
            shut = [moves[shape] for shape in _SHAPES if shape in moves]
            has_joint = bool((garment.weights[garment.bone_ids == _JOINT] > 0).any())
            if shut and not has_joint:
                start, count = int(model.skin_vertadr[number]), len(garment.vertices)
                parts.append((slice(start, start + count), garment.vertices, np.sum(shut, axis=0)))
        return cls(model, tuple(parts))

    def follow(self, pose: Pose) -> None:
        """Close the eyes as far as a pose has them; the next drawing shows it."""
        if not self.parts:
            return
        turn = pose.rotations[_JOINT]
        share = np.clip(np.arctan2(turn[0, 2], turn[0, 0]) / LIDS_CLOSED_RAD, 0.0, 1.0)
        for where, still, moves in self.parts:
            self.model.skin_vert[where] = still + np.float32(share) * moves
