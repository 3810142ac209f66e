"""What textures, printed labels, the room and the tabletop promise to whoever looks at them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from adamo_vh.runtime.assets import catalog, labels, paint
from adamo_vh.runtime.assets.asset import Asset, Material
from adamo_vh.runtime.assets.labels import Band, Label, Line, Motif
from adamo_vh.runtime.assets.room import room

PICTURES: dict[str, Callable[[], paint.Picture]] = {
    "wood": lambda: paint.wood(64, 128, (150, 104, 66), 1),
    "planks": lambda: paint.planks((96, 192), 4, 2, (150, 104, 66), 2),
    "plaster": lambda: paint.plaster((96, 128), (200, 189, 170), 3),
    "soil": lambda: paint.soil(96, 4),
    "leaf": lambda: paint.leaf((62, 118, 52), (120, 160, 90), 5, 96),
    "fabric": lambda: paint.fabric(96, (120, 90, 70), 6),
    "carpet": lambda: paint.carpet(96, (140, 90, 60), 7),
    "terracotta": lambda: paint.terracotta(96, 8),
    "sky": lambda: paint.sky(96, 128, 9),
}
SEAMLESS = ("wood", "plaster", "soil", "carpet", "terracotta")
MOTIFS = (labels.tomato, labels.peanut, labels.grapes, labels.cross, labels.capsule)
WORDS = Label(
    ground=(240, 180, 40),
    lines=(Line("TOMATO", (0.55, 0.9), (30, 20, 10)), Line("SOUP", (0.15, 0.45), (30, 20, 10))),
    bands=(Band((0.0, 0.08), (180, 20, 20)),),
)
GIRTH_M, HEIGHT_M = 0.22, 0.10
WHITEST = 0.85
"""Lit, a lighter paint would clip."""
BRIGHTEST_WALL = 0.80

built = cache(catalog.build)


# --- textures -------------------------------------------------------------------------------


@pytest.mark.parametrize("name", PICTURES)
def test_the_same_seed_paints_the_same_bytes(name: str) -> None:
    first, second = PICTURES[name](), PICTURES[name]()
    assert first.dtype == np.uint8 and first.ndim == 3 and first.shape[2] == 3
    assert first.tobytes() == second.tobytes()


def test_another_seed_paints_another_picture() -> None:
    assert paint.soil(64, 1).tobytes() != paint.soil(64, 2).tobytes()


@pytest.mark.parametrize("name", SEAMLESS)
@pytest.mark.parametrize("axis", [0, 1])
def test_seamless_pictures_have_no_edge(name: str, axis: int) -> None:
    """The step from the last row to the first is no larger than between any other two rows."""
    picture = PICTURES[name]().astype(float)
    steps = np.abs(picture - np.roll(picture, 1, axis=axis)).mean(axis=(1 - axis, 2))
    assert steps[0] <= 1.5 * np.median(steps[1:])


@pytest.mark.parametrize("name", PICTURES)
def test_no_material_is_blue(name: str) -> None:
    assert not blue(PICTURES[name]() / 255.0).any()


def test_ramp_reads_from_the_bottom_up() -> None:
    picture = paint.ramp(
        ((0.0, (200, 0, 0)), (0.5, (200, 0, 0)), (0.5, (0, 90, 0)), (1.0, (0, 90, 0)))
    )
    assert tuple(picture[-1, 0]) == (200, 0, 0)
    assert tuple(picture[0, 0]) == (0, 90, 0)


# --- labels ---------------------------------------------------------------------------------


@pytest.mark.parametrize("panels", [2, 3])
def test_words_fit_the_arc_that_faces_a_person(panels: int) -> None:
    label = replace(WORDS, panels=panels)
    runs = word_runs(label)
    assert len(runs) == panels
    assert all(10.0 < end - start <= 90.0 for start, end in runs)


@pytest.mark.parametrize("panels", [2, 3])
def test_a_panel_faces_the_front(panels: int) -> None:
    """Half way around (u = 0.5) is the front of a turned body."""
    middles = [(start + end) / 2 for start, end in word_runs(replace(WORDS, panels=panels))]
    assert min(abs(middle - 180.0) for middle in middles) < 2.0


def test_lines_stay_where_they_were_put() -> None:
    changed = np.asarray(printed_pixels(WORDS).any(axis=1))
    v = 1.0 - (np.flatnonzero(changed) + 0.5) / changed.size
    assert v.min() >= 0.15 - 0.01 and v.max() <= 0.9 + 0.01
    assert not ((v > 0.46) & (v < 0.54)).any()


def test_labels_are_drawn_the_same_every_time() -> None:
    first, second = (labels.wrap(WORDS, GIRTH_M, HEIGHT_M) for _ in range(2))
    assert first.tobytes() == second.tobytes()


@pytest.mark.parametrize("motif", MOTIFS, ids=lambda motif: str(motif.__name__))
def test_motifs_are_visible_and_keep_to_their_place(motif: Callable[..., None]) -> None:
    label = replace(WORDS, lines=(), motifs=(Motif(motif, (0.3, 0.7)),))
    bare = labels.wrap(replace(label, motifs=()), GIRTH_M, HEIGHT_M)
    rows = np.flatnonzero((labels.wrap(label, GIRTH_M, HEIGHT_M) != bare).any(axis=(1, 2)))
    v = 1.0 - (rows + 0.5) / len(bare)
    assert v.max() - v.min() > 0.2
    assert v.min() >= 0.27 and v.max() <= 0.73


# --- objects in the room --------------------------------------------------------------------


@pytest.mark.parametrize("name", catalog.OBJECTS)
def test_white_paint_leaves_room_for_light(name: str) -> None:
    """Clear glass is left out: at its alpha even pure white adds little."""
    for part in (p for p in built(name).parts if p.material.rgba[3] == 1.0):
        assert colours(part.material).min(axis=-1).max() <= WHITEST, part.material.name


def test_glass_is_clear_with_a_denser_base() -> None:
    alpha = {part.material.name: part.material.rgba[3] for part in built("glass").parts}
    assert 0.2 <= alpha["wall"] <= 0.35
    assert alpha["wall"] < alpha["base"] < 1.0


def test_only_the_thick_base_of_the_glass_casts_a_shadow() -> None:
    """The rim alone would cast a dotted ring."""
    casts = {part.material.name for part in built("glass").parts if part.material.casts_shadow}
    assert casts == {"base"}


def test_mug_is_hollow() -> None:
    """Straight down its middle one meets the inner bottom, far below the lip."""
    asset = built("cup")
    middle = asset.colliders[0].position[0]
    points = np.concatenate([part.vertices for part in asset.parts])
    near_axis = np.hypot(points[:, 0] - middle, points[:, 1]) < 0.02
    assert points[near_axis, 2].max() < -0.04


def test_tabletop_is_where_the_scene_counts_on_it() -> None:
    table = built("dining_table")
    (top,) = table.surfaces
    assert top.center == (0.0, 0.0, 0.78)
    assert top.half_size == (0.525, 0.83)
    points = np.concatenate([part.vertices for part in table.parts])
    assert points[:, 2].max() == pytest.approx(0.78, abs=1e-6)
    assert points[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    assert all(part.material.reflectance == 0.0 for part in table.parts)


# --- room -----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def shell() -> Asset:
    return room(-3.0, 3.0, -5.0, 3.0, 3.2)


def test_floor_walls_and_ceiling_span_the_room(shell: Asset) -> None:
    points = {part.material.name: part.vertices for part in shell.parts}
    for name in ("walls", "parquet"):
        np.testing.assert_allclose(points[name][:, :2].min(axis=0), (-3.0, -5.0), atol=1e-5)
        np.testing.assert_allclose(points[name][:, :2].max(axis=0), (3.0, 3.0), atol=1e-5)
    np.testing.assert_allclose(points["parquet"][:, 2], 0.0, atol=1e-6)
    np.testing.assert_allclose(points["ceiling"][:, 2], 3.2, atol=1e-5)
    assert points["walls"][:, 2].max() == pytest.approx(3.2, abs=1e-5)


def test_shell_faces_inwards(shell: Asset) -> None:
    """Drawn from inside, and left out by a renderer that looks from outside."""
    center = np.array((0.0, -1.0, 1.6))
    for part in shell.parts:
        if part.material.name in ("walls", "parquet", "ceiling", "outside"):
            inwards = np.einsum("ij,ij->i", part.normals, center - part.vertices)
            assert (inwards > 0).all(), part.material.name


def test_window_is_a_real_opening(shell: Asset) -> None:
    (walls,) = (part for part in shell.parts if part.material.name == "walls")
    triangles = walls.vertices[walls.faces].mean(axis=1)
    east = triangles[np.isclose(triangles[:, 0], 3.0, atol=1e-4)]
    opening = (np.abs(east[:, 1] + 1.0) < 0.95) & (east[:, 2] > 1.0) & (east[:, 2] < 2.4)
    assert len(east) > 0 and not opening.any()


@pytest.mark.parametrize("off_the_wall_m", [0.3, 1.0, 3.0])
@pytest.mark.parametrize("aside_m", [-2.5, -1.3, 0.0, 1.3, 2.5])
def test_one_sees_the_outside_at_every_angle(
    shell: Asset, off_the_wall_m: float, aside_m: float
) -> None:
    """Every line from an eye through the opening ends on the picture behind it, not in a void."""
    (outside,) = (part for part in shell.parts if part.material.name == "outside")
    eye = np.array((3.0 - off_the_wall_m, -1.0 + aside_m, 1.6))
    opening = np.stack(np.meshgrid(3.12, np.linspace(-1.9, -0.1, 7), [1.0, 1.7, 2.4]), axis=-1)
    lines = opening.reshape(-1, 3) - eye
    a, b, c = np.moveaxis(outside.vertices[outside.faces].astype(float) - eye, 1, 0)
    # A line passes a triangle where it lies on the same side of all three edges, seen from the eye.
    sides = [lines @ np.cross(p, q).T for p, q in ((a, b), (b, c), (c, a))]
    inside = np.logical_and.reduce([side <= 1e-9 for side in sides])
    assert inside.any(axis=1).all()


def test_paint_runs_around_the_room_unbroken(shell: Asset) -> None:
    """Where two panels of a wall meet, their textures meet too."""
    (walls,) = (part for part in shell.parts if part.material.name == "walls")
    size = np.array(walls.material.texture.shape[1::-1])  # type: ignore[union-attr]
    by_place: dict[tuple[float, ...], list[NDArray[np.float64]]] = {}
    for place, uv in zip(np.round(walls.vertices, 3).tolist(), walls.uvs, strict=True):
        by_place.setdefault(tuple(place), []).append(uv % 1.0 * size)
    for found in by_place.values():
        off = np.abs(np.array(found) - found[0])
        assert np.minimum(off, size - off).max() < 0.5


def test_nothing_leaves_the_room(shell: Asset) -> None:
    """Colliders lie around the room on five sides, and none reaches into it."""
    lower, upper = np.array((-3.0, -5.0, 0.0)), np.array((3.0, 3.0, 3.2))
    closed = set()
    for collider in shell.colliders:
        assert collider.shape == "box"
        middle, half = np.array(collider.position), np.array(collider.size)
        overlap = np.minimum(middle + half, upper) - np.maximum(middle - half, lower)
        assert overlap.min() <= 1e-9
        axis = int(overlap.argmin())
        closed.add((axis, bool(middle[axis] > 0)))
        others = [i for i in range(3) if i != axis]
        assert (overlap[others] >= (upper - lower)[others] - 1e-9).all()
    assert closed == {(0, False), (0, True), (1, False), (1, True), (2, False)}


def test_room_is_neither_white_nor_blue(shell: Asset) -> None:
    for part in shell.parts:
        pixels = colours(part.material)
        assert not blue(pixels).any(), part.material.name
        if part.material.emission == 0.0:
            assert pixels.mean(axis=tuple(range(pixels.ndim - 1))).max() <= BRIGHTEST_WALL


# --- measures -------------------------------------------------------------------------------


def printed_pixels(label: Label) -> NDArray[np.bool_]:
    """(H, W) where the words are."""
    bare = labels.wrap(replace(label, lines=()), GIRTH_M, HEIGHT_M)
    return np.asarray((labels.wrap(label, GIRTH_M, HEIGHT_M) != bare).any(axis=2))


def word_runs(label: Label) -> list[tuple[float, float]]:
    """(start, end) degrees around of each panel's words; gaps between letters do not count."""
    columns = np.flatnonzero(printed_pixels(label).any(axis=0))
    width = printed_pixels(label).shape[1]
    # A panel that lies across the seam is read in one piece.
    gaps = np.diff(columns, append=columns[0] + width)
    breaks = np.flatnonzero(gaps > width / 40)
    starts = columns[(breaks + 1) % len(columns)]
    ends = columns[np.roll(breaks, -1)] + 1
    degrees = 360.0 / width
    return [
        (s * degrees, (e if e > s else e + width) * degrees)
        for s, e in zip(starts, ends, strict=True)
    ]


def colours(material: Material) -> NDArray[np.float64]:
    """(..., 3) sRGB of every texel, tinted, in [0, 1]."""
    tint = np.array(material.rgba[:3])
    if material.texture is None:
        return tint[None]
    return np.asarray(material.texture / 255.0 * tint)


def blue(pixels: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Where a person would say blue."""
    red, green, blue_ = np.moveaxis(pixels, -1, 0)
    return np.asarray((blue_ > 1.25 * np.maximum(red, green)) & (blue_ > 0.2))
