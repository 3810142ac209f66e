"""Engines of a process: made once, shared by many episodes, closed when nobody needs them."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from threading import Barrier
from typing import Any

import pytest

from adamo_vh.engine import acting_body
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import SceneError
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session import pooling
from adamo_vh.session.pooling import Engines

S1 = EpisodeConfig("Look")


class Made:
    """An engine that tells whether it is open; the worlds in it are those of one real engine."""

    def __init__(self, real: BuiltinEngine) -> None:
        self._real = real
        self.is_open = True

    def close(self) -> None:
        self.is_open = False

    def __getattr__(self, name: str) -> Any:
        return getattr(self._real, name)


@pytest.fixture
def made(engine: BuiltinEngine, monkeypatch: pytest.MonkeyPatch) -> list[Made]:
    engines: list[Made] = []

    def create(scene: str, figure: str, variation: int) -> Made:
        if scene == "nowhere":
            raise SceneError("no scene 'nowhere'")
        engines.append(Made(engine))
        return engines[-1]

    monkeypatch.setattr(pooling, "create_engine", create)
    return engines


def scene(name: str) -> EpisodeConfig:
    return EpisodeConfig("Look", scene=name)


def test_episodes_at_once_share_one_engine(made: list[Made]) -> None:
    engines, together = Engines(), Barrier(4)

    def play(number: int) -> None:
        with engines.lent(S1) as world:
            together.wait()
            acting_body(world).pick(57) if number == 0 else None
            together.wait()
            assert (acting_body(world).state().held is not None) == (number == 0)

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(play, range(4)))
    assert [one.is_open for one in made] == [True]


def test_no_more_idle_engines_are_kept_than_fit(made: list[Made]) -> None:
    engines = Engines()
    for name in ("a", "b", "a", "c"):
        with engines.lent(scene(name)):
            pass
    assert [one.is_open for one in made] == [True, False, True]
    with ExitStack() as all_in_use:
        for name in ("a", "b", "c", "d"):
            all_in_use.enter_context(engines.lent(scene(name)))
        assert sum(one.is_open for one in made) == 4
    assert sum(one.is_open for one in made) == 2


def test_an_engine_that_may_be_at_fault_gets_no_new_episode(made: list[Made]) -> None:
    engines = Engines()
    with engines.lent(S1) as staying:
        with pytest.raises(ValueError, match="broke"), engines.lent(S1):
            raise ValueError("broke")
        with engines.lent(S1) as other:
            assert other.lender is not staying.lender
            engines.distrust(other)
        assert [one.is_open for one in made] == [True, False]
        assert staying.state().objects
    assert [one.is_open for one in made] == [False, False]


def test_an_engine_that_cannot_be_made_is_tried_again(made: list[Made]) -> None:
    engines = Engines()
    for _ in range(2):
        with pytest.raises(SceneError, match="nowhere"), engines.lent(scene("nowhere")):
            pass
    with engines.lent(S1):
        assert len(made) == 1
