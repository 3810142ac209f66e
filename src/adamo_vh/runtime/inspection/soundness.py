"""What must hold in every state of the built-in engine, beyond what holds in every engine."""

from __future__ import annotations

import numpy as np

from adamo_vh.engine import ObjectState, WorldState
from adamo_vh.observation import NOTHING
from adamo_vh.runtime.navigation import BODY_HEIGHT_M, BODY_RADIUS_M
from adamo_vh.runtime.solids import Solids
from adamo_vh.runtime.world import CompiledWorld

DEPTH_M = 0.003
"""How deep things may be in each other: contacts are a little soft."""
BODY_M = 0.001
"""How much nearer than its radius the body may be to furniture or a wall."""


class Soundness:
    """The rules of one compiled world."""

    def __init__(self, world: CompiledWorld) -> None:
        """Take the furniture of a world.

        Args:
            world: Is read, never changed.
        """
        self._world = world
        self._furniture = Solids.of(world.solids)
        self._obstacles = Solids.of(
            [s for s in world.solids if s.overlaps_height(0.0, BODY_HEIGHT_M)]
        )

    def faults(self, state: WorldState) -> list[str]:
        """What is wrong with a state of the world as it is now."""
        faults = [*self._body(state), *self._contacts(state.body.held)]
        for item in state.objects:
            # What is held floats before the chest, also where that is in furniture.
            if not item.held:
                faults += self._resting(item)
        return faults

    def _body(self, state: WorldState) -> list[str]:
        room, at = state.scene, state.body.position
        walls = min(at.x - room.x_min, room.x_max - at.x, at.y - room.y_min, room.y_max - at.y)
        furniture = float(self._obstacles.distance(np.array([[at.x, at.y]]))[0])
        nearest = min(walls, furniture)
        if nearest >= BODY_RADIUS_M - BODY_M:
            return []
        return [f"the body at {at} is {nearest:.4f} m from furniture or a wall"]

    def _resting(self, item: ObjectState) -> list[str]:
        if self._furniture.hold(item.box.center.array()[None], DEPTH_M)[0]:
            return [f"object {item.id} at {item.box.center} is inside furniture"]
        return []

    def _contacts(self, held: int | None) -> list[str]:
        contact, owner = self._world.data.contact, self._world.object_of_geom
        faults = []
        for i in np.flatnonzero(contact.dist < -DEPTH_M):
            pair = {int(owner[geom]) for geom in contact.geom[i]}
            if pair != {NOTHING} and held not in pair:
                names = " and ".join(
                    "a fixed thing" if j == NOTHING else f"object {j}" for j in pair
                )
                faults.append(f"{names} are {-contact.dist[i]:.4f} m in each other")
        return faults
