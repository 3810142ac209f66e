"""The floor plan measures what happened, and draws the room around it."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
from tests.report.test_page_lean import DONE, call, lean, lean_turns
from tests.run_folder import played
from tests.tabletop import carried_out, tabletop

from adamo_vh.action import Walk
from adamo_vh.engine import FurnitureOutline, WorldState
from adamo_vh.geometry import Quaternion
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.report.floor_plan import floor_plan
from adamo_vh.report.timeline import turns
from adamo_vh.report.whereabouts import Whereabouts


def furnished() -> WorldState:
    """The tabletop with a table, a chair below it, a rug, a lamp and a picture."""

    def piece(
        name: str, x: float, y: float, half: float, low: float, high: float
    ) -> FurnitureOutline:
        corners = ((x - half, y - half), (x + half, y - half), (x + half, y + half))
        return FurnitureOutline(name, (*corners, (x - half, y + half)), low, high)

    pieces = (
        piece("lamp", 0.0, -1.0, 0.2, 2.1, 3.2),
        piece("table", 0.0, -1.0, 0.8, 0.0, 0.78),
        piece("chair", 0.7, -1.0, 0.25, 0.0, 0.9),
        piece("rug", 0.0, -1.0, 1.4, 0.0, 0.01),
        piece("picture", 0.0, -4.9, 0.1, 1.2, 1.9),
        FurnitureOutline("no outline", (), 0.0, 1.0),
    )
    return replace(tabletop(), furniture=pieces)


def test_the_floor_plan_measures_the_episode(tmp_path: Path) -> None:
    run = played(tmp_path)
    plan = floor_plan(run.manifest.initial, turns(read_trajectory(tmp_path)), run.world)
    assert (plan.x, plan.y, plan.width, plan.height) == (-3.0, -3.0, 6.0, 8.0)
    assert len(plan.objects) == 19
    assert len(plan.areas) == 4
    assert [surface.label for surface in plan.surfaces] == ["table"]  # No furniture is known.
    assert [stop.label for stop in plan.stops] == ["start", "1–4", "5"]
    assert (plan.stops[0].x, plan.stops[0].y) == (-2.0, 1.0)  # y is turned over.
    assert plan.path.count(" ") == 2
    (move,) = plan.moves
    assert move.title == "Tape_4: now on table"
    assert move.start == (-0.174, 0.603)
    assert (move.outline.x, move.outline.y) == (0.12, 1.25)


def test_the_floor_plan_outlines_turned_boxes(tmp_path: Path) -> None:
    world = tabletop()
    item = world.object(5)
    turned = replace(item, box=replace(item.box, orientation=Quaternion.from_yaw(math.pi / 2)))
    plan = floor_plan(replace(world, objects=(turned,)), (), None)
    (outline,) = plan.objects
    xs, ys = zip(*(map(float, p.split(",")) for p in outline.points.split()), strict=True)
    assert max(xs) - min(xs) == pytest.approx(item.box.size.y, abs=2e-3)
    assert max(ys) - min(ys) == pytest.approx(item.box.size.x, abs=2e-3)
    assert len(xs) == 4


def test_the_floor_plan_has_every_stop_of_a_plan(tmp_path: Path) -> None:
    run = lean(tmp_path)
    spots = [{"x": -1.5, "y": 0.5, "z": 0.0}, {"x": -1.0, "y": 2.0, "z": 0.0}]
    run.think("", *(call("Walk", "On.", **spot) for spot in spots))
    for spot in spots:
        run.world = carried_out(run.world, Walk(**spot))
        run.acted("Walk", spot, DONE)
    plan = floor_plan(run.manifest.initial, lean_turns(run), None)
    assert [stop.label for stop in plan.stops] == ["start", "1", "2"]
    assert len(plan.poses) == 1


def test_furniture_is_drawn_and_named_in_the_order_in_which_it_covers() -> None:
    plan = floor_plan(furnished(), (), None)
    assert [(item.label, item.kind) for item in plan.furniture] == [
        ("rug", "flat"),
        ("picture", "wall"),
        ("chair", "standing"),
        ("table", "standing"),
        ("lamp", "hanging"),
    ]
    assert plan.surfaces == ()
    names = [label.text for label in plan.labels["large"] if label.kind == "name"]
    assert names == ["table", "chair"]
    assert [label.text for label in plan.labels["small"] if label.kind == "name"] == ["table"]


def test_a_bare_room_is_drawn_where_something_is() -> None:
    plan = floor_plan(tabletop(), (), None)
    view = plan.view
    assert view.width < 4.5 and view.height < 4.5
    # The body at (-2, 1) in the drawing's frame, and all of the table.
    assert view.x < -2.3 and view.x + view.width > 0.8
    assert plan.labels["small"][0].size < 0.2


def test_the_whole_of_a_furnished_room_is_drawn() -> None:
    world = furnished()
    far = replace(world.furniture[1], points=((-3, -5), (3, -5), (3, 3), (-3, 3)))
    plan = floor_plan(replace(world, furniture=(far,)), (), None)
    assert (plan.view.width, plan.view.height) == pytest.approx((6.7, 8.7))


def test_no_labels_overlap_where_things_are_crowded() -> None:
    for labels in floor_plan(furnished(), (), None).labels.values():
        boxes = [label.extent for label in labels]
        for i, (left, top, right, bottom) in enumerate(boxes):
            for a, b, c, d in boxes[i + 1 :]:
                assert right <= a or c <= left or bottom <= b or d <= top


def test_every_object_has_its_number_in_the_large_plan() -> None:
    world = tabletop()
    labels = floor_plan(world, (), None).labels["large"]
    numbers = {label.text for label in labels if label.kind == "object"}
    assert numbers == {str(item.id) for item in world.objects}


def test_without_a_final_state_the_feedback_tells_what_moved() -> None:
    told = {
        "Tape_4": Whereabouts("Tape_4", 2, "on the floor", (1.0, 2.0)),
        "57": Whereabouts("57", 3, "in the hand"),
    }
    (move,) = floor_plan(tabletop(), (), None, told).moves
    assert move.title == "Tape_4: now on the floor"
    assert (move.outline.x, move.outline.y) == (1.0, -2.0)
