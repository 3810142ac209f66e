"""Failed episodes that were read and labelled by hand, kept so that they can be played again.

`labelled.jsonl` holds one a line: how it was set up, what the player replied in each turn, how it
ended, and the label: the code, and a sentence of reason. The player is not asked again: it decides
by pictures, and these change with the renderer. Its replies are given once more, and the end is
compared with what was read.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import adamo_vh
from adamo_vh.analysis.diagnosis import Code
from adamo_vh.benchmark.tasks import task as find_task
from adamo_vh.engine import World
from adamo_vh.episode.result import EpisodeResult
from adamo_vh.inference.model import Model
from adamo_vh.inference.players.scripted import ScriptedModel, read_script
from adamo_vh.perception import Labeling
from adamo_vh.record.termination import Limits
from adamo_vh.record.trajectory import Observed, Trajectory, read_trajectory

LABELLED = Path(__file__).with_name("labelled.jsonl")


@dataclass(frozen=True, slots=True)
class End:
    """What an episode that is played again is known by."""

    state: str
    """Hash of the last state."""
    met: tuple[bool, ...]
    """Which conditions hold in it."""
    feedback: tuple[str, ...]
    """The code that came back for each call."""
    seen: tuple[int, ...]
    """Objects of the task that were listed in a view, by their ids."""


@dataclass(frozen=True, slots=True)
class Labelled:
    """A failed episode, and why it failed in the eyes of its reader."""

    scene: str
    variation: int
    labeling: str
    task: str
    player: str
    """Who played, as `natural.py` names it."""
    settings: Mapping[str, Any]
    """What else was set, as `run_episode` takes it; of the limits only `max_steps`."""
    code: str
    """Empty until somebody has read it."""
    reason: str
    end: End
    replies: tuple[Mapping[str, Any], ...]
    """As a script file holds them."""

    @property
    def name(self) -> str:
        """Short and unique; fit for a folder."""
        place = f"{self.scene}-{self.variation}" if self.variation else self.scene
        return "-".join((place, self.labeling, self.task, self.player.replace(":", "")))

    @property
    def label(self) -> Code:
        """What the diagnosis should say."""
        return Code(self.code)

    def again(self, engine: World, out: Path) -> EpisodeResult:
        """Give the same replies once more.

        Args:
            engine: Of its scene and variation.
            out: Folder for its run folder.
        """
        replies = read_script(self.replies, f"{LABELLED.name}, {self.name}")
        return played(self, ScriptedModel(self.name, replies), engine, out / self.name)


def played(episode: Labelled, model: Model | str, engine: World, folder: Path) -> EpisodeResult:
    """Play an episode as it was set up.

    Args:
        episode: Says how; its replies play no part.
        model: Who plays.
        engine: Of its scene and variation.
        folder: The run folder.
    """
    settings = dict(episode.settings)
    if "max_steps" in settings:
        settings["limits"] = Limits(max_steps=settings.pop("max_steps"))
    return adamo_vh.run_episode(
        task=episode.task,
        labeling=episode.labeling,
        model=model,
        engine=engine,
        out=folder,
        **settings,
    )


def end_of(episode: Labelled, result: EpisodeResult, folder: Path) -> End:
    """What an episode is known by, from its result and its run folder."""
    trajectory = read_trajectory(folder)
    names = {item.id: item.class_name for item in result.final.objects}
    return End(
        state=result.state_hash,
        met=tuple(condition.satisfied for condition in result.conditions),
        feedback=tuple(act.feedback.code for act in trajectory.acts),
        seen=_seen(trajectory, Labeling(episode.labeling), names, find_task(episode.task).objects),
    )


def _seen(
    trajectory: Trajectory, labeling: Labeling, names: Mapping[int, str], asked: Collection[int]
) -> tuple[int, ...]:
    views = (event for event in trajectory.events if isinstance(event, Observed))
    listed = {labeling.resolve(item.tag, names) for view in views for item in view.objects}
    return tuple(sorted(number for number in asked if number in listed))


def difference(read: End, now: End) -> str:
    """In which way an episode is no longer the one that was read; empty if it is the same."""
    if now == read:
        return ""
    if now.feedback != read.feedback:
        pairs = zip(read.feedback, now.feedback, strict=False)
        step = next((n for n, (a, b) in enumerate(pairs, start=1) if a != b), 0)
        if step:
            return f"call {step} came to {now.feedback[step - 1]}, not {read.feedback[step - 1]}"
        return f"it has {len(now.feedback)} calls, not {len(read.feedback)}"
    if now.met != read.met:
        return f"the conditions {_numbers(now.met)} hold at the end, not {_numbers(read.met)}"
    if now.seen != read.seen:
        return f"of what was asked {list(now.seen)} was in view, not {list(read.seen)}"
    return "the last state is another one"


def _numbers(met: Iterable[bool]) -> list[int]:
    return [number for number, holds in enumerate(met, start=1) if holds]


def read_labelled(path: Path = LABELLED) -> tuple[Labelled, ...]:
    """All episodes of the file."""
    return tuple(map(_read, path.read_text(encoding="utf-8").splitlines()))


def _read(line: str) -> Labelled:
    data = json.loads(line)
    end = data["end"]
    known = End(end["state"], tuple(end["met"]), tuple(end["feedback"]), tuple(end["seen"]))
    return Labelled(**{**data, "end": known, "replies": tuple(data["replies"])})


def write_labelled(episodes: Iterable[Labelled], path: Path = LABELLED) -> None:
    """Write all episodes of the file."""
    lines = (json.dumps(asdict(e), ensure_ascii=False, separators=(",", ":")) for e in episodes)
    path.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
