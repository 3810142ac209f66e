"""A saved state of the built-in engine, as compressed JSON: it may come from elsewhere."""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass
from functools import cache

from pydantic import TypeAdapter, ValidationError

from adamo_vh.errors import EngineError
from adamo_vh.runtime.embodiment import Stance
from adamo_vh.runtime.world import CompiledWorld

_MAX_BYTES = 5_000_000


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Everything that decides what happens next."""

    scene: str
    qpos: tuple[float, ...]
    body: Stance
    said: tuple[str, ...]
    absent: tuple[int, ...] = ()
    """Objects that somebody took out of the room."""
    lights: tuple[float, ...] | None = None
    """How bright the lights are; None in old snapshots, where they are as in the scene."""

    def pack(self) -> bytes:
        """The snapshot as bytes."""
        return zlib.compress(_codec().dump_json(self))

    @staticmethod
    def unpack(data: bytes, world: CompiledWorld) -> Snapshot:
        """Read a snapshot of a world.

        Raises:
            EngineError: It is damaged, or of another scene.
        """
        try:
            # A bound on the size: snapshots may come from elsewhere.
            text = zlib.decompressobj().decompress(data, _MAX_BYTES)
            kept = _codec().validate_json(text)
        except (zlib.error, ValidationError, ValueError) as error:
            raise EngineError(f"The snapshot is damaged: {error}") from None
        if kept.scene != world.name or len(kept.qpos) != world.model.nq:
            raise EngineError(
                f"The snapshot is of scene {kept.scene!r}, the engine has {world.name!r}."
            )
        if fault := kept.fault(world):
            raise EngineError(f"The snapshot is damaged: {fault}")
        return kept

    def fault(self, world: CompiledWorld) -> str:
        """What no state of a world can have; empty if there is nothing."""
        at, gaze = self.body.position, self.body.gaze
        numbers = (*self.qpos, at.x, at.y, at.z, self.body.heading_rad, gaze.x, gaze.y, gaze.z)
        named = {*self.absent, *([] if self.body.held is None else [self.body.held])}
        lights = world.brightness if self.lights is None else self.lights
        if not all(map(math.isfinite, (*numbers, *lights))):
            return "a number in it is not finite"
        if unknown := named - set(world.objects):
            return f"the scene has no object {min(unknown)}"
        if self.body.held in self.absent:
            return f"object {self.body.held} is in the hand and out of the room"
        if len(lights) != len(world.brightness):
            return f"it has {len(lights)} lights, the scene {len(world.brightness)}"
        return ""


@cache
def _codec() -> TypeAdapter[Snapshot]:
    return TypeAdapter(Snapshot)
