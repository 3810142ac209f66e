"""The mistakes of those who write their first engine: axes, units, halves, order, moments."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.dialled import Passing, with_body
from tests.service.conformance.test_broken import (
    Broken,
    also,
    body_state,
    first_box,
    first_object,
    info,
    instead,
    report,
    scene,
    state,
    view,
)

from adamo_vh.action import Outcome
from adamo_vh.engine import BodyReport, ObjectTaken, WorldState
from adamo_vh.geometry import Box, Quaternion, Vec3
from adamo_vh.observation import Percept
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.service.conformance import Verdict, conform


def boxes(change: Callable[[Box], Box]) -> Broken:
    """Every box of the state is told otherwise."""

    def changed(now: WorldState) -> WorldState:
        objects = tuple(replace(item, box=change(item.box)) for item in now.objects)
        return replace(now, objects=objects)

    return state(changed)


def seen(change: Callable[[Box], Box]) -> Broken:
    """Every box in a view is told otherwise."""

    def changed(percept: Percept) -> Percept:
        objects = {
            number: replace(item, box=change(item.box)) for number, item in percept.objects.items()
        }
        return replace(percept, objects=objects)

    return view(changed)


def on_itself(now: WorldState) -> WorldState:
    one = now.objects[0]
    return replace(now, objects=(replace(one, support=f"object {one.id}"), *now.objects[1:]))


def flat(percept: Percept) -> Percept:
    """Rows from the bottom, as OpenGL has them."""
    layers = tuple(np.ascontiguousarray(ids[::-1]) for ids in percept.id_layers)
    return replace(percept, rgb=np.ascontiguousarray(percept.rgb[::-1]), id_layers=layers)


def rows_from_below(percept: Percept) -> Percept:
    return replace(percept, rgb=percept.rgb[::-1])


def horizontal_angle(percept: Percept) -> Percept:
    camera = percept.camera
    wide = 2 * math.atan(math.tan(camera.fov_y_rad / 2) * camera.width_px / camera.height_px)
    return replace(percept, camera=replace(camera, fov_y_rad=wide))


def y_up(point: Vec3) -> Vec3:
    return Vec3(point.x, point.z, point.y)


def first_missing(percept: Percept) -> Percept:
    """One object is in the pixels and not in the list."""
    number = min(percept.objects)
    kept = {key: item for key, item in percept.objects.items() if key != number}
    return replace(percept, objects=kept)


def one_object_everywhere(percept: Percept) -> Percept:
    number = min(percept.objects)
    layer = np.full_like(percept.id_layers[0], number)
    return replace(percept, id_layers=(layer,), objects={number: percept.objects[number]})


def distances(engine: Any) -> Any:
    """Rays answer along their way from the origin of the room, not from their start."""

    def rays(origin: Vec3, ways: Any) -> Any:
        hits = engine.body.rays(origin, ways)
        return [None if hit is None else hit - origin for hit in hits]

    return with_body(engine, rays=rays)


def short_of_rays(engine: Any) -> Any:
    return with_body(
        engine, rays=lambda origin, ways: [h for h in engine.body.rays(origin, ways)][:-1]
    )


def hand_left_behind(engine: Any) -> Any:
    """The held object stays where it was taken."""
    was: dict[int, Any] = {}

    def pick(number: int) -> BodyReport:
        was[number] = engine.state().object(number).box
        return engine.body.pick(number)  # type: ignore[no-any-return]

    def changed() -> WorldState:
        now: WorldState = engine.state()
        objects = tuple(
            replace(item, box=was[item.id]) if item.held and item.id in was else item
            for item in now.objects
        )
        return replace(now, objects=objects)

    return Passing(with_body(engine, pick=pick), state=changed)


def straight_through(engine: Any) -> Any:
    """The body goes to any point, also into furniture."""

    def walk(point: Vec3) -> BodyReport:
        stance = engine.body.stance
        engine.body.stance = stance.walked(Vec3(point.x, point.y, 0.0), stance.heading_rad)
        far = stance.position.horizontal_distance(point)
        return BodyReport(Outcome.DONE, "ok", engine.body.stance.position, walked_m=far)

    return with_body(engine, walk=walk)


def never_stops(engine: Any) -> Any:
    """An engine that steps its physics whenever it is asked."""
    calls = iter(range(10_000))

    def now() -> WorldState:
        told: WorldState = engine.state()
        heading = told.body.heading_rad + 0.01 * next(calls)
        return replace(told, body=replace(told.body, heading_rad=heading))

    return Passing(engine, state=now)


def takes_all(event: Any) -> None:
    """Events are taken without a look at what they are about."""


def apply_half(engine: Any) -> Any:
    def apply(event: Any) -> None:
        engine.apply(event)
        if isinstance(event, ObjectTaken):
            engine.body.look(Vec3(0, 0, 0))
            raise KeyError(event.object_id)

    return Passing(engine, apply=apply)


HALF = Vec3(0.5, 0.5, 0.5)
MISTAKES: list[tuple[str, str, Broken, str]] = [
    ("centimetres", "state-boxes", boxes(lambda b: replace(b, size=b.size * 100)), "large"),
    ("a room in centimetres", "scene-areas", scene(x_min=-2.0, x_max=2.0), "not inside the room"),
    ("a ceiling in the floor", "scene-extent", scene(height_m=-2.8), "-2.8 m"),
    ("y is up", "state-sound", boxes(lambda b: replace(b, center=y_up(b.center))), "not inside"),
    ("y is up, seen", "capture-projection", seen(lambda b: replace(b, center=y_up(b.center))), "%"),
    (
        "half sizes, seen",
        "capture-projection",
        seen(lambda b: replace(b, size=b.size * 0.5)),
        "outside",
    ),
    (
        "the foot for the middle",
        "state-supports",
        boxes(lambda b: replace(b, center=b.center - Vec3(0, 0, b.size.z / 2))),
        "from the top of",
    ),
    ("a box without height", "state-boxes", first_box(size=Vec3(0.1, 0.1, 0.0)), "large"),
    ("quaternions of length 2", "state-boxes", first_box(orientation=Quaternion(0, 2)), "unit"),
    ("a thing on itself", "state-supports", state(on_itself), "rests on object"),
    ("a thing on nothing", "state-supports", first_object(support=None), "rests on None"),
    ("a thing on a ghost", "state-supports", first_object(support="object 9999"), "is not there"),
    ("a class of its own", "scene-names", first_object(class_name="Thing"), "'Thing' and"),
    ("degrees", "body-eyes", body_state(heading_rad=90.0), "heading_rad is 90.0"),
    ("eyes beside the body", "body-eyes", body_state(eyes=Vec3(5.0, 5.0, 1.6)), "are not above"),
    ("reach in centimetres", "body-sizes", info(reach_m=90.0), "reach_m is 90"),
    ("no radius", "body-sizes", info(radius_m=0.0), "radius_m is 0"),
    ("rows from the bottom", "capture-handedness", view(flat), "up and down are exchanged"),
    ("colours from the bottom", "capture-layers", view(rows_from_below), "upside down"),
    ("the horizontal angle", "capture-camera", view(horizontal_angle), "rad vertically"),
    ("the horizontal angle, seen", "capture-projection", view(horizontal_angle), "outside"),
    ("an object unlisted", "capture-objects", view(first_missing), "listed are"),
    ("one object everywhere", "capture-complete", view(one_object_everywhere), "pixels"),
    ("one colour", "capture-colours", view(lambda p: replace(p, rgb=p.rgb * 0 + 9)), "hardly"),
    ("offsets for points", "rays-line", distances, "is not on its ray"),
    ("a ray too few", "rays-line", short_of_rays, "35 answers for 36 rays"),
    ("through furniture", "walk-obstacle", straight_through, "it stands in"),
    ("out of the room", "walk-outside", straight_through, "outside of the room"),
    ("walks on the spot", "walk-arrives", instead("walk", Outcome.DONE, "ok"), "could be walked"),
    ("the look walks", "look-turns", also("look", lambda e: e.body.walk(HALF)), "the body moved"),
    ("the look is refused", "look-turns", instead("look", Outcome.REFUSED, "ok"), "is refused/ok"),
    ("a wrong limit", "look-limits", report("look", code="stopped_short"), "gaze_limited"),
    ("the hand stays empty", "pick-takes", instead("pick", Outcome.DONE, "ok"), "could be picked"),
    ("a hand left behind", "hand-carries", hand_left_behind, "stayed behind"),
    ("the wish for the place", "drop-floor", report("drop", point=HALF), "it reports"),
    ("nothing is let go", "drop-floor", instead("drop", Outcome.DONE, "ok"), "still holds"),
    (
        "where it lay is refused",
        "drop-back",
        instead("drop", Outcome.REFUSED, "no_free_spot"),
        "it",
    ),
    ("a wrong correction", "drop-taken", report("drop", code="ok"), "instead of corrected"),
    ("a code of success", "report-codes", report("pick", outcome=Outcome.REFUSED, code="ok"), "ok"),
    ("done and unreachable", "report-codes", report("walk", outcome=Outcome.DONE), "goes with"),
    ("it never stops", "state-still", never_stops, "something moves"),
    ("it never stops, reset", "reset-start", never_stops, "the body"),
    ("seeing turns", "capture-passive", also("see", lambda e: e.body.look(HALF)), "the body"),
    ("events are ignored", "events-sound", lambda e: Passing(e, apply=takes_all), "still there"),
    ("an event half done", "events-sound", apply_half, "KeyError, not EngineError"),
    (
        "a snapshot of megabytes",
        "snapshot-small",
        lambda e: Passing(e, snapshot=lambda: b"x" * 3_000_000),
        "3000000 bytes",
    ),
]


@pytest.mark.parametrize(
    ("name", "broken", "told"),
    [pytest.param(*rest, id=mistake) for mistake, *rest in MISTAKES],
)
def test_a_usual_mistake_is_found(
    engine: BuiltinEngine, name: str, broken: Broken, told: str
) -> None:
    (finding,) = conform(broken(engine), [name]).findings
    assert finding.verdict is Verdict.FAILED, finding
    assert told in finding.found, finding.found
