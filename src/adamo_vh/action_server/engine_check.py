"""Whether an engine keeps the contract: run it on your own before you let a model live in it.

It plays a short life in the engine through the same server as an agent and says in sentences what
does not hold; an engine that passes gives the same episode again, tells the truth, and scores.
"""

from __future__ import annotations

from collections.abc import Iterator

from adamo_vh.action import Action, Drop, Look, Pick, Walk
from adamo_vh.action_server.local import LocalActionServer
from adamo_vh.action_server.soundness import state_faults, step_faults, view_faults
from adamo_vh.engine import ObjectAdded, ObjectMoved, ObjectTaken, World, acting_body
from adamo_vh.errors import AdamoError, EngineError
from adamo_vh.geometry import Vec3

_SIZE_PX = (640, 360)
_ASIDE_M = 0.8
"""How far the check asks the body to walk and to put things."""


def engine_faults(world: World) -> tuple[str, ...]:
    """What an engine does otherwise than `adamo_vh.engine` says; empty if nothing is found.

    Args:
        world: Is reset, lived in, and left as after a reset.
    """
    try:
        return tuple(_faults(world))
    except AdamoError as error:
        return (str(error),)


def _faults(world: World) -> Iterator[str]:
    yield from _body_faults(world)
    world.reset(0)
    first = world.state()
    yield from state_faults(first)
    if unnamed := sorted({item.id for item in first.objects} - set(world.object_names)):
        yield f"object_names lacks {unnamed}"
    yield from _life(world)
    yield from _memory(world)
    yield from _events(world)
    world.reset(0)
    if world.state().hash() != first.hash():
        yield "reset(0) gives another world the second time"


def _body_faults(world: World) -> Iterator[str]:
    info = acting_body(world).info
    sizes = {
        "radius_m": info.radius_m,
        "eye_height_m": info.eye_height_m,
        "fov_y_rad": info.fov_y_rad,
        "reach_m": info.reach_m,
        "reach_top_m": info.reach_top_m,
    }
    for name, value in sizes.items():
        if not value > 0:
            yield f"BodyInfo.{name} is {value}"


def _life(world: World) -> Iterator[str]:
    """Look round, take the first thing in view, put it down: what is said must be what is so."""
    body = acting_body(world)
    server = LocalActionServer(world, resolution=_SIZE_PX)
    before = world.state()
    percept, sighting = body.see(*_SIZE_PX), server.observe()
    if world.state().hash() != before.hash():
        yield "seeing changes the world"
    if percept.body != body.state():
        yield "Percept.body is not the body's state"
    ids = {server.tag(number): number for number in world.object_names}
    yield from view_faults(percept, sighting.observation, ids, before)
    at = before.body.position
    calls: list[Action] = [Look(at.x + 1.0, at.y, 1.0), Walk(at.x + _ASIDE_M, at.y, 0.0)]
    for item in sighting.observation.objects[:1]:
        here = item.position
        calls += [Pick(item.tag), Drop(item.tag, at.x, at.y, 0.0), Pick(item.tag)]
        calls += [Drop(item.tag, here.x, here.y, here.z)]
    for action in calls:
        before = world.state()
        try:
            result = server.execute(action)
        except EngineError as error:
            yield f"{action}: {error}"
            return
        after = world.state()
        faults = [*step_faults(before, after, action, result.feedback), *state_faults(after)]
        yield from (f"{action}: {fault}" for fault in faults)


def _memory(world: World) -> Iterator[str]:
    """A snapshot brings the same world back, and the same call leads on from it in the same way."""
    body, kept = acting_body(world), world.snapshot()
    at = world.state()
    aside = at.body.position + Vec3(0.0, _ASIDE_M, 0.0)
    body.walk(aside)
    there = world.state().hash()
    world.restore(kept)
    if world.state().hash() != at.hash():
        yield "restore does not bring the state of the snapshot back"
    body.walk(aside)
    if world.state().hash() != there:
        yield "the same call from the same snapshot leads to another state"
    try:
        world.restore(b"no snapshot")
    except EngineError:
        return
    except Exception as error:
        yield f"restoring a damaged snapshot raises {type(error).__name__}, not EngineError"
    else:
        yield "a damaged snapshot is restored without a word"


def _events(world: World) -> Iterator[str]:
    """An event is carried out with a sound state after it, or is an EngineError without effect."""
    state = world.state()
    if not state.objects:
        return
    item, aside = state.objects[0], state.body.position + Vec3(_ASIDE_M, 0.0, 0.0)
    for event in (
        ObjectMoved(item.id, aside),
        ObjectTaken(item.id),
        ObjectAdded(item.id, item.box.center),
        ObjectTaken(-1),
    ):
        before = world.state().hash()
        try:
            world.apply(event)
        except EngineError:
            if world.state().hash() != before:
                yield f"{event} is refused, but changed the world"
            continue
        except Exception as error:
            yield f"{event} raises {type(error).__name__}, not EngineError"
            continue
        yield from (f"{event}: {fault}" for fault in state_faults(world.state()))
