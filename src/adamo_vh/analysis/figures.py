"""The figures of a set of episodes: means over its cells, so that each task counts once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import fsum

from adamo_vh.analysis.outcome import Outcome
from adamo_vh.analysis.statistics import Interval, interval, mean, pass_hat
from adamo_vh.inference.model import ModelKind

DETERMINISTIC = (ModelKind.RULE_BASED, ModelKind.SCRIPTED, ModelKind.REPLAY)
"""Players that do the same whenever the world is the same."""
KINDS = ("Walk", "Look", "Pick", "Drop")
"""The paper's tools."""

Cell = Sequence[Outcome]
"""Episodes that are alike but for repetition and variation."""


@dataclass(frozen=True, slots=True)
class Scored:
    """One of the two scores, and how sure it is."""

    mean: float | None
    """Mean over cells of the mean over episodes; None if nothing is scored."""
    repeat: Interval | None
    """Would this repeat? From the spread of the repetitions within each cell."""
    task: Interval | None
    """Would it hold for other tasks? From the spread of the tasks' means."""
    variation: Interval | None
    """Would it hold for other layouts? From the spread of the variations within each cell."""
    pass_hat: tuple[float, ...]
    """pass^1, pass^2, ...: how likely all of k repetitions get the full score."""


@dataclass(frozen=True, slots=True)
class Why:
    """Why an interval is missing, or what is odd about it; empty if there is nothing to say."""

    repeat: str
    task: str
    variation: str


@dataclass(frozen=True, slots=True)
class Figures:
    """All figures of a set of episodes; counts are per episode, None is unknown."""

    n: int
    """Scored episodes."""
    unscored: int
    """Episodes that a fault ended that is not the agent's; in no other figure."""
    cells: int
    """Cells with scored episodes."""
    tasks: int
    """Tasks with scored episodes."""
    completion: Scored
    strict: Scored
    why: Why
    calls: dict[str, float | None]
    """Tool calls: Walk, Look, Pick, Drop, those added from outside, and all together as "total".
    The paper's own Look counts the first view too: that is one more."""
    model_calls: float | None
    requests: float | None
    tokens: float | None
    input_tokens: float | None
    cached_tokens: float | None
    output_tokens: float | None
    reasoning_tokens: float | None
    tokens_estimated: bool
    """Whether some tokens were estimated, because the provider did not count them."""
    early_stops: float | None
    """Share of episodes that the agent ended with conditions open."""
    false_claims: float | None
    """Share of episodes that it ended so and said that all was done."""
    refused: float | None
    corrected: float | None
    protocol_failures: float | None
    missing_notes: float | None
    cut_prompts: float | None
    """Model calls whose prompt no longer held every reply before; None if any record tells not."""
    walked_m: float | None
    path_ratio: float | None
    """Metres walked over the oracle's, of complete episodes; None if no way is known or needed."""
    solved: int
    """Complete episodes."""
    cost_usd: float | None
    """None if the price of any call is unknown."""
    cost_per_solved_usd: float | None
    """All that was spent on scored episodes for each complete one; None if there is none."""
    tokens_per_solved: float | None
    seconds_per_call: float | None
    model_s: float | None
    world_s: float | None
    waited_s: float | None


TIMINGS = ("seconds_per_call", "model_s", "world_s", "waited_s")
"""What depends on the clock."""


def figures(cells: Sequence[Cell]) -> Figures:
    """The figures of some cells, of one model and profile alone."""
    scored = [[outcome for outcome in cell if outcome.is_scored] for cell in cells]
    groups = [group for group in scored if group]
    episodes = [outcome for group in groups for outcome in group]
    tasks = {outcome.task for outcome in episodes}

    def average(measure: Callable[[Outcome], float | None]) -> float | None:
        return _mean_of_cells(groups, measure)

    solved = sum(outcome.is_complete for outcome in episodes)
    tokens = sum(outcome.usage.total_tokens for outcome in episodes)
    costs = [outcome.cost_usd for outcome in episodes]
    known = [cost for cost in costs if cost is not None]
    cost = fsum(known) if known and len(known) == len(costs) else None
    return Figures(
        n=len(episodes),
        unscored=sum(map(len, cells)) - len(episodes),
        cells=len(groups),
        tasks=len(tasks),
        completion=_scored(groups, lambda o: o.completion),
        strict=_scored(groups, lambda o: o.strict),
        why=_why(groups, len(tasks)),
        calls=_calls(groups),
        model_calls=average(lambda o: o.model_calls),
        requests=average(lambda o: o.requests),
        tokens=average(lambda o: o.usage.total_tokens),
        input_tokens=average(lambda o: o.usage.input_tokens),
        cached_tokens=average(lambda o: o.usage.cached_tokens),
        output_tokens=average(lambda o: o.usage.output_tokens),
        reasoning_tokens=average(lambda o: o.usage.reasoning_tokens),
        tokens_estimated=any(outcome.usage.estimated for outcome in episodes),
        early_stops=average(lambda o: o.is_early_stop),
        false_claims=average(lambda o: o.is_false_claim),
        refused=average(lambda o: o.refused),
        corrected=average(lambda o: o.corrected),
        protocol_failures=average(lambda o: o.protocol_failures),
        missing_notes=average(lambda o: o.missing_notes),
        cut_prompts=None
        if any(o.cut_prompts is None for o in episodes)
        else average(lambda o: o.cut_prompts),
        walked_m=average(lambda o: o.walked_m),
        path_ratio=_path_ratio(episodes),
        solved=solved,
        cost_usd=None if cost is None else average(lambda o: o.cost_usd),
        cost_per_solved_usd=None if cost is None or not solved else cost / solved,
        tokens_per_solved=tokens / solved if solved else None,
        seconds_per_call=average(lambda o: o.model_s / o.model_calls if o.model_calls else None),
        model_s=average(lambda o: o.model_s),
        world_s=average(lambda o: o.world_s),
        waited_s=average(lambda o: o.waited_s),
    )


