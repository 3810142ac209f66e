"""What must hold in every state of the world, however it came about.

For tests and measurements: each function gives sentences on what is wrong, and nothing else.
"""

from __future__ import annotations

import numpy as np

from adamo_vh.action import Action, Drop, Feedback, Look, Outcome, Pick, Walk
from adamo_vh.engine import ObjectState, WorldState
from adamo_vh.geometry import Vec3
from adamo_vh.observation import NOTHING, Observation, Percept
from adamo_vh.runtime.navigation import BODY_HEIGHT_M, BODY_RADIUS_M
from adamo_vh.runtime.solids import Solids
from adamo_vh.runtime.world import CompiledWorld

DEPTH_M = 0.003
"""How deep things may be in each other, in the floor or in a wall: contacts are a little soft."""
BODY_M = 0.001
"""How much nearer than its radius the body may be to furniture or a wall."""
AS_ASKED_M = 0.05
"""What is called done ended this close to the wish."""


class Soundness:
    """The rules of one world."""

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

    def state_faults(self, state: WorldState) -> list[str]:
        """What is wrong with a state of the world as it is now."""
        held = state.body.held
        faults = [*self._hand(state), *self._body(state), *self._contacts(held)]
        for item in state.objects:
            faults += self._inside(item, state)
            # What is held floats before the chest, also where that is in furniture.
            if not item.held:
                faults += self._resting(item)
        return faults

    @staticmethod
    def _hand(state: WorldState) -> list[str]:
        flagged = [item.id for item in state.objects if item.held]
        wanted = [] if state.body.held is None else [state.body.held]
        if flagged == wanted:
            return []
        return [f"objects {flagged} say that they are held, the hand holds {wanted}"]

    def _body(self, state: WorldState) -> list[str]:
        room, at = state.scene, state.body.position
        walls = min(at.x - room.x_min, room.x_max - at.x, at.y - room.y_min, room.y_max - at.y)
        furniture = float(self._obstacles.distance(np.array([[at.x, at.y]]))[0])
        nearest = min(walls, furniture)
        faults = []
        if not nearest >= BODY_RADIUS_M - BODY_M:
            faults.append(f"the body at {at} is {nearest:.4f} m from furniture or a wall")
        if at.z != 0.0:
            faults.append(f"the body floats at {at.z:.4f} m")
        return faults

    @staticmethod
    def _inside(item: ObjectState, state: WorldState) -> list[str]:
        room, corners = state.scene, item.box.corners()
        low, high = corners.min(axis=0), corners.max(axis=0)
        floor = np.array([room.x_min, room.y_min, 0.0]) - DEPTH_M
        ceiling = np.array([room.x_max, room.y_max, room.height_m]) + DEPTH_M
        if (low >= floor).all() and (high <= ceiling).all():
            return []
        return [f"object {item.id} at {item.box.center} is not inside the room"]

    def _resting(self, item: ObjectState) -> list[str]:
        faults = []
        if item.support is None:
            faults.append(f"object {item.id} at {item.box.center} rests on nothing")
        if self._furniture.hold(item.box.center.array()[None], DEPTH_M)[0]:
            faults.append(f"object {item.id} at {item.box.center} is inside furniture")
        return faults

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


def step_faults(
    before: WorldState, after: WorldState, action: Action, feedback: Feedback
) -> list[str]:
    """Where the feedback on an action does not say what happened.

    Args:
        before: The world before the action.
        after: The world after it.
        action: What was asked for.
        feedback: What the agent is told.
    """
    if feedback.outcome is Outcome.REFUSED:
        return [] if after.hash() == before.hash() else ["a refused action changed the world"]
    match action:
        case Look() | Walk():
            faults = _nothing_moved(before, after)
            wish = Vec3(action.x, action.y, action.z)
            reached = after.body.gaze.distance(wish)
            if isinstance(action, Walk):
                reached = after.body.position.horizontal_distance(wish)
            if feedback.outcome is Outcome.DONE and reached > AS_ASKED_M + 1e-6:
                faults.append(f"done, but {reached:.3f} m away from the wish {wish}")
            return faults
        case Pick():
            taken = before.body.held is None and after.body.held is not None
            return [] if taken else ["the hand did not take anything"]
        case Drop():
            return _dropped(before, after, action, feedback)
        case _:
            return []


def _nothing_moved(before: WorldState, after: WorldState) -> list[str]:
    held = before.body.held
    if after.body.held != held:
        return ["the hand holds something else"]
    pairs = zip(before.objects, after.objects, strict=True)
    return [f"object {a.id} moved" for a, b in pairs if a.box != b.box and a.id != held]


def _dropped(before: WorldState, after: WorldState, action: Drop, feedback: Feedback) -> list[str]:
    held = before.body.held
    if held is None or after.body.held is not None:
        return ["the hand did not let go"]
    center = after.object(held).box.center
    missed = center.horizontal_distance(Vec3(action.x, action.y, action.z))
    if feedback.outcome is Outcome.DONE and missed > AS_ASKED_M + 1e-6:
        return [f"done, but object {held} lies {missed:.3f} m beside the wish"]
    return []


def view_faults(
    percept: Percept, observation: Observation, ids: dict[str, int], state: WorldState
) -> list[str]:
    """Where an observation says what its picture does not show.

    Args:
        percept: The raw capture.
        observation: What was made of it.
        ids: Object by tag.
        state: The world then.
    """
    faults = []
    tags = [item.tag for item in observation.objects]
    if len(set(tags)) != len(tags):
        faults.append(f"a tag is listed twice: {tags}")
    for item in observation.objects:
        shows = np.logical_or.reduce([layer == ids[item.tag] for layer in percept.id_layers])
        rows, columns = np.nonzero(shows.any(axis=1))[0], np.nonzero(shows.any(axis=0))[0]
        if not len(rows):
            faults.append(f"{item.tag} is listed, but not one pixel shows it")
            continue
        tight = (columns[0], rows[0], columns[-1] + 1, rows[-1] + 1)
        if item.box_px != tight or item.pixels != int(shows.sum()):
            faults.append(f"the box {item.box_px} of {item.tag} is not tight: {tight}")
        if item.position != state.object(ids[item.tag]).box.center:
            faults.append(f"{item.tag} is not at {item.position}")
    return faults
