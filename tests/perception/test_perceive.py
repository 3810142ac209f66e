"""Perceiving turns a percept into one consistent view, and tells nothing that is not visible."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.percepts import NAMES, ids, percept, sphere_hits, tabletop

import adamo_vh.perception
from adamo_vh.errors import ConfigError, EngineError
from adamo_vh.geometry import Box, Vec3
from adamo_vh.perception import (
    ImageFormat,
    Labeling,
    PerceptionConfig,
    TextForm,
    agent_state,
    object_lines,
    perceive,
    point_lines,
)
from adamo_vh.perception.clutter import Clutter
from adamo_vh.perception.overlay import layout
from adamo_vh.perception.visibility import visible_objects

PNG = PerceptionConfig(image_format=ImageFormat.PNG)


def test_the_public_surface():
    assert adamo_vh.perception.__all__ == sorted(adamo_vh.perception.__all__)
    for name in adamo_vh.perception.__all__:
        assert hasattr(adamo_vh.perception, name)


@pytest.mark.parametrize("labeling", Labeling)
def test_objects_are_listed_by_id_with_their_truth(labeling):
    view = tabletop(1280, 720)
    observation = perceive(view, sphere_hits, PerceptionConfig(labeling), NAMES)
    assert [item.tag for item in observation.objects] == [
        labeling.tag(i, NAMES[i]) for i in sorted(view.objects)
    ]
    for item, object_id in zip(observation.objects, sorted(view.objects), strict=True):
        box = view.objects[object_id].box
        assert item.position == box.center
        assert item.volume_m3 == box.volume_m3
        assert item.pixels == np.count_nonzero(view.id_layers[0] == object_id)
    assert observation.camera == view.camera


@pytest.mark.parametrize("labeling", Labeling)
@pytest.mark.parametrize(("width_px", "height_px"), [(640, 360), (1280, 720), (1920, 1080)])
def test_frame_and_text_show_the_same_tags(labeling, width_px, height_px):
    view = tabletop(width_px, height_px)
    observation = perceive(view, sphere_hits, PerceptionConfig(labeling), NAMES)
    clutter = Clutter.of(view.id_layers, visible_objects(view, 20))
    placed = layout(width_px, height_px, observation.objects, observation.points, clutter)
    lines = [
        *object_lines(observation.objects, TextForm.FULL).splitlines(),
        *point_lines(observation.points).splitlines(),
    ]
    told = {line.removeprefix("- ").split(":")[0] for line in lines}
    assert told == {tag.tag for tag in placed}


def test_same_percept_same_bytes():
    config = PerceptionConfig()
    one = perceive(tabletop(1280, 720), sphere_hits, config, NAMES)
    other = perceive(tabletop(1280, 720), sphere_hits, config, NAMES)
    assert one == other


def test_what_is_below_the_threshold_leaves_no_trace():
    boxes = {4: (100, 100, 160, 140), 57: (300, 200, 380, 230)}
    without = percept(ids(640, 360, boxes))
    layer = ids(640, 360, boxes)
    layer[50, 300:303] = 34
    hidden = percept(layer, boxes={34: Box(Vec3(9, 9, 9), Vec3(1, 1, 1))})
    assert 34 in hidden.objects
    # The pixels themselves are the renderer's; only what is made of them is compared.
    hidden = replace(hidden, rgb=without.rgb)
    assert perceive(hidden, sphere_hits, PNG, NAMES) == perceive(without, sphere_hits, PNG, NAMES)


@pytest.mark.parametrize(("labeling", "tag"), [(Labeling.SEM, "Plate_57"), (Labeling.OPAQ, "57")])
def test_the_hand_is_known_even_when_out_of_view(labeling, tag):
    view = percept(ids(640, 360, {4: (100, 100, 160, 140)}), held=57)
    observation = perceive(view, sphere_hits, PerceptionConfig(labeling), NAMES)
    assert observation.agent.held == tag
    assert tag not in {item.tag for item in observation.objects}
    assert agent_state(view.body, labeling, NAMES) == observation.agent


def test_names_are_asked_for_the_hand_alone():
    view = percept(ids(640, 360, {4: (100, 100, 160, 140)}))
    observation = perceive(view, sphere_hits, PerceptionConfig(), {})
    assert [item.tag for item in observation.objects] == ["Tape_4"]
    assert observation.agent.held is None


def test_the_grid_is_configurable():
    view = tabletop(640, 360)
    for grid in (0, 3, 7):
        points = perceive(view, sphere_hits, PerceptionConfig(grid=grid), NAMES).points
        assert len(points) == grid * grid


def test_an_engine_that_hides_what_it_shows_is_at_fault():
    view = replace(percept(ids(640, 360, {4: (100, 100, 160, 140)})), objects={})
    with pytest.raises(EngineError, match="object 4"):
        perceive(view, sphere_hits, PerceptionConfig(), NAMES)


@pytest.mark.parametrize("wrong", [{"grid": -1}, {"jpeg_quality": 0}, {"jpeg_quality": 101}])
def test_wrong_settings_are_refused(wrong):
    with pytest.raises(ConfigError):
        PerceptionConfig(**wrong)
