"""What people say first to a virtual human, said to a player and judged by world and answer.

    python -m benchmarks.everyday [--model baseline] [--scene s1] [--labeling sem]
        [--profile paper] [--resolution 960x540] [--lines 3,7]
        [--file benchmarks/further.tsv] [--json]

The instructions and their conditions are in `everyday.tsv`, more of them in `further.tsv`. An
answer is judged by its text alone: what it states must be so, whatever was asked.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from benchmarks.judging import Outcome, false_claims, holds

import adamo_vh
from adamo_vh.episode.config import read_resolution

_DATA = Path(__file__).with_suffix(".tsv")


def lines(scene: str, data: Path = _DATA) -> Iterator[tuple[str, str]]:
    """Each instruction of a file with its condition in a scene."""
    for line in data.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            instruction, *conditions = line.split("\t")
            yield instruction, conditions[-1] if scene == "s2" else conditions[0]


def main() -> None:
    """Run each instruction alone, from the start of the scene."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--model", default="baseline")
    parser.add_argument("--scene", action="append")
    parser.add_argument("--labeling", default="sem")
    parser.add_argument("--profile", default="paper")
    parser.add_argument("--resolution", type=read_resolution, default=(960, 540))
    parser.add_argument("--lines", default="")
    parser.add_argument("--file", type=Path, default=_DATA)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    rows: list[dict[str, Any]] = []
    wanted = {int(number) for number in arguments.lines.split(",") if number}
    for scene in arguments.scene or ["s1", "s2"]:
        engine = adamo_vh.create_engine(scene)
        for number, (instruction, condition) in enumerate(lines(scene, arguments.file), start=1):
            if wanted and number not in wanted:
                continue
            engine.reset(0)
            before = engine.state()
            result = adamo_vh.run_episode(
                instruction,
                scene=scene,
                labeling=arguments.labeling,
                profile=arguments.profile,
                model=arguments.model,
                resolution=arguments.resolution,
                engine=engine,
            )
            outcome = Outcome(before, engine.state(), result.answer)
            met = holds(condition, outcome)
            told_done = met if "refuses" not in condition else None
            row = {
                "scene": scene,
                "line": number,
                "instruction": instruction,
                "condition": condition,
                "met": met,
                "false_claims": false_claims(outcome, told_done),
                "steps": result.steps,
                "answer": result.answer,
            }
            rows.append(row)
            if not arguments.json:
                _print(row)
        engine.close()
    if arguments.json:
        print(json.dumps({"model": arguments.model, "episodes": rows}))
        return
    for scene in dict.fromkeys(row["scene"] for row in rows):
        of_scene = [row for row in rows if row["scene"] == scene]
        false = sum(len(row["false_claims"]) for row in of_scene)
        print(
            f"{scene}: {sum(row['met'] for row in of_scene)} of {len(of_scene)} as asked, "
            f"{false} false claims"
        )


def _print(row: dict[str, Any]) -> None:
    sign = "ok  " if row["met"] else "MISS"
    print(f"{row['scene']} {row['line']:2d} {sign} {row['instruction']}", flush=True)
    print(f"       {row['steps']:2d} steps: {row['answer']}")
    for claim in row["false_claims"]:
        print(f"       FALSE {claim}")


if __name__ == "__main__":
    main()
