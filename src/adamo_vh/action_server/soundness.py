"""What must hold in every state of every engine, whatever led to it.

Each function gives sentences on what is wrong, and nothing else.
"""

from __future__ import annotations

import numpy as np

from adamo_vh.action import Action, Drop, Feedback, Look, Outcome, Pick, Walk
from adamo_vh.engine import ObjectState, WorldState
from adamo_vh.geometry import Vec3
from adamo_vh.observation import Observation, Percept

DEPTH_M = 0.003
"""How deep things may be in the floor or in a wall: contacts are a little soft."""
AS_ASKED_M = 0.05
"""What is called done ended this close to the wish."""


def state_faults(state: WorldState) -> list[str]:
    """What is wrong with a state of a world."""
    ids = [item.id for item in state.objects]
    faults = [] if ids == sorted(set(ids)) else [f"the objects are not ordered by id: {ids}"]
    faults += _hand(state)
    if state.body.position.z != 0.0:
        faults.append(f"the body floats at {state.body.position.z:.4f} m")
    if not state.scene.is_within_walls(state.body.position, 0.0):
        faults.append(f"the body at {state.body.position} is not inside the room")
    for item in state.objects:
        faults += _inside(item, state)
        if not item.held and item.support is None:
            faults.append(f"object {item.id} at {item.box.center} rests on nothing")
    return faults


def _hand(state: WorldState) -> list[str]:
    flagged = [item.id for item in state.objects if item.held]
    held = state.body.held
    wanted = [] if held is None else [held]
    if flagged != wanted:
        return [f"objects {flagged} say that they are held, the hand holds {wanted}"]
    felt = state.body.held_box
    if (held is None) != (felt is None) or (held is not None and felt != state.object(held).box):
        return [f"the hand holds {held}, but feels {felt}"]
    return []


def _inside(item: ObjectState, state: WorldState) -> list[str]:
    room, corners = state.scene, item.box.corners()
    low, high = corners.min(axis=0), corners.max(axis=0)
    floor = np.array([room.x_min, room.y_min, 0.0]) - DEPTH_M
    ceiling = np.array([room.x_max, room.y_max, room.height_m]) + DEPTH_M
    if (low >= floor).all() and (high <= ceiling).all():
        return []
    return [f"object {item.id} at {item.box.center} is not inside the room"]


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
            wish = before.scene.nearest(Vec3(action.x, action.y, action.z))
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
