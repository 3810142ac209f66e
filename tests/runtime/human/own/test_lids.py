"""In films an own figure blinks by the shape of its face."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from tests.runtime.human.own.rigs import Rig, rig

from adamo_vh.runtime.human.anatomy import lids, turned
from adamo_vh.runtime.human.looks import LIDS_CLOSED_RAD, load_figure
from adamo_vh.runtime.human.own.lids import Lids
from adamo_vh.runtime.human.own.reading import own_figure_of
from adamo_vh.runtime.human.skeleton import Pose
from adamo_vh.runtime.human.skin_mujoco import add_human


def posed(figure, closed_rad):
    spec = mujoco.MjSpec()
    add_human(spec, figure)
    model = spec.compile()
    before = model.skin_vert.copy()
    Lids.of(model, figure).follow(turned(Pose(), lids(closed_rad)))
    return model.skin_vert - before


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0, 2.0])
def test_lids_close_as_far_as_the_pose_says(share):
    told = Rig("unity", garments=("lids", "shoes"), without=("eyelids",))
    figure = own_figure_of(rig(told), "x.glb").figure
    moved = posed(figure, share * LIDS_CLOSED_RAD)
    (shapes,) = (figure.shapes or {}).values()
    whole = shapes["eyeBlinkLeft"] + shapes["eyeBlinkRight"]
    number = next(i for i, g in enumerate(figure.garments) if g.name.endswith("lids"))
    start = sum(len(g.vertices) for g in figure.garments[:number])
    np.testing.assert_allclose(
        moved[start : start + len(whole)], min(share, 1.0) * whole, atol=1e-6
    )
    assert np.count_nonzero(moved) <= np.count_nonzero(whole)


def test_what_a_joint_closes_is_not_closed_twice():
    told = Rig("unity", garments=("lids", "shoes"))
    assert not posed(own_figure_of(rig(told), "x.glb").figure, LIDS_CLOSED_RAD).any()
    assert not posed(load_figure("mara"), LIDS_CLOSED_RAD).any()
