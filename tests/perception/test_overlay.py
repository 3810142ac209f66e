"""What is drawn stays legible: tags never collide, hide what they name, or leave the picture."""

from __future__ import annotations

import io
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image
from tests.percepts import NAMES, camera, ids, percept, sphere_hits, tabletop

from adamo_vh.observation import ObservedObject
from adamo_vh.perception.clutter import Clutter
from adamo_vh.perception.overlay import ImageFormat, OverlayScale, draw_overlay, layout
from adamo_vh.perception.plates import plate, tag_colour
from adamo_vh.perception.reference_points import reference_points
from adamo_vh.perception.tag_layout import TagRequest, place_tags
from adamo_vh.perception.visibility import visible_objects

SIZES = [(640, 360), (1280, 720), (1920, 1080)]


def no_clutter(width_px: int, height_px: int) -> Clutter:
    """A picture without objects."""
    return Clutter.of([ids(width_px, height_px, {})], ())


def apart(a, b):
    return a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]


def seen(view):
    """Visible objects of a percept, as the overlay takes them, and their clutter."""
    visible = visible_objects(view, 20)
    objects = [
        ObservedObject(
            f"{view.objects[item.id].class_name}_{item.id}",
            view.objects[item.id].box.center,
            view.objects[item.id].box.volume_m3,
            item.box_px,
            item.pixels,
        )
        for item in visible
    ]
    return objects, Clutter.of(view.id_layers, visible)


@st.composite
def scenes(draw):
    """A picture size and up to 19 boxes, each at most 0.6 of the picture wide and high."""
    width, height = draw(st.sampled_from(SIZES))
    boxes = {}
    for object_id in draw(st.lists(st.sampled_from(sorted(NAMES)), unique=True, max_size=19)):
        w, h = draw(st.integers(3, int(width * 0.6))), draw(st.integers(3, int(height * 0.6)))
        left, top = draw(st.integers(0, width - w)), draw(st.integers(0, height - h))
        boxes[object_id] = (left, top, left + w, top + h)
    return percept(ids(width, height, boxes))


@settings(max_examples=25, deadline=None)
@given(view=scenes(), grid=st.integers(0, 7))
def test_tags_are_inside_disjoint_and_beside_what_they_name(view, grid):
    width, height = view.camera.width_px, view.camera.height_px
    objects, clutter = seen(view)
    points = reference_points(view.camera, sphere_hits, grid)
    placed = layout(width, height, objects, points, clutter)
    assert {tag.tag for tag in placed} == {item.tag for item in [*objects, *points]}
    for tag in placed:
        left, top, right, bottom = tag.rect
        assert 0 <= left < right <= width
        assert 0 <= top < bottom <= height
    for one, other in combinations(placed, 2):
        assert apart(one.rect, other.rect), (one, other)
    rects = {tag.tag: tag.rect for tag in placed}
    for item in objects:
        assert apart(rects[item.tag], item.box_px)
    for point in points:
        u, v = (int(value) for value in point.pixel)
        assert apart(rects[point.tag], (u, v, u + 1, v + 1))


@settings(max_examples=40, deadline=None)
@given(
    size=st.tuples(st.integers(20, 120), st.integers(12, 80)),
    count=st.integers(0, 30),
    data=st.data(),
)
def test_tiny_pictures_drop_tags_but_never_stack_them(size, count, data):
    width, height = size
    requests = []
    for number in range(count):
        left, top = data.draw(st.integers(0, width - 1)), data.draw(st.integers(0, height - 1))
        right = data.draw(st.integers(left + 1, width))
        bottom = data.draw(st.integers(top + 1, height))
        tag_size = (data.draw(st.integers(8, 40)), data.draw(st.integers(6, 16)))
        is_object = number < count // 2
        requests.append(TagRequest(str(number), (left, top, right, bottom), tag_size, is_object))
    placed = place_tags(width, height, requests, no_clutter(width, height))
    assert placed == place_tags(width, height, requests, no_clutter(width, height))
    for one, other in combinations(placed, 2):
        assert apart(one.rect, other.rect)
    for tag in placed:
        assert tag.rect[0] >= 0
        assert tag.rect[1] >= 0
        assert tag.rect[2] <= width
        assert tag.rect[3] <= height
        request = requests[int(tag.tag)]
        assert request.is_object or apart(tag.rect, request.anchor)


def test_a_later_tag_never_costs_an_earlier_one_its_place():
    first = [TagRequest(f"A{i}", (10 * i, 30, 10 * i + 8, 38), (30, 12), True) for i in range(8)]
    later = [TagRequest(f"P{i}", (10 * i, 10, 10 * i + 1, 11), (14, 10), False) for i in range(9)]
    clutter = no_clutter(90, 60)
    alone = place_tags(90, 60, first, clutter)
    assert place_tags(90, 60, first + later, clutter)[: len(alone)] == alone


def test_an_object_that_fills_the_picture_still_has_its_tag():
    view = percept(ids(640, 360, {50: (0, 0, 640, 360)}))
    objects, clutter = seen(view)
    placed = layout(640, 360, objects, [], clutter)
    assert [tag.tag for tag in placed] == ["IndoorPlant_50"]


def test_a_lone_tag_stands_on_its_box_without_a_leader():
    request = TagRequest("Cup_45", (300, 200, 380, 260), (60, 18), True)
    (placed,) = place_tags(640, 360, [request], no_clutter(640, 360))
    assert placed.rect == (300, 182, 360, 200)
    assert placed.leader is None


