"""`adamo-vh bench --dry-run`: the episodes of a study and what they will take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.table import Table

from adamo_vh.cli.terminal import line, put_json, say, wide_console
from adamo_vh.cognition.budget import Budget
from adamo_vh.readable import readable
from adamo_vh.study.outlook import Outlook, outlook
from adamo_vh.study.plan import Planned, Study, plan
from adamo_vh.study.running import Means, default_in_flight, default_workers, ordered, sharded
from adamo_vh.study.store import is_study, read_outcomes


def forecast_and_show(study: Study, out: Path | None, means: Means, *, as_json: bool) -> None:
    """List what would be played and tell what it will take; nothing is started or written."""
    mine = ordered(sharded(plan(study), means.shard))
    done: set[str] = set()
    if out is not None and is_study(out):
        done = {one.key for one in read_outcomes(out)[0] if one.is_scored}
    left = [one for one in mine if one.key not in done]
    in_flight = means.in_flight or default_in_flight(study.models)
    ahead = outlook(left, means.workers or default_workers(), in_flight)
    warning = _too_little(ahead, means.budget)
    if as_json:
        put_json(_json(mine, len(done), ahead, warning))
        return
    for one in mine:
        say(f"{one.key}{'  (done)' if one.key in done else ''}")
    say("")
    _print(ahead, len(left))
    if warning:
        say(warning, "yellow")


def _print(ahead: Outlook, left: int) -> None:
    table = Table(
        "model", "episodes", "calls", "tokens", "at 2x calls", "USD", "at 2x calls", "s/call",
        "hours in a row", box=SIMPLE_HEAD,
    )  # fmt: skip
    for column in table.columns[1:]:
        column.justify = "right"
    for one in ahead.models:
        table.add_row(
            readable(one.model),
            f"{one.episodes:,}",
            f"{one.calls:,}",
            _short(one.tokens),
            _short(one.tokens_high),
            "unknown" if one.usd is None else f"{one.usd:,.2f}",
            "unknown" if one.usd_high is None else f"{one.usd_high:,.2f}",
            f"{one.seconds_per_call:.2f}",
            f"{(one.model_s + one.world_s) / 3600:,.2f}",
        )
    wide_console().print(table)
    if any(one.is_remote for one in ahead.models):
        line("assumed", "a call for each act of a task and one to end; a remote model's s/call is "
             "the paper's mean")  # fmt: skip
    for place, seconds in ahead.action_s.items():
        line("measured", f"{seconds:.2f} s for an action with its view in {place}")
    line(
        "time",
        f"{left:,} episodes in about {_duration(ahead.seconds)} with {ahead.workers} workers x "
        f"{ahead.in_flight} in flight on {ahead.cores} cores",
    )


def _short(number: int) -> str:
    for size, sign in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if number >= size:
            return f"{number / size:.3g} {sign}"
    return str(number or "")


def _duration(seconds: float) -> str:
    minutes = round(seconds / 60)
    if seconds < 120:
        return f"{seconds:.0f} s"
    return f"{minutes} min" if minutes < 120 else f"{seconds / 3600:,.1f} h"


def _too_little(ahead: Outlook, budget: Budget) -> str:
    """What to say of a budget that may not be enough; empty if it is."""
    tokens = sum(one.tokens for one in ahead.models)
    calls = sum(one.calls for one in ahead.models if one.is_remote)
    prices = [one.usd for one in ahead.models]
    usd = None if None in prices else sum(price or 0.0 for price in prices)
    for name, cap, expected in (
        ("tokens", budget.tokens, tokens),
        ("US dollars", budget.usd, usd),
        ("calls", budget.calls, calls),
    ):
        if cap is None:
            continue
        if expected is None:
            return "No price is known for a model: a budget of money would be refused."
        if expected > cap:
            return f"The budget of {cap:,g} {name} will not be enough: {expected:,.6g} expected."
    return ""


def _json(episodes: Sequence[Planned], done: int, ahead: Outlook, warning: str) -> dict[str, Any]:
    return {
        "episodes": [
            {
                "episode": one.key,
                "scene": one.cell.scene,
                "task": one.cell.task,
                "labeling": one.cell.labeling,
                "model": one.cell.model,
                "profile": one.cell.profile,
                "axes": dict(one.cell.axes),
                "variation": one.variation,
                "repetition": one.repetition,
                "seed": one.config.seed,
            }
            for one in episodes
        ],
        "done": done,
        "forecast": {
            "models": [asdict(one) for one in ahead.models],
            "tokens": sum(one.tokens for one in ahead.models),
            "usd": None
            if any(one.usd is None for one in ahead.models)
            else sum(one.usd or 0.0 for one in ahead.models),
            "hours": ahead.seconds / 3600,
            "action_s": dict(ahead.action_s),
            "workers": ahead.workers,
            "in_flight": ahead.in_flight,
            "cores": ahead.cores,
        },
        "warning": warning,
    }
