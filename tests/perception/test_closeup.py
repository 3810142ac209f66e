"""Inspect and Survey: large, truthful pictures of what is in view, and of nothing else."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator, Sequence

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from adamo_vh.action import Action, Code, Drop, Inspect, Look, Outcome, Pick, Survey, Walk
from adamo_vh.action_server import LEAN_TOOLS, LocalActionServer
from adamo_vh.geometry import Vec3
from adamo_vh.observation import Frame, Percept
from adamo_vh.perception import ImageFormat, Labeling, PerceptionConfig
from adamo_vh.perception.closeup import (
    CLOSEUP_FONT_PX,
    CLOSEUP_PX,
    STRIP,
    aim,
    seen_corners,
    strip_px,
)
from adamo_vh.perception.contact_sheet import SHEET_PX
from adamo_vh.perception.plates import INK, tag_colour
from adamo_vh.perception.visibility import PixelBox, visible_objects
from adamo_vh.runtime.builtin import BuiltinEngine

FULL = (1280, 720)
SMALL = (480, 270)
PLATE, KEY, PEANUT_BUTTER, CUP, GLASS = 57, 34, 8, 45, 37
STRIP_PX = strip_px(CLOSEUP_FONT_PX)
BLANK = (58, 60, 66)
LENGTHWISE = 0.65
"""How much of one side of a close-up an object takes at least."""
IN_HAND = 0.55
"""The same for what is in the hand, of which all of the box is shown."""

Picture = NDArray[np.uint8]


@pytest.fixture(scope="module")
def living_room() -> Iterator[BuiltinEngine]:
    made = BuiltinEngine("s2")
    yield made
    made.close()


def serve(
    engine: BuiltinEngine,
    resolution: tuple[int, int] = FULL,
    labeling: Labeling = Labeling.SEM,
) -> LocalActionServer:
    """A server without losses in its pictures."""
    config = PerceptionConfig(labeling, image_format=ImageFormat.PNG)
    return LocalActionServer(engine, perception=config, resolution=resolution, tools=LEAN_TOOLS)


def pixels(frame: Frame) -> Picture:
    with Image.open(io.BytesIO(frame.data)) as picture:
        assert picture.size == (frame.width_px, frame.height_px)
        return np.asarray(picture.convert("RGB"))


def shown(server: LocalActionServer, action: Action) -> Picture:
    """The one picture that an action shows."""
    result = server.execute(action)
    assert result.feedback.outcome is Outcome.DONE, result.feedback.text
    assert result.observation is None
    (frame,) = result.pictures
    return pixels(frame)


def near_of(engine: BuiltinEngine, view: Percept, box: PixelBox) -> Percept:
    """What a close-up of a part of a view is made from."""
    aimed = aim(view.camera.position, seen_corners(view, box), CLOSEUP_PX)
    return engine.body.closeup(aimed.point, aimed.fov_y_rad, aimed.width_px, aimed.height_px)


def mask_of(percept: Percept, object_id: int) -> NDArray[np.bool_]:
    return np.asarray(np.logical_or.reduce([ids == object_id for ids in percept.id_layers]))


def spread(mask: NDArray[np.bool_]) -> tuple[float, float]:
    """Width and height of what is true, as shares of the whole."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return (
        float(columns[-1] + 1 - columns[0]) / mask.shape[1],
        float(rows[-1] + 1 - rows[0]) / mask.shape[0],
    )


def check_inspected(server: LocalActionServer, engine: BuiltinEngine, object_id: int) -> None:
    """An object in view is shown large, whole and with nothing drawn on it."""
    tag = server.tag(object_id)
    view = engine.capture(*FULL)
    item = next(found for found in visible_objects(view, 20) if found.id == object_id)
    picture = shown(server, Inspect(tag))
    near = near_of(engine, view, item.box_px)
    mask = mask_of(near, object_id)
    assert max(spread(mask)) >= LENGTHWISE, tag
    assert mask.sum() > 8 * item.pixels or mask.mean() > 0.25, tag
    assert picture.shape == (mask.shape[0] + STRIP_PX, mask.shape[1], 3)
    beyond = (picture[STRIP_PX:] == BLANK).all(axis=-1)
    assert (picture[STRIP_PX:][mask & ~beyond] == near.rgb[mask & ~beyond]).all(), tag
    # The tag's plate has an edge in its colour, and it is in the strip above the picture.
    assert (picture[:STRIP_PX] == tag_colour(tag)).all(axis=-1).any(), tag


# --- Inspect ---------------------------------------------------------------------------------