def test_a_tag_that_was_moved_away_is_led_back():
    walls = [TagRequest(f"W{i}", (0, 20 * i, 640, 20 * i + 20), (640, 20), True) for i in range(18)]
    middle = TagRequest("Key_34", (320, 175, 324, 179), (60, 18), True)
    placed = place_tags(640, 360, [*walls[:8], middle], no_clutter(640, 360))
    key = placed[-1]
    assert key.leader is not None
    (_, (u, v)) = key.leader
    assert 320 <= u < 324
    assert 175 <= v < 179


def test_tags_avoid_hiding_other_objects():
    """A small object right above: the tag goes where it hides nothing of it."""
    view = percept(ids(1280, 720, {34: (600, 290, 612, 298), 45: (590, 305, 650, 360)}))
    objects, clutter = seen(view)
    rects = {tag.tag: tag.rect for tag in layout(1280, 720, objects, [], clutter)}
    assert apart(rects["Cup_45"], (600, 290, 612, 298))


@pytest.mark.parametrize(("width_px", "height_px"), SIZES)
def test_a_busy_table_hides_little(width_px, height_px):
    view = tabletop(width_px, height_px)
    objects, clutter = seen(view)
    points = reference_points(view.camera, sphere_hits, 6)
    placed = layout(width_px, height_px, objects, points, clutter)
    assert len(placed) == len(objects) + len(points)
    layer = view.id_layers[0].copy()
    for tag in placed:
        left, top, right, bottom = tag.rect
        layer[top:bottom, left:right] = -1
    for item in objects:
        object_id = int(item.tag.split("_")[1])
        assert np.count_nonzero(layer == object_id) >= 0.6 * item.pixels, item.tag


@pytest.mark.parametrize(("width_px", "height_px"), SIZES)
def test_boxes_hide_nothing_of_their_object(width_px, height_px):
    box = (width_px // 3, height_px // 3, width_px // 2, height_px // 2)
    view = percept(ids(width_px, height_px, {45: box}))
    objects, clutter = seen(view)
    frame = draw_overlay(view.rgb, objects, [], clutter, ImageFormat.PNG)
    picture = np.asarray(Image.open(io.BytesIO(frame.data)))
    left, top, right, bottom = box
    assert (picture[top:bottom, left:right] == view.rgb[top:bottom, left:right]).all()
    line = left - OverlayScale.of(height_px).casing - 1
    assert tuple(picture[(top + bottom) // 2, line]) == tag_colour("Cup_45")


def test_the_percept_is_left_as_it_is():
    view = tabletop(640, 360)
    before = view.rgb.copy()
    objects, clutter = seen(view)
    draw_overlay(view.rgb, objects, reference_points(view.camera, sphere_hits, 6), clutter)
    assert (view.rgb == before).all()


@pytest.mark.parametrize(("image_format", "name"), [("jpeg", "JPEG"), ("png", "PNG")])
def test_frames_are_encoded_as_they_say(image_format, name):
    view = tabletop(640, 360)
    objects, clutter = seen(view)
    frame = draw_overlay(view.rgb, objects, [], clutter, ImageFormat(image_format))
    picture = Image.open(io.BytesIO(frame.data))
    assert (picture.format, picture.size) == (name, (640, 360))
    assert frame.media_type == f"image/{image_format}"
    assert (frame.width_px, frame.height_px) == (640, 360)


def test_quality_costs_bytes():
    view = tabletop(640, 360)
    objects, clutter = seen(view)
    low = draw_overlay(view.rgb, objects, [], clutter, jpeg_quality=40)
    high = draw_overlay(view.rgb, objects, [], clutter, jpeg_quality=95)
    assert len(low.data) < len(high.data)


def test_text_grows_with_the_picture_and_stops_shrinking():
    fonts = [OverlayScale.of(height).object_font for height in (90, 360, 720, 1080)]
    assert fonts == sorted(fonts)
    assert fonts[0] == fonts[1] >= 10
    assert fonts[-1] >= 20


def test_colour_depends_on_the_id_alone():
    assert tag_colour("Plate_57") == tag_colour("57")
    assert len({tag_colour(str(i)) for i in NAMES}) >= 10


def test_plates_are_as_large_as_their_text_needs():
    assert plate("IndoorPlant_50", 20, (1, 2, 3)).width > plate("Cup_45", 20, (1, 2, 3)).width
    assert plate("P1", 16, None).height < plate("P1", 20, None).height


def test_clutter_weighs_objects_alike():
    view = percept(ids(1280, 720, {34: (100, 100, 110, 110), 50: (400, 200, 700, 600)}))
    _, clutter = seen(view)
    small, large, none = clutter.hidden(
        np.array([(99, 99, 111, 111), (399, 199, 701, 601), (800, 0, 1280, 720)])
    )
    assert small == pytest.approx(large, rel=0.6)
    assert none == 0


def test_the_camera_has_no_part_in_the_layout():
    """Points are where they are told to be, at the middle of their crosses."""
    points = reference_points(camera(640, 360), sphere_hits, 2)
    blank = np.zeros((360, 640, 3), dtype=np.uint8)
    frame = draw_overlay(blank, [], points, no_clutter(640, 360), ImageFormat.PNG)
    picture = np.asarray(Image.open(io.BytesIO(frame.data)))
    for point in points:
        assert tuple(picture[int(point.pixel[1]), int(point.pixel[0])]) == (255, 255, 255)
