"""The built-in engine keeps the rules of the world on the tabletop."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from adamo_vh.action import Code, Outcome
from adamo_vh.action_server.soundness import state_faults
from adamo_vh.engine import FLOOR, WorldState
from adamo_vh.errors import EngineError
from adamo_vh.geometry import Vec3
from adamo_vh.observation import NOTHING
from adamo_vh.runtime import physics
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.embodiment import REACH_M
from adamo_vh.runtime.inspection.soundness import Soundness
from adamo_vh.runtime.navigation import BODY_RADIUS_M
from adamo_vh.runtime.rendering import SceneRenderer
from adamo_vh.runtime.scenes import load_scene

PLATE, GLASS, KEY, TAPE, CUP, BOTTLE = 57, 37, 34, 4, 45, 36
SMALL = (480, 270)


def place(state: WorldState, object_id: int) -> Vec3:
    return state.object(object_id).box.center


def test_everything_settles_where_the_scene_says(engine: BuiltinEngine) -> None:
    state = engine.state()
    assert len(state.objects) == 19
    for item, placed in zip(
        state.objects, sorted(load_scene("s1").objects, key=lambda o: o.id), strict=True
    ):
        assert item.support == "table"
        assert item.box.center.horizontal_distance(Vec3(*placed.position, 0)) < 0.005
        assert item.box.bottom_z == pytest.approx(0.78, abs=0.003)
        assert item.box.orientation.matrix()[2, 2] > 0.999


def test_the_furniture_is_outlined_from_above(engine: BuiltinEngine) -> None:
    (table,) = engine.state().furniture
    xs, ys = zip(*table.points, strict=True)
    assert (table.name, table.bottom_m) == ("table", 0.0)
    assert table.top_m == pytest.approx(0.78, abs=0.002)
    # 1.05 x 1.66 m, centred at (-0.05, -1.0), as the scene has it.
    assert (min(xs), max(xs)) == pytest.approx((-0.575, 0.475), abs=0.01)
    assert (min(ys), max(ys)) == pytest.approx((-1.83, -0.17), abs=0.01)


def test_what_rests_goes_on_resting(engine: BuiltinEngine) -> None:
    before = engine.state()
    for target in (CUP, KEY, PLATE):
        engine.body.pick(target)
        engine.body.drop(Vec3(-1.6, -2.0, 0.0))
    after = engine.state()
    for item in before.objects:
        if item.id not in (CUP, KEY, PLATE):
            assert after.object(item.id).box == item.box


def test_the_first_view_shows_all_objects(engine: BuiltinEngine) -> None:
    percept = engine.capture(1920, 1080)
    assert sorted(percept.objects) == [item.id for item in engine.state().objects]
    assert percept.rgb.shape == (1080, 1920, 3)
    for layer in percept.id_layers:
        assert set(np.unique(layer)) <= {NOTHING, *percept.objects}


def test_ids_agree_with_the_geometry(engine: BuiltinEngine) -> None:
    """Pixels of each object lie where its box is projected: nothing leaks at the edges."""
    percept = engine.capture(1920, 1080)
    for item in percept.objects.values():
        corners = percept.camera.project(item.box.corners())
        low, high = corners[:, :2].min(axis=0) - 2, corners[:, :2].max(axis=0) + 2
        for layer in percept.id_layers:
            rows, columns = np.nonzero(layer == item.id)
            assert (columns >= low[0]).all()
            assert (columns <= high[0]).all()
            assert (rows >= low[1]).all()
            assert (rows <= high[1]).all()


def test_what_stands_behind_the_glass_is_in_the_second_layer(engine: BuiltinEngine) -> None:
    engine.body.pick(KEY)
    glass = place(engine.state(), GLASS)
    engine.body.drop(Vec3(glass.x + 0.075, glass.y, 0.78))
    engine.body.walk(Vec3(-0.85, glass.y, 0))
    engine.body.look(glass)
    front, behind = engine.capture(1920, 1080).id_layers
    assert (front == GLASS).any()
    assert not (behind == GLASS).any()
    assert (behind == KEY).sum() > (front == KEY).sum()


def test_picking_walks_within_reach_and_holds(engine: BuiltinEngine) -> None:
    report = engine.body.pick(PLATE)
    state = engine.state()
    assert (report.outcome, report.code) == (Outcome.DONE, Code.REPOSITIONED)
    assert report.point is not None
    assert engine.body.state().position.horizontal_distance(report.point) <= REACH_M
    held = state.object(PLATE)
    assert held.held
    assert held.support is None
    assert state.body.held == PLATE
    assert engine.body.pick(GLASS).code == Code.HAND_FULL


def test_the_held_object_goes_with_the_body(engine: BuiltinEngine) -> None:
    engine.body.pick(CUP)
    engine.body.walk(Vec3(2.0, 2.0, 0.0))
    state = engine.state()
    assert place(state, CUP).horizontal_distance(state.body.position) < 0.6
    assert 0.8 < place(state, CUP).z < 1.3


AT_THE_WALL = [
    (Vec3(-2.75, -1.0, 0.0), Vec3(-3.0, -1.0, 1.4)),
    (Vec3(2.75, 0.0, 0.0), Vec3(3.0, 0.0, 1.4)),
    (Vec3(-1.0, 2.75, 0.0), Vec3(3.0, 2.75, 1.4)),
    (Vec3(-2.75, -4.75, 0.0), Vec3(-3.0, -5.0, 1.0)),
]
"""Places to stand, and where to look from there: at a wall, along one, into a corner."""


@pytest.mark.parametrize("object_id", [PLATE, BOTTLE, 50])
def test_what_is_held_is_never_in_a_wall(engine: BuiltinEngine, object_id: int) -> None:
    sound, room = Soundness(engine.world), engine.scene
    engine.body.pick(object_id)
    for place_to_stand, gaze in AT_THE_WALL:
        assert engine.body.walk(place_to_stand).outcome is Outcome.DONE
        engine.body.look(gaze)
        state = engine.state()
        corners = state.object(object_id).box.corners()
        assert (corners[:, :2] > [room.x_min, room.y_min]).all()
        assert (corners[:, :2] < [room.x_max, room.y_max]).all()
        assert [*state_faults(state), *sound.faults(state)] == []
        # The hand went along, and the thing is still before the body.
        hand = engine.stage.shown(engine.body.stance).hand
        assert hand.distance(place(state, object_id)) < 1e-6
        assert place(state, object_id).horizontal_distance(state.body.position) > 0.1
        # It is a state like any other.
        kept = engine.snapshot()
        engine.restore(kept)
        assert engine.state() == state


def test_away_from_walls_things_are_held_at_arms_length(engine: BuiltinEngine) -> None:
    """Drawn in at a wall, and out again as soon as there is room."""
    engine.body.pick(PLATE)
    engine.body.walk(Vec3(-2.0, -3.0, 0.0))
    engine.body.look(Vec3(0.0, -3.0, 1.0))
    before = engine.state()
    engine.body.walk(Vec3(-2.75, -3.0, 0.0))
    engine.body.look(Vec3(-3.0, -3.0, 1.0))
    near = engine.state()
    assert place(near, PLATE).horizontal_distance(near.body.position) < 0.3
    engine.body.walk(Vec3(-2.0, -3.0, 0.0))
    engine.body.look(Vec3(0.0, -3.0, 1.0))
    assert engine.state().hash() == before.hash()
    assert place(before, PLATE).horizontal_distance(before.body.position) > 0.35


def test_a_watched_carrier_pushes_nothing_through_the_wall(engine: BuiltinEngine) -> None:
    engine.body.pick(PLATE)
    lowest: list[float] = []

    def watch(_: float) -> bool:
        shown = engine.stage.shown(engine.body.stance)
        box = engine.world.box(PLATE)
        assert shown.hand.distance(box.center) < 1e-6
        lowest.append(float(box.corners()[:, 0].min()))
        return True

    engine.stage.watcher = watch
    try:
        engine.body.walk(Vec3(-2.75, -2.0, 0.0))
        engine.body.look(Vec3(-3.0, -2.0, 1.0))
    finally:
        engine.stage.watcher = None
    assert len(lowest) > 20
    assert min(lowest) > -3.0


def test_the_rules_tell_a_held_thing_in_a_wall(engine: BuiltinEngine) -> None:
    engine.body.pick(PLATE)
    engine.body.walk(Vec3(-2.75, -1.0, 0.0))
    assert state_faults(engine.state()) == []
    physics.place(engine.world, PLATE, Vec3(-3.05, -1.0, 1.05))
    assert any("not inside the room" in fault for fault in state_faults(engine.state()))


def test_a_free_point_on_the_floor_takes_the_object(engine: BuiltinEngine) -> None:
    engine.body.pick(PLATE)
    report = engine.body.drop(Vec3(-1.6, -2.4, 0.0))
    item = engine.state().object(PLATE)
    assert report.outcome is Outcome.DONE
    assert report.support == item.support == FLOOR
    assert item.box.center.horizontal_distance(Vec3(-1.6, -2.4, 0)) < 0.03
    assert item.box.bottom_z == pytest.approx(0.0, abs=0.003)
    assert not item.held


def test_a_point_on_another_object_is_corrected(engine: BuiltinEngine) -> None:
    engine.body.pick(GLASS)
    plate = place(engine.state(), PLATE)
    report = engine.body.drop(plate)
    item = engine.state().object(GLASS)
    assert (report.outcome, report.code) == (Outcome.CORRECTED, Code.PLACED_ELSEWHERE)
    assert item.support == "table"
    assert 0.1 < item.box.center.horizontal_distance(plate) < 0.3


def test_a_point_in_the_air_above_the_table_lands_on_it(engine: BuiltinEngine) -> None:
    engine.body.pick(CUP)
    report = engine.body.drop(Vec3(-0.42, -0.35, 1.1))
    assert report.outcome is Outcome.CORRECTED
    assert engine.state().object(CUP).support == "table"


def test_a_point_far_from_any_surface_is_refused_and_nothing_changes(
    engine: BuiltinEngine,
) -> None:
    engine.body.pick(CUP)
    before = engine.state().hash()
    report = engine.body.drop(Vec3(1.5, 1.5, 1.6))
    assert (report.outcome, report.code) == (Outcome.REFUSED, Code.NO_FREE_SPOT)
    assert engine.state().hash() == before


def test_dropping_with_an_empty_hand_is_refused(engine: BuiltinEngine) -> None:
    assert engine.body.drop(Vec3(0, 0, 0)).code == Code.HAND_EMPTY


def test_the_body_never_stands_on_what_it_drops(engine: BuiltinEngine) -> None:
    engine.body.pick(PLATE)
    here = engine.body.state().position
    engine.body.drop(here)
    plate = place(engine.state(), PLATE)
    assert plate.horizontal_distance(here) < 0.05
    assert engine.body.state().position.horizontal_distance(plate) > BODY_RADIUS_M + 0.125


def test_walking_around_and_into_the_table(engine: BuiltinEngine) -> None:
    over = engine.body.walk(Vec3(2.0, -1.0, 0.0))
    assert over.outcome is Outcome.DONE
    assert over.walked_m > 4.0
    into = engine.body.walk(Vec3(-0.05, -1.0, 0.0))
    assert (into.outcome, into.code) == (Outcome.CORRECTED, Code.STOPPED_SHORT)
    assert into.point is not None
    assert into.point.x > 0.475 + BODY_RADIUS_M - 0.01
    assert into.walked_m < 2.0


def test_looking_straight_down_is_corrected(engine: BuiltinEngine) -> None:
    here = engine.body.state().position
    assert engine.body.look(Vec3(here.x, here.y, 0.0)).code == Code.GAZE_LIMITED
    assert engine.body.look(Vec3(here.x, here.y + 1.0, 0.0)).outcome is Outcome.DONE


def test_the_looked_at_point_is_in_the_middle_of_the_view(engine: BuiltinEngine) -> None:
    target = Vec3(0.326, -0.603, 0.8)
    engine.body.look(target)
    camera = engine.capture(*SMALL).camera
    assert camera.project(target.array()[None])[0, :2] == pytest.approx((240, 135), abs=1)


def test_rays_pass_through_the_held_object(engine: BuiltinEngine) -> None:
    engine.body.pick(PLATE)
    hand = place(engine.state(), PLATE)
    eyes = engine.body.state().eyes
    direction = (hand - eyes).array()[None] / (hand - eyes).norm()
    [hit] = engine.body.rays(eyes, direction)
    assert hit is not None
    assert hit.distance(eyes) > hand.distance(eyes) + 0.1


def test_rays_hit_what_the_picture_shows(engine: BuiltinEngine) -> None:
    camera = engine.capture(*SMALL).camera
    table_point = np.array([[-0.5, -1.0, 0.78]])
    pixel = camera.project(table_point)[:, :2]
    [hit] = engine.body.rays(camera.position, camera.rays(pixel))
    assert hit is not None
    assert hit.array() == pytest.approx(table_point[0], abs=0.01)


def _play(engine: BuiltinEngine) -> tuple[str, bytes]:
    engine.reset(3)
    engine.body.pick(PLATE)
    engine.body.drop(Vec3(-1.6, -2.4, 0.0))
    engine.body.look(Vec3(0, -1, 0.8))
    engine.body.pick(BOTTLE)
    engine.body.drop(Vec3(-0.3, -0.6, 0.78))
    return engine.state().hash(), engine.capture(*SMALL).rgb.tobytes()


def test_the_same_seed_gives_the_same_states_and_frames(engine: BuiltinEngine) -> None:
    assert _play(engine) == _play(engine)


def test_another_process_gives_the_same_states_and_frames(engine: BuiltinEngine) -> None:
    program = (
        "import hashlib; from adamo_vh.runtime.builtin import BuiltinEngine;"
        "from tests.runtime.test_builtin_engine import _play;"
        "h, f = _play(BuiltinEngine('s1')); print(h, hashlib.sha256(f).hexdigest())"
    )
    import hashlib

    digest, frame = _play(engine)
    out = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    ).stdout
    assert out.split() == [digest, hashlib.sha256(frame).hexdigest()]


def test_another_action_gives_another_hash(engine: BuiltinEngine) -> None:
    start = engine.state().hash()
    engine.body.look(Vec3(1, 1, 1))
    assert engine.state().hash() != start
    engine.reset(0)
    assert engine.state().hash() == start


def test_what_is_said_is_delivered(engine: BuiltinEngine) -> None:
    engine.body.say("Done.")
    assert list(engine.body.said) == ["Done."]
    engine.reset(0)
    assert list(engine.body.said) == []


def test_a_snapshot_goes_on_the_same_way(engine: BuiltinEngine) -> None:
    engine.body.pick(PLATE)
    kept = engine.snapshot()
    at = engine.state()
    engine.body.drop(Vec3(-1.6, -2.4, 0.0))
    engine.body.pick(BOTTLE)
    end = engine.state().hash()
    engine.restore(kept)
    assert engine.state() == at
    engine.body.drop(Vec3(-1.6, -2.4, 0.0))
    engine.body.pick(BOTTLE)
    assert engine.state().hash() == end


def test_a_damaged_snapshot_is_refused(engine: BuiltinEngine) -> None:
    before = engine.state().hash()
    for damaged in (b"", b"nonsense", engine.snapshot()[:50]):
        with pytest.raises(EngineError, match="damaged"):
            engine.restore(damaged)
    assert engine.state().hash() == before


def test_the_first_picture_needs_no_scipy() -> None:
    """Its import would take a tenth of the time from the start to the first frame."""
    program = (
        "import sys; import adamo_vh; from adamo_vh.action_server import LocalActionServer;"
        "LocalActionServer(adamo_vh.create_engine('s1'), resolution=(320, 180)).observe();"
        "print(sorted(name for name in sys.modules if name.split('.')[0] == 'scipy'))"
    )
    out = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    ).stdout
    assert out.strip() == "[]"


def test_drawing_leaves_the_model_as_it_is(engine: BuiltinEngine) -> None:
    """What MuJoCo would draw on is left out; the model keeps its sizes."""
    sizes = (1920, 1080)
    SceneRenderer(engine.world.model, engine.world.object_of_geom).close()
    vis = engine.world.model.vis
    assert (vis.global_.offwidth, vis.global_.offheight) == sizes
    assert min(vis.quality.offsamples, vis.quality.shadowsize) > 0


def test_no_ray_slips_through_between_two_triangles(engine: BuiltinEngine) -> None:
    # The floor's own edge runs here.
    down = np.array([[0.0, 0.0, -1.0], [0.1, 0.0, -1.0]])
    hits = engine.body.rays(Vec3(-1.2, -1.0, 1.0), down / np.linalg.norm(down, axis=1)[:, None])
    assert [None if hit is None else round(hit.z, 6) for hit in hits] == [0.0, 0.0]
