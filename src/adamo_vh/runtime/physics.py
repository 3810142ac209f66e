"""Settling and support: what moves comes to rest, and what rests knows on what.

Simulation runs only while something can move (after a pick or a drop). Things that did not really
move keep their exact pose, so that nothing creeps over a long episode.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from adamo_vh.engine import FLOOR, object_support
from adamo_vh.geometry import Array, Solid, Vec3
from adamo_vh.runtime.solids import Solids
from adamo_vh.runtime.world import CompiledWorld, WorldObject

if TYPE_CHECKING:
    import mujoco

_MAX_SETTLE_S = 4.0
_CHECK_EVERY = 25
_STILL_M_S = 0.004
_STILL_RAD_S = 0.08
_CREEP_M = 0.001
_CREEP_QUATERNION = 0.004
_BESIDE_M = np.array([1.3e-5, 0.7e-5, 0.0])
"""How far beside a ray another one goes that slipped through."""
_UPWARD = 0.5
"""Least vertical part of a contact normal that carries."""


def settle(world: CompiledWorld, held: int | None) -> None:
    """Simulate until everything rests, at most a few simulated seconds.

    Args:
        world: Changed in place.
        held: Id of the object in the hand: it stays where it is and touches nothing.
    """
    import mujoco

    model, data = world.model, world.data
    before = data.qpos.copy()
    data.qvel[:] = 0
    data.qacc_warmstart[:] = 0
    fixed = [world.objects[i] for i in sorted(world.absent)]
    if held is not None:
        fixed.append(world.objects[held])
        touchable = set_touch(world, world.objects[held], (0, 0))
    steps = int(_MAX_SETTLE_S / model.opt.timestep)
    for step in range(1, steps + 1):
        mujoco.mj_step(model, data)
        for item in fixed:
            _hold(world, item, before)
        if step % _CHECK_EVERY == 0 and _is_still(world):
            break
    for item in world.objects.values():
        _undo_creep(data, item, before)
    data.qvel[:] = 0
    mujoco.mj_forward(model, data)
    if held is not None:
        set_touch(world, world.objects[held], touchable)


def set_touch(world: CompiledWorld, item: WorldObject, bits: tuple[int, int]) -> tuple[int, int]:
    """Set the collision bits of an object; (0, 0) lets it touch nothing.

    Returns:
        The bits that it had.
    """
    model, geoms = world.model, list(item.geoms)
    kept = int(model.geom_contype[geoms[0]]), int(model.geom_conaffinity[geoms[0]])
    model.geom_contype[geoms], model.geom_conaffinity[geoms] = bits
    return kept


def _hold(world: CompiledWorld, item: WorldObject, qpos: Array) -> None:
    data = world.data
    data.qpos[item.qpos : item.qpos + 7] = qpos[item.qpos : item.qpos + 7]
    data.qvel[item.qvel : item.qvel + 6] = 0


def _is_still(world: CompiledWorld) -> bool:
    speed = world.data.qvel.reshape(-1, 6)
    return bool(
        (np.linalg.norm(speed[:, :3], axis=1) < _STILL_M_S).all()
        and (np.linalg.norm(speed[:, 3:], axis=1) < _STILL_RAD_S).all()
    )


def _undo_creep(data: mujoco.MjData, item: WorldObject, before: Array) -> None:
    pose = slice(item.qpos, item.qpos + 7)
    moved = np.abs(data.qpos[pose] - before[pose])
    if np.linalg.norm(moved[:3]) < _CREEP_M and moved[3:].max() < _CREEP_QUATERNION:
        data.qpos[pose] = before[pose]


def place(world: CompiledWorld, object_id: int, position: Vec3) -> None:
    """Put the centre of an object's box somewhere, at rest and turned as it is."""
    item = world.objects[object_id]
    world.data.qpos[item.qpos : item.qpos + 3] = position.array()
    world.data.qvel[item.qvel : item.qvel + 6] = 0


