"""Checks of what may be declared missing: the same again, snapshots, and events."""

from __future__ import annotations

from collections.abc import Iterator

from adamo_vh.action import Code
from adamo_vh.action_server.soundness import state_faults
from adamo_vh.engine import LightChanged, ObjectAdded, ObjectMoved, ObjectTaken, WorldEvent
from adamo_vh.errors import EngineError
from adamo_vh.service.conformance.check import CheckFunction, Probe, refused_with, unchanged


def _life(probe: Probe) -> list[str]:
    """A short life, and the digest of each of its states."""
    place, number = probe.place(), probe.pickable()
    probe.body.walk(place)
    walked = probe.state().hash()
    probe.body.pick(number)
    picked = probe.state().hash()
    probe.body.drop(place)
    return [walked, picked, probe.state().hash()]


def _again(probe: Probe) -> Iterator[str]:
    first = _life(probe)
    probe.world.reset(0)
    if (second := _life(probe)) != first:
        step = next(i for i, pair in enumerate(zip(first, second, strict=True)) if len({*pair}) > 1)
        yield f"the same calls after a reset lead to another state at step {step + 1}"


def _restores(probe: Probe) -> Iterator[str]:
    number = probe.take()
    kept, at = probe.world.snapshot(), probe.state()
    probe.world.reset(0)
    probe.world.restore(kept)
    yield from unchanged(at, probe.state())
    if probe.body.state().held != number:
        yield "the hand is empty after the restore"


def _leads_on(probe: Probe) -> Iterator[str]:
    place = probe.place()
    probe.take()
    kept, ends = probe.world.snapshot(), []
    for _ in range(2):
        probe.body.drop(place)
        ends.append(probe.state().hash())
        probe.world.restore(kept)
    if len(set(ends)) > 1:
        yield "the same call from the same snapshot leads to another state"


def _damaged(probe: Probe) -> Iterator[str]:
    before = probe.state()
    kept = probe.world.snapshot()
    for wrong in (b"no snapshot", kept[: len(kept) // 2]):
        try:
            probe.world.restore(wrong)
        except EngineError:
            pass
        except Exception as error:
            yield f"a damaged snapshot raises {type(error).__name__}, not EngineError"
        else:
            yield "a damaged snapshot is restored without a word"
        yield from unchanged(before, probe.state())


def _small(probe: Probe) -> Iterator[str]:
    size = len(probe.world.snapshot())
    if not 0 < size <= 2_000_000:
        yield f"a snapshot has {size} bytes"


def _tried(probe: Probe, event: WorldEvent) -> tuple[bool, str]:
    """Whether an event was carried out, and what is wrong with how it was refused."""
    before = probe.state()
    try:
        probe.world.apply(event)
    except EngineError:
        found = next(unchanged(before, probe.state()), "")
        return False, f"{event.type} is refused, and {found}" if found else ""
    except Exception as error:
        return False, f"{event.type} raises {type(error).__name__}, not EngineError"
    return True, ""


def _events(probe: Probe) -> Iterator[str]:
    number, place = probe.pickable(), probe.place()
    for event in (
        ObjectMoved(number, place),
        ObjectTaken(number),
        ObjectAdded(number, place),
        LightChanged(0, 0.2),
    ):
        carried_out, wrong = _tried(probe, event)
        if wrong:
            yield wrong
        ids = {item.id for item in probe.state().objects}
        if carried_out and (number in ids) == isinstance(event, ObjectTaken):
            there = "still" if number in ids else "not"
            yield f"after {event.type} object {number} is {there} there"
        yield from (f"after {event.type}: {fault}" for fault in state_faults(probe.state()))


def _events_refused(probe: Probe) -> Iterator[str]:
    place = probe.place()
    for event in (ObjectTaken(-1), ObjectMoved(-1, place), LightChanged(99_999, 0.5)):
        carried_out, wrong = _tried(probe, event)
        if carried_out:
            yield f"{event.type} of what is not there is carried out"
        if wrong:
            yield wrong


def _gone(probe: Probe) -> Iterator[str]:
    number = probe.pickable()
    carried_out, _ = _tried(probe, ObjectTaken(number))
    if not carried_out:
        yield f"object {number} cannot be taken out of the room"
        return
    yield from refused_with(probe.body.pick(number), Code.GONE)


MEMORY_CHECKS: dict[str, CheckFunction] = {
    "again-same": _again,
    "snapshot-restores": _restores,
    "snapshot-leads-on": _leads_on,
    "snapshot-damaged": _damaged,
    "snapshot-small": _small,
    "events-sound": _events,
    "events-refused": _events_refused,
    "events-gone": _gone,
}
