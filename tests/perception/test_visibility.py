"""An object is visible when enough of its pixels are, and its box is tight around them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from tests.percepts import ids, percept

from adamo_vh.observation import NOTHING
from adamo_vh.perception.visibility import VisibleObject, pixel_threshold, visible_objects


@pytest.mark.parametrize(
    ("width_px", "height_px", "needed"),
    [(1920, 1080, 20), (1280, 720, 9), (640, 360, 4), (64, 36, 4), (3840, 2160, 80)],
)
def test_threshold_follows_the_area_of_the_picture(width_px, height_px, needed):
    assert pixel_threshold(20, width_px, height_px) == needed


@pytest.mark.parametrize(
    ("width_px", "height_px", "needed"), [(1920, 1080, 20), (1280, 720, 9), (640, 360, 4)]
)
def test_one_pixel_decides(width_px, height_px, needed):
    enough = ids(width_px, height_px, {7: (50, 40, 50 + needed, 41)})
    lacking = ids(width_px, height_px, {7: (50, 40, 49 + needed, 41)})
    assert [item.pixels for item in visible_objects(percept(enough), 20)] == [needed]
    assert visible_objects(percept(lacking), 20) == ()


def test_boxes_are_tight_and_counts_exact():
    layer = ids(640, 360, {5: (0, 0, 30, 20), 2: (100, 50, 140, 90), 9: (130, 80, 640, 360)})
    assert visible_objects(percept(layer), 20) == (
        VisibleObject(2, 40 * 40 - 10 * 10, (100, 50, 140, 90)),
        VisibleObject(5, 600, (0, 0, 30, 20)),
        VisibleObject(9, 510 * 280, (130, 80, 640, 360)),
    )


def test_pieces_of_one_object_count_together():
    layer = ids(640, 360, {3: (10, 10, 90, 30), 4: (40, 0, 60, 60)})
    found = {item.id: item for item in visible_objects(percept(layer), 20)}
    assert found[3] == VisibleObject(3, 80 * 20 - 20 * 20, (10, 10, 90, 30))


def test_what_stands_behind_glass_is_visible():
    key, glass = (210, 120, 225, 130), (200, 100, 240, 160)
    front = ids(640, 360, {34: key, 37: glass})
    without_glass = ids(640, 360, {34: key})
    assert visible_objects(percept(front, without_glass), 20) == (
        VisibleObject(34, 150, key),
        VisibleObject(37, 2400, glass),
    )


def test_pixels_in_both_layers_count_once_and_the_rest_joins():
    front = ids(640, 360, {34: (100, 100, 140, 110), 37: (120, 80, 160, 130)})
    without_glass = ids(640, 360, {34: (100, 100, 140, 110)})
    found = {item.id: item for item in visible_objects(percept(front, without_glass), 20)}
    assert found[34] == VisibleObject(34, 400, (100, 100, 140, 110))


def test_an_empty_view_shows_nothing():
    blank = ids(640, 360, {})
    assert visible_objects(percept(blank, blank), 20) == ()


_LAYER = arrays(np.int16, (12, 17), elements=st.integers(NOTHING, 5))


@given(front=_LAYER, behind=_LAYER)
def test_agrees_with_counting_pixel_by_pixel(front, behind):
    found = {item.id: item for item in visible_objects(percept(front, behind), 20)}
    for object_id in range(6):
        rows, columns = np.nonzero((front == object_id) | (behind == object_id))
        if len(rows) < 4:
            assert object_id not in found
        else:
            box = (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1)
            assert found[object_id] == VisibleObject(object_id, len(rows), box)