@pytest.mark.parametrize("labeling", list(Labeling))
def test_every_object_of_the_tabletop_can_be_inspected(
    engine: BuiltinEngine, labeling: Labeling
) -> None:
    server = serve(engine, labeling=labeling)
    assert len(server.observe().observation.objects) == 19
    # How an object is called changes nothing of how it looks.
    for object_id in list(engine.object_names)[:: 1 if labeling is Labeling.SEM else 4]:
        check_inspected(server, engine, object_id)


@pytest.mark.parametrize(
    ("stand", "look"),
    [
        ((-2.0, -1.0), (0.5, -2.9, 0.8)),
        ((0.2, -1.2), (0.1, -2.9, 0.8)),
        ((1.9, 1.6), (1.9, 2.7, 1.3)),
        ((1.7, -0.4), (2.7, -0.45, 0.6)),
    ],
)
def test_objects_of_the_living_room_can_be_inspected_from_several_places(
    living_room: BuiltinEngine, stand: tuple[float, float], look: tuple[float, float, float]
) -> None:
    living_room.reset(0)
    server = serve(living_room)
    server.execute(Walk(*stand, 0.0))
    seen = server.execute(Look(*look)).observation
    assert seen is not None
    assert len(seen.objects) >= 2
    ids = {server.tag(i): i for i in living_room.object_names}
    for item in seen.objects:
        check_inspected(server, living_room, ids[item.tag])


def test_showing_changes_nothing(engine: BuiltinEngine) -> None:
    server = serve(engine, SMALL)
    server.observe()
    before, body = server.save(), engine.body.state()
    hashed = server.state_hash()
    for action in (Inspect("Key_34"), Survey(), Inspect("Plate_57"), Inspect("Unicorn_1")):
        result = server.execute(action)
        assert result.state_hash == hashed
        assert (server.save(), engine.body.state()) == (before, body)
    assert server.observe().observation.frame == serve(engine, SMALL).observe().observation.frame


def test_what_is_not_in_view_is_not_shown(engine: BuiltinEngine) -> None:
    server = serve(engine, SMALL)
    server.observe()
    server.execute(Look(-2.9, -1.0, 1.5))
    result = server.execute(Inspect("Plate_57"))
    assert (result.feedback.outcome, result.feedback.code) == (Outcome.REFUSED, Code.NOT_IN_VIEW)
    assert result.feedback.text == "Refused: Plate_57 is not in view now; look at it first."
    assert result.pictures == ()


def test_unseen_and_unknown_tags_read_the_same_as_for_pick(engine: BuiltinEngine) -> None:
    engine.body.look(Vec3(-2.9, -1.0, 1.5))
    server = serve(engine, SMALL)
    assert server.observe().observation.objects == ()
    for tag, code in (("Plate_57", Code.NOT_SEEN), ("Plate_58", Code.UNKNOWN_TAG)):
        refused = server.execute(Inspect(tag))
        assert refused.feedback == server.execute(Pick(tag)).feedback
        assert refused.feedback.code == code
        assert refused.pictures == ()
    # In view, but not yet in a view that the agent was shown.
    engine.body.look(Vec3(0.0, -1.0, 0.8))
    assert server.execute(Inspect("Plate_57")).feedback.code == Code.NOT_SEEN


@pytest.mark.parametrize("object_id", [PLATE, KEY, CUP])
def test_what_is_in_the_hand_can_always_be_inspected(engine: BuiltinEngine, object_id: int) -> None:
    server = serve(engine)
    server.observe()
    tag = server.tag(object_id)
    server.execute(Pick(tag))
    for look_down in (False, True):
        hand = engine.state().object(object_id).box.center
        point = Vec3(hand.x, hand.y, hand.z) if look_down else Vec3(-1.0, 2.9, 1.7)
        engine.body.look(point)
        in_view = object_id in {i.id for i in visible_objects(engine.capture(*FULL), 20)}
        assert in_view == look_down
        picture = shown(server, Inspect(tag))[STRIP_PX:]
        blank = (picture == BLANK).all(axis=-1)
        assert blank.any() == (not look_down)
        # The thing itself, also where the view ends.
        assert max(spread(~blank)) >= IN_HAND
        assert picture[~blank].std() > 10


# --- partial observability -------------------------------------------------------------------


def cut_by_the_edge(engine: BuiltinEngine) -> tuple[Percept, int, PixelBox]:
    """Look so that the edge of the view cuts an object."""
    for y in np.arange(0.0, 2.5, 0.05):
        engine.body.look(Vec3(-0.2, float(y), 0.9))
        view = engine.capture(*FULL)
        for item in visible_objects(view, 20):
            left, top, right, bottom = item.box_px
            if right == FULL[0] and right - left > 8 and bottom - top > 30:
                return view, item.id, item.box_px
    raise AssertionError("the edge of the view cuts nothing")