def put_down(world: CompiledWorld, object_id: int, position: Vec3, held: int | None) -> None:
    """Put the centre of an object's box just above a place, and let everything come to rest."""
    place(world, object_id, position + Vec3(0.0, 0.0, 0.001))
    settle(world, held)


def solids_on(world: CompiledWorld, excluded: int | None) -> list[Solid]:
    """The objects in the room as prisms, but one."""
    return [Solid.around(world.box(item.id)) for item in world.present() if item.id != excluded]


def supports(world: CompiledWorld, held: int | None) -> dict[int, str | None]:
    """What each object rests on, from the contacts that carry it.

    Returns:
        By object id: a piece of furniture (with its level, if it has several), "floor", the
        support name of another object, or None for what is held or in the air. Furniture goes
        before objects.
    """
    carriers: dict[int, set[str]] = {item.id: set() for item in world.present()}
    contact = world.data.contact
    slopes = contact.frame[:, 2]
    for i in np.flatnonzero(np.abs(slopes) >= _UPWARD):
        lower, upper = (int(geom) for geom in contact.geom[i])
        # The contact normal points from the first geom to the second.
        if slopes[i] < 0:
            upper, lower = lower, upper
        thing = int(world.object_of_geom[upper])
        if thing in carriers and thing != held:
            carriers[thing].add(_carrier(world, lower, float(contact.pos[i, 2])))
    static = {FLOOR, *(s.support for s in world.surfaces)}
    found: dict[int, str | None] = {}
    for object_id, names in carriers.items():
        order = sorted(names, key=lambda name: (name not in static, name))
        found[object_id] = order[0] if order else None
    return found


def _carrier(world: CompiledWorld, geom: int, z: float) -> str:
    """Name of what a geom belongs to, for something that lies on it at height z."""
    other = world.objects.get(int(world.object_of_geom[geom]))
    if other is not None:
        return object_support(other.id)
    name = world.furniture_of_body.get(int(world.model.geom_bodyid[geom]))
    if name is None:
        return FLOOR
    levels = [s for s in world.surfaces if s.support.split("/")[0] == name]
    if not levels:
        return name
    return min(levels, key=lambda s: abs(s.center.z - z)).support


def raycast(
    world: CompiledWorld, origin: Vec3, directions: Array, ignored: int | None
) -> Sequence[Vec3 | None]:
    """First hits of rays with what can be seen, except one object.

    Args:
        world: The world.
        origin: Start of all rays, metres.
        directions: (N, 3) unit vectors.
        ignored: Object id that rays pass through.
    """
    start = origin.array()
    distance = _distances(world, start, directions, ignored)
    if (missed := distance < 0).any():
        # Where a ray meets the very edge between two triangles it slips through both.
        distance[missed] = _distances(world, start + _BESIDE_M, directions[missed], ignored)
    return [
        Vec3.of(start + d * direction) if d >= 0 else None
        for d, direction in zip(distance, directions, strict=True)
    ]


def _distances(world: CompiledWorld, start: Array, directions: Array, ignored: int | None) -> Array:
    """(N,) how far rays go; negative where nothing was hit."""
    import mujoco

    count = len(directions)
    hit = np.full(count, -1, np.int32)
    distance = np.zeros(count)
    skip = world.objects[ignored].body if ignored is not None else -1
    mujoco.mj_multiRay(
        world.model,
        world.data,
        start,
        np.ascontiguousarray(directions, np.float64).ravel(),
        np.array([1, 1, 1, 0, 0, 0], np.uint8),
        1,
        skip,
        hit,
        distance,
        None,
        count,
        mujoco.mjMAXVAL,
    )
    return np.where(hit >= 0, distance, -1.0)


def line_is_free(world: CompiledWorld, start: Vec3, end: Vec3) -> bool:
    """Whether no furniture is between two points."""
    return not gathered(world.solids).block(start, end)


@lru_cache(maxsize=8)
def gathered(solids: tuple[Solid, ...]) -> Solids:
    """Prisms as arrays; kept for the next time."""
    return Solids.of(solids)
