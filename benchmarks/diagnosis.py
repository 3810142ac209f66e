"""How often the diagnosis is right: players that fail in one known way each, and hand labels.

    python benchmarks/diagnosis.py [--scene s1] [--labeling sem] [--variation 0] [--way loop]
        [--tasks 2] [--seed 0] [--labelled] [--out DIR] [--misses] [--json]

Scene, labeling, variation and way may be repeated. Each way is played in so many tasks that it
fits, of each scene, variation and labeling. The rules were written on the scenes as they are
(variation 0); test variations, from 1000, show what they are worth elsewhere. What the player was
built to do wrong is what the diagnosis should say. With `--labelled`, natural failures are played
again instead, call by call, and what is expected was written down by a reader before any rule saw
them: `labelled.jsonl`. One that does not end as it did when it was read is named and not counted.
"""

from __future__ import annotations

import argparse
import itertools
import json
import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import adamo_vh
from adamo_vh.analysis.diagnosis import Code, FailureClass
from adamo_vh.benchmark.tasks import TASKS, Task
from adamo_vh.engine import World
from adamo_vh.episode.result import EpisodeResult
from adamo_vh.perception import Labeling
from adamo_vh.record.termination import Limits
from adamo_vh.session.explaining import explain_run

sys.path.append(str(Path(__file__).resolve().parents[1]))  # As a file it stands in no package.
from benchmarks.failing import WAYS, Player, Way
from benchmarks.labelled import difference, end_of, read_labelled


@dataclass(frozen=True, slots=True)
class Trial:
    """One failed episode and what was said of it."""

    name: str
    expected: Code
    found: Code | None
    seconds: float
    """Time of the diagnosis."""
    steps: int
    summary: str

    @property
    def found_class(self) -> str:
        """The class that was found."""
        return str(self.found.failure_class) if self.found else "none"


