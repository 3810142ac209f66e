"""`adamo-vh tasks`, and `verify`, `check` and `generate` below it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import typer
from rich.console import Console
from rich.table import Table

from adamo_vh.benchmark.tasks import TASKS
from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import put_json, say
from adamo_vh.perception import Labeling

if TYPE_CHECKING:
    from adamo_vh.session.proving import Proof


def list_tasks(*, as_json: bool) -> None:
    """Print every task with its C-D level."""
    if as_json:
        rows = [
            {
                "id": task.id,
                "prompt": task.prompt,
                "family": task.family,
                "units": list(task.units),
                "printed": asdict(task.printed),
                "computed": asdict(task.computed),
                "conditions": [str(condition) for condition in task.conditions],
            }
            for task in TASKS
        ]
        put_json({"tasks": rows})
        return
    table = Table("task", "prompt", "ACT", "REF", "REL", "C-D", "printed", "conditions")
    for task in TASKS:
        level = task.computed
        table.add_row(
            task.id,
            task.prompt,
            str(level.act),
            str(level.ref),
            str(level.rel),
            str(level.total),
            str(task.printed.total),
            "; ".join(str(condition) for condition in task.conditions),
        )
    Console().print(table)


def verify(scene: str | None, variation: int, *, as_json: bool) -> None:
    """Play oracle and idle for every task, scene and labeling; exit 1 if a task is unsound."""
    from adamo_vh.benchmark.verify import verify_tasks
    from adamo_vh.session.bodies import create_engine
    from adamo_vh.session.builtin import scene_names

    rows = []
    for name in [scene] if scene else scene_names():
        engine = create_engine(name, variation=variation)
        for labeling in Labeling:
            for row in verify_tasks(engine, labeling):
                rows.append(row)
                if not as_json:
                    mark = "ok  " if row.is_sound else "FAIL"
                    say(
                        f"{mark} {row.scene} {row.labeling:<4} {row.task:<3} oracle "
                        f"{row.oracle:.2f} strict {row.oracle_strict:.0f} idle {row.idle:.2f}"
                    )
        engine.close()
    if as_json:
        put_json({"tasks": [asdict(row) for row in rows]})
    if not all(row.is_sound for row in rows):
        raise typer.Exit(Exit.NO)


def check(file: str, scene: str | None, random_episodes: int, *, as_json: bool) -> None:
    """Prove a task in every scene that it fits; exit 1 if it is unsound in any."""
    from adamo_vh.benchmark.tasks import task as find_task
    from adamo_vh.session.proving import prove

    task = find_task(file)
    if not as_json:
        level = task.computed
        say(f"{task.id}: {task.prompt}")
        say(f"C-D level {level.total} (ACT {level.act}, REF {level.ref}, REL {level.rel})")
    proofs: list[Proof] = []
    for proof in prove(task, scene, random_episodes):
        proofs.append(proof)
        if not as_json:
            _say_proof(proof)
    sound = all(proof.is_sound for proof in proofs)
    if as_json:
        rows = [
            {
                **asdict(proof.found),
                "random": proof.random,
                "problems": proof.problems,
                "sound": proof.is_sound,
            }
            for proof in proofs
        ]
        told = {"prompt": task.prompt, "computed": asdict(task.computed)}
        put_json({"task": task.id, **told, "sound": sound, "scenes": rows})
    if not sound:
        raise typer.Exit(Exit.NO)


def generate(
    seed: int,
    count: int,
    scenes: Sequence[str],
    split: str,
    random_episodes: int,
    out: Path | None,
    *,
    as_json: bool,
) -> None:
    """Make new tasks, and write each as soon as it is proved."""
    from adamo_vh.session.generating import generate, write_task

    folder = out or Path("tasks") / f"{split}-{seed}"
    made = generate(
        seed,
        count,
        scenes,
        split,
        random_episodes=random_episodes,
        on_refused=lambda task, why: None if as_json else say(f"     refused {task.id}: {why}"),
    )
    rows = []
    for one in made:
        task, path = one.task, write_task(folder, one.task)
        rows.append(
            {
                "id": task.id,
                "file": str(path),
                "prompt": task.prompt,
                "scenes": list(task.scenes),
                "computed": asdict(task.computed),
                "random": one.random,
            }
        )
        if not as_json:
            level = f"C-D {task.computed.total:>2} {task.scenes[0]}"
            say(f"ok   {path} {level} random {one.random:.2f}: {task.prompt}")
    if as_json:
        put_json({"seed": seed, "split": split, "tasks": rows})


def _say_proof(proof: Proof) -> None:
    row = proof.found
    luck = "not tried" if proof.random is None else f"{proof.random:.2f}"
    say(
        f"{'ok  ' if proof.is_sound else 'FAIL'} {row.scene} {row.labeling:<4} oracle "
        f"{row.oracle:.2f} strict {row.oracle_strict:.0f} idle {row.idle:.2f} random {luck}"
    )
    for problem in proof.problems:
        say(f"     {problem}")
