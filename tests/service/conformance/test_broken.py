"""Each check catches the engine that it is there for."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.dialled import Passing, with_body

from adamo_vh.action import Outcome
from adamo_vh.engine import BodyReport, LightChanged, ObjectTaken, WorldState
from adamo_vh.errors import EngineError
from adamo_vh.geometry import Quaternion, Vec3
from adamo_vh.observation import Percept
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.service.conformance.running import CHECKS, Verdict, conform

Broken = Callable[[Any], Any]


def scene(**changed: Any) -> Broken:
    return lambda engine: Passing(engine, scene=replace(engine.scene, **changed))


def info(**changed: Any) -> Broken:
    return lambda engine: with_body(engine, info=replace(engine.body.info, **changed))


def state(change: Callable[[WorldState], WorldState]) -> Broken:
    return lambda engine: Passing(engine, state=lambda: change(engine.state()))


def first_object(**changed: Any) -> Broken:
    def change(now: WorldState) -> WorldState:
        return replace(now, objects=(replace(now.objects[0], **changed), *now.objects[1:]))

    return state(change)


def first_box(**changed: Any) -> Broken:
    def change(now: WorldState) -> WorldState:
        one = now.objects[0]
        return replace(
            now, objects=(replace(one, box=replace(one.box, **changed)), *now.objects[1:])
        )

    return state(change)


def body_state(**changed: Any) -> Broken:
    return state(lambda now: replace(now, body=replace(now.body, **changed)))


def view(change: Callable[[Percept], Percept]) -> Broken:
    return lambda engine: with_body(engine, see=lambda w, h: change(engine.body.see(w, h)))


def report(method: str, **changed: Any) -> Broken:
    """What a method reports is changed after it was carried out."""

    def broken(engine: Any) -> Any:
        real = getattr(engine.body, method)
        return with_body(engine, **{method: lambda *a: replace(real(*a), **changed)})

    return broken


def instead(method: str, outcome: Outcome, code: str, **more: Any) -> Broken:
    """A method does nothing and reports something."""
    return lambda engine: with_body(
        engine, **{method: lambda *_: BodyReport(outcome, code, **more)}
    )


def also(method: str, act: Callable[[Any], Any]) -> Broken:
    """A method does something more."""

    def broken(engine: Any) -> Any:
        real = getattr(engine.body, method)

        def both(*arguments: Any) -> Any:
            result = real(*arguments)
            act(engine)
            return result

        return with_body(engine, **{method: both})

    return broken


def shifted(percept: Percept) -> Percept:
    return replace(percept, id_layers=tuple(np.roll(i, 60, axis=1) for i in percept.id_layers))


def mirrored(percept: Percept) -> Percept:
    layers = tuple(np.ascontiguousarray(i[:, ::-1]) for i in percept.id_layers)
    return replace(percept, rgb=np.ascontiguousarray(percept.rgb[:, ::-1]), id_layers=layers)


def counted(change: Callable[[WorldState, int], WorldState]) -> Broken:
    def broken(engine: Any) -> Any:
        calls = iter(range(10_000))
        return Passing(engine, state=lambda: change(engine.state(), next(calls)))

    return broken


def creeping(now: WorldState, call: int) -> WorldState:
    one = now.objects[0]
    center = one.box.center + Vec3(0.001 * call, 0.0, 0.0)
    box = replace(one.box, center=center)
    return replace(now, objects=(replace(one, box=box), *now.objects[1:]))


def random_walk(engine: Any) -> Any:
    steps = iter(range(10_000))

    def walk(point: Vec3) -> BodyReport:
        return engine.body.walk(point + Vec3(0.002 * next(steps), 0.0, 0.0))  # type: ignore[no-any-return]

    return with_body(engine, walk=walk)


def still_camera(engine: Any) -> Any:
    kept: list[Percept] = []

    def see(width: int, height: int) -> Percept:
        kept[:] = kept or [engine.body.see(width, height)]
        return kept[0]

    return with_body(engine, see=see)


def forgets_hand(engine: Any) -> Any:
    def restore(snapshot: bytes) -> None:
        engine.restore(snapshot)
        engine.body.drop(engine.body.state().position)

    return Passing(engine, restore=restore)


def stays_gone(event: Any) -> None:
    raise TypeError("what is an event?")


def drops_at(offset: Vec3) -> Broken:
    return lambda engine: with_body(
        engine, drop=lambda point: replace(engine.body.drop(point + offset), outcome=Outcome.DONE)
    )


def degrees(engine: Any) -> float:
    return math.degrees(engine.body.info.fov_y_rad)


def clockwise(now: WorldState) -> WorldState:
    return replace(now, furniture=tuple(replace(f, points=f.points[::-1]) for f in now.furniture))


def far_camera(percept: Percept) -> Percept:
    moved = percept.camera.position + Vec3(0.0, 0.0, 0.3)
    return replace(percept, camera=replace(percept.camera, position=moved))


def of_yesterday(percept: Percept) -> Percept:
    return replace(percept, body=replace(percept.body, heading_rad=1.0))


def noisy(engine: Any) -> Any:
    draws = np.random.default_rng(1)

    def see(width: int, height: int) -> Percept:
        percept: Percept = engine.body.see(width, height)
        noise = draws.integers(0, 3, percept.rgb.shape).astype(np.uint8)
        return replace(percept, rgb=percept.rgb // 2 + noise)

    return with_body(engine, see=see)


def leaves_support(engine: Any) -> Any:
    def drop(point: Vec3) -> BodyReport:
        report = engine.body.drop(point)
        return replace(report, support="somewhere")  # type: ignore[no-any-return]

    return with_body(engine, drop=drop)


def takes_from_afar(engine: Any) -> Any:
    def pick(number: int) -> BodyReport:
        found = engine.body.pick(number)
        return replace(found, code="ok", walked_m=0.0)  # type: ignore[no-any-return]

    return with_body(engine, pick=pick)


def wandering(engine: Any) -> None:
    engine.body.walk(engine.body.state().position + Vec3(0.6, 0.3, 0.0))


BROKEN: dict[str, tuple[Broken, str]] = {
    "scene-extent": (scene(height_m=0.0), "0.0 m"),
    "scene-areas": (scene(x_max=-2.0), "is not inside the room"),
    "scene-names": (lambda engine: Passing(engine, object_names={}), "object_names lacks"),
    "scene-furniture": (state(clockwise), "not counter-clockwise"),
    "body-sizes": (info(fov_y_rad=74.0), "fov_y_rad is 74"),
    "body-eyes": (body_state(eyes=Vec3(0.0, 0.0, 0.2)), "the eyes are at 0.20 m"),
    "state-sound": (body_state(position=Vec3(0.0, 0.0, 0.1)), "floats"),
    "state-boxes": (first_box(orientation=Quaternion(2.0)), "no unit quaternion"),
    "state-supports": (first_object(support="cloud"), "which no furniture is called"),
    "state-still": (counted(creeping), "something moves"),
    "reset-start": (lambda engine: Passing(engine, reset=lambda seed: None), "the world changed"),
    "capture-size": (view(lambda p: replace(p, rgb=p.rgb[1:])), "the picture is (269, 480, 3)"),
    "capture-colours": (view(lambda p: replace(p, rgb=p.rgb * 0)), "black"),
    "capture-camera": (view(far_camera), "the camera is at"),
    "capture-moment": (view(of_yesterday), "not the body's state"),
    "capture-objects": (view(lambda p: replace(p, objects={})), "listed are []"),
    "capture-projection": (view(shifted), "outside of their projected boxes"),
    "capture-handedness": (view(mirrored), "left and right are exchanged"),
    "capture-layers": (view(lambda p: replace(p, rgb=p.rgb[:, ::-1])), "mirrored"),
    "capture-passive": (also("see", wandering), "the world changed: the body"),
    "capture-turns": (still_camera, "the colours are the same"),
    "capture-complete": (
        view(lambda p: replace(p, id_layers=(np.full_like(p.id_layers[0], -1),))),
        "lack an object that is there",
    ),
    "capture-repeatable": (noisy, "two pictures of the same moment differ"),
    "closeup-aim": (
        lambda engine: with_body(engine, closeup=lambda p, f, w, h: engine.body.see(w, h)),
        "not in the middle",
    ),
    "rays-line": (
        lambda engine: with_body(engine, rays=lambda o, d: [o + Vec3(1, 1, 1)] * len(d)),
        "not on its ray",
    ),
    "rays-floor": (lambda engine: with_body(engine, rays=lambda o, d: [None]), "hits None"),
    "rays-objects": (
        lambda engine: with_body(engine, rays=lambda o, d: [None] * len(d)),
        "hit something else",
    ),
    "rays-body": (lambda engine: with_body(engine, rays=lambda o, d: [o]), "the body itself"),
    "rays-hand": (
        lambda engine: with_body(
            engine, rays=lambda o, d: [engine.body.state().held_box.center] * len(d)
        ),
        "in the hand",
    ),
    "look-turns": (instead("look", Outcome.DONE, "ok"), "the gaze is at"),
    "look-limits": (report("look", outcome=Outcome.DONE, code="ok"), "done, but the gaze"),
    "walk-arrives": (report("walk", walked_m=0.0), "says that it walked 0.00 m"),
    "walk-eyes": (body_state(eyes=Vec3(0.0, 0.0, 1.6)), "the eyes stayed"),
    "walk-stays": (report("walk", walked_m=3.0), "3.00 m"),
    "walk-outside": (report("walk", outcome=Outcome.DONE, code="ok"), "outside of the room"),
    "walk-obstacle": (report("walk", outcome=Outcome.DONE, code="ok"), "done, but it stands"),
    "pick-takes": (report("pick", code="hand_full"), "done/hand_full"),
    "pick-code": (report("pick", code="repositioned"), ""),
    "pick-closer": (takes_from_afar, "was out of reach: ok"),
    "pick-full": (report("pick", outcome=Outcome.DONE, code="ok"), "instead of refused/hand_full"),
    "drop-empty": (instead("drop", Outcome.DONE, "ok"), "done/ok instead of refused/hand_empty"),
    "drop-floor": (leaves_support, "the report says 'somewhere'"),
    "drop-rests": (counted(creeping), "it still moves"),
    "drop-back": (leaves_support, "reported 'somewhere'"),
    "drop-taken": (drops_at(Vec3(0.2, 0.0, 0.0)), "beside the wish"),
    "drop-nowhere": (instead("drop", Outcome.DONE, "ok"), "above the ceiling"),
    "hand-carries": (also("walk", lambda e: e.body.drop(e.body.state().position)), "let go"),
    "report-codes": (instead("drop", Outcome.DONE, "well"), "not 'well'"),
    "say-accepts": (also("say", wandering), "the world changed"),
    "again-same": (random_walk, "lead to another state"),
    "snapshot-restores": (
        lambda engine: Passing(engine, restore=lambda kept: None),
        "the world changed",
    ),
    "snapshot-leads-on": (forgets_hand, "leads to another state"),
    "snapshot-damaged": (
        lambda engine: Passing(engine, restore=lambda kept: None),
        "restored without a word",
    ),
    "snapshot-small": (lambda engine: Passing(engine, snapshot=lambda: b""), "0 bytes"),
    "events-sound": (
        lambda engine: Passing(engine, apply=stays_gone),
        "TypeError, not EngineError",
    ),
    "events-refused": (lambda engine: Passing(engine, apply=lambda e: None), "is carried out"),
    "events-gone": (instead("pick", Outcome.REFUSED, "unreachable"), ""),
}
"""For each check an engine that breaks it, and what is said then."""
HARD = {"pick-code", "events-gone", "pick-refused"}
"""What is broken here in ways of its own, below."""


@pytest.mark.parametrize("name", [name for name in BROKEN if name not in HARD])
def test_a_check_catches_what_it_is_there_for(engine: BuiltinEngine, name: str) -> None:
    broken, told = BROKEN[name]
    (finding,) = conform(broken(engine), [name]).findings
    assert finding.verdict is Verdict.FAILED, finding
    assert told in finding.found, finding.found
    assert finding.expected and finding.mend


def test_every_check_is_broken_once() -> None:
    assert {check.name for check in CHECKS} == {*BROKEN, *HARD}


def test_a_pick_that_says_it_walked_and_did_not_is_caught(engine: BuiltinEngine) -> None:
    near = with_body(engine, info=engine.body.info)
    real = engine.body.pick

    def pick(number: int) -> BodyReport:
        done = real(number)
        swapped = "ok" if done.code == "repositioned" else "repositioned"
        return replace(done, code=swapped)

    near.bodies["agent"].pick = pick
    (finding,) = conform(near, ["pick-code"]).findings
    assert finding.verdict is Verdict.FAILED and "the body moved" in finding.found


def test_a_refused_pick_that_changes_something_is_caught(engine: BuiltinEngine) -> None:
    def pick(number: int) -> BodyReport:
        wandering(engine)
        return BodyReport(Outcome.REFUSED, "unreachable")

    (finding,) = conform(with_body(engine, pick=pick), ["pick-refused"]).findings
    assert finding.verdict is Verdict.FAILED
    assert "the nearest place is not told" in finding.found and "the body" in finding.found


def test_what_was_taken_away_is_gone(engine: BuiltinEngine) -> None:
    real = engine.body.pick

    def pick(number: int) -> BodyReport:
        done = real(number)
        return replace(done, code="unreachable") if done.code == "gone" else done

    (finding,) = conform(with_body(engine, pick=pick), ["events-gone"]).findings
    assert "refused/unreachable instead of refused/gone" in finding.found


def test_an_event_that_is_refused_and_done_is_caught(engine: BuiltinEngine) -> None:
    def apply(event: Any) -> None:
        if isinstance(event, LightChanged):
            raise EngineError("no lights here.")
        wandering(engine)
        raise EngineError("never.")

    (finding,) = conform(Passing(engine, apply=apply), ["events-sound"]).findings
    assert "object_moved is refused, and the world changed" in finding.found
    with pytest.raises(EngineError):
        apply(ObjectTaken(1))
