"""Logs of Inspect AI: `.eval` files that `inspect view` and its data frames open.

In Inspect a log is one task with one model, so episodes are gathered by model, profile, scene and
labeling. Episodes wait in memory until their log is written; if they take too much room, the
largest log is written as far as it is, and another of the same kind is begun.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from statistics import fmean
from typing import Any

from adamo_vh.adapters.exports.dialogue import dialogue
from adamo_vh.adapters.exports.form import Form
from adamo_vh.adapters.exports.recorded import Episode
from adamo_vh.adapters.inspect.conversation import chat, spent_on
from adamo_vh.adapters.inspect.scoring import score_of
from adamo_vh.extras import needed
from adamo_vh.inference.messages import Message, pictures_of
from adamo_vh.study.axes import slug

SCORER = "adamo_vh/episode"
_MOST_BYTES = 300_000_000
"""Of pictures that wait in memory."""


@dataclass(slots=True)
class _Log:
    """Episodes of one log that are not written yet."""

    title: str
    samples: list[Any] = field(default_factory=list)
    first: Episode | None = None
    bytes: int = 0
    written: int = 0
    """Files before this one."""


def write_inspect(episodes: Iterable[Episode], folder: Path, form: Form) -> int:
    """Write episodes as logs.

    Args:
        episodes: What is exported.
        folder: Takes the `.eval` files.
        form: Nothing of it matters here.

    Returns:
        How many episodes were written.

    Raises:
        ConfigError: The extra is not installed.
    """
    needed("inspect_ai", "inspect")
    logs: dict[str, _Log] = {}
    count = 0
    for episode in episodes:
        with episode.tolerated():
            messages = dialogue(episode)
            log = logs.setdefault(title := _title(episode), _Log(title))
            log.first = log.first or episode
            log.samples.append(_sample(episode, messages))
            log.bytes += sum(len(p.data) for message in messages for p in pictures_of(message))
            count += 1
        if sum(one.bytes for one in logs.values()) > _MOST_BYTES:
            _write(max(logs.values(), key=lambda one: one.bytes), folder)
    for log in logs.values():
        _write(log, folder)
    return count


def _title(episode: Episode) -> str:
    config = episode.manifest.config
    labeling = episode.manifest.labeling or str(config.labeling)
    parts = (config.scene, labeling, episode.manifest.model_name, str(config.profile))
    return "_".join(slug(part) for part in parts)


def _write(log: _Log, folder: Path) -> None:
    """Write what waits, and begin anew."""
    from inspect_ai.log import write_eval_log

    if log.first is None:
        return
    number = "" if not log.written else f"_{log.written + 1}"
    write_eval_log(_eval_log(log), folder / f"{log.title}{number}.eval")
    log.samples, log.first, log.bytes = [], None, 0
    log.written += 1


def _eval_log(log: _Log) -> Any:
    from inspect_ai.log import (
        EvalConfig,
        EvalDataset,
        EvalLog,
        EvalResults,
        EvalSpec,
        EvalStats,
    )

    assert log.first is not None
    manifest, config = log.first.manifest, log.first.manifest.config
    begun = manifest.started_at or datetime.now(UTC).isoformat()
    ids = [sample.id for sample in log.samples]
    spec = EvalSpec(
        eval_id=log.title,
        run_id=log.title,
        created=begun,
        task="adamo_vh/recorded",
        task_id=log.title,
        dataset=EvalDataset(name="adamo_vh", samples=len(ids), sample_ids=ids),
        model=f"adamo-vh/{manifest.model_name}",
        config=EvalConfig(epochs=1),
        task_args={"scene": config.scene, "labeling": str(config.labeling)},
        metadata={"profile": str(config.profile), "model_kind": str(manifest.model_kind)},
        packages={name: text for name, text in manifest.versions.items() if "." in text},
    )
    scores = _scores(log.samples)
    results = EvalResults(total_samples=len(ids), completed_samples=len(ids), scores=scores)
    stats = EvalStats(started_at=begun, completed_at=begun)
    return EvalLog(status="success", eval=spec, results=results, stats=stats, samples=log.samples)


def _scores(samples: list[Any]) -> list[Any]:
    """Means over the episodes that have a score."""
    from inspect_ai.log import EvalMetric, EvalScore

    found = []
    for name in ("completion", "strict"):
        values = [
            float(sample.scores[SCORER].value[name])
            for sample in samples
            if isinstance(sample.scores[SCORER].value, dict)
        ]
        if values:
            metric = {"mean": EvalMetric(name="mean", value=fmean(values))}
            found.append(
                EvalScore(
                    name=name,
                    scorer=SCORER,
                    metrics=metric,
                    scored_samples=len(values),
                    unscored_samples=len(samples) - len(values),
                )
            )
    return found


def _sample(episode: Episode, messages: tuple[Message, ...]) -> Any:
    from inspect_ai.log import EvalSample
    from inspect_ai.model import ModelOutput

    manifest, result = episode.manifest, episode.result
    config = manifest.config
    answer = result.answer if result else ""
    used = result is not None and result.usage.total_tokens > 0
    spent = spent_on(result.usage, result.cost_usd) if result and used else None
    return EvalSample(
        id=episode.name,
        epoch=1,
        input=config.instruction,
        target=config.task or "",
        messages=chat(messages),
        output=ModelOutput.from_content(manifest.model_name, answer),
        scores={SCORER: score_of(result)},
        metadata={
            "task": config.task,
            "variation": config.variation,
            "seed": config.seed,
            "termination": str(result.termination) if result else "unfinished",
        },
        model_usage={manifest.model_name: spent} if spent else {},
        started_at=manifest.started_at or None,
        total_time=result.model_s + result.world_s if result else None,
    )
