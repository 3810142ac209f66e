"""What is exported, opened by the libraries that it is for."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from tests.adapters.exports.runs import run
from tests.run_folder import played

from adamo_vh.adapters.exports.exporting import export

pytestmark = pytest.mark.extras


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """A real episode with close-ups, and one of every outcome."""
    folder = tmp_path_factory.mktemp("runs")
    run(folder / "real", None, "lean", "T3")
    played(folder / "drawn")
    return [folder / "real", folder / "drawn"]


def test_datasets_opens_the_tables_with_pictures(runs: list[Path], tmp_path: Path) -> None:
    import datasets
    from PIL.Image import Image

    export(runs, "parquet", tmp_path / "out")
    out, cache = str(tmp_path / "out"), str(tmp_path / "cache")
    turns = datasets.load_dataset(out, "turns", split="train", cache_dir=cache)
    assert isinstance(turns.features["image"], datasets.Image)
    first = turns[0]
    assert isinstance(first["image"], Image) and first["image"].size == (160, 90)
    assert json.loads(first["actions"][0]["arguments"])
    assert {row["episode"] for row in turns} == {"real", "drawn"}
    outcomes = [action["outcome"] for row in turns for action in row["actions"]]
    assert {"done", "refused", "corrected"} <= set(outcomes)
    episodes = datasets.load_dataset(out, "episodes", split="train", cache_dir=cache)
    assert episodes[0]["completion"] == 1.0


def test_datasets_opens_the_fine_tuning_examples(runs: list[Path], tmp_path: Path) -> None:
    import datasets

    export(runs[:1], "sft", tmp_path / "out")
    lines = (tmp_path / "out" / "train.jsonl").read_text().splitlines()
    found = datasets.load_dataset(
        "json",
        data_files=str(tmp_path / "out" / "train.jsonl"),
        split="train",
        cache_dir=str(tmp_path / "cache"),
    )
    assert len(found) == len(lines)
    assert found[0]["messages"][-1]["role"] == "assistant"


def test_the_models_of_atif_take_the_trajectories(runs: list[Path], tmp_path: Path) -> None:
    import atif

    export(runs, "atif", tmp_path / "out")
    for name in ("real", "drawn"):
        text = (tmp_path / "out" / name / "trajectory.json").read_text()
        told = atif.Trajectory.model_validate_json(text)
        assert told.has_multimodal_content()
        assert told.to_json_dict() == json.loads(text)


def test_inspect_reads_the_logs(runs: list[Path], tmp_path: Path) -> None:
    from inspect_ai.log import list_eval_logs, read_eval_log

    export(runs, "inspect", tmp_path / "out")
    logs = [read_eval_log(info) for info in list_eval_logs(str(tmp_path / "out"))]
    samples = {sample.id: sample for log in logs for sample in log.samples or ()}
    assert set(samples) == {"real", "drawn"}
    assert {log.status for log in logs} == {"success"}
    score = samples["real"].scores["adamo_vh/episode"]
    assert score.value == {"completion": 1.0, "strict": 1.0}
    roles = [message.role for message in samples["drawn"].messages]
    assert roles[:4] == ["system", "user", "assistant", "tool"]


def test_rerun_verifies_the_recordings(runs: list[Path], tmp_path: Path) -> None:
    export(runs, "rerun", tmp_path / "out")
    files = [str(path) for path in sorted((tmp_path / "out").glob("*.rrd"))]
    assert len(files) == 2
    tool = str(Path(sys.executable).with_name("rerun"))
    subprocess.run([tool, "rrd", "verify", *files], check=True, capture_output=True, timeout=120)
    done = subprocess.run(
        [tool, "rrd", "print", files[1]], check=True, capture_output=True, text=True, timeout=120
    )
    for entity in ("/view/frame", "/view/boxes", "/world/way", "/mind", "/state_text"):
        assert entity in done.stdout
