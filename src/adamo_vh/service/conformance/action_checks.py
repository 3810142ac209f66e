"""Checks of what the body does: look, walk, pick, drop, say, and how it refuses."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from adamo_vh.action import Code, Outcome
from adamo_vh.action_server.soundness import state_faults
from adamo_vh.engine import FLOOR, BodyReport
from adamo_vh.geometry import Vec3
from adamo_vh.service.conformance.check import (
    NEAR_M,
    TOUCH_M,
    CheckFunction,
    NotTriedError,
    Probe,
    refused_with,
    unchanged,
)

_OUTCOMES = {
    Outcome.DONE: {Code.OK, Code.REPOSITIONED},
    Outcome.CORRECTED: {
        Code.STOPPED_SHORT,
        Code.GAZE_LIMITED,
        Code.PLACED_ELSEWHERE,
        Code.CANCELLED,
    },
    Outcome.REFUSED: {
        Code.HAND_FULL,
        Code.HAND_EMPTY,
        Code.GONE,
        Code.UNREACHABLE,
        Code.NO_FREE_SPOT,
    },
}


def _look(probe: Probe) -> Iterator[str]:
    before = probe.state()
    wish = before.body.position + Vec3(0.0, 1.5, 1.0)
    report = probe.body.look(wish)
    after = probe.state()
    if report.outcome is not Outcome.DONE:
        yield f"looking at {wish} is {report.outcome}/{report.code}"
    if after.body.gaze.distance(wish) > NEAR_M:
        yield f"the gaze is at {after.body.gaze}, not at {wish}"
    if after.body.position.distance(before.body.position) > 1e-3:
        yield "the body moved"
    if after.objects != before.objects:
        yield "objects moved"
    if abs(after.body.heading_rad - np.pi / 2) > 0.1:
        yield f"it looks along +Y with heading {after.body.heading_rad:.2f} rad, not pi/2"


def _look_limits(probe: Probe) -> Iterator[str]:
    here = probe.state().body.position
    report = probe.body.look(Vec3(here.x, here.y, 2.6))
    gaze = probe.body.state().gaze
    if report.outcome is Outcome.DONE and gaze.distance(Vec3(here.x, here.y, 2.6)) > NEAR_M:
        yield f"done, but the gaze is at {gaze}"
    if report.outcome is Outcome.CORRECTED and report.code != Code.GAZE_LIMITED:
        yield f"corrected/{report.code} instead of corrected/gaze_limited"
    if report.point is None or report.point.distance(gaze) > 1e-3:
        yield f"it reports {report.point}, the gaze is at {gaze}"


def _walk(probe: Probe) -> Iterator[str]:
    try:
        place = probe.place()
    except NotTriedError as error:
        yield str(error)
        return
    before = probe.state()
    report = probe.body.walk(place)
    after = probe.state()
    straight = after.body.position.horizontal_distance(before.body.position)
    if report.outcome is not Outcome.DONE:
        yield f"{report.outcome}/{report.code}"
    if after.body.position.horizontal_distance(place) > NEAR_M:
        yield f"the body is at {after.body.position}, not at {place}"
    if report.walked_m < straight - 0.01:
        yield f"it says that it walked {report.walked_m:.2f} m, and moved {straight:.2f} m"
    if report.point is None or report.point.distance(after.body.position) > 1e-3:
        yield f"it reports {report.point}, the body is at {after.body.position}"
    if after.objects != before.objects:
        yield "objects moved"
    yield from state_faults(after)


def _walk_eyes(probe: Probe) -> Iterator[str]:
    before = probe.state().body
    probe.body.walk(probe.place())
    after = probe.state().body
    if after.eyes.distance(before.eyes) < 0.1:
        yield "the eyes stayed where they were"


def _walk_stay(probe: Probe) -> Iterator[str]:
    here = probe.state().body.position
    report = probe.body.walk(here)
    if report.walked_m > NEAR_M or report.outcome is not Outcome.DONE:
        yield f"walking to where it stands is {report.outcome}, {report.walked_m:.2f} m"


def _walk_far(probe: Probe) -> Iterator[str]:
    room = probe.world.scene
    wish = Vec3(room.x_max + 3.0, room.y_max + 3.0, 0.0)
    report = probe.body.walk(wish)
    state = probe.state()
    if report.outcome is Outcome.DONE:
        yield "done, though the wish is outside of the room"
    elif report.outcome is Outcome.CORRECTED and report.code != Code.STOPPED_SHORT:
        yield f"corrected/{report.code} instead of corrected/stopped_short"
    yield from state_faults(state)


def _walk_into(probe: Probe) -> Iterator[str]:
    tall = [piece for piece in probe.state().furniture if piece.bottom_m < 0.5 < piece.top_m]
    if not tall:
        raise NotTriedError("no furniture is told")
    points = np.array(tall[0].points)
    middle = points.mean(axis=0)
    wish = Vec3(float(middle[0]), float(middle[1]), 0.0)
    report = probe.body.walk(wish)
    here = probe.state().body.position
    if report.outcome is Outcome.DONE and here.horizontal_distance(wish) > NEAR_M:
        yield f"done, but it stands at {here}"
    if report.outcome is not Outcome.DONE and report.code != Code.STOPPED_SHORT:
        yield f"{report.outcome}/{report.code} instead of corrected/stopped_short"
    if here.horizontal_distance(wish) < 0.1:
        yield f"it stands in {tall[0].name!r}"


def _pick(probe: Probe) -> Iterator[str]:
    try:
        number = probe.pickable()
    except NotTriedError as error:
        yield str(error)
        return
    before = probe.state()
    report = probe.body.pick(number)
    after = probe.state()
    item = after.object(number)
    if report.outcome is not Outcome.DONE or report.code not in (Code.OK, Code.REPOSITIONED):
        yield f"{report.outcome}/{report.code}"
    if after.body.held != number or not item.held:
        yield f"the hand holds {after.body.held}, the object says held: {item.held}"
    if item.support is not None:
        yield f"what is in the hand rests on {item.support!r}"
    if after.body.held_box != item.box:
        yield "held_box is not the box of the object"
    if item.box.size.distance(before.object(number).box.size) > 1e-3:
        yield "the box has another size in the hand"
    if item.box.center.horizontal_distance(after.body.position) > 1.0:
        yield f"the object is at {item.box.center}, the body at {after.body.position}"
    yield from state_faults(after)


def _pick_code(probe: Probe) -> Iterator[str]:
    number = probe.pickable()
    before = probe.state()
    report = probe.body.pick(number)
    after = probe.state()
    moved = after.body.position.horizontal_distance(before.body.position)
    if (report.code == Code.REPOSITIONED) != (moved > 0.01):
        yield f"the code is {report.code}, and the body moved {moved:.2f} m"
    if abs(report.walked_m - moved) > 0.01 and report.walked_m < moved:
        yield f"it says that it walked {report.walked_m:.2f} m, and moved {moved:.2f} m"


def _pick_closer(probe: Probe) -> Iterator[str]:
    state, reach = probe.state(), probe.body.info.reach_m
    far = sorted(
        state.objects,
        key=lambda item: -item.box.center.horizontal_distance(state.body.position),
    )
    for item in far:
        if item.box.center.horizontal_distance(state.body.position) <= reach + 0.3:
            break
        probe.world.reset(0)
        report = probe.body.pick(item.id)
        if report.outcome is Outcome.REFUSED:
            continue
        here = probe.state().body.position
        if report.code != Code.REPOSITIONED or report.walked_m <= 0:
            yield f"object {item.id} was out of reach: {report.code}, {report.walked_m:.2f} m"
        if here.horizontal_distance(item.box.center) > reach + 0.05:
            yield f"it took object {item.id} from {here}, farther than reach_m"
        return
    raise NotTriedError("no object is out of reach at the start and can be picked")


def _pick_full(probe: Probe) -> Iterator[str]:
    number = probe.take()
    before = probe.state()
    others = [item.id for item in before.objects if item.id != number]
    for other in (*others[:1], number):
        yield from refused_with(probe.body.pick(other), Code.HAND_FULL)
    yield from unchanged(before, probe.state())


def _drop_empty(probe: Probe) -> Iterator[str]:
    before = probe.state()
    yield from refused_with(probe.body.drop(before.body.position), Code.HAND_EMPTY)
    yield from unchanged(before, probe.state())


def _drop_floor(probe: Probe) -> Iterator[str]:
    number, wish, report = probe.drop_aside()
    state = probe.state()
    item = state.object(number)
    if state.body.held is not None or item.held:
        yield f"the hand still holds {state.body.held}"
        return
    if report.support != FLOOR or item.support != FLOOR:
        yield f"it rests on {item.support!r}, the report says {report.support!r}"
    missed = item.box.center.horizontal_distance(wish)
    if report.outcome is Outcome.DONE and missed > NEAR_M:
        yield f"done, but it lies {missed:.2f} m beside the wish"
    if report.point is None or report.point.distance(item.box.center) > 0.01:
        yield f"it reports {report.point}, the box is at {item.box.center}"


def _drop_rests(probe: Probe) -> Iterator[str]:
    number, _, _ = probe.drop_aside()
    first, second = probe.state(), probe.state()
    if first.hash() != second.hash():
        yield "it still moves after the answer"
    gap = first.object(number).box.bottom_z
    if abs(gap) > TOUCH_M:
        yield f"its bottom is {gap:+.3f} m from the floor"
    yield from state_faults(first)


def _drop_back(probe: Probe) -> Iterator[str]:
    number = probe.pickable()
    was = probe.state().object(number)
    probe.take()
    report = probe.body.drop(was.box.center)
    now = probe.state().object(number)
    if report.outcome is Outcome.REFUSED:
        yield f"where it lay it cannot be put again: {report.code}"
    elif now.support != was.support or report.support != now.support:
        yield f"it lay on {was.support!r}; now {now.support!r}, reported {report.support!r}"
    elif now.box.center.distance(was.box.center) > probe.body.info.correction_m + 0.05:
        yield f"it lies at {now.box.center}, and was at {was.box.center}"


def _drop_taken(probe: Probe) -> Iterator[str]:
    number = probe.take()
    state = probe.state()
    lying = [
        item
        for item in state.objects
        if item.id != number and item.support and not item.support.startswith("object")
    ]
    for item in lying:
        probe.world.reset(0)
        probe.take()
        wish = item.box.center
        report = probe.body.drop(wish)
        if report.outcome is Outcome.REFUSED:
            continue
        now = probe.state()
        missed = now.object(number).box.center.horizontal_distance(wish)
        if report.outcome is Outcome.DONE and missed > NEAR_M:
            yield f"done, but it lies {missed:.2f} m beside the wish"
        if report.outcome is Outcome.CORRECTED and report.code != Code.PLACED_ELSEWHERE:
            yield f"corrected/{report.code} instead of corrected/placed_elsewhere"
        if now.object(item.id).box.center.distance(item.box.center) > 0.02:
            yield f"object {item.id}, which lay there, was pushed away"
        if missed > probe.body.info.correction_m + 0.05:
            yield f"it was put {missed:.2f} m away, farther than correction_m"
        return
    raise NotTriedError("nothing could be put down near another object")


def _drop_nowhere(probe: Probe) -> Iterator[str]:
    probe.take()
    before = probe.state()
    room = before.scene
    wish = Vec3((room.x_min + room.x_max) / 2, (room.y_min + room.y_max) / 2, room.height_m + 5.0)
    report = probe.body.drop(wish)
    if report.outcome is not Outcome.REFUSED:
        yield f"{report.outcome}/{report.code} for a point above the ceiling"
    elif report.code not in (Code.NO_FREE_SPOT, Code.UNREACHABLE):
        yield f"refused/{report.code} instead of refused/no_free_spot"
    yield from unchanged(before, probe.state())


def _carry(probe: Probe) -> Iterator[str]:
    place = probe.place()
    number = probe.take()
    before = probe.state().object(number).box.center
    start = probe.state().body.position
    probe.body.walk(place if place.horizontal_distance(start) > 0.3 else place + Vec3(0.5, 0, 0))
    state = probe.state()
    moved = state.body.position.horizontal_distance(start)
    if state.body.held != number:
        yield "the hand let go while walking"
    elif moved > 0.3 and state.object(number).box.center.distance(before) < 0.05:
        yield "the object stayed behind while the body walked"


def _codes(probe: Probe) -> Iterator[str]:
    room = probe.world.scene
    reports: list[BodyReport] = [
        probe.body.drop(Vec3(0, 0, 0)),
        probe.body.look(Vec3(room.x_max, room.y_max, 1.0)),
        probe.body.walk(Vec3(room.x_max + 9, room.y_max, 0.0)),
    ]
    for item in probe.state().objects[:6]:
        reports += [probe.body.pick(item.id), probe.body.drop(item.box.center)]
    for report in reports:
        allowed = _OUTCOMES.get(report.outcome, set())
        if report.outcome is not Outcome.REFUSED and report.code not in allowed:
            yield f"{report.outcome} goes with {', '.join(sorted(allowed))}, not {report.code!r}"
        if report.outcome is Outcome.REFUSED and report.code in {Code.OK, Code.REPOSITIONED}:
            yield f"refused with {report.code!r}, which means success"


def _refusals(probe: Probe) -> Iterator[str]:
    tried = 0
    for item in probe.state().objects:
        before = probe.state()
        report = probe.body.pick(item.id)
        if report.outcome is Outcome.REFUSED:
            tried += 1
            yield from unchanged(before, probe.state())
            if report.code == Code.UNREACHABLE and report.point is None:
                yield f"object {item.id} is unreachable, and the nearest place is not told"
        else:
            probe.world.reset(0)
    if not tried:
        raise NotTriedError("every object can be picked from the start")


def _say(probe: Probe) -> Iterator[str]:
    before = probe.state()
    probe.body.say("The cup is on the table. “Fertig!” 好")
    yield from unchanged(before, probe.state())


ACTION_CHECKS: dict[str, CheckFunction] = {
    "look-turns": _look,
    "look-limits": _look_limits,
    "walk-arrives": _walk,
    "walk-eyes": _walk_eyes,
    "walk-stays": _walk_stay,
    "walk-outside": _walk_far,
    "walk-obstacle": _walk_into,
    "pick-takes": _pick,
    "pick-code": _pick_code,
    "pick-closer": _pick_closer,
    "pick-full": _pick_full,
    "pick-refused": _refusals,
    "drop-empty": _drop_empty,
    "drop-floor": _drop_floor,
    "drop-rests": _drop_rests,
    "drop-back": _drop_back,
    "drop-taken": _drop_taken,
    "drop-nowhere": _drop_nowhere,
    "hand-carries": _carry,
    "report-codes": _codes,
    "say-accepts": _say,
}
