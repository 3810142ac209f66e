"""What a model is drawn of: which geoms and skins, in which order, and whose they are."""

from __future__ import annotations

import numpy as np
import pytest

from adamo_vh.geometry import Vec3
from adamo_vh.observation import NOTHING
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.human.skin_mujoco import BODY_GROUP
from adamo_vh.runtime.parts import Parts

SMALL = (160, 90)


@pytest.fixture
def parts(engine: BuiltinEngine) -> Parts:
    return engine.stage.renderer._painter.parts


def test_what_collides_is_not_drawn_and_every_object_is(
    engine: BuiltinEngine, parts: Parts
) -> None:
    world = engine.world
    assert (world.model.geom_group[parts.geoms] < 3).all()
    drawn = set(world.object_of_geom[parts.geoms].tolist()) - {NOTHING}
    assert drawn == set(engine.object_names)
    assert len(parts) == len(parts.geoms) + world.model.nskin


def test_small_parts_come_first_so_that_the_room_is_shaded_last(
    engine: BuiltinEngine, parts: Parts
) -> None:
    model = engine.world.model
    assert (np.diff(model.geom_rbound[parts.geoms]) >= 0).all()
    room = model.body("room").id
    assert model.geom_bodyid[parts.geoms[-1]] == room


def test_a_number_in_a_label_leads_to_the_object(engine: BuiltinEngine, parts: Parts) -> None:
    owners = engine.world.object_of_geom[parts.geoms]
    assert (parts.object_of[1 : len(owners) + 1] == owners).all()
    assert parts.object_of[0] == NOTHING
    assert (parts.object_of[len(owners) + 1 :] == NOTHING).all()


def test_objects_and_the_figure_move_and_furniture_does_not(
    engine: BuiltinEngine, parts: Parts
) -> None:
    owners = engine.world.object_of_geom[parts.geoms]
    assert (parts.moves[: len(owners)] == (owners != NOTHING)).all()
    assert parts.moves[len(owners) :].all()


def test_only_the_drinking_glass_is_glass(engine: BuiltinEngine, parts: Parts) -> None:
    (glass,) = parts.glass
    assert engine.object_names[glass] == "Glass"
    of_glass = set(parts.object_of[1:][np.flatnonzero(parts.of_glass)].tolist())
    assert of_glass - {NOTHING} == {glass}
    assert (parts.of_glass | ~parts.clear).all()


def test_the_figure_is_left_out_where_it_is_out_of_view(engine: BuiltinEngine) -> None:
    """Its skins have no middle of their own: it is measured anew for each picture."""
    painter = engine.stage.renderer._painter
    skins = slice(len(painter.parts.geoms), None)
    engine.capture(*SMALL)
    before = painter._brush.at[skins].copy()
    engine.body.walk(engine.body.stance.position + Vec3(0.0, 0.4, 0.0))
    engine.capture(*SMALL)
    moved = np.linalg.norm(painter._brush.at[skins] - before, axis=1)
    assert moved.max() > 0.05
    reach = painter._brush.radius[skins][painter.parts.skin_group == BODY_GROUP]
    assert (reach > 0.01).all()
    assert (reach < 1.0).all()
