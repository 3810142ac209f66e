"""Why it failed, on the page of an episode."""

from __future__ import annotations

import io
import json
from pathlib import Path

from PIL import Image
from tests.run_folder import played

from adamo_vh.analysis.diagnosis import Code, Diagnosis, Evidence
from adamo_vh.analysis.diagnosis.finding import DIAGNOSIS
from adamo_vh.record.trajectory import Observed, read_trajectory
from adamo_vh.report.failure import facts
from adamo_vh.report.page import write_page
from adamo_vh.report.timeline import turns


def _diagnosed(folder: Path, code: Code | None = Code.TOO_FAR) -> Diagnosis:
    views = [e for e in read_trajectory(folder).events if isinstance(e, Observed)]
    return Diagnosis(
        code.failure_class if code else None,
        code,
        "Asked: <b>this</b>. It is not so at the end.",
        (
            Evidence(4, "It was put too far away."),
            Evidence(0, "It was listed.", views[0].frame, (20, 10, 30, 20)),
            Evidence(1, "Of a picture that is gone.", "0" * 24 + ".jpg", (0, 0, 5, 5)),
        ),
        (2, 1, 1),
        2,
    )


def test_each_fact_leads_to_its_step_and_shows_its_part_of_the_picture(tmp_path: Path) -> None:
    played(tmp_path)
    trajectory = read_trajectory(tmp_path)
    told = facts(
        _diagnosed(tmp_path), turns(trajectory), lambda n: (tmp_path / "frames" / n).read_bytes()
    )
    anchors = {act.step: turn.anchor for turn in turns(trajectory) for act in turn.acts}
    assert [fact.anchor for fact in told] == [anchors[4], "turn-1", anchors[1]]
    assert told[0].crop is None and told[2].crop is None
    assert told[1].crop is not None
    assert Image.open(io.BytesIO(told[1].crop)).width <= 64


def test_the_page_says_why_it_failed(tmp_path: Path) -> None:
    played(tmp_path)
    assert "Why it failed" not in write_page(tmp_path).read_text("utf-8")
    (tmp_path / DIAGNOSIS).write_text(json.dumps(_diagnosed(tmp_path).json()), "utf-8")
    page = write_page(tmp_path).read_text("utf-8")
    assert "Why it failed" in page and "too far" in page
    assert "&lt;b&gt;this&lt;/b&gt;" in page


def test_a_success_shows_nothing_and_a_damaged_diagnosis_is_named(tmp_path: Path) -> None:
    played(tmp_path)
    (tmp_path / DIAGNOSIS).write_text(json.dumps(_diagnosed(tmp_path, None).json()), "utf-8")
    assert "Why it failed" not in write_page(tmp_path).read_text("utf-8")
    (tmp_path / DIAGNOSIS).write_text('{"class": "odd"}', "utf-8")
    page = write_page(tmp_path).read_text("utf-8")
    assert "Why it failed" not in page and "A diagnosis cannot be read" in page
