"""What stands in the tables: every figure of one study, and the rules behind them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from tests.outcomes import made, repeated
from tests.report.study.expected import ONE_STUDY, SIDE_BY_SIDE
from tests.report.study.material import baseline, episodes, material, side_by_side, source

from adamo_vh.analysis.figures import figures
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.inference.model import ModelKind
from adamo_vh.report.study.ablations import axes_of
from adamo_vh.report.study.contents import sections
from adamo_vh.report.study.levels import fit
from adamo_vh.report.study.material import Material
from adamo_vh.report.study.section import Section
from adamo_vh.report.study.table import Table


def tables(of: Material) -> dict[str, Table]:
    return {table.name: table for section in sections(of) for table in section.tables}


def rows(table: Table) -> list[list[str]]:
    return [[cell.text for cell in row.cells] for row in table.rows]


def section(of: Material, name: str) -> Section | None:
    return next((one for one in sections(of) if one.name == name), None)


@pytest.fixture(scope="module")
def found() -> dict[str, Table]:
    return tables(material(source("mine", episodes(), baseline())))


@pytest.mark.parametrize("name", ONE_STUDY)
def test_every_figure_is_as_expected(found: dict[str, Table], name: str) -> None:
    expected = [line.split(" | ") for line in ONE_STUDY[name].strip().splitlines()]
    assert [list(found[name].columns), *rows(found[name])] == expected


@pytest.fixture(scope="module")
def beside() -> dict[str, Table]:
    return tables(side_by_side())


@pytest.mark.parametrize("name", SIDE_BY_SIDE)
def test_so_is_every_figure_of_two_studies(beside: dict[str, Table], name: str) -> None:
    expected = [line.split(" | ") for line in SIDE_BY_SIDE[name].strip().splitlines()]
    assert [list(beside[name].columns), *rows(beside[name])] == expected


def test_no_table_is_left_out_of_what_is_expected(found: dict[str, Table]) -> None:
    assert {name for name in found if not name.startswith("cells-")} == set(ONE_STUDY)


def test_a_mean_is_that_of_the_analysis(found: dict[str, Table]) -> None:
    cells: dict[tuple[str, str, str], list] = {}
    for one in episodes():
        cells.setdefault((one.scene, one.labeling, one.task), []).append(one)
    known = figures(list(cells.values()))
    (row,) = [row for row in found["headline"].rows if row.cells[0].text == "openai:gpt-4o"]
    assert row.cells[2].value == known.completion.mean
    assert row.cells[3].value == known.completion.repeat
    assert row.cells[4].value == known.completion.task
    assert row.cells[8].value == known.strict.pass_hat[-1]


def test_paper_rows_are_over_the_same_cells_as_ours() -> None:
    only = material(source("mine", iter([made("T1", 1.0, labeling="opaq")])))
    headline = rows(tables(only)["headline"])
    # GPT-4o did T1 in S1 under OPAQ in all of 15 repetitions.
    assert headline[1][:3] == ["GPT-4o (paper)", "vlm", "1.00"]
    assert headline[1][11] == "15"


def test_a_task_of_ones_own_has_no_paper_beside_it() -> None:
    own = material(source("mine", iter([_renamed(made("T1", 1.0))])))
    found = tables(own)
    assert [row[0] for row in rows(found["headline"])] == ["openai:gpt-4o"]
    assert rows(found["prompts"])[0][:2] == ["mine.toml", ""]
    assert not section(own, "levels").charts[0].panels  # type: ignore[union-attr]


def _renamed(one: Outcome) -> Outcome:
    nothing: dict[str, Any] = {"printed_level": None, "computed_level": None}
    return replace(one, task="mine.toml", key="s1/mine/sem/v0000/r01", family="", **nothing)


def test_why_an_interval_is_missing_is_told() -> None:
    found = tables(material(source("mine", baseline())))
    (row, *_) = found["headline"].rows
    assert row.cells[3].value is None
    assert row.cells[3].why.startswith("deterministic")
    assert found["headline"].notes[row.cells[3].why] == "a"


def test_nothing_is_called_zero_that_is_unknown() -> None:
    unpriced = list(repeated("T1", 1.0, 0.0, cost_usd=None, shortest_m=None))
    found = tables(material(source("mine", iter(unpriced))))
    tokens = dict(zip(found["tokens"].columns, rows(found["tokens"])[0], strict=True))
    assert (tokens["cost"], tokens["cost per solved"]) == ("–", "–")
    assert tokens["tokens per solved"] == "18,200"
    conduct = dict(zip(found["conduct"].columns, rows(found["conduct"])[0], strict=True))
    assert conduct["path / oracle’s"] == "–"


def test_what_is_unscored_is_counted_apart() -> None:
    some = list(repeated("T1", 1.0, None, 1.0))
    found = tables(material(source("mine", iter(some))))
    headline = dict(zip(found["headline"].columns, rows(found["headline"])[0], strict=True))
    assert (headline["completion"], headline["n"], headline["unscored"]) == ("1.00", "2", "1")
    kinds = [chip.kind for table in found.values() for row in table.rows for chip in row.chips]
    assert sorted(kinds) == ["c3", "c3", "cu"]


def test_labelings_are_compared_only_where_both_were_played() -> None:
    only = material(source("mine", (o for o in episodes() if o.labeling == "sem")))
    assert section(only, "labelings").remark.startswith("Only one")  # type: ignore[union-attr]
    both = tables(material(source("mine", episodes())))["labelings"]
    first = dict(zip(both.columns, rows(both)[0], strict=True))
    assert (first["OPAQ"], first["SEM"], first["difference"]) == ("0.37", "0.63", "+0.27")


def test_the_papers_gain_from_labels_is_the_one_it_prints(found: dict[str, Table]) -> None:
    gains = {row[0]: row[-2] for row in rows(found["labelings"])}
    assert gains["GPT-4o (paper), printed"] == "+83.3 %"
    assert gains["Claude 3.5 Sonnet (paper), printed"] == "+118.4 %"


def test_failures_are_counted_with_their_episodes() -> None:
    of = material(source("mine", episodes()))
    codes = tables(of)["failure-codes-vlm"]
    failed = [one for one in of.outcomes if one.completion == 0]
    assert sum(len(row.chips) for row in codes.rows) == len(failed)
    assert sum(row.cells[-2].value for row in codes.rows) == len(failed)  # type: ignore[misc]
    classes = tables(of)["failure-classes"]
    for row in classes.rows:
        shares = [cell.value for cell in row.cells[4:7] if cell.value is not None]
        if not row.is_paper and shares:
            assert sum(shares) == pytest.approx(1.0)  # type: ignore[arg-type]


def test_players_of_different_kinds_are_never_put_together() -> None:
    of = material(source("mine", episodes(), episodes("other:vlm"), baseline()))
    found = tables(of)
    names = {row.cells[1].text for row in found["failure-classes"].rows if not row.is_paper}
    assert names == {"all vlm models", "openai:gpt-4o", "other:vlm", "baseline"}
    codes = {name for name in found if name.startswith("failure-codes")}
    assert codes == {"failure-codes-vlm", "failure-codes-rule-based"}


def test_a_long_row_of_episodes_says_how_many_more_there_are() -> None:
    many = material(source("mine", repeated("T1", *[0.0] * 120, diagnosis="reasoning")))
    (row,) = tables(many)["failure-codes-vlm"].rows
    assert (len(row.chips), row.more) == (90, 30)


def test_undiagnosed_failures_stay_in_sight() -> None:
    some = material(source("mine", repeated("T1", 0.0, 1.0)))
    (row,) = tables(some)["failure-codes-vlm"].rows
    assert (row.cells[0].text, row.cells[1].text) == ("undiagnosed", "–")


def test_all_done_means_no_failures() -> None:
    done = material(source("mine", repeated("T1", 1.0, 1.0)))
    assert section(done, "failures").remark == "No scored episode failed."  # type: ignore[union-attr]


def test_settings_are_named_by_what_tells_them_apart() -> None:
    one = material(source("mine", episodes(profile="lean")))
    assert [one.name(setting) for setting in one.settings] == ["openai:gpt-4o"]
    groups = (
        episodes(profile=profile, axes={"k": k}) for profile in ("lean", "paper") for k in "46"
    )
    many = material(source("mine", *groups))
    assert [many.name(setting) for setting in many.settings] == [
        "openai:gpt-4o, lean, k=4",
        "openai:gpt-4o, lean, k=6",
        "openai:gpt-4o, paper, k=4",
        "openai:gpt-4o, paper, k=6",
    ]


def test_the_same_model_in_two_studies_is_told_apart_by_the_study() -> None:
    both = material(source("before"), source("after", episodes(skill=0.9)))
    assert {both.name(setting) for setting in both.settings} == {
        "after, openai:gpt-4o",
        "before, openai:gpt-4o",
    }
    assert len(both.outcomes) == 2 * 60
    assert axes_of(both) == ()


def test_a_difference_is_of_the_second_less_the_first() -> None:
    both = material(source("a", repeated("T1", 0.0, 0.0), repeated("T2", 0.0, 0.0)),
                    source("b", repeated("T1", 1.0, 1.0), repeated("T2", 1.0, 0.0)))  # fmt: skip
    table = tables(both)["comparison"]
    first = dict(zip(table.columns, rows(table)[0], strict=True))
    assert first["second less first"] == "b, openai:gpt-4o less a, openai:gpt-4o"
    assert (first["first’s mean"], first["second’s mean"]) == ("0.00", "0.75")
    assert first["difference"] == "+0.75"
    assert (first["tasks"], first["first’s n"], first["second’s n"]) == ("2", "4", "4")


def test_settings_that_share_nothing_are_not_compared() -> None:
    apart = material(source("a", repeated("T1", 1.0)), source("b", repeated("T2", 1.0)))
    assert section(apart, "comparison").remark  # type: ignore[union-attr]


def test_many_settings_are_compared_with_the_first() -> None:
    groups = [episodes(f"m{number}", repetitions=2, tasks=("T1", "T2")) for number in range(6)]
    table = tables(material(source("mine", *groups)))["comparison"]
    pairs = {row[1] for row in rows(table)}
    assert pairs == {f"m{number} less m0" for number in range(1, 6)}


@pytest.mark.parametrize(
    ("axis", "values", "paper"),
    [
        ("k", ("4", "50"), ["0.82", "0.84", "0.86", "0.93"]),
        ("grid", ("3", "6"), ["0.92", "0.90", "0.89", "0.93", "0.87"]),
        ("resolution", ("640x360", "1920x1080"), ["0.76", "0.85", "0.93"]),
        (
            "sampling",
            ("temperature=0,top_p=0", "temperature=0.8,top_p=1"),
            ["0.93", "0.82", "0.85"],
        ),
        ("limits.max_steps", ("10", "60"), []),
    ],
)
def test_an_axis_has_its_table_beside_the_papers(
    axis: str, values: tuple[str, ...], paper: list[str]
) -> None:
    groups = [episodes(axes={axis: value}, skill=0.3 + 0.1 * n) for n, value in enumerate(values)]
    of = material(source("mine", *groups))
    assert axes_of(of) == (axis,)
    table = tables(of)[f"ablation-{axis}"]
    assert [row.cells[1].text for row in table.rows if not row.is_paper] == list(values)
    assert [row.cells[2].text for row in table.rows if row.is_paper] == paper
    chart = section(of, "ablations").charts[0]  # type: ignore[union-attr]
    completion = chart.panels[0]
    assert [mark.y for mark in completion.series[0].marks] == [
        row.cells[2].value for row in table.rows if not row.is_paper
    ]
    assert len(completion.x.ticks) >= max(len(values), len(paper))


def test_without_a_further_axis_there_are_no_ablations() -> None:
    assert section(material(), "ablations") is None
    one = material(source("mine", episodes(axes={"k": "4"})))
    assert section(one, "ablations") is None


def test_models_put_together_are_told_apart_by_their_settings() -> None:
    groups = (episodes(model, axes={"k": k}) for model in ("a", "b") for k in ("4", "50"))
    spearman = tables(material(source("mine", *groups)))["spearman"]
    pooled = {row.cells[0].text for row in spearman.rows if row.cells[0].text.startswith("all")}
    assert pooled == {"all vlm models, k=4", "all vlm models, k=50"}


@pytest.mark.parametrize(
    ("points", "line"),
    [
        ([(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)], ((0.0, 0.0), (2.0, 2.0))),
        ([(0.0, 1.0), (2.0, 0.0), (1.0, 0.5)], ((0.0, 1.0), (2.0, 0.0))),
        ([(1.0, 0.2), (1.0, 0.9)], ()),
        ([], ()),
    ],
)
def test_the_fit_is_the_line_of_least_squares(points, line) -> None:
    assert [pytest.approx(end) for end in line] == list(fit(points))


def test_distances_are_a_mean_that_holds_its_last_value() -> None:
    some = tuple(repeated("T1", 0.0, 0.0, diagnosis="execution"))
    ways = {some[0].key: (4, 2), some[1].key: (2, 2, 2, 3)}
    of = material(source("mine", iter(some), distances=ways))
    chart = next(c for c in section(of, "failures").charts if c.name == "distance")  # type: ignore[union-attr]
    (series,) = chart.panels[0].series
    assert [mark.y for mark in series.marks] == [1.0, 0.75, 0.75, 1.0]


def test_a_way_that_began_at_done_is_no_way() -> None:
    (one,) = repeated("T1", 0.0, diagnosis="execution")
    of = material(source("mine", iter([one]), distances={one.key: (0, 1)}))
    assert "distance" not in [c.name for c in section(of, "failures").charts]  # type: ignore[union-attr]


def test_a_deterministic_model_is_drawn_without_the_first_interval() -> None:
    of = material(source("mine", baseline(), episodes("random", model_kind=ModelKind.RANDOM)))
    lines = {line.label: line for line in section(of, "headline").charts[0].lines}  # type: ignore[union-attr]
    assert lines["baseline"].inner is None and lines["baseline"].outer is not None
    assert lines["random"].inner is not None
    assert lines["GPT-4o (paper)"].tone < 0
