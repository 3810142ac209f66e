"""The worker: what it says of each end, and of itself."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from adamo_vh.analysis.diagnosis.finding import DIAGNOSIS
from adamo_vh.record.trajectory import Ended
from adamo_vh.study import worker
from adamo_vh.study.executor import Failed, Finished, Report
from adamo_vh.study.plan import Planned, Study, plan
from adamo_vh.study.store import episode_folder
from adamo_vh.study.worker import Player, Pulse, Setup

(PLANNED,) = plan(Study(("T1",), settings={"resolution": "320x180"}))


def _reports(folder: Path, *episodes: Planned) -> list[Report]:
    player = Player(Setup(folder))
    heard = [player.play(planned) for planned in episodes]
    assert not player.hangs
    return heard


def _with(**settings: Any) -> Planned:
    return replace(PLANNED, config=replace(PLANNED.config, **settings))


def test_an_episode_ends_with_its_outcome(tmp_path: Path) -> None:
    first, again = _reports(tmp_path, PLANNED, PLANNED)
    assert isinstance(first, Finished)
    assert first.outcome.is_scored
    assert again == first


def test_a_place_is_free_before_a_failure_is_explained(tmp_path: Path) -> None:
    (fails,) = plan(
        Study(
            ("T1",),
            models=("random",),
            settings={"resolution": "160x90", "limits": {"max_steps": 2}},
        )
    )
    diagnosis = episode_folder(tmp_path, fails.key) / DIAGNOSIS
    told: list[tuple[str, bool]] = []

    def played(key: str) -> None:
        told.append((key, diagnosis.exists()))

    player = Player(Setup(tmp_path), played=played)
    report = player.play(fails)
    assert isinstance(report, Finished)
    assert report.outcome.diagnosis
    assert told == [(fails.key, False)]
    assert diagnosis.exists()
    assert player.play(fails) == report  # It needs no explaining any more.
    assert len(told) == 1


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (_with(scene="nowhere"), "no scene 'nowhere'"),
        (_with(model="scripted:none.json"), "none.json"),
        (_with(model="nobody"), "Unknown model"),
        (_with(figure="nobody"), "nobody"),
    ],
    ids=["scene", "script", "model", "figure"],
)
def test_what_is_wrong_with_the_study_is_not_tried_again(
    tmp_path: Path, wrong: Planned, said: str
) -> None:
    (report,) = _reports(tmp_path, wrong)
    assert isinstance(report, Failed)
    assert said in report.why
    assert not report.again


def test_a_folder_that_cannot_be_written_is_no_fault_of_the_episode(tmp_path: Path) -> None:
    (tmp_path / "episodes").write_text("")
    (report,) = _reports(tmp_path, PLANNED)
    assert isinstance(report, Failed)
    assert report.fatal
    assert str(tmp_path) in report.why


def test_an_episode_without_a_sign_of_life_is_noticed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(worker, "_SILENT_S", 0.0)
    player = Player(Setup(tmp_path))
    assert not player.hangs
    player._pulses["x"] = Pulse()
    assert player.hangs


def test_every_event_is_a_sign_of_life(monkeypatch: pytest.MonkeyPatch) -> None:
    pulse = Pulse()
    pulse.heard -= 1000
    before = pulse.heard
    pulse.notify(Ended(0, "answered", "", "", 0.0))  # type: ignore[arg-type]
    assert pulse.heard > before + 900