def main() -> None:
    """Play, diagnose, and print the confusion."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--scene", action="append")
    parser.add_argument("--labeling", action="append", type=Labeling)
    parser.add_argument("--variation", action="append", type=int, help="of the scenes; 0 alone")
    parser.add_argument("--way", action="append")
    parser.add_argument("--tasks", type=int, default=2, help="tasks for each way")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--labelled", action="store_true", help="natural failures instead")
    parser.add_argument("--out", type=Path, help="keep the run folders here")
    parser.add_argument("--misses", action="store_true", help="print what was told wrongly")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    trials: list[Trial] = []
    changed: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        out = arguments.out or Path(folder)
        for scene, variation in _places(arguments):
            engine = adamo_vh.create_engine(scene, variation=variation)
            played = _labelled if arguments.labelled else _played
            for trial in played(engine, out, arguments):
                if isinstance(trial, str):
                    print(f"No longer the episode that was read: {trial}", file=sys.stderr)
                    changed.append(trial)
                    continue
                trials.append(trial)
                is_miss = trial.found is not trial.expected
                if is_miss and arguments.misses:
                    print(f"{trial.name}: {trial.expected}, told {trial.found}\n  {trial.summary}")
            engine.close()
    if arguments.json:
        print(json.dumps({**_figures(trials), "changed": changed}))
    else:
        _print(trials, "labelled" if arguments.labelled else "built to fail by")
        if changed:
            print(f"{len(changed)} are no longer the episodes that were read, and are not counted.")


def _places(arguments: argparse.Namespace) -> list[tuple[str, int]]:
    """Scenes and variations to play in."""
    if not arguments.labelled:
        scenes = arguments.scene or ["s1", "s2"]
        return list(itertools.product(scenes, arguments.variation or [0]))
    places = {(episode.scene, episode.variation) for episode in read_labelled()}
    return sorted(
        (scene, variation)
        for scene, variation in places
        if scene in (arguments.scene or [scene])
        and variation in (arguments.variation or [variation])
    )


def _played(engine: World, out: Path, arguments: argparse.Namespace) -> Iterator[Trial]:
    for way in WAYS:
        if arguments.way and way.name not in arguments.way:
            continue
        for labeling in arguments.labeling or list(Labeling):
            fitting = [task for task in TASKS if way.fits(task, labeling)]
            lots = random.Random(f"{way.name} {labeling} {engine.scene.full_name} {arguments.seed}")
            for task in lots.sample(fitting, min(arguments.tasks, len(fitting))):
                trial = _trial(engine, out, way, task, labeling, arguments.seed)
                if trial is not None:
                    yield trial


def _trial(
    engine: World, out: Path, way: Way, task: Task, labeling: Labeling, seed: int
) -> Trial | None:
    """Play one way; None if it did not fail after all."""
    place = engine.scene.full_name.replace(" ", "-")
    name = f"{place}-{labeling}-{task.id}-{way.name}-{seed}"
    engine.reset(0)
    player = Player(way, task, engine, labeling, seed)
    result = adamo_vh.run_episode(
        task=task.id,
        labeling=labeling,
        engine=engine,
        model=player,
        observers=[player],
        out=out / name,
        resolution=(640, 360),
        limits=Limits(max_steps=way.max_steps),
    )
    return _explained(out / name, engine, result, way.code)


def _explained(folder: Path, engine: World, result: EpisodeResult, expected: Code) -> Trial | None:
    if result.strict == 1 or result.completion is None:
        return None
    began = time.perf_counter()
    found = explain_run(folder, engine)
    seconds = time.perf_counter() - began
    return Trial(folder.name, expected, found.code, seconds, result.steps, found.summary)


def _labelled(engine: World, out: Path, arguments: argparse.Namespace) -> Iterator[Trial | str]:
    """Play the natural failures of a scene again; a text says why one is another episode now."""
    for episode in read_labelled():
        if (episode.scene, episode.variation) != (engine.scene.name, engine.scene.variation) or (
            arguments.labeling and episode.labeling not in arguments.labeling
        ):
            continue
        folder = out / episode.name
        result = episode.again(engine, out)
        if change := difference(episode.end, end_of(episode, result, folder)):
            yield f"{episode.name}: {change}"
        elif (trial := _explained(folder, engine, result, episode.label)) is not None:
            yield trial


def _figures(trials: Sequence[Trial]) -> dict[str, Any]:
    """Recall by class and code, and both confusions."""
    right_class = sum(t.found_class == t.expected.failure_class for t in trials)
    right_code = sum(t.found is t.expected for t in trials)
    confusion = Counter((str(t.expected.failure_class), t.found_class) for t in trials)
    codes = Counter((str(t.expected), str(t.found)) for t in trials)
    recall = {
        str(kind): confusion[kind, kind] / total
        for kind in FailureClass
        if (total := sum(n for (expected, _), n in confusion.items() if expected == kind))
    }
    return {
        "episodes": len(trials),
        "class": right_class / max(1, len(trials)),
        "code": right_code / max(1, len(trials)),
        "recall": recall,
        "classes": [[*pair, n] for pair, n in sorted(confusion.items())],
        "codes": [[*pair, n] for pair, n in sorted(codes.items())],
        "slowest_s": max((t.seconds for t in trials), default=0.0),
        "seconds_per_step": sum(t.seconds for t in trials) / max(1, sum(t.steps for t in trials)),
    }


def _print(trials: Sequence[Trial], title: str) -> None:
    figures = _figures(trials)
    kinds = [*map(str, FailureClass), "none"]
    counted = {(a, b): n for a, b, n in figures["classes"]}
    print(f"\n{title:<18}" + "".join(f"{kind:>12}" for kind in kinds) + "   recall")
    for kind in kinds[:-1]:
        row = "".join(f"{counted.get((kind, other), 0):>12}" for other in kinds)
        print(f"{kind:<18}{row}   {figures['recall'].get(kind, 0):.2f}")
    print(f"\n{'code':<18}{'episodes':>9}{'right':>7}   told instead")
    for code in Code:
        told = {b: n for a, b, n in figures["codes"] if a == code}
        if told:
            wrong = ", ".join(f"{b} {n}" for b, n in told.items() if b != code)
            print(f"{code:<18}{sum(told.values()):>9}{told.get(str(code), 0):>7}   {wrong}")
    print(
        f"\n{figures['episodes']} episodes: class right {figures['class']:.3f}, "
        f"code right {figures['code']:.3f}; slowest diagnosis {figures['slowest_s']:.2f} s, "
        f"{figures['seconds_per_step'] * 1000:.0f} ms a step"
    )


if __name__ == "__main__":
    main()
