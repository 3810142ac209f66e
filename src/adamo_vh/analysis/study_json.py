"""A study's rows as one JSON object: what `report --json` prints."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from adamo_vh.analysis.cells import Setting, cells, in_order, means, spelled
from adamo_vh.analysis.failures import failures, shares
from adamo_vh.analysis.figures import TIMINGS, Figures, Scored
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.analysis.ranks import ranks
from adamo_vh.analysis.statistics import CONFIDENCE, Interval

_DIGITS = 6
_PLAIN = (
    "calls model_calls requests tokens input_tokens cached_tokens output_tokens reasoning_tokens "
    "tokens_estimated early_stops false_claims refused corrected protocol_failures missing_notes "
    "cut_prompts walked_m path_ratio solved cost_usd cost_per_solved_usd tokens_per_solved"
)


def study_json(outcomes: Iterable[Outcome], *, timings: bool = True) -> dict[str, Any]:
    """A study as plain JSON data, in the same order whatever order the episodes come in.

    Args:
        outcomes: Its episodes.
        timings: Whether to tell what depends on the clock; without, two runs of the same study
            give the same bytes.
    """
    episodes = in_order(outcomes)
    return {
        "episodes": len(episodes),
        "unscored": sum(not outcome.is_scored for outcome in episodes),
        "confidence": CONFIDENCE,
        "cells": [
            {
                **_setting(row.setting),
                "scene": row.scene,
                "labeling": row.labeling,
                "task": row.task,
                **_variations(row.variations),
                **_figures(row.figures, timings),
            }
            for row in cells(episodes)
        ],
        "means": [
            {
                **_setting(row.setting),
                "by": list(row.by),
                **{name: row.of(name) for name in ("scene", "labeling", "family")},
                **_variations(row.variations),
                **_figures(row.figures, timings),
            }
            for row in means(episodes)
        ],
        "failures": [_failure(outcome) for outcome in failures(episodes)],
        "failure_shares": [
            {
                "labeling": row.labeling,
                "model": row.model,
                "class": row.class_,
                "code": row.code,
                "count": row.count,
                "share": _rounded(row.share),
            }
            for row in shares(episodes)
        ],
        "spearman": [
            {
                **_setting(row.setting),
                "labeling": row.labeling,
                "level": row.level,
                "over": row.over,
                "rho": _rounded(row.rank.rho),
                "p": _rounded(row.rank.p),
                "n": row.rank.n,
            }
            for row in ranks(episodes)
        ],
    }


def _setting(setting: Setting) -> dict[str, Any]:
    return {
        "model": setting.model,
        "model_kind": setting.model_kind,
        "profile": setting.profile,
        "axes": dict(setting.axes),
    }


def _variations(numbers: Sequence[int]) -> dict[str, Any]:
    """One variation as its number, several as the command line takes them."""
    return {"variation": numbers[0] if len(numbers) == 1 else spelled(numbers)}


def _figures(found: Figures, timings: bool) -> dict[str, Any]:
    names = [*_PLAIN.split(), *(TIMINGS if timings else ())]
    return {
        "n": found.n,
        "unscored": found.unscored,
        **_scored(found.completion, "completion", ""),
        "repeat_reason": found.why.repeat,
        "task_reason": found.why.task,
        "variation_reason": found.why.variation,
        **_scored(found.strict, "strict", "strict_"),
        **{name: _rounded(getattr(found, name)) for name in names},
    }


def _scored(score: Scored, name: str, prefix: str) -> dict[str, Any]:
    return {
        name: _rounded(score.mean),
        f"{prefix}repeat_interval": _interval(score.repeat),
        f"{prefix}task_interval": _interval(score.task),
        f"{prefix}variation_interval": _interval(score.variation),
        f"{prefix}pass_hat": [_rounded(value) for value in score.pass_hat],
    }


def _interval(found: Interval | None) -> list[Any] | None:
    return None if found is None else [_rounded(found.low), _rounded(found.high)]


def _failure(outcome: Outcome) -> dict[str, Any]:
    return {
        "episode": outcome.key,
        "class": outcome.diagnosis or None,
        "code": outcome.diagnosis_code or None,
        "model": outcome.model,
        "profile": outcome.profile,
        "axes": dict(sorted(outcome.axes.items())),
        "scene": outcome.scene,
        "labeling": outcome.labeling,
        "task": outcome.task,
        "variation": outcome.variation,
        "repetition": outcome.repetition,
        "completion": _rounded(outcome.completion),
        "termination": str(outcome.termination),
        "false_claim": outcome.is_false_claim,
        "run": outcome.run,
    }


def _rounded(value: Any) -> Any:
    """Numbers short enough for people; whatever else as it is."""
    if isinstance(value, Mapping):
        return {name: _rounded(inner) for name, inner in value.items()}
    return round(value, _DIGITS) + 0.0 if isinstance(value, float) else value