def _mean_of_cells(
    groups: Sequence[Cell], measure: Callable[[Outcome], float | None]
) -> float | None:
    """Mean over cells of the mean over episodes, of those that have the figure."""
    means = [
        mean([float(value) for value in map(measure, group) if value is not None])
        for group in groups
    ]
    return mean([value for value in means if value is not None])


def _calls(groups: Sequence[Cell]) -> dict[str, float | None]:
    others = sorted({name for group in groups for o in group for name in o.calls} - set(KINDS))
    found = {
        name: _mean_of_cells(groups, lambda o, name=name: o.calls.get(name, 0))  # type: ignore[misc]
        for name in (*KINDS, *others)
    }
    return {**found, "total": _mean_of_cells(groups, lambda o: o.steps)}


def _path_ratio(episodes: Sequence[Outcome]) -> float | None:
    known = [(o.walked_m, o.shortest_m) for o in episodes if o.is_complete and o.shortest_m]
    shortest = fsum(way for _, way in known)
    return fsum(walked for walked, _ in known) / shortest if known else None


def _scored(groups: Sequence[Cell], measure: Callable[[Outcome], float | None]) -> Scored:
    def values(cell: Cell) -> list[float]:
        return [value for value in map(measure, cell) if value is not None]

    centre = _mean_of_cells(groups, measure)
    if centre is None:
        return Scored(None, None, None, None, ())
    tasks: dict[str, list[float]] = {}
    for group in groups:
        tasks.setdefault(group[0].task, []).append(fsum(values(group)) / len(group))
    clusters = [fsum(means) / len(means) for means in tasks.values()]
    layouts = [[fsum(values(v)) / len(v) for v in _by_variation(group)] for group in groups]
    again = [values(part) for part in repeated(groups)]
    return Scored(
        mean=centre,
        repeat=None if is_deterministic(groups) else interval(again, centre),
        task=interval([clusters], centre),
        variation=interval(layouts, centre),
        pass_hat=_pass_hats([[value >= 1.0 for value in values(group)] for group in groups]),
    )


def is_deterministic(groups: Sequence[Cell]) -> bool:
    """Whether a repetition would be the same, because the player and the world are."""
    return any(group[0].model_kind in DETERMINISTIC for group in groups)


def _pass_hats(cells: Sequence[Sequence[bool]]) -> tuple[float, ...]:
    """pass^k, averaged over cells, as far as the smallest cell goes."""
    most = min(map(len, cells), default=0)
    found = []
    for k in range(1, most + 1):
        likely = [pass_hat(sum(cell), len(cell), k) for cell in cells]
        found.append(fsum(value for value in likely if value is not None) / len(cells))
    return tuple(found)


def _by_variation(cell: Cell) -> list[Cell]:
    parts: dict[int, list[Outcome]] = {}
    for outcome in cell:
        parts.setdefault(outcome.variation, []).append(outcome)
    return [parts[number] for number in sorted(parts)]


def repeated(groups: Sequence[Cell]) -> Sequence[Cell]:
    """What was repeated: each variation of each cell, or else each cell with all its layouts."""
    parts = [part for group in groups for part in _by_variation(group)]
    return groups if any(len(part) < 2 for part in parts) else parts


def _why(groups: Sequence[Cell], tasks: int) -> Why:
    """Why intervals are missing."""
    if not groups:
        return Why(*("nothing is scored",) * 3)
    repeat = ""
    if is_deterministic(groups):
        repeat = "deterministic: the same in every repetition; n counts variations"
    elif any(len(group) < 2 for group in groups):
        repeat = "a cell has a single scored episode"
    elif len(repeated(groups)) == len(groups) and any(len(_by_variation(g)) > 1 for g in groups):
        repeat = "each variation was played too seldom: the spread of the layouts is in it"
    variation = ""
    if any(len(_by_variation(group)) < 2 for group in groups):
        variation = "a cell has a single variation"
    return Why(repeat, "a single task" if tasks < 2 else "", variation)
