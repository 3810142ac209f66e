"""The face in MuJoCo: eyes turn by shapes, and so do lids that no joint closes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from adamo_vh.runtime.human.face import eye_shapes, look_shares
from adamo_vh.runtime.human.looks import LIDS_CLOSED_RAD, Figure, Garment
from adamo_vh.runtime.human.skeleton import INDEX, Pose

if TYPE_CHECKING:
    import mujoco

_LIDS = INDEX["eyelids"]


@dataclass(frozen=True, slots=True, eq=False)
class _Part:
    """A garment that moves by shapes."""

    where: slice
    """Its vertices in the model."""
    still: NDArray[np.float32]
    """(N, 3) where they are at rest."""
    moves: Mapping[str, NDArray[np.float32]]
    """By shape, (N, 3) how far they go."""


@dataclass(frozen=True, slots=True, eq=False)
class FaceParts:
    """The parts of a model that move with eyes and lids."""

    model: mujoco.MjModel
    parts: tuple[_Part, ...]

    @classmethod
    def of(cls, model: mujoco.MjModel, figure: Figure) -> FaceParts:
        """Those of a figure that is in a model."""
        parts = []
        for number, garment in enumerate(figure.garments):
            if moves := _moves(figure, garment):
                start, count = int(model.skin_vertadr[number]), len(garment.vertices)
                parts.append(_Part(slice(start, start + count), garment.vertices, moves))
        return cls(model, tuple(parts))

    def follow(self, pose: Pose, look_rad: tuple[float, float]) -> None:
        """Move them as a moment has it; the next drawing shows it.

        Args:
            pose: How far the eyes are shut.
            look_rad: How they are turned in the head: to the left, and down.
        """
        if not self.parts:
            return
        turn = pose.rotations[_LIDS]
        shut = float(np.clip(np.arctan2(turn[0, 2], turn[0, 0]) / LIDS_CLOSED_RAD, 0.0, 1.0))
        shares = look_shares(*look_rad) | {"eyeBlinkLeft": shut, "eyeBlinkRight": shut}
        for part in self.parts:
            moved = part.still
            for shape, move in part.moves.items():
                if share := shares[shape]:
                    moved = moved + np.float32(share) * move
            self.model.skin_vert[part.where] = moved


def _moves(figure: Figure, garment: Garment) -> dict[str, NDArray[np.float32]]:
    if figure.shapes is None:
        return eye_shapes(garment)
    has_joint = bool((garment.weights[garment.bone_ids == _LIDS] > 0).any())
    names = ("eyeLook",) if has_joint else ("eyeLook", "eyeBlink")
    shapes = figure.shapes.get(garment.name, {})
    return {shape: move for shape, move in shapes.items() if shape.startswith(names)}
