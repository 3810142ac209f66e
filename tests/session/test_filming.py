"""What a film is made of: the figure as it is drawn, from any camera, and through her own eyes."""

from __future__ import annotations

import numpy as np

from adamo_vh.geometry import Vec3
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session.filming import FilmSet

SMALL = (160, 90)
FLOOR = Vec3(-1.6, -2.4, 0.0)
CUP = 45


def test_the_eyes_of_a_film_go_down_with_her_and_the_scored_ones_do_not(
    engine: BuiltinEngine,
) -> None:
    engine.reset(0)
    film_set = FilmSet(engine)
    assert engine.body.pick(CUP).outcome.value != "refused"
    heights: list[float] = []
    scored: list[float] = []
    low: list[np.ndarray] = []

    def moment() -> None:
        body, eyes, _ = film_set.figure()
        heights.append(eyes.z)
        scored.append(body.eyes.z)
        if eyes.z == min(heights) and eyes.z < 1.2:
            camera = engine.body.stance.camera(*SMALL)
            film_set.picture(camera)
            low[:] = [film_set.eyes(*SMALL), engine.stage.picture(engine.body.stance, camera)]

    film_set.watch(moment)
    try:
        engine.body.drop(FLOOR)
    finally:
        film_set.watch(None)
    assert min(heights) < 1.2
    assert max(heights) > 1.5
    assert max(scored) - min(scored) < 1e-9
    ours, standing = (picture.astype(int) for picture in low)
    assert np.abs(ours - standing).mean() > 5


def test_rays_of_a_film_pass_through_her_and_end_at_the_room(engine: BuiltinEngine) -> None:
    engine.reset(0)
    film_set = FilmSet(engine)
    body, eyes, hand = film_set.figure()
    assert eyes.distance(body.eyes) < 0.1
    assert 0.2 < hand.distance(body.position) < 1.2
    before = body.position + Vec3(0.0, 0.0, 1.2)
    ends = film_set.rays(before + Vec3(0.5, 0.0, 0.0), np.array([[-1.0, 0.0, 0.0]]))
    assert ends[0] is not None
    assert ends[0].distance(before) > 0.3
