"""The tabletop world as plain data, and what the four tools do to it, for tests without an engine.

Nothing is corrected here: what cannot be done leaves the world as it is.
"""

from __future__ import annotations

import math
from dataclasses import replace

from adamo_vh.action import Drop, Look, Pick, Walk
from adamo_vh.engine import FLOOR, Area, BodyInfo, ObjectState, SceneInfo, WorldState
from adamo_vh.geometry import Box, Quaternion, Vec3
from adamo_vh.observation import BodyState

BODY = BodyInfo("mara", 0.25, 1.6, math.radians(74), 0.9, 2.07, 0.5)
TABLE = "table"
TABLE_TOP_M = 0.78
TABLE_X = (-0.575, 0.475)
TABLE_Y = (-1.83, -0.17)
STAND_OFF_M = 0.30

# id: class, box size (x, y, z), place on the table (x, y)
OBJECTS = {
    0: ("Lock", (0.045, 0.020, 0.077), (0.076, -1.353)),
    2: ("Flashlight", (0.180, 0.045, 0.045), (-0.360, -0.850)),
    3: ("Battery", (0.046, 0.032, 0.077), (-0.174, -0.853)),
    4: ("Tape", (0.136, 0.136, 0.043), (-0.174, -0.603)),
    5: ("Screwdriver", (0.228, 0.022, 0.021), (-0.360, -1.155)),
    8: ("PeanutButter", (0.109, 0.109, 0.150), (0.076, -0.853)),
    18: ("Lock", (0.061, 0.026, 0.062), (-0.174, -1.353)),
    19: ("TomatoSoup", (0.070, 0.070, 0.105), (0.076, -1.603)),
    20: ("Pills", (0.055, 0.055, 0.085), (-0.420, -1.350)),
    21: ("Binoculars", (0.192, 0.173, 0.069), (0.076, -0.353)),
    23: ("Painkiller", (0.046, 0.046, 0.112), (-0.424, -1.603)),
    27: ("Lighter", (0.070, 0.022, 0.090), (-0.174, -1.103)),
    30: ("Battery", (0.022, 0.023, 0.082), (0.076, -1.103)),
    34: ("Key", (0.055, 0.024, 0.002), (-0.174, -1.603)),
    36: ("WineBottle", (0.063, 0.064, 0.241), (0.326, -1.603)),
    37: ("Glass", (0.100, 0.100, 0.143), (0.326, -1.103)),
    45: ("Cup", (0.149, 0.105, 0.131), (-0.424, -0.353)),
    50: ("IndoorPlant", (0.250, 0.250, 0.340), (0.326, -1.353)),
    57: ("Plate", (0.250, 0.250, 0.030), (0.326, -0.603)),
}

CORNERS = tuple(
    Area(name, "corner", x, y, x + 1, y + 1)
    for name, x, y in (
        ("south-west", -3.0, -5.0),
        ("south-east", 2.0, -5.0),
        ("north-west", -3.0, 2.0),
        ("north-east", 2.0, 2.0),
    )
)
SCENE = SceneInfo("tabletop", -3.0, -5.0, 3.0, 3.0, 3.2, CORNERS)


def tabletop() -> WorldState:
    """The world at the start: all objects on the table, the body beside it."""
    objects = tuple(
        ObjectState(
            i, name, Box(Vec3(x, y, TABLE_TOP_M + size[2] / 2), Vec3.of(size)), TABLE, False
        )
        for i, (name, size, (x, y)) in OBJECTS.items()
    )
    start = Vec3(-2.0, -1.0, 0.0)
    return WorldState(SCENE, objects, BodyState(start, 0.0, Vec3(0.51, -1.25, 1.17), _eyes(start)))


def changed(state: WorldState, item: ObjectState) -> WorldState:
    """The same world with one object replaced."""
    return replace(state, objects=tuple(item if o.id == item.id else o for o in state.objects))


