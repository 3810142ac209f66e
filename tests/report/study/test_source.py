"""From the folder of a study to its report: distances, pages, links, files."""

from __future__ import annotations

import csv
import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from tests.outcomes import made, repeated
from tests.run_folder import played

from adamo_vh.analysis.diagnosis.finding import DIAGNOSIS, Code, Diagnosis, FailureClass
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.errors import FileError
from adamo_vh.report.page import PAGE
from adamo_vh.report.study.material import Material, Source
from adamo_vh.report.study.source import Pages, links, source_of
from adamo_vh.report.study.writing import write_report


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run")
    played(folder)
    return folder


@pytest.fixture
def study(tmp_path: Path, run: Path) -> tuple[Path, tuple[Outcome, ...]]:
    """A study of three failed and two complete episodes, with their run folders."""
    folder = tmp_path / "a study"
    failed = repeated("T1", 0.0, 0.0, 0.0, diagnosis="execution", diagnosis_code="gave_up")
    outcomes = (*failed, *repeated("T2", 1.0, 1.0, model="baseline"))
    for one in outcomes:
        shutil.copytree(run, folder / one.run)
        (folder / one.run / PAGE).unlink(missing_ok=True)
    return folder, outcomes


def pages_of(folder: Path) -> set[str]:
    return {path.parent.relative_to(folder).as_posix() for path in folder.rglob(PAGE)}


@pytest.mark.parametrize(
    ("pages", "made_pages", "linked"),
    [(Pages.EXAMPLES, 2, 5), (Pages.FAILED, 3, 5), (Pages.ALL, 5, 5), (Pages.NONE, 0, 0)],
)
def test_pages_are_made_for_what_is_wanted(
    study: tuple[Path, tuple[Outcome, ...]], pages: Pages, made_pages: int, linked: int
) -> None:
    folder, outcomes = study
    found, failed = links(folder, outcomes, folder, pages)
    assert (len(pages_of(folder)), len(found), failed) == (made_pages, linked, {})
    for key, link in found.items():
        (one,) = [o for o in outcomes if o.key == key]
        target = folder / link.replace("%3A", ":").replace("%20", " ")
        assert target.is_file() if link.endswith(PAGE) else target.is_dir()
        assert (folder / one.run) in (target, target.parent)


def test_a_page_that_is_there_is_linked_and_not_made_again(
    study: tuple[Path, tuple[Outcome, ...]],
) -> None:
    folder, outcomes = study
    page = folder / outcomes[-1].run / PAGE
    page.write_text("mine")
    found, _ = links(folder, outcomes, folder, Pages.ALL)
    assert page.read_text() == "mine"
    assert found[outcomes[-1].key].endswith(PAGE)


def test_links_lead_from_wherever_the_report_is(
    study: tuple[Path, tuple[Outcome, ...]], tmp_path: Path
) -> None:
    folder, outcomes = study
    found, _ = links(folder, outcomes, tmp_path / "elsewhere" / "deep", Pages.EXAMPLES)
    assert all(link.startswith("../../a%20study/episodes/") for link in found.values())


@pytest.mark.parametrize("run_path", ["", "/etc", "../outside", "episodes/../../outside"])
def test_an_index_cannot_lead_out_of_its_study(tmp_path: Path, run_path: str) -> None:
    (tmp_path / "outside").mkdir()
    folder = tmp_path / "study"
    folder.mkdir()
    one = replace(made("T1", 0.0, diagnosis="execution"), run=run_path)
    assert links(folder, (one,), folder, Pages.ALL) == ({}, {})
    assert source_of("s", folder, (one,), 1, {}).distances == {}
    assert not list((tmp_path / "outside").iterdir())


def test_an_episode_whose_record_is_gone_has_no_link(tmp_path: Path) -> None:
    one = made("T1", 0.0)
    assert links(tmp_path, (one,), tmp_path, Pages.ALL) == ({}, {})


def test_a_page_that_cannot_be_made_costs_no_report(
    study: tuple[Path, tuple[Outcome, ...]],
) -> None:
    folder, outcomes = study
    for name in ("manifest.json", "result.json"):
        (folder / outcomes[0].run / name).write_text("{")
    found, failed = links(folder, outcomes, folder, Pages.ALL)
    assert set(failed) == {outcomes[0].key}
    assert found[outcomes[0].key].endswith("/")  # Its folder is there all the same.


def test_distances_come_from_what_was_diagnosed(study: tuple[Path, tuple[Outcome, ...]]) -> None:
    folder, outcomes = study
    first, second, third, *_ = outcomes
    told = Diagnosis(FailureClass.EXECUTION, Code.GAVE_UP, "It gave up.", (), (3, 2, 2))
    (folder / first.run / DIAGNOSIS).write_text(json.dumps(told.json()))
    (folder / second.run / DIAGNOSIS).write_text("{")
    (folder / third.run / DIAGNOSIS).unlink(missing_ok=True)
    assert source_of("s", folder, outcomes, 5, {}).distances == {first.key: (3, 2, 2)}


def test_a_report_is_a_page_and_its_tables(tmp_path: Path) -> None:
    source = Source("mine", tuple(repeated("T1", 0.0, 1.0)), 4)
    page, *beside = write_report(Material.of("Mine", [source]), tmp_path / "out")
    assert page == tmp_path / "out" / "report.html"
    assert {"report.md", "report.tex", "headline.csv", "cells.csv", "episodes.csv"} <= {
        path.name for path in beside
    }
    rows = list(csv.reader((tmp_path / "out" / "tables" / "episodes.csv").open()))
    assert len(rows) == 3
    assert "# Mine" in (tmp_path / "out" / "report.md").read_text(encoding="utf-8")


def test_the_same_study_gives_the_same_report(tmp_path: Path) -> None:
    outcomes = tuple(repeated("T1", 0.0, 1.0, 1.0))
    for name, order in (("a", outcomes), ("b", outcomes[::-1])):
        write_report(Material.of("Mine", [Source("mine", order, 3)]), tmp_path / name)
    for path in (tmp_path / "a").rglob("*.*"):
        again = tmp_path / "b" / path.relative_to(tmp_path / "a")
        assert again.read_bytes() == path.read_bytes(), path.name


def test_a_folder_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    material = Material.of("Mine", [Source("mine", tuple(repeated("T1", 1.0)), 1)])
    with pytest.raises(FileError, match="file"):
        write_report(material, tmp_path / "file")