def test_beyond_the_edge_of_the_view_all_is_blank(engine: BuiltinEngine) -> None:
    server = serve(engine)
    server.observe()
    view, object_id, box = cut_by_the_edge(engine)
    picture = shown(server, Inspect(server.tag(object_id)))[STRIP_PX:]
    near = near_of(engine, view, box)
    v, u = np.indices(picture.shape[:2]) + 0.5
    rays = near.camera.rays(np.stack([u.ravel(), v.ravel()], axis=1))
    places = view.camera.project(view.camera.position.array() + rays)
    beyond = (places[:, 0] > FULL[0]).reshape(picture.shape[:2])
    assert 0.02 < beyond.mean() < 0.6
    assert (mask_of(near, object_id) & beyond).any(), "nothing is cut off"
    drawn = {BLANK, INK, tag_colour(server.tag(object_id))}
    assert {tuple(colour) for colour in picture[beyond].tolist()} <= drawn, "more than the marks"
    assert (picture[beyond] == BLANK).all(axis=-1).mean() > 0.97
    # Up to the edge, and outside the marks, it is the true picture.
    same = (picture == near.rgb).all(axis=-1)
    assert same[mask_of(near, object_id) & ~beyond].all()


def test_what_is_hidden_stays_hidden(engine: BuiltinEngine) -> None:
    server = serve(engine)
    server.observe()
    jar = engine.state().object(PEANUT_BUTTER).box.center
    server.execute(Pick("Key_34"))
    server.execute(Drop("Key_34", jar.x + 0.11, jar.y, 0.78))
    server.execute(Walk(-1.9, jar.y, 0.0))
    view = server.execute(Look(jar.x, jar.y, jar.z)).observation
    assert view is not None
    tags = [item.tag for item in view.objects]
    assert "PeanutButter_8" in tags
    assert "Key_34" not in tags
    percept = engine.capture(*FULL)
    box = next(i.box_px for i in visible_objects(percept, 20) if i.id == PEANUT_BUTTER)
    assert KEY not in near_of(engine, percept, box).objects
    assert server.execute(Inspect("Key_34")).feedback.code == Code.NOT_IN_VIEW
    text = server.execute(Survey()).feedback.text
    assert "PeanutButter_8" in text
    assert "Key_34" not in text


def test_a_closeup_is_from_the_same_eyes(engine: BuiltinEngine) -> None:
    view = engine.capture(*SMALL)
    for item in visible_objects(view, 20):
        near = near_of(engine, view, item.box_px)
        assert near.camera.position == view.camera.position
        assert near.body == view.body
        assert near.camera.fov_y_rad < view.camera.fov_y_rad


# --- Survey ----------------------------------------------------------------------------------


def test_a_survey_shows_exactly_what_is_listed_in_its_order(engine: BuiltinEngine) -> None:
    server = serve(engine)
    tags = [item.tag for item in server.observe().observation.objects]
    result = server.execute(Survey())
    assert result.feedback.text == f"Done: sheet, row by row: {', '.join(tags)}."
    (frame,) = result.pictures
    columns, rows = 5, math.ceil(len(tags) / 5)
    assert frame.width_px == SHEET_PX
    sheet = pixels(frame)
    width, height = SHEET_PX // columns, (frame.height_px - 8) // rows
    for number, tag in enumerate(tags):
        row, column = divmod(number, columns)
        cell = sheet[row * height : (row + 1) * height, column * width : (column + 1) * width]
        assert (cell[:40] == tag_colour(tag)).all(axis=-1).any(), tag
        assert cell[40:].std() > 10, tag
    rest = sheet[(rows - 1) * height + 8 :, (len(tags) % columns) * width + 8 :]
    assert (rest == STRIP).all(), "something is shown behind the last object"


@pytest.mark.parametrize(("count", "columns"), [(1, 1), (2, 2), (4, 2), (5, 3)])
def test_few_objects_make_a_small_sheet(engine: BuiltinEngine, count: int, columns: int) -> None:
    from adamo_vh.perception.contact_sheet import contact_sheet

    view = engine.capture(*FULL)
    found = visible_objects(view, 20)[:count]
    items = [(item.id, f"{item.id}", item.box_px) for item in found]
    sheet = contact_sheet(view, items, engine.body.closeup)
    cell = (sheet.width - 8) // columns - 8
    assert 300 <= cell <= 320
    assert sheet.width <= SHEET_PX
    assert sheet.height <= SHEET_PX + 8