def held(state: WorldState, object_id: int) -> WorldState:
    """The same world with an object in the hand."""
    item = state.object(object_id)
    box = replace(item.box, center=state.body.position + Vec3(0.3, 0.0, 1.0))
    state = changed(state, replace(item, box=box, support=None, held=True))
    return replace(state, body=replace(state.body, held=object_id))


def resting(
    state: WorldState,
    object_id: int,
    x: float,
    y: float,
    support: str = FLOOR,
    yaw_rad: float = 0.0,
) -> WorldState:
    """The same world with an object released upright on the floor or the table."""
    item = state.object(object_id)
    z = (0.0 if support == FLOOR else TABLE_TOP_M) + item.box.size.z / 2
    box = Box(Vec3(x, y, z), item.box.size, Quaternion.from_yaw(yaw_rad))
    state = changed(state, replace(item, box=box, support=support, held=False))
    empty = state.body.held == object_id
    return replace(state, body=replace(state.body, held=None)) if empty else state


def carried_out(state: WorldState, action: Look | Walk | Pick | Drop) -> WorldState:
    """The world after an action; tags are bare ids."""
    match action:
        case Look():
            return _facing(state, Vec3(action.x, action.y, action.z))
        case Walk():
            return _beside(state, Vec3(action.x, action.y, 0.0))
        case Pick(object=tag):
            if state.body.held is not None:
                return state
            return held(_within_reach(state, state.object(int(tag)).box.center), int(tag))
        case Drop(object=tag):
            return _put(state, int(tag), Vec3(action.x, action.y, action.z))


def _on_table(size: tuple[float, float, float], x: float, y: float) -> Box:
    return Box(Vec3(x, y, TABLE_TOP_M + size[2] / 2), Vec3.of(size))


def _put(state: WorldState, object_id: int, point: Vec3) -> WorldState:
    radius = math.hypot(*state.object(object_id).box.size.array()[:2]) / 2
    above = _over_table(point, margin_m=0.0)
    if state.body.held != object_id or (point.z == 0.0 and _over_table(point, margin_m=radius)):
        return state
    if point.z > 0.0 and (not above or abs(point.z - TABLE_TOP_M) > 0.01):
        return state
    state = _within_reach(state, point)
    return resting(state, object_id, point.x, point.y, TABLE if above else FLOOR)


def _over_table(point: Vec3, margin_m: float) -> bool:
    return (
        TABLE_X[0] - margin_m <= point.x <= TABLE_X[1] + margin_m
        and TABLE_Y[0] - margin_m <= point.y <= TABLE_Y[1] + margin_m
    )


def _within_reach(state: WorldState, point: Vec3) -> WorldState:
    near = state.body.position.horizontal_distance(point) <= 0.9
    return _facing(state if near else _beside(state, point), point)


def _beside(state: WorldState, point: Vec3) -> WorldState:
    """The body at a point, or at the edge of the table that is nearest to it."""
    if _over_table(point, STAND_OFF_M):
        edges = [
            Vec3(TABLE_X[0] - STAND_OFF_M, point.y, 0.0),
            Vec3(TABLE_X[1] + STAND_OFF_M, point.y, 0.0),
            Vec3(point.x, TABLE_Y[0] - STAND_OFF_M, 0.0),
            Vec3(point.x, TABLE_Y[1] + STAND_OFF_M, 0.0),
        ]
        point = min(edges, key=point.horizontal_distance)
    place = Vec3(point.x, point.y, 0.0)
    return replace(state, body=replace(state.body, position=place, eyes=_eyes(place)))


def _facing(state: WorldState, point: Vec3) -> WorldState:
    here = state.body.position
    heading = math.atan2(point.y - here.y, point.x - here.x)
    return replace(state, body=replace(state.body, heading_rad=heading, gaze=point))


def _eyes(position: Vec3) -> Vec3:
    return position + Vec3(0.0, 0.0, 1.6)
