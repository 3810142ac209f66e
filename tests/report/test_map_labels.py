"""Labels of a map never cover each other, and stand by what they name."""

from __future__ import annotations

import math

from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.report.map_labels import Ground, Wish, placed

GROUND = Ground(0.0, 0.0, 6.0, 8.0)
places = st.floats(0.2, 5.8)
wishes = st.lists(
    st.builds(
        Wish,
        st.text("aB9_ 語", min_size=1, max_size=40),
        st.just("name"),
        places,
        places,
        st.floats(0.05, 0.4),
        st.floats(0.0, 0.3),
    ),
    max_size=30,
)


@given(wishes)
def test_no_two_labels_overlap_and_all_are_inside(wanted: list[Wish]) -> None:
    boxes = [label.extent for label in placed(wanted, GROUND)]
    for i, (left, top, right, bottom) in enumerate(boxes):
        assert left >= -0.001 and top >= -0.001 and right <= 6.001 and bottom <= 8.001
        for a, b, c, d in boxes[i + 1 :]:
            assert right <= a or c <= left or bottom <= b or d <= top


def test_a_label_stands_on_its_point_if_it_may_and_beside_it_if_not() -> None:
    on, beside = placed(
        [Wish("sofa", "name", 3, 3, 0.2, 0.0), Wish("1", "stop", 3, 6, 0.2, 0.1)], GROUND
    )
    assert (on.x, on.y, on.origin) == (3, 3, None)
    assert 0.1 < math.hypot(beside.x - 3, beside.y - 6) < 0.4


def test_what_is_seen_is_better_not_covered() -> None:
    ground = Ground(0, 0, 6, 8, [(3.0, 3.0)])
    (label,) = placed([Wish("a", "name", 3, 3, 0.2, 0.0)], ground)
    left, top, right, bottom = label.extent
    assert not (left < 3 < right and top < 3 < bottom)


def test_crowded_labels_move_off_and_a_line_tells_what_they_name() -> None:
    labels = placed([Wish("one and all", "object", 3, 3, 0.2, 0.0)] * 12, GROUND)
    assert len(labels) == 12
    assert labels[0].origin is None and labels[-1].origin == (3, 3)


def test_a_label_without_a_place_nearby_is_left_out() -> None:
    many = [Wish("sofa", "name", 3, 3, 0.2, 0.0, 0.6)] * 60
    assert 1 < len(placed(many, GROUND)) < 60


def test_long_names_are_cut() -> None:
    (label,) = placed([Wish("x" * 60, "name", 3, 3, 0.1, 0.0)], GROUND)
    assert len(label.text) == 26 and label.text.endswith("…")
