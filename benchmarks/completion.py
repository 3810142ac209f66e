"""Completion of a model on every task: one episode for each task, scene, labeling and profile.

    python benchmarks/completion.py [--model baseline] [--scene s1] [--labeling sem]
        [--profile paper] [--task T4] [--budget-usd 5] [--seed 0] [--resolution 1920x1080]
        [--variation 0] [--json]

Scene, labeling, profile, task and variation may be repeated. Tokens are the provider's, or
estimated for players that have none.
"""

from __future__ import annotations

import argparse
import itertools
import json
import statistics
from typing import Any

import adamo_vh
from adamo_vh.benchmark.tasks import TASKS
from adamo_vh.cognition.budget import Budget, BudgetGuard, Ledger
from adamo_vh.cognition.profile import PROFILES
from adamo_vh.episode.config import read_resolution
from adamo_vh.inference.cost.tokens import metered
from adamo_vh.session.minds import fitting, model_of


def main() -> None:
    """Run the episodes and print a line each."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--model", default="baseline")
    parser.add_argument("--scene", action="append")
    parser.add_argument("--labeling", action="append")
    parser.add_argument("--profile", action="append")
    parser.add_argument("--task", action="append")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--resolution", type=read_resolution, default=(1920, 1080))
    parser.add_argument("--variation", type=int, action="append")
    parser.add_argument("--budget-usd", type=float, help="cap on the whole run")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    ledger, caps = Ledger(), Budget(usd=arguments.budget_usd)
    rows: list[dict[str, Any]] = []
    places = itertools.product(arguments.scene or ["s1"], arguments.variation or [0])
    for scene, variation in places:
        engine = adamo_vh.create_engine(scene, variation=variation)
        cells = itertools.product(
            arguments.profile or ["paper"],
            arguments.labeling or ["sem", "opaq"],
            arguments.task or [item.id for item in TASKS],
        )
        for profile, labeling, task in cells:
            # What may be asked of a model depends on the profile.
            player = model_of(arguments.model, profile=PROFILES[profile])
            chosen = fitting(PROFILES[profile], player)
            result = adamo_vh.run_episode(
                task=task,
                scene=scene,
                labeling=labeling,
                profile=chosen,
                model=metered(player),
                seed=arguments.seed,
                resolution=arguments.resolution,
                guards=[BudgetGuard(Budget(), ledger, caps)],
                engine=engine,
            )
            player.info.close()
            row = {
                "scene": scene,
                "variation": variation,
                "profile": profile,
                "labeling": labeling,
                "task": task,
                "completion": result.completion,
                "strict": result.strict,
                "steps": result.steps,
                "model_calls": result.model_calls,
                "tokens": result.tokens,
                "model_ms_per_call": round(result.model_s / max(1, result.model_calls) * 1000, 1),
                "termination": str(result.termination),
                "answer": result.answer,
            }
            rows.append(row)
            if not arguments.json:
                scored = "    " if result.completion is None else f"{result.completion:.2f}"
                print(
                    f"{scene} {variation} {profile:<5} {labeling:<4} {task:<3} {scored} "
                    f"strict {result.strict or 0:.0f} steps {result.steps:2d} calls "
                    f"{result.model_calls:2d} tokens {result.tokens:6d} "
                    f"{row['model_ms_per_call']:6.1f} ms/call  {result.answer[:80]}",
                    flush=True,
                )
        engine.close()
    means = _means(rows)
    if arguments.json:
        print(json.dumps({"model": arguments.model, "means": means, "episodes": rows}))
    else:
        for cell, mean in means.items():
            print(f"{cell:<16}", "  ".join(f"{key} {value}" for key, value in mean.items()))


def _means(rows: list[dict[str, Any]]) -> dict[str, dict[str, float]]:
    """Means over the scored episodes of each scene, profile and labeling."""
    cells: dict[str, list[dict[str, Any]]] = {}
    for row in rows:
        if row["completion"] is not None:
            cells.setdefault(f"{row['scene']} {row['profile']} {row['labeling']}", []).append(row)
    counted = ("completion", "strict", "model_calls", "tokens", "model_ms_per_call")
    return {
        cell: {key: round(statistics.mean(row[key] for row in found), 3) for key in counted}
        for cell, found in cells.items()
    }


if __name__ == "__main__":
    main()
