"""One engine for many episodes at once: nobody can tell that he is not alone."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from tests.records import assert_the_same_record

import adamo_vh
from adamo_vh.action import ToolSchema
from adamo_vh.benchmark.tasks import TASKS
from adamo_vh.engine import LightChanged, ObjectMoved, ObjectTaken, World, acting_body
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import EpisodeResult, read_manifest
from adamo_vh.errors import EngineError
from adamo_vh.geometry import Vec3
from adamo_vh.inference.messages import AIMessage, Message, ToolCall
from adamo_vh.inference.model import Model, Reply, Sampling
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.inference.players.wrapper import Ask, Wrapped
from adamo_vh.inference.registry import create_model
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.service.conformance import engine_faults
from adamo_vh.session.lending import Lender, LentWorld
from adamo_vh.session.session import Session

TINY = (320, 180)
SHORT = {"resolution": TINY, "limits": adamo_vh.Limits(max_steps=8)}
PLATE, CUP = 57, 45


@pytest.fixture(params=["s1", "s2"])
def lender(request: pytest.FixtureRequest) -> Lender:
    made: BuiltinEngine = request.getfixturevalue(f"{request.param}_engine")
    made.reset(0)
    return Lender(made)


@pytest.fixture
def lent_s1(engine: BuiltinEngine) -> Lender:
    return Lender(engine)


def played(
    settings: Sequence[Mapping[str, Any]], world: Callable[[], World], out: Path, threads: int
) -> list[EpisodeResult]:
    def play(number: int) -> EpisodeResult:
        folder = out / str(number)
        return adamo_vh.run_episode(engine=world(), out=folder, **settings[number])

    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(play, range(len(settings))))


def assert_the_same(settings: Sequence[Mapping[str, Any]], lender: Lender, here: Path) -> None:
    """Play episodes at once in a lent engine, and one after the other in an own one."""
    played(settings, lender.lend, here / "lent", len(settings))
    with Lender(adamo_vh.create_engine(lender.world.scene.name)) as own:
        played(settings, lambda: own.world, here / "own", 1)
    for number in range(len(settings)):
        assert_the_same_record(here / "lent" / str(number), here / "own" / str(number))


@pytest.mark.parametrize("every", [8, pytest.param(1, marks=pytest.mark.slow)])
def test_tasks_at_once_go_as_alone(lender: Lender, every: int, tmp_path: Path) -> None:
    labelings = ("sem", "opaq")
    settings = [
        {"task": task.id, "labeling": labelings[i % 2], "resolution": TINY}
        for i, task in enumerate(TASKS[::every])
    ]
    assert_the_same(settings, lender, tmp_path)


def test_whatever_is_done_at_once_goes_as_alone(lender: Lender, tmp_path: Path) -> None:
    settings = [
        {"instruction": "Do something", "model": "random", "seed": seed, **SHORT}
        for seed in range(2)
    ]
    assert_the_same(settings, lender, tmp_path)


class Meanwhile(Wrapped):
    """A model during whose thinking something is done."""

    def __init__(self, model: Model, job: Callable[[], None]) -> None:
        def around(
            ask: Ask, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
        ) -> Reply:
            job()
            return ask(messages, tools, sampling)

        super().__init__(model, around)


def test_what_happens_in_other_worlds_is_not_seen(lender: Lender, tmp_path: Path) -> None:
    other = lender.lend()
    body = acting_body(other)
    turns = iter(range(1000))

    def upheaval() -> None:
        other.reset(0)
        match next(turns) % 3:
            case 0:
                other.apply(LightChanged(0, 0.0))
                other.apply(ObjectTaken(CUP))
            case 1:
                body.pick(PLATE)
                body.say("I have it.")
            case _:
                other.apply(ObjectMoved(PLATE, Vec3(-1.5, -2.5, 0.0)))
                body.walk(Vec3(-1.0, -3.0, 0.0))

    config = EpisodeConfig.of(task="T8", scene=lender.world.scene.name, resolution=TINY)
    for kind, job in (("alone", lambda: None), ("disturbed", upheaval)):
        folder, mind = tmp_path / kind, Meanwhile(create_model("baseline"), job)
        with Session.begin(config, folder, engine=lender.lend(), model=mind) as session:
            session.apply(LightChanged(0, 0.3))
            session.say(config.instruction)
            session.apply(ObjectTaken(CUP))
            job()
            session.say("What do you see?")
            session.result()
    assert_the_same_record(tmp_path / "alone", tmp_path / "disturbed")
    assert next(turns) > 3


def test_what_was_said_stays_in_its_world(lent_s1: Lender) -> None:
    one, two = lent_s1.lend(), lent_s1.lend()
    acting_body(one).say("one")
    acting_body(two).say("two")
    engine: Any = lent_s1.world
    with one.turn():
        assert engine.body.said == ["one"]
    with two.turn():
        assert engine.body.said == ["two"]


def test_a_lent_world_keeps_the_contract(lent_s1: Lender) -> None:
    assert engine_faults(lent_s1.lend()) == ()


def test_a_run_in_a_lent_engine_needs_no_handing_in(lent_s1: Lender, tmp_path: Path) -> None:
    adamo_vh.run_episode(task="T8", engine=lent_s1.lend(), resolution=TINY, out=tmp_path)
    assert read_manifest(tmp_path).engine == ""
    assert adamo_vh.replay_episode(tmp_path, engine=lent_s1.lend()).mismatches == ()
    assert adamo_vh.replay_episode(tmp_path).mismatches == ()


# --- waiting --------------------------------------------------------------------------------


def script(*names: str) -> ScriptedModel:
    calls = [
        AIMessage("", (ToolCall(name, name, {"x": 0.5, "y": -1.0, "z": 0.8}),)) for name in names
    ]
    return ScriptedModel("scripted", calls)


def test_waiting_for_the_engine_is_no_time_of_the_agent(lent_s1: Lender, tmp_path: Path) -> None:
    busy, held_s = lent_s1.lend(), 0.4
    free = threading.Event()

    def keep_busy() -> None:
        with busy.turn():
            free.set()
            time.sleep(held_s)

    def get_busy() -> None:
        free.clear()
        threading.Thread(target=keep_busy).start()
        free.wait()

    mind = Meanwhile(script("Look", "Look"), get_busy)
    begun = time.monotonic()
    result = adamo_vh.run_episode(
        "Look", model=mind, engine=lent_s1.lend(), resolution=TINY, out=tmp_path
    )
    passed_s = time.monotonic() - begun
    recorded = read_trajectory(tmp_path)
    waits_s = 2 * held_s
    assert passed_s > waits_s
    assert recorded.ended is not None
    assert recorded.ended.seconds < passed_s - 0.9 * waits_s
    assert sum(act.world_s for act in recorded.acts) < passed_s - 0.9 * waits_s
    assert result.termination is TerminationReason.ANSWERED


# --- in the middle of an action -------------------------------------------------------------


def test_a_view_waits_for_the_action_of_another_episode(lent_s1: Lender) -> None:
    engine: Any = lent_s1.world
    one, two = lent_s1.lend(), lent_s1.lend()
    seen: list[int] = []
    pool = ThreadPoolExecutor(1)

    def watch(seconds: float) -> bool:
        if not seen:
            seen.append(0)
            pool.submit(check)
            time.sleep(0.1)
        return True

    def check() -> None:
        result = adamo_vh.run_episode("Look", model=script(), engine=two, resolution=TINY)
        assert result.termination is TerminationReason.ANSWERED
        seen.append(1)

    engine.stage.watcher = watch
    try:
        acting_body(one).pick(PLATE)
    finally:
        engine.stage.watcher = None
        pool.shutdown()
    assert seen == [0, 1]
    assert acting_body(one).state().held == PLATE


def test_a_watcher_sees_the_moment_of_its_own_world_alone(lent_s1: Lender) -> None:
    engine: Any = lent_s1.world
    one, two = lent_s1.lend(), lent_s1.lend()
    places: set[float] = set()

    moments = iter(range(1000))

    def watch(seconds: float) -> bool:
        if next(moments) % 8:
            return True
        places.add(acting_body(one).see(*TINY).body.position.x)
        with pytest.raises(EngineError, match="in the middle of another episode's action"):
            two.state()
        return True

    engine.stage.watcher = watch
    try:
        acting_body(one).walk(Vec3(-1.0, -3.0, 0.0))
    finally:
        engine.stage.watcher = None
    assert len(places) > 2
    assert two.state().hash() != one.state().hash()


# --- the end of a loan ----------------------------------------------------------------------


def test_what_was_given_back_cannot_be_used(lent_s1: Lender) -> None:
    one, two = lent_s1.lend(), lent_s1.lend()
    one.state()
    one.close()
    with pytest.raises(EngineError, match="given back; lend another one"):
        one.state()
    assert two.state().hash() == lent_s1.lend().state().hash()


class Fragile:
    """The built-in engine, which now and then cannot tell its state."""

    def __init__(self, inner: BuiltinEngine) -> None:
        self._inner = inner
        self.fails = False

    def snapshot(self) -> bytes:
        if self.fails:
            raise RuntimeError("lost")
        return self._inner.snapshot()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._inner, name)


def test_a_broken_world_breaks_no_other(engine: BuiltinEngine) -> None:
    fragile: Any = Fragile(engine)
    lender = Lender(fragile)
    one, two = lender.lend(), lender.lend()
    acting_body(one).pick(PLATE)
    fragile.fails = True
    acting_body(two).pick(CUP)
    fragile.fails = False
    assert acting_body(two).state().held == CUP
    with pytest.raises(
        EngineError, match="could not keep this episode's world: RuntimeError: lost"
    ):
        one.state()


def test_an_own_engine_is_recorded_by_its_own_name(engine: BuiltinEngine, tmp_path: Path) -> None:
    class Yard(Fragile):
        @property
        def scene(self) -> Any:
            from dataclasses import replace

            return replace(engine.scene, source="a yard of ours")

    yard: Any = Yard(engine)
    lent: LentWorld = Lender(yard).lend()
    adamo_vh.run_episode("Look", model=script(), engine=lent, resolution=TINY, out=tmp_path)
    assert read_manifest(tmp_path).engine == "Yard"
