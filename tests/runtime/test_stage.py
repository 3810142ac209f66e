"""Actions can be watched, filmed and stopped; watching changes nothing."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest

from adamo_vh.action import Code, Outcome
from adamo_vh.adapters.video import HEIGHT, WIDTH, VideoRecorder
from adamo_vh.engine import BodyReport
from adamo_vh.errors import ConfigError
from adamo_vh.geometry import Vec3
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session.filming import FilmSet

PLATE, CUP = 57, 45
FLOOR = Vec3(-1.6, -2.4, 0.0)


def play(engine: BuiltinEngine) -> list[tuple[BodyReport, str]]:
    engine.reset(0)
    story = []
    for act in (
        lambda: engine.body.look(Vec3(0, -1, 0.8)),
        lambda: engine.body.pick(PLATE),
        lambda: engine.body.walk(Vec3(1.5, 1.5, 0)),
        lambda: engine.body.drop(FLOOR),
    ):
        report = act()
        story.append((report, engine.snapshot().hex()))
    return story


def test_watching_changes_no_state_bit_for_bit(engine: BuiltinEngine) -> None:
    alone = play(engine)
    engine.stage.watcher = lambda _: True
    try:
        assert play(engine) == alone
    finally:
        engine.stage.watcher = None


def test_the_moments_are_in_order_and_continuous(engine: BuiltinEngine) -> None:
    times: list[float] = []
    places: list[Vec3] = []
    hands: list[Vec3] = []

    def watch(seconds: float) -> bool:
        shown = engine.stage.shown(engine.body.stance)
        times.append(seconds)
        places.append(shown.body.position)
        hands.append(shown.hand)
        return True

    engine.stage.watcher = watch
    try:
        engine.body.walk(Vec3(2.0, -1.0, 0.0))
    finally:
        engine.stage.watcher = None
    assert times == sorted(times)
    assert times[-1] > 3.0
    steps = [a.distance(b) for a, b in itertools.pairwise(places)]
    assert max(steps) < 0.15
    assert max(a.distance(b) for a, b in itertools.pairwise(hands)) < 0.25
    assert places[-1] == engine.body.state().position


def test_a_thing_is_in_the_hand_from_the_grasp_on(engine: BuiltinEngine) -> None:
    gaps: list[float] = []

    def watch(_: float) -> bool:
        shown = engine.stage.shown(engine.body.stance)
        if shown.body.held == CUP:
            gaps.append(shown.hand.distance(engine._world.box(CUP).center))
        return True

    engine.stage.watcher = watch
    try:
        engine.body.pick(CUP)
    finally:
        engine.stage.watcher = None
    assert gaps
    assert max(gaps) < 1e-6


@pytest.mark.parametrize("moment", [0.0, 0.4, 1.0, 2.0])
def test_a_walk_can_be_stopped_anywhere(engine: BuiltinEngine, moment: float) -> None:
    engine.stage.watcher = lambda seconds: seconds < moment
    try:
        report = engine.body.walk(Vec3(2.0, -1.0, 0.0))
    finally:
        engine.stage.watcher = None
    assert (report.outcome, report.code) == (Outcome.CORRECTED, Code.CANCELLED)
    here = engine.body.state().position
    assert report.point == here
    assert here.horizontal_distance(Vec3(2.0, -1.0, 0)) > 1.0
    assert engine.body.walk(Vec3(2.0, -1.0, 0.0)).outcome is Outcome.DONE


def test_a_pick_that_is_stopped_leaves_the_thing_or_holds_it(engine: BuiltinEngine) -> None:
    """Whenever it is stopped, the thing is either on the table or in the hand, never in between."""
    seen = set()
    for moment in np.arange(0.0, 6.0, 0.4):
        engine.reset(0)
        engine.body.walk(Vec3(-0.9, -0.4, 0.0))
        engine.stage.watcher = lambda seconds, stop=moment: seconds < stop
        engine.body.pick(CUP)
        engine.stage.watcher = None
        cup = engine.state().object(CUP)
        assert cup.held == (engine.body.state().held == CUP)
        assert cup.held or cup.support == "table"
        seen.add(cup.held)
    assert seen == {True, False}


def test_the_figure_is_seen_from_outside_but_does_not_hide_the_view(
    engine: BuiltinEngine,
) -> None:
    own = engine.capture(640, 360)
    engine.body.walk(Vec3(1.6, -1.0, 0.0))
    outside = engine.view(own.camera)
    assert np.abs(outside.rgb.astype(int) - own.rgb.astype(int)).max(axis=2).mean() > 0.5
    assert len(own.objects) == 19


def test_a_film_can_be_played(engine: BuiltinEngine, tmp_path: Path) -> None:
    import cv2

    recorder = VideoRecorder(tmp_path / "film.webm", FilmSet(engine))
    try:
        engine.body.look(Vec3(0.5, -1.2, 1.0))
    finally:
        recorder.close()
    assert engine.stage.watcher is None
    film = cv2.VideoCapture(str(tmp_path / "film.webm"))
    pictures = 0
    while True:
        read, picture = film.read()
        if not read:
            break
        pictures += 1
        assert picture.shape == (HEIGHT, WIDTH, 3)
        assert picture.std() > 10
    assert pictures >= 4
    assert (tmp_path / "film.vtt").read_text(encoding="utf-8").startswith("WEBVTT")


def test_a_film_needs_a_known_ending(engine: BuiltinEngine, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"\.webm, \.avi or \.mp4"):
        VideoRecorder(tmp_path / "film.mov", FilmSet(engine))


BOTTLE, PLANT = 36, 50


@pytest.mark.parametrize("thing", [BOTTLE, CUP, PLANT])
def test_what_is_taken_is_in_the_hand_at_every_moment_and_where_it_is_told(
    engine: BuiltinEngine, thing: int
) -> None:
    engine.reset(0)
    gaps: list[float] = []

    def watch(seconds: float) -> bool:
        shown = engine.stage.shown(engine.body.stance)
        if shown.body.held is not None:
            gaps.append(shown.hand.distance(engine.world.box(thing).center))
        return True

    engine.stage.watcher = watch
    try:
        assert engine.body.pick(thing).outcome is not Outcome.REFUSED
    finally:
        engine.stage.watcher = None
    assert len(gaps) > 8
    assert max(gaps) < 1e-6
    # At rest the thing is where every thing is carried, and the hand has come to it.
    stance = engine.body.stance
    assert engine.world.box(thing).center.distance(engine.stage.hand(stance)) < 1e-9
    assert engine.stage.shown(stance).hand.distance(engine.stage.hand(stance)) < 0.03


def test_the_outline_of_a_thing_is_that_of_its_meshes(engine: BuiltinEngine) -> None:
    engine.reset(0)
    corners = engine.world.surface(PLANT)
    size = engine.world.objects[PLANT].size
    np.testing.assert_allclose(np.ptp(corners, axis=0), size.array(), atol=0.012)
    thing = engine.stage.thing(PLANT)
    assert thing is not None
    ahead = np.array([1.0, 0.0])
    # Below are the narrow pot's sides, above those of the leaves.
    assert thing.side(ahead, -0.12) < 0.8 * thing.side(ahead, 0.08)
    assert thing.height == pytest.approx(size.z, abs=0.012)
    assert engine.stage.thing(None) is None
    assert engine.stage.thing(PLANT) is thing
