"""How long the report of a large study takes: 1,800 episodes, as many as the paper played.

The episodes are made up, with run folders that hold a diagnosis each where one failed; everything
from reading the index to the last table is measured, and the drawing of episodes' pages apart.

    python benchmarks/reporting.py
"""

from __future__ import annotations

import json
import random
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from adamo_vh.analysis.diagnosis.finding import DIAGNOSIS, Code, Diagnosis
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.benchmark.tasks import task
from adamo_vh.cli.study_report import report_and_show
from adamo_vh.inference.model import ModelKind, Usage
from adamo_vh.record.run_folder import RESULT
from adamo_vh.record.termination import TerminationReason
from adamo_vh.study.index import Index
from adamo_vh.study.plan import Planned, Study, plan
from adamo_vh.study.store import episode_folder, write_study

TARGET_S = 30.0
STUDY = Study(
    tuple(f"T{number}" for number in range(1, 16)),
    scenes=("s1", "s2"),
    labelings=("sem", "opaq"),
    models=("openai:gpt-4o", "anthropic:claude-sonnet-4-5"),
    repetitions=15,
)
CODES = (Code.WRONG_OBJECT, Code.NOT_RECOGNISED, Code.FALSE_CLAIM, Code.GOAL_FORGOTTEN)


def outcome(planned: Planned, lots: random.Random) -> Outcome:
    """What came of an episode that was never played."""
    asked = task(planned.cell.task)
    count = len(asked.conditions)
    skill = 0.9 if planned.cell.labeling == "sem" else 0.5
    met = sum(lots.random() < skill for _ in range(count))
    code = None if met == count else lots.choice(CODES)
    return Outcome(
        key=planned.key,
        scene=planned.cell.scene,
        variation=0,
        labeling=planned.cell.labeling,
        model=planned.cell.model,
        model_kind=ModelKind.VLM,
        profile="paper",
        task=planned.cell.task,
        repetition=planned.repetition,
        seed=planned.config.seed,
        completion=met / count,
        strict=float(met == count),
        termination=TerminationReason.ANSWERED,
        conditions=count,
        conditions_open=count - met,
        claims_success=lots.random() < 0.5,
        steps=3 * count,
        calls={"Pick": count, "Drop": count, "Look": count},
        model_calls=3 * count + 1,
        requests=3 * count + 1,
        protocol_failures=0,
        missing_notes=0,
        refused=0,
        corrected=0,
        usage=Usage(9_000 * count, 100),
        cost_usd=0.02 * count,
        model_s=lots.uniform(5, 9) * count,
        world_s=1.0,
        waited_s=0.0,
        walked_m=2.0,
        direct_m=2.0,
        shortest_m=1.5,
        family=str(asked.family),
        printed_level=asked.printed.total,
        computed_level=asked.computed.total,
        run=f"episodes/{planned.key}",
        diagnosis=str(code.failure_class) if code else "",
        diagnosis_code=str(code) if code else "",
    )


def folders(study: Path, outcomes: list[Outcome], lots: random.Random) -> Iterator[Outcome]:
    """Write what a report reads of the run folders."""
    for one in outcomes:
        run = episode_folder(study, one.key)
        run.mkdir(parents=True)
        (run / RESULT).write_text("{}")
        if one.diagnosis_code:
            code = Code(one.diagnosis_code)
            way = tuple(lots.randrange(1, 12) for _ in range(one.steps))
            found = Diagnosis(code.failure_class, code, "Made up.", (), way)
            (run / DIAGNOSIS).write_text(json.dumps(found.json()))
        yield one


def main() -> None:
    """Make the study, report it, and say how long that took."""
    lots = random.Random(0)
    episodes = plan(STUDY)
    with tempfile.TemporaryDirectory() as place:
        study = Path(place) / "study"
        outcomes = [outcome(planned, lots) for planned in episodes]
        write_study(study, STUDY, episodes)
        Index(study).put(folders(study, outcomes, lots))
        start = time.perf_counter()
        report_and_show([study], out=None, pages="none", figures=None, as_json=False, timings=True)
        took = time.perf_counter() - start
        size = (study / "report.html").stat().st_size
    print(f"{len(episodes)} episodes in {took:.1f} s of {TARGET_S:.0f}, page {size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
