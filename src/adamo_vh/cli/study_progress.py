"""How far a study is: a live table on a terminal, plain lines or JSON otherwise."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.live import Live
from rich.table import Table

from adamo_vh.analysis.outcome import Outcome
from adamo_vh.cli.terminal import line, put_json, say, wide_console
from adamo_vh.readable import readable
from adamo_vh.study.plan import Planned
from adamo_vh.study.running import Played
from adamo_vh.study.tally import CellTally, Tally

_HEAD = ("model", "scene", "labeling", "profile", "settings")
_COUNTS = ("done", "running", "unscored", "mean", "tokens", "USD")


def grouped(tally: Tally) -> dict[tuple[str, ...], CellTally]:
    """The cells, all tasks of one kind together: a study has too many for a screen otherwise."""
    found: dict[tuple[str, ...], CellTally] = {}
    for cell, counts in tally.cells.items():
        axes = ", ".join(f"{name}={value}" for name, value in cell.axes)
        key = (cell.model, cell.scene, cell.labeling, cell.profile, axes)
        found[key] = found.get(key, CellTally()).added(counts)
    return found


def table_of(tally: Tally) -> Table:
    """How far every group of cells is, and the whole."""
    groups = grouped(tally)
    varied = [i for i in range(len(_HEAD)) if i < 3 or len({key[i] for key in groups}) > 1]
    table = Table(caption=pace(tally), box=SIMPLE_HEAD, padding=(0, 1))
    for i in varied:
        # What tells two rows apart is never cut off.
        table.add_column(_HEAD[i], overflow="fold")
    for name in _COUNTS:
        table.add_column(name, justify="right")
    for key, counts in groups.items():
        table.add_row(*(readable(key[i]) for i in varied), *_cells(counts))
    if len(groups) > 1:
        table.add_section()
        table.add_row("all", *[""] * (len(varied) - 1), *_cells(tally.total))
    return table


def _cells(counts: CellTally) -> tuple[str, ...]:
    mean = "" if counts.mean is None else f"{counts.mean:.2f}"
    money = f"{counts.usd:.2f}" if counts.usd else ""
    return (
        f"{counts.done}/{counts.planned}",
        str(counts.running or ""),
        str(counts.unscored or ""),
        mean,
        f"{counts.tokens:,}" if counts.tokens else "",
        money,
    )


def pace(tally: Tally) -> str:
    """Episodes an hour and the time left, at the speed so far."""
    rate, left = tally.per_hour, tally.seconds_left
    if rate is None or left is None:
        return ""
    minutes, seconds = divmod(round(left), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{rate:,.0f} episodes an hour, {hours}:{minutes:02d}:{seconds:02d} left"


class LiveTable:
    """The table, kept up to date on a terminal."""

    def __init__(self, tally: Tally) -> None:
        """Show it."""
        self._tally = tally
        self._console = Console()
        self._live = Live(console=self._console, refresh_per_second=2, auto_refresh=False)
        self._live.start()

    def began(self, planned: Planned) -> None:
        """The next tick shows it."""

    def ended(self, planned: Planned, outcome: Outcome | None, why: str, *, again: bool) -> None:
        """Say what is no plain end; the next tick shows the rest."""
        if why:
            say(_unscored(planned.key, why, again=again), "yellow", console=self._console)

    def noted(self, text: str) -> None:
        """Print it above the table."""
        say(text, "dim", console=self._console)

    def tick(self) -> None:
        """Draw the table."""
        self._live.update(table_of(self._tally), refresh=True)

    def close(self) -> None:
        """Leave the table as it is."""
        self._live.stop()


class PlainLines:
    """A line for every episode."""

    def __init__(self, tally: Tally) -> None:
        """Show nothing yet."""
        self._tally = tally

    def began(self, planned: Planned) -> None:
        """Its end is told."""

    def ended(self, planned: Planned, outcome: Outcome | None, why: str, *, again: bool) -> None:
        """Say how it ended."""
        if why:
            say(_unscored(planned.key, why, again=again))
        elif outcome is not None:
            total = self._tally.total
            done = f"{total.done}/{total.planned}"
            said = f"completion {outcome.completion:.2f}, strict {outcome.strict:.0f}"
            say(f"{done:>9}  {planned.key}  {said}, {outcome.termination}")

    def noted(self, text: str) -> None:
        """Print it."""
        say(text)

    def tick(self) -> None:
        """Nothing to do."""

    def close(self) -> None:
        """Nothing to do."""


def _unscored(key: str, why: str, *, again: bool) -> str:
    later = "; will be tried again" if again else ""
    return f"unscored   {key}: {why.rstrip('.')}{later}"


class JsonLines:
    """Every event as one JSON object a line."""

    def __init__(self, folder: Path, tally: Tally) -> None:
        """Say what begins."""
        self._tally = tally
        total = tally.total
        put_json(
            {
                "event": "study",
                "folder": str(folder),
                "episodes": total.planned,
                "done": total.done,
            }
        )

    def began(self, planned: Planned) -> None:
        """Tell."""
        put_json({"event": "began", "episode": planned.key})

    def ended(self, planned: Planned, outcome: Outcome | None, why: str, *, again: bool) -> None:
        """Tell."""
        told: dict[str, Any] = {"event": "ended", "episode": planned.key}
        told |= {"completion": None, "strict": None, "termination": None, "why": why}
        if outcome is not None:
            told["completion"], told["strict"] = outcome.completion, outcome.strict
            told["termination"] = outcome.termination
        total = self._tally.total
        put_json({**told, "again": again, "done": total.done, "episodes": total.planned})

    def noted(self, text: str) -> None:
        """Tell."""
        put_json({"event": "note", "text": text})

    def tick(self) -> None:
        """Nothing to do."""

    def close(self) -> None:
        """Nothing to do."""


def put_summary(played: Played, folder: Path, *, as_json: bool) -> None:
    """Say how the study stands: how far, what has no score and why, what to do next."""
    total, verdict = played.tally.total, played.verdict
    if as_json:
        put_json(
            {
                "event": "done",
                "folder": str(folder),
                "episodes": total.planned,
                "scored": total.done,
                "unscored": total.planned - total.done,
                "completion": total.mean,
                "tokens": total.tokens,
                "usd": total.usd,
                "episodes_per_hour": played.tally.per_hour,
                "stopped": verdict.stopped,
                "budget_spent": verdict.budget_spent,
                "problems": dict(verdict.problems),
            }
        )
        return
    wide_console().print(table_of(played.tally))
    for key, why in verdict.problems.items():
        line("unscored", f"{key}: {why}", "yellow")
    if verdict.budget_spent:
        line("budget", verdict.budget_spent, "yellow")
    line("study", str(folder))
    if total.done < total.planned:
        line("next", "the same command plays what has no score yet")
    else:
        line("next", f"adamo-vh report {folder}")
