"""The camera of a film sees her, and nothing stands before it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from adamo_vh.adapters.tripod import _BAD, Tripod
from adamo_vh.geometry import Vec3
from adamo_vh.session.filming import FilmSet

SIZE = (208, 180)


@pytest.fixture(scope="module")
def shared():
    made = FilmSet.of("s2", "mara")
    yield made
    made.engine.close()


@pytest.fixture
def film_set(shared):
    shared.engine.reset(0)
    yield shared
    shared.watch(None)


def seen_share(film_set, camera):
    """How much of her eyes, trunk and hips is in the picture with nothing before it."""
    points = Tripod(film_set, SIZE)._figure()[:3]
    u, v, depth = camera.project(points).T
    inside = (depth > 0) & (u > 0) & (u < SIZE[0]) & (v > 0) & (v < SIZE[1])
    lines = points - camera.position.array()
    far = np.linalg.norm(lines, axis=1)
    met = film_set.rays(camera.position, lines / far[:, None])
    free = [
        m is None or m.distance(camera.position) > f - 0.3 for m, f in zip(met, far, strict=True)
    ]
    return float((inside & free).mean())


PLACES = [(-2.0, -1.0), (1.6, 1.0), (2.2, -1.6), (-1.0, 1.6), (0.4, 0.0), (-2.2, 1.2)]


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("heading", [0.0, 2.0, -2.0])
def test_wherever_she_stands_she_is_seen_and_the_lens_is_free(film_set, place, heading):
    body = film_set.engine.body
    x, y = place
    body.walk(Vec3(x, y, 0.0))
    at = body.stance.position
    body.look(at + Vec3(2 * math.cos(heading), 2 * math.sin(heading), 1.4))
    tripod = Tripod(film_set, SIZE)
    camera = tripod.camera()
    assert seen_share(film_set, camera) == 1.0
    scene = film_set.scene
    assert scene.x_min < camera.position.x < scene.x_max
    assert scene.y_min < camera.position.y < scene.y_max
    # Nothing near fills the picture.
    assert tripod._cluttered(camera.position, tripod._figure()) < 0.6
    # Her face or her side is seen, not her back, where the room allows it.
    assert 1.2 < camera.position.horizontal_distance(at) < 4.5


def test_it_stands_still_while_nothing_is_in_the_way(film_set):
    tripod = Tripod(film_set, SIZE)
    first = tripod.camera().position
    assert tripod.rating(first, tripod._figure()) < _BAD
    for _ in range(20):
        assert tripod.camera().position.distance(first) < 1e-9


def test_it_follows_her_through_a_walk_and_loses_her_for_moments_at_most(film_set):
    tripod = Tripod(film_set, SIZE)
    shares = []
    jumps = []
    last = [tripod.camera().position]

    def moment():
        camera = tripod.camera()
        shares.append(seen_share(film_set, camera))
        jumps.append(camera.position.distance(last[0]))
        last[0] = camera.position

    film_set.watch(moment)
    film_set.engine.body.walk(Vec3(2.0, 1.0, 0.0))
    film_set.engine.body.pick(36)
    film_set.watch(None)
    assert np.mean(shares) > 0.9
    # It stands, glides or cuts, and does not wander.
    cuts = sum(jump > 0.5 for jump in jumps)
    assert cuts <= 1 + len(jumps) // 30
    assert all(jump < 0.2 or jump > 0.5 for jump in jumps)


def test_what_is_behind_her_or_too_near_is_rated_worse(film_set):
    tripod = Tripod(film_set, SIZE)
    body = film_set.body()
    ahead = Vec3(math.cos(body.heading_rad), math.sin(body.heading_rad), 0.0)
    up = Vec3(0.0, 0.0, 1.7)
    front = tripod._odd(body.position + ahead * 2.6 + up)
    assert front < tripod._odd(body.position - ahead * 2.6 + up)
    assert front < tripod._odd(body.position + ahead * 0.8 + up)
    assert front < tripod._odd(body.position + ahead * 6.0 + up)
