"""Charts by matplotlib: vector files for a paper, the same on every run."""

from __future__ import annotations

import importlib.util
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest
from tests.report.study.material import baseline, episodes, material, source

from adamo_vh.analysis.statistics import Interval
from adamo_vh.errors import ConfigError, FileError
from adamo_vh.report.study.chart import Chart, Line, Mark, Panel, Part, Series, places, shares
from adamo_vh.report.study.contents import sections
from adamo_vh.report.study.figures import check_plotting, write_figures

pytest.importorskip("matplotlib")


def bars(name: str = "one", label: str = "a") -> Chart:
    marks = (Mark(0, 0.5, Interval(0.2, 0.7)), Mark(1, 1.0))
    series = (
        Series(label, 0, "bars", marks),
        Series("line", 1, "line", marks, fit=((0.0, 0.0), (1.0, 1.0))),
        Series("points", 2, "points", marks),
        Series("paper", -1, "marks", marks),
        Series("paper's points", -1, "points", marks),
    )
    return Chart(name, "T", "C.", (Panel(label, places(["x", label]), shares("y"), series),))


@pytest.mark.slow
def test_every_chart_of_a_report_is_drawn_in_both_formats(tmp_path: Path) -> None:
    of = material(source("mine", episodes(repetitions=2), baseline()))
    charts = [chart for section in sections(of) for chart in section.charts]
    written = write_figures(charts, tmp_path / "figures")
    assert {path.name for path in written} == {
        f"{chart.name}.{kind}" for chart in charts for kind in ("pdf", "svg")
    }
    for path in written:
        head = path.read_bytes()[:5]
        assert head == (b"%PDF-" if path.suffix == ".pdf" else b"<?xml")


def test_the_same_chart_is_the_same_file(tmp_path: Path) -> None:
    for folder in ("a", "b"):
        write_figures([bars()], tmp_path / folder)
    for name in ("one.pdf", "one.svg"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_text_in_a_figure_stays_text(tmp_path: Path) -> None:
    write_figures([bars(label="Plate 57")], tmp_path)
    drawn = ET.fromstring((tmp_path / "one.svg").read_text(encoding="utf-8"))
    assert "Plate 57" in [text for text in drawn.itertext()]


NAMES = ("$\\frac{1}{0}$", "a_b^c", "\\alpha $", "<b>&", "50 %", "\x1b[31m")


def test_a_name_is_no_formula(tmp_path: Path) -> None:
    all_names = " ".join(NAMES)
    rows = tuple(Line(name, 0, 0.5, Interval(0, 1)) for name in NAMES)
    parts = (Part(all_names, 0, 0.6), Part("b", 1, 0.4))
    row = Chart("rows", "T", "C.", lines=rows, axis=shares(all_names))
    stack = Chart("stack", "T", "C.", lines=(Line(all_names, parts=parts),), axis=shares("x"))
    assert len(write_figures([bars(label=all_names), row, stack], tmp_path)) == 6


def test_a_place_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="file"):
        write_figures([bars()], tmp_path / "file")


def test_what_is_missing_is_told_with_its_fix(monkeypatch: pytest.MonkeyPatch) -> None:
    def nothing(name: str, *_: Any) -> None:
        return None

    monkeypatch.setattr(importlib.util, "find_spec", nothing)
    monkeypatch.setattr("adamo_vh.report.study.figures.find_spec", nothing)
    with pytest.raises(ConfigError, match=r"pip install 'adamo-vh\[figures\]'"):
        check_plotting()
