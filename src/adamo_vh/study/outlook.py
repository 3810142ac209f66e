"""What a study will take, told before anything is started: tokens, money, hours."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from adamo_vh.action_server import execute_call
from adamo_vh.cognition.forecast import SECONDS_PER_CALL, Forecast
from adamo_vh.engine import World
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.inference.cost.tokens import estimate_request, rule_for
from adamo_vh.inference.registry import is_remote
from adamo_vh.observation import Observation
from adamo_vh.session.bodies import create_engine, open_server
from adamo_vh.session.forecasting import calls_expected, first_prompt, forecast_from
from adamo_vh.session.minds import model_of
from adamo_vh.study.plan import Planned


@dataclass(frozen=True, slots=True)
class ModelOutlook:
    """What the episodes of one model will take."""

    model: str
    is_remote: bool
    episodes: int
    calls: int
    tokens_low: int
    """If the episodes take half as many calls as expected."""
    tokens: int
    """As expected. 0 for a model that has none."""
    tokens_high: int
    """If they take twice as many."""
    usd: float | None
    """For the expected tokens; None if the price is not known."""
    usd_high: float | None
    seconds_per_call: float
    """The paper's mean for a remote model; measured for a local one."""
    model_s: float
    """Seconds of all its calls, one after the other."""
    world_s: float
    """Seconds of all actions, at the measured speed of this machine."""


@dataclass(frozen=True, slots=True)
class Outlook:
    """What a study will take."""

    models: tuple[ModelOutlook, ...]
    action_s: Mapping[str, float]
    """Measured seconds of an action with its view, by scene and resolution."""
    workers: int
    in_flight: int
    cores: int

    @property
    def seconds(self) -> float:
        """From the first episode to the last: limited by the cores or by the models' answers."""
        at_once = min(self.workers, self.cores)
        # What is computed here shares the cores; what waits for a provider does not.
        here = sum(m.world_s + (0.0 if m.is_remote else m.model_s) for m in self.models)
        waiting = sum(m.world_s + m.model_s for m in self.models if m.is_remote)
        return max(here / at_once, waiting / (self.workers * self.in_flight))


@dataclass(slots=True)
class _Gauge:
    """What was measured with one setting; its tasks share it."""

    first: int
    """Tokens of the first request."""
    action_s: float
    call_s: float


def outlook(episodes: Sequence[Planned], workers: int, in_flight: int) -> Outlook:
    """Forecast what episodes will take; no model but a local one is asked, and no key is needed.

    Args:
        episodes: Those that are still to be played.
        workers: Processes.
        in_flight: Episodes at once in each.

    Raises:
        SceneError: A scene is unknown or wrong.
        ConfigError: The price table is damaged.
    """
    gauges: dict[EpisodeConfig, _Gauge] = {}
    action_s: dict[str, float] = {}
    found: dict[str, list[tuple[Forecast, float, float]]] = {}
    for scene, its in _by_scene(episodes).items():
        engine = create_engine(scene, its[0].config.figure)
        try:
            for config, count in _counted(its):
                setting = replace(
                    config, instruction="any", task=None, own_task=None, seed=0, variation=0
                )
                gauge = gauges.get(setting)
                if gauge is None:
                    gauge = gauges[setting] = _measured(config, engine)
                    width, height = config.resolution
                    action_s.setdefault(f"{scene} {width}x{height}", gauge.action_s)
                ahead = forecast_from(config, gauge.first, count, gauge.call_s)
                world_s = max(0.0, calls_expected(config) - 1) * gauge.action_s * count
                found.setdefault(config.model, []).append((ahead, world_s, gauge.call_s))
        finally:
            engine.close()
    models = tuple(_summed(model, parts) for model, parts in found.items())
    return Outlook(models, action_s, workers, in_flight, os.cpu_count() or 1)


def _by_scene(episodes: Iterable[Planned]) -> dict[str, list[Planned]]:
    found: dict[str, list[Planned]] = {}
    for one in episodes:
        found.setdefault(one.config.scene, []).append(one)
    return found


def _counted(episodes: Iterable[Planned]) -> list[tuple[EpisodeConfig, int]]:
    """Settings with the number of their episodes, repetitions and variations together."""
    counts: dict[EpisodeConfig, int] = {}
    for one in episodes:
        config = replace(one.config, seed=0, variation=0)
        counts[config] = counts.get(config, 0) + 1
    return list(counts.items())


def _measured(config: EpisodeConfig, engine: World) -> _Gauge:
    """Measure the first request, an action with its view and, for a local model, its answer."""
    engine.reset(0)
    server = open_server(config, engine)
    view = server.observe().observation
    prompt, tools = first_prompt(config, engine, server, view)
    call_s, first = SECONDS_PER_CALL, 0
    if is_remote(config.model):
        first = estimate_request(prompt, tools, rule_for(config.model))
    else:
        model = model_of(config.model, profile=config.profile, seed=config.seed)
        try:
            begun = time.perf_counter()
            model.complete(prompt, tools, config.sampling)
            call_s = time.perf_counter() - begun
        finally:
            model.info.close()
    begun = time.perf_counter()
    execute_call(server, "Look", _somewhere(view))
    return _Gauge(first, time.perf_counter() - begun, call_s)


def _somewhere(view: Observation) -> dict[str, float]:
    """A point to look at."""
    gaze = view.agent.gaze
    return {"x": gaze.x, "y": gaze.y, "z": gaze.z}


def _summed(model: str, parts: Sequence[tuple[Forecast, float, float]]) -> ModelOutlook:
    ahead = [one for one, _, _ in parts]
    remote = is_remote(model)
    calls = sum(one.calls for one in ahead)
    model_s = sum(one.seconds for one in ahead)

    def tokens(name: str) -> int:
        return sum(getattr(one, name) for one in ahead) if remote else 0

    def money(name: str) -> float | None:
        prices: list[Any] = [getattr(one, name) for one in ahead]
        if not remote:
            return 0.0
        return None if None in prices else sum(prices)

    return ModelOutlook(
        model,
        remote,
        sum(one.episodes for one in ahead),
        calls,
        tokens("tokens_low"),
        tokens("tokens_typical"),
        tokens("tokens_high"),
        money("usd"),
        money("usd_high"),
        model_s / calls,
        model_s,
        sum(world_s for _, world_s, _ in parts),
    )
