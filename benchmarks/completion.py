"""Completion of a model on every task: one episode for each task, scene and labeling.

python benchmarks/completion.py [--model baseline] [--scene s1] [--labeling sem] [--json]
"""

from __future__ import annotations

import argparse
import json
import statistics
from typing import Any

import adamo
from adamo.benchmark.tasks import TASKS


def main() -> None:
    """Run the episodes and print a line each."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--model", default="baseline")
    parser.add_argument("--scene", action="append")
    parser.add_argument("--labeling", action="append")
    parser.add_argument("--task", action="append")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    rows: list[dict[str, Any]] = []
    for scene in arguments.scene or ["s1"]:
        engine = adamo.create_engine(scene)
        for labeling in arguments.labeling or ["sem", "opaq"]:
            for task in arguments.task or [item.id for item in TASKS]:
                result = adamo.run_episode(
                    task=task, scene=scene, labeling=labeling, model=arguments.model, engine=engine
                )
                thinking = result.model_s / max(1, result.model_calls) * 1000
                row = {
                    "scene": scene,
                    "labeling": labeling,
                    "task": task,
                    "completion": result.completion,
                    "strict": result.strict,
                    "steps": result.steps,
                    "model_ms_per_call": round(thinking, 1),
                    "termination": str(result.termination),
                    "answer": result.answer,
                }
                rows.append(row)
                if not arguments.json:
                    print(
                        f"{scene} {labeling:<4} {task:<3} {result.completion:.2f} strict "
                        f"{result.strict:.0f} steps {result.steps:2d} {thinking:6.1f} ms/call  "
                        f"{result.answer[:90]}"
                    )
        engine.close()
    means = {
        f"{scene} {labeling}": round(
            statistics.mean(
                row["completion"]
                for row in rows
                if (row["scene"], row["labeling"]) == (scene, labeling)
            ),
            3,
        )
        for scene, labeling in {(row["scene"], row["labeling"]) for row in rows}
    }
    if arguments.json:
        print(json.dumps({"model": arguments.model, "mean_completion": means, "episodes": rows}))
    else:
        print(means)


if __name__ == "__main__":
    main()
