"""A damaged record costs what it held: the page shows the rest, the score above all."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
from tests.report.test_page import Page, page_of
from tests.run_folder import Recorder, config, played

from adamo_vh.episode.result import read_manifest, read_result
from adamo_vh.errors import RecordError
from adamo_vh.record.run_folder import EVENTS, MANIFEST, RESULT
from adamo_vh.record.trajectory import Acted, Trajectory, read_trajectory
from adamo_vh.report.page import render_page


def spoil(path: Path) -> None:
    path.write_text('{"config": 3}' if path.name != EVENTS else "no JSON\n" + path.read_text())


@pytest.mark.parametrize("name", [MANIFEST, EVENTS])
@pytest.mark.parametrize("lost", [True, False])
def test_a_finished_score_is_shown_whatever_else_is_lost(
    tmp_path: Path, name: str, lost: bool
) -> None:
    played(tmp_path)
    if lost:
        (tmp_path / name).unlink()
    else:
        spoil(tmp_path / name)
    page = page_of(tmp_path)
    for words in ("1.00", "Tape_4 near", "T5", "tabletop", "rule-based", "The tape is now next to"):
        assert words in page.text
    assert "Not all of the record could be read." in page.text
    assert name in page.text
    assert str(tmp_path) not in page.text
    assert "Not finished" not in page.text


def test_without_its_events_a_page_still_counts(tmp_path: Path) -> None:
    played(tmp_path)
    (tmp_path / EVENTS).write_text("no JSON\n")
    page = page_of(tmp_path)
    assert "<dt>steps</dt><dd>5</dd>" in page.source
    assert "The steps could not be read." in page.text
    assert page.named("article") == []


def test_a_damaged_line_costs_what_it_held(tmp_path: Path) -> None:
    played(tmp_path)
    events = tmp_path / EVENTS
    lines = events.read_bytes().splitlines(keepends=True)
    for number in range(len(lines)):
        events.write_bytes(b"".join([*lines[:number], b"{spoilt\n", *lines[number + 1 :]]))
        page = page_of(tmp_path)
        assert f"events.jsonl, line {number + 1} is damaged" in page.text
        assert len(page.named("article")) >= 5
        assert "1.00" in page.text and "The tape is now next to" in page.text
    events.write_bytes(b"".join([b"{\n", b"[]\n", *lines[2:]]))
    assert "(1 more lines are)" in page_of(tmp_path).text
    with pytest.raises(RecordError, match="line 1 is damaged"):
        read_trajectory(tmp_path)


def test_without_its_manifest_nothing_is_made_up(tmp_path: Path) -> None:
    played(tmp_path)
    (tmp_path / MANIFEST).unlink()
    page = page_of(tmp_path)
    assert page.named("figure", "plan") == []  # Nobody knows where things began.
    assert "top-p" not in page.text and "temperature" not in page.text
    assert len(page.named("article")) == 6


def test_a_damaged_result_leaves_the_steps(tmp_path: Path) -> None:
    played(tmp_path)
    spoil(tmp_path / RESULT)
    page = page_of(tmp_path)
    assert len(page.named("article")) == 6
    assert "its result cannot be read" in page.text
    assert "result.json" in page.text


def test_without_manifest_and_result_it_is_no_run(tmp_path: Path) -> None:
    played(tmp_path)
    spoil(tmp_path / MANIFEST)
    spoil(tmp_path / RESULT)
    with pytest.raises(RecordError, match=r"manifest\.json"):
        page_of(tmp_path)


def test_a_record_before_furniture_and_endings_has_its_page(tmp_path: Path) -> None:
    played(tmp_path)
    manifest = json.loads((tmp_path / MANIFEST).read_text())
    del manifest["initial"]["furniture"]
    (tmp_path / MANIFEST).write_text(json.dumps(manifest))
    lines = [json.loads(line) for line in (tmp_path / EVENTS).read_text().splitlines()]
    for event in lines:
        event.pop("ending", None)
        event.pop("finish_reason", None)
    (tmp_path / EVENTS).write_text("".join(json.dumps(event) + "\n" for event in lines))
    page = page_of(tmp_path)
    assert len(page.named("article")) == 6
    assert len(page.named("polygon", "surface")) == 1


@pytest.mark.parametrize("number", [math.nan, math.inf, -1e300])
def test_odd_numbers_are_no_reason_to_draw_nothing(tmp_path: Path, number: float) -> None:
    run = Recorder(tmp_path, config())
    played_ = played(tmp_path / "other")
    folder = played_.folder
    events = []
    for event in read_trajectory(folder).events:
        if isinstance(event, Acted):
            point = replace(event.agent.position, x=number)
            agent = replace(event.agent, position=point, heading_rad=number, gaze=point)
            event = replace(event, agent=agent, world_s=number)  # noqa: PLW2901
        events.append(event)
    page = Page(
        render_page(
            read_manifest(folder), Trajectory(tuple(events)), read_result(folder), lambda _: b""
        )
    )
    assert "1.00" in page.text
    assert run.manifest.config.instruction in page.text
