"""Why a recorded episode failed: its diagnosis, made from the run folder and kept in it."""

from __future__ import annotations

import json
import warnings
from contextlib import ExitStack
from pathlib import Path

from adamo_vh.analysis.diagnosis.diagnosing import diagnose
from adamo_vh.analysis.diagnosis.finding import DIAGNOSIS, Diagnosis
from adamo_vh.benchmark.tasks import Task
from adamo_vh.engine import World
from adamo_vh.episode.result import read_manifest, read_result
from adamo_vh.errors import FileError
from adamo_vh.files import write_whole
from adamo_vh.perception import Tagger
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.report.page import PAGE, try_page
from adamo_vh.session.bodies import opened


def explain_run(
    folder: str | Path,
    engine: World | None = None,
    *,
    task: Task | None = None,
    labeling: Tagger | None = None,
) -> Diagnosis:
    """Say why a recorded episode failed, and keep that in its run folder as `diagnosis.json`.

    Args:
        folder: A run folder.
        engine: Of the same scene and variation; is left in another state. Made from the record by
            default, which takes a few seconds.
        task: What was asked, if the task is no built-in one.
        labeling: As when it was recorded, if it was handed in.

    Raises:
        RecordError: The folder holds no readable run, or one that needs an engine that is not here.
    """
    path = Path(folder)
    manifest, trajectory = read_manifest(path), read_trajectory(path)
    result = read_result(path)
    with ExitStack() as stack:
        world = opened(stack, manifest.config, engine, (path, manifest))
        found = diagnose(manifest, trajectory, result, world, task=task, labeling=labeling)
    try:
        text = json.dumps(found.json(), indent=1, ensure_ascii=False)
        write_whole(path / DIAGNOSIS, text.encode("utf-8", "replace"))
    except FileError as error:
        # What was found is not lost for a folder that cannot be written.
        warnings.warn(f"the diagnosis is not kept: {error}", stacklevel=2)
    if (path / PAGE).exists():
        try_page(path)
    return found