def test_a_survey_of_nothing_is_refused(engine: BuiltinEngine) -> None:
    engine.body.look(Vec3(-2.9, -1.0, 1.5))
    result = serve(engine, SMALL).execute(Survey())
    assert (result.feedback.outcome, result.feedback.code) == (Outcome.REFUSED, Code.NOT_IN_VIEW)
    assert result.feedback.text == "Refused: no object is in view now; look round first."
    assert result.pictures == ()


def test_a_survey_makes_nothing_known(engine: BuiltinEngine) -> None:
    """Only a view that was shown lets its objects be picked."""
    server = serve(engine, SMALL)
    assert server.execute(Survey()).pictures
    assert server.seen == frozenset()


# --- both ------------------------------------------------------------------------------------


def test_the_same_call_gives_the_same_bytes(engine: BuiltinEngine) -> None:
    def play() -> list[bytes]:
        engine.reset(0)
        server = LocalActionServer(engine, tools=LEAN_TOOLS)
        server.observe()
        calls = (Inspect("Glass_37"), Survey(), Inspect("Glass_37"))
        return [server.execute(call).pictures[0].data for call in calls]

    first = play()
    assert play() == first
    assert first[0] == first[2]


@pytest.mark.parametrize("resolution", [SMALL, (640, 360)])
def test_small_views_give_large_closeups(
    engine: BuiltinEngine, resolution: tuple[int, int]
) -> None:
    server = serve(engine, resolution)
    listed = server.observe().observation.objects
    assert len(listed) >= 15
    for item in listed[:: 1 if resolution == SMALL else 4]:
        picture = shown(server, Inspect(item.tag))[STRIP_PX:]
        assert max(picture.shape) == CLOSEUP_PX
        object_id = int(item.tag.rsplit("_", 1)[1])
        mask = mask_of(near_of(engine, engine.capture(*resolution), item.box_px), object_id)
        assert max(spread(mask)) >= 0.6, item.tag
    assert shown(server, Survey()).shape[1] == SHEET_PX


# --- reference points ------------------------------------------------------------------------

WALL_M = 0.05
STANDS = ((-2.0, -1.0), (2.2, -4.2), (1.7, 1.4))


def points_of(
    engine: BuiltinEngine, config: PerceptionConfig, stands: Sequence[tuple[float, float]] = STANDS
) -> list[Vec3]:
    """Reference points of views all round from some places; no number is left out."""
    found: list[Vec3] = []
    for stand in stands:
        engine.body.walk(Vec3(*stand, 0.0))
        server = LocalActionServer(engine, perception=config, resolution=SMALL)
        for turn in range(6):
            at, yaw = engine.body.state().position, turn * math.pi / 3
            ahead = Vec3(at.x + 2 * math.cos(yaw), at.y + 2 * math.sin(yaw), 1.6 - turn % 3)
            engine.body.look(ahead)
            points = server.observe().observation.points
            assert [point.tag for point in points] == [f"P{i}" for i in range(len(points))]
            found += [point.position for point in points]
    return found


@pytest.fixture(params=["s1", "s2"])
def any_room(
    request: pytest.FixtureRequest, s1_engine: BuiltinEngine, living_room: BuiltinEngine
) -> BuiltinEngine:
    made = s1_engine if request.param == "s1" else living_room
    made.reset(0)
    return made


def test_no_reference_point_is_outside_the_room(any_room: BuiltinEngine) -> None:
    points = points_of(any_room, PerceptionConfig(grid=7))
    assert len(points) > 400
    assert all(any_room.scene.is_within_walls(point, WALL_M) for point in points)
    assert any(not any_room.scene.is_within_walls(point, -WALL_M) for point in points)
    assert any(point.z > 2.07 for point in points)


def test_points_above_reach_and_on_walls_can_be_left_out(any_room: BuiltinEngine) -> None:
    config = PerceptionConfig(grid=7, points_below_m=2.07, points_on_walls=False)
    points = points_of(any_room, config)
    assert len(points) > 100
    assert all(any_room.scene.is_within_walls(point, -WALL_M) for point in points)
    assert all(point.z <= 2.07 for point in points)
    low = points_of(any_room, PerceptionConfig(grid=7, points_below_m=0.5), STANDS[:1])
    assert all(point.z <= 0.5 for point in low)
    assert any(not any_room.scene.is_within_walls(point, -WALL_M) for point in low)
