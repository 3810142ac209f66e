"""One episode in its run folder: whatever interrupted it, the same comes out in the end."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from adamo_vh.analysis.outcome import Outcome
from adamo_vh.errors import FolderInUseError, RecordError
from adamo_vh.record.run_folder import EVENTS, MANIFEST, RESULT, FolderLock
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.study.plan import Planned, Study, plan
from adamo_vh.study.playing import ASIDE, play, set_aside
from adamo_vh.study.store import episode_folder

SHORT = {"resolution": "320x180", "limits.max_steps": 10}
STUDY = Study(("T4",), models=("baseline", "random"), settings=SHORT)
BASELINE, RANDOM = plan(STUDY)


@pytest.fixture(scope="module")
def undisturbed(
    tmp_path_factory: pytest.TempPathFactory, s1_engine: BuiltinEngine
) -> dict[str, tuple[Path, Outcome]]:
    """Both episodes as they go when nothing happens."""
    played = {}
    for planned in (BASELINE, RANDOM):
        folder = tmp_path_factory.mktemp("study")
        played[planned.key] = (folder, play(folder, planned, engine=s1_engine))
    return played


def _timeless(outcome: Outcome) -> Outcome:
    return replace(outcome, model_s=0.0, world_s=0.0, waited_s=0.0)


def _copy(source: Path, there: Path) -> Path:
    shutil.copytree(source, there, dirs_exist_ok=True)
    return there


def _events(folder: Path, planned: Planned) -> list[bytes]:
    path = episode_folder(folder, planned.key) / EVENTS
    return path.read_bytes().splitlines(keepends=True)


def test_an_episode_is_played_without_a_page(
    undisturbed: dict[str, tuple[Path, Outcome]],
) -> None:
    folder, outcome = undisturbed[BASELINE.key]
    assert outcome.completion == 1.0
    assert (outcome.key, outcome.model, outcome.run) == (
        BASELINE.key,
        "baseline",
        f"episodes/{BASELINE.key}",
    )
    names = {path.name for path in episode_folder(folder, BASELINE.key).iterdir()}
    assert names == {"manifest.json", "events.jsonl", "frames", "result.json", "run.lock"}


def test_a_model_that_draws_lots_has_the_name_of_its_cell(
    undisturbed: dict[str, tuple[Path, Outcome]],
) -> None:
    _, outcome = undisturbed[RANDOM.key]
    assert outcome.model == "random"
    assert outcome.seed == RANDOM.config.seed


def test_what_has_a_score_is_not_played_again(
    undisturbed: dict[str, tuple[Path, Outcome]],
) -> None:
    folder, outcome = undisturbed[BASELINE.key]
    assert play(folder, BASELINE) == outcome  # Even a world is not needed.


@pytest.mark.parametrize("planned", [BASELINE, RANDOM], ids=["baseline", "random"])
@pytest.mark.parametrize(
    ("kept", "half_a_line"),
    [(0, True), (1, False), (2, True), (3, False), (5, True), (-1, False), (-1, True)],
)
def test_an_episode_that_was_killed_comes_to_the_same_end(
    undisturbed: dict[str, tuple[Path, Outcome]],
    tmp_path: Path,
    s1_engine: BuiltinEngine,
    planned: Planned,
    kept: int,
    half_a_line: bool,
) -> None:
    source, outcome = undisturbed[planned.key]
    folder = _copy(source, tmp_path)
    run = episode_folder(folder, planned.key)
    (run / RESULT).unlink()
    lines = _events(folder, planned)
    kept = min(kept, len(lines)) if kept >= 0 else len(lines) - 1
    rest = lines[kept][:9] if half_a_line and kept < len(lines) else b""
    (run / EVENTS).write_bytes(b"".join(lines[:kept]) + rest)
    again = play(folder, planned, engine=s1_engine)
    assert _timeless(again) == _timeless(outcome)
    assert len(_events(folder, planned)) == len(lines)
    assert not (folder / ASIDE).exists()


def test_a_kill_before_the_result_was_written_costs_no_call(
    undisturbed: dict[str, tuple[Path, Outcome]], tmp_path: Path, s1_engine: BuiltinEngine
) -> None:
    source, outcome = undisturbed[RANDOM.key]
    folder = _copy(source, tmp_path)
    (episode_folder(folder, RANDOM.key) / RESULT).unlink()
    before = _events(folder, RANDOM)
    assert _timeless(play(folder, RANDOM, engine=s1_engine)) == _timeless(outcome)
    assert _events(folder, RANDOM) == before


def test_a_kill_before_the_first_word_leaves_nothing_in_the_way(
    undisturbed: dict[str, tuple[Path, Outcome]], tmp_path: Path, s1_engine: BuiltinEngine
) -> None:
    run = episode_folder(tmp_path, BASELINE.key)
    run.mkdir(parents=True)
    (run / "run.lock").write_text("")
    (run / EVENTS).write_text("")
    (run / ".1234.part").write_text("{")
    outcome = play(tmp_path, BASELINE, engine=s1_engine)
    assert _timeless(outcome) == _timeless(undisturbed[BASELINE.key][1])
    assert not (run / ".1234.part").exists()


def test_a_record_that_does_not_come_out_the_same_is_set_aside(
    undisturbed: dict[str, tuple[Path, Outcome]], tmp_path: Path, s1_engine: BuiltinEngine
) -> None:
    source, outcome = undisturbed[BASELINE.key]
    folder = _copy(source, tmp_path)
    run = episode_folder(folder, BASELINE.key)
    (run / RESULT).unlink()
    lines = _events(folder, BASELINE)
    acted = next(i for i, line in enumerate(lines) if b'"type":"acted"' in line)
    event = json.loads(lines[acted])
    lines[acted] = json.dumps({**event, "state_hash": "0" * 64}).encode() + b"\n"
    (run / EVENTS).write_bytes(b"".join(lines[:-1]))
    assert _timeless(play(folder, BASELINE, engine=s1_engine)) == _timeless(outcome)
    assert (folder / ASIDE / BASELINE.key / EVENTS).is_file()


def test_what_is_set_aside_takes_the_place_of_nothing(tmp_path: Path) -> None:
    places = []
    for number in range(2):
        run = episode_folder(tmp_path, BASELINE.key)
        run.mkdir(parents=True)
        (run / MANIFEST).write_text(str(number))
        places.append(set_aside(tmp_path, BASELINE.key))
    assert [(place / MANIFEST).read_text() for place in places] == ["0", "1"]
    assert not run.exists()


def test_a_damaged_result_is_told_and_left_as_it_is(
    undisturbed: dict[str, tuple[Path, Outcome]], tmp_path: Path
) -> None:
    folder = _copy(undisturbed[BASELINE.key][0], tmp_path)
    path = episode_folder(folder, BASELINE.key) / RESULT
    path.write_text("{")
    with pytest.raises(RecordError, match=r"result\.json"):
        play(folder, BASELINE)
    assert path.read_text() == "{"


def test_an_episode_that_somebody_plays_is_left_alone(
    tmp_path: Path, s1_engine: BuiltinEngine
) -> None:
    run = episode_folder(tmp_path, BASELINE.key)
    with FolderLock(run), pytest.raises(FolderInUseError):
        play(tmp_path, BASELINE, engine=s1_engine)
