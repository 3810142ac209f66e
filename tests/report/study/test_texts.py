"""The tables as Markdown, LaTeX and CSV: the same figures, and names that are only names."""

from __future__ import annotations

import csv
import io
import re

import pytest
from tests.report.study.expected_texts import LATEX, MARKDOWN
from tests.report.study.material import baseline, episodes, material, source, tiny

from adamo_vh.analysis.statistics import Interval
from adamo_vh.report.study.contents import sections
from adamo_vh.report.study.every_cell import cell_rows, episode_rows
from adamo_vh.report.study.page import played
from adamo_vh.report.study.section import Section
from adamo_vh.report.study.table import Cell, Row, Table
from adamo_vh.report.study.texts import comma_separated, latex, markdown

NAMES = (
    "a|b",
    "*bold* _it_",
    "<b>&amp;</b>",
    "x % y & z # 1 ~ ^ {q} \\end{table}",
    "\x1b[31m\u202ered",
)


def one_table(*cells: Cell) -> Table:
    row = Row(cells)
    return Table("one", "One", "A caption.", tuple(f"c{n}" for n in range(len(cells))), (row, row))


def section(*cells: Cell) -> Section:
    return Section("s", "A section", "", (one_table(*cells),))


@pytest.mark.parametrize("name", NAMES)
def test_a_name_breaks_no_format(name: str) -> None:
    table = section(Cell(name), Cell(0.5, "share"))
    (line,) = {line for line in markdown("t", "", [table]).splitlines() if "0.50" in line}
    assert len(re.findall(r"(?<!\\)\|", line)) == 3
    assert not re.search(r"(?<!\\)[<*]", line)
    tex = [line for line in latex("t", [table]).splitlines() if "0.50" in line]
    assert all(len(re.findall(r"(?<!\\)&", line)) == 1 for line in tex)
    assert all(not re.search(r"(?<!\\)[%#]", line) for line in tex)
    assert "\\end{table}}" not in "".join(tex)
    assert not re.search("[\x1b\u202e]", "".join(tex) + line)


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@x", "\t=1"])
def test_a_spreadsheet_takes_no_name_for_a_formula(text: str) -> None:
    _, row, _ = csv.reader(io.StringIO(comma_separated(one_table(Cell(text)))))
    assert row[0][0] not in "=+-@\t"


def test_csv_holds_full_numbers_and_both_ends_of_an_interval() -> None:
    table = one_table(Cell(0.123456789, "share"), Cell(Interval(0.1, 0.25), "share"), Cell(None))
    heads, row, _ = csv.reader(io.StringIO(comma_separated(table)))
    assert heads == ["c0", "c1 (low)", "c1 (high)", "c2"]
    assert row == ["0.123457", "0.1", "0.25", ""]


def test_why_something_is_missing_is_told_below_a_table() -> None:
    table = section(Cell(None, why="nobody knows"), Cell(None, why="a single task"))
    text = markdown("t", "", [table])
    assert "– (a)" in text.replace("\\", "") and "(a) nobody knows; (b) a single task" in text


def test_all_formats_have_all_tables() -> None:
    of = material(source("mine", episodes(), baseline()))
    found = sections(of)
    names = [table.name for one in found for table in one.tables]
    assert len(names) == len(set(names)) >= 15
    assert markdown("t", "", found).count("\n### ") == len(names)
    tex = latex("t", found)
    assert tex.count(r"\begin{tabular}") == tex.count(r"\end{tabular}") == len(names)
    assert tex.isascii()


def test_the_texts_of_a_small_study_are_as_expected() -> None:
    of = tiny()
    assert markdown("Tiny", played(of), sections(of)) == MARKDOWN
    assert latex("Tiny", sections(of)[:1]) == LATEX


def test_every_cell_and_episode_has_a_line() -> None:
    of = material(source("mine", episodes(repetitions=2)))
    cells = list(csv.DictReader(io.StringIO(comma_separated(cell_rows(of)))))
    assert len(cells) == 2 * 2 * 5
    rows = list(csv.DictReader(io.StringIO(comma_separated(episode_rows(of)))))
    assert [row["episode"] for row in rows] == [outcome.key for outcome in of.outcomes]
    assert {row["completion"] for row in rows} == {"0.0", "1.0"}


@pytest.mark.parametrize(
    ("value", "text"), [(-0.0004, "0.00"), (0.0, "0.00"), (0.25, "+0.25"), (-0.25, "−0.25")]
)
def test_what_rounds_to_nothing_has_no_sign(value: float, text: str) -> None:
    assert Cell(value, "share", signed=True).text == text
