"""`adamo-vh run` and `adamo-vh replay`: live progress, and the result as text or JSON."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import typer
from rich.console import Console

from adamo_vh.cli.exits import Exit
from adamo_vh.cli.progress import Progress
from adamo_vh.cli.terminal import complain, line, put_json, say
from adamo_vh.cognition.budget import Budget
from adamo_vh.cognition.forecast import Forecast
from adamo_vh.engine import World
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import EpisodeResult, read_manifest, to_json
from adamo_vh.episode.sealing import sign_run
from adamo_vh.errors import ConfigError
from adamo_vh.record.run_folder import reserve
from adamo_vh.record.signing import Signer
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import Observer

RUNS = Path("runs")


def run_and_show(
    instruction: str | None,
    *,
    as_json: bool,
    out: Path | None,
    record: bool,
    limits: Limits,
    video: Path | None,
    sign: Path | None,
    where: tuple[str, int],
    **settings: Any,
) -> None:
    """Run an episode and print what happens, or one JSON object at the end."""
    from adamo_vh.session.forecasting import refuse_early
    from adamo_vh.session.session import Session

    signer = Signer(sign) if sign else None
    if video is not None:
        # Drawing the film takes minutes that are not the agent's.
        limits = replace(limits, max_seconds=1e9)
    config = EpisodeConfig.of(instruction, limits=limits, **settings)
    observers: list[Observer] = [] if as_json else [Progress(Console())]
    refuse_early(config, out)  # A film takes its file at once.
    with ExitStack() as stack:
        engine = stack.enter_context(engine_at(where, config.scene, config.figure, as_json=as_json))
        if video is not None:
            if engine is not None:
                raise ConfigError("--video films the built-in engine alone; leave --engine out.")
            engine = stack.enter_context(filming(video, config, observers))
        folder = stack.enter_context(run_folder(out, config.task or config.instruction))
        session = stack.enter_context(
            Session.begin(config, folder, record=record, engine=engine, observers=observers)
        )
        mark_latest(folder)
        if not as_json and (ahead := session.forecast()):
            _announce(ahead, config.budget)
        result = session.play()
    if signer is not None:
        sign_run(folder, signer)
    show_result(result, folder, as_json=as_json)


def _announce(ahead: Forecast, budget: Budget) -> None:
    """Say what an episode will take, and whether its budget is enough."""
    line("forecast", ahead.text())
    if warning := ahead.warns(budget):
        say(warning, "yellow")


@contextmanager
def filming(path: Path, config: EpisodeConfig, observers: list[Observer]) -> Iterator[World]:
    """An engine whose episode is filmed; the film is finished at the end."""
    from adamo_vh.adapters.video import VideoRecorder
    from adamo_vh.session.filming import FilmSet

    film_set = FilmSet.of(config.scene, config.figure, config.variation)
    recorder = VideoRecorder(path, film_set)
    observers.append(recorder)
    try:
        yield film_set.engine
    finally:
        recorder.close()
        film_set.engine.close()


@contextmanager
def engine_at(
    where: tuple[str, int], scene: str, figure: str, *, as_json: bool
) -> Iterator[World | None]:
    """The world in an engine that dials in; None for the built-in one.

    Args:
        where: What kind of engine, and the port at which it is waited for.
        scene: What it is to load.
        figure: Who the virtual human is.
        as_json: Say nothing but on standard error.

    Raises:
        ConfigError: There is no such kind, or the port is taken.
        EngineError: No engine came, or it failed.
    """
    kind, port = where
    if kind == "built-in":
        yield None
        return
    if kind != "remote":
        raise ConfigError(f"--engine {kind}: use built-in or remote.")
    from adamo_vh.service.engines.waiting import dialled_in

    with dialled_in(scene, figure, port=port, tell=complain if as_json else say) as world:
        yield world


def resume_and_show(
    folder: Path, budget: Budget, sign: Path | None, where: tuple[str, int], *, as_json: bool
) -> None:
    """Go on with an interrupted run, under its own budget or a new one."""
    from adamo_vh.session.runs import resume_episode

    signer = Signer(sign) if sign else None
    progress = () if as_json else (Progress(Console()),)
    config = read_manifest(folder).config
    with engine_at(where, config.scene, config.figure, as_json=as_json) as engine:
        result = resume_episode(folder, budget=budget or None, engine=engine, observers=progress)
    if signer is not None:
        sign_run(folder, signer)
    show_result(result, folder, as_json=as_json)


def show_result(result: EpisodeResult, folder: Path, *, as_json: bool) -> None:
    """Print what came of an episode; the exit code says whether it counts."""
    if as_json:
        put_json(result_json(result))
    else:
        _print_result(result, folder)
    if not result.termination.is_scored:
        raise typer.Exit(Exit.NO)


def replay_and_show(run_dir: Path, start: int, *, as_json: bool) -> None:
    """Replay a run folder and say whether every state came out the same."""
    from adamo_vh.session.runs import replay_episode

    report = replay_episode(run_dir, start)
    same = not report.mismatches
    if as_json:
        found = {"steps": report.steps, "same": same, "mismatches": report.mismatches}
        put_json({**found, "frames_differ": report.frames_differ, "cut": report.cut})
    elif same:
        frames = (
            "all frames equal"
            if not report.frames_differ
            else (f"{report.frames_differ} frames differ in bytes (another machine or driver)")
        )
        say(f"Same: every state hash equal in {report.steps} steps; {frames}.")
        if report.cut:
            say(
                f"Not executed: {report.cut} that a person cut short; their saved states are whole."
            )
    else:
        for mismatch in report.mismatches:
            say(f"Different: {mismatch}")
    if not same:
        raise typer.Exit(Exit.NO)


@contextmanager
def run_folder(out: Path | None, what: str) -> Iterator[Path]:
    """The folder of a run: what was asked for, or a new one below runs/ for this run alone.

    A new one is taken away again if nothing was recorded.

    Args:
        out: What was asked for.
        what: What the run is about, in a few words.
    """
    folder = out or _new_run_folder(what)
    try:
        yield folder
    finally:
        if out is None:
            # Not empty, unless the run failed before it began.
            with suppress(OSError):
                folder.rmdir()


def _new_run_folder(what: str) -> Path:
    words = re.sub(r"[^a-z0-9]+", "-", what.lower()).strip("-")[:40].strip("-") or "episode"
    stamp = datetime.now(UTC).strftime("%Y%m%d-%H%M%S")
    return reserve(RUNS, f"{stamp}-{words}")


def mark_latest(folder: Path) -> None:
    """Point runs/latest at the newest run, where the file system allows it."""
    half = RUNS / f"latest.{os.getpid()}.part"
    with suppress(OSError):
        RUNS.mkdir(exist_ok=True)
        half.symlink_to(os.path.relpath(folder, RUNS), target_is_directory=True)
        half.replace(RUNS / "latest")
    with suppress(OSError):
        half.unlink()


def result_json(result: EpisodeResult) -> dict[str, Any]:
    """The object that `adamo-vh run --json` prints."""
    data = to_json(result)
    keys = (
        "task instruction scene labeling profile model model_kind seed termination why answer "
        "steps model_calls calls missing_notes unreadable requests usage cost_usd rungs model_s "
        "world_s walked_m direct_m run state_hash isolation"
    )
    world = [
        {
            "id": item.id,
            "tag": item.tag,
            "class": item.class_name,
            "position": [item.position.x, item.position.y, item.position.z],
            "support": item.support,
            "held": item.held,
        }
        for item in result.world()
    ]
    score = data["score"] or {
        "completion": None,
        "strict": None,
        "conditions": [],
        "violations": [],
    }
    counted = {"variation": result.variation, "tokens": result.tokens, "world": world}
    return {**{key: data[key] for key in keys.split()}, **score, **counted}


def _accounts(result: EpisodeResult) -> str:
    """What the model took: calls, tokens, money."""
    usage = result.usage
    parts = [f"{result.profile} profile, {result.model_calls} calls"]
    if usage.total_tokens:
        parts.append(
            f"{usage.input_tokens} tokens in ({usage.cached_tokens} cached), "
            f"{usage.output_tokens} out ({usage.reasoning_tokens} reasoning)"
            + (", estimated in part: the server did not count them" if usage.estimated else "")
        )
        cost = result.cost_usd
        parts.append("price unknown" if cost is None else f"{cost:.4f} USD")
    if result.rungs:
        parts.append(f"calls as {', '.join(result.rungs)}")
    if result.unreadable:
        parts.append(f"{result.unreadable} unreadable replies")
    return "; ".join(parts)


def _print_result(result: EpisodeResult, folder: Path) -> None:
    say("")
    broken = result.termination is TerminationReason.BROKEN
    line("fault" if broken else "answer", result.answer or f"(none: {result.termination})")
    if result.completion is not None:
        met = sum(c.satisfied for c in result.conditions)
        line(
            "score",
            f"completion {result.completion:.2f} ({met} of {len(result.conditions)} conditions), "
            f"strict {result.strict:.0f}",
        )
    elif not result.termination.is_scored:
        line("score", "unscored: the fault is not the agent's")
    for violation in result.violations:
        line("", violation)
    calls = ", ".join(f"{name} {count}" for name, count in result.calls.items()) or "none"
    line("calls", f"{calls}; {result.termination}")
    if result.why:
        line("stopped", result.why)
    line("model", _accounts(result))
    for warning in result.warnings:
        line("warning", warning)
    if result.assisted:
        line("assisted", "a person took part; not ranked")
    if result.isolation:
        told = (
            "" if result.is_ranked else ": the player may have seen more than its body; not ranked"
        )
        line("isolation", f"{result.isolation}{told}")
    line("time", f"model {result.model_s:.1f} s, world {result.world_s:.1f} s")
    line("walked", f"{result.walked_m:.1f} m, {result.direct_m:.1f} m in straight lines")
    line("page", str(folder / "episode.html"))
