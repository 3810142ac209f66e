"""The page of a study: whole, without scripts, deaf to names, and every link leads somewhere."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from tests.report.study.material import baseline, episodes, material, source
from tests.report.test_page import HOSTILE, Page

from adamo_vh.analysis.statistics import Interval
from adamo_vh.report.study.contents import sections
from adamo_vh.report.study.material import Material
from adamo_vh.report.study.page import render_study
from adamo_vh.report.study.table import Cell
from adamo_vh.report.templating import csp_hash


def page(of: Material) -> Page:
    return Page(render_study(of, sections(of)))


@pytest.fixture(scope="module")
def plain() -> Page:
    return page(material(source("mine", episodes(), baseline())))


def test_it_allows_its_own_style_and_nothing_else(plain: Page) -> None:
    (policy,) = [
        attributes["content"] for name, attributes in plain.tags
        if name == "meta" and "http-equiv" in attributes
    ]  # fmt: skip
    (style,) = plain.raw["style"]
    assert "default-src 'none'" in policy and csp_hash(style) in policy
    assert "script" not in {name for name, _ in plain.tags}
    for _, attributes in plain.tags:
        assert not [key for key in attributes if key.startswith("on") or key == "style"]
        assert not {"src", "srcset"} & attributes.keys()


def test_every_link_on_it_leads_somewhere(plain: Page) -> None:
    there = {attributes["id"] for _, attributes in plain.tags if "id" in attributes}
    links = {a["href"] for name, a in plain.tags if name == "a" and a.get("href")}
    inside = {link[1:] for link in links if link.startswith("#")}
    assert len(inside) > 40
    assert inside - there == set()
    ids = [attributes["id"] for _, attributes in plain.tags if "id" in attributes]
    assert len(ids) == len(set(ids))


def test_the_headline_stands_beside_the_papers_own(plain: Page) -> None:
    text = " ".join(plain.texts)
    for said in ("would it repeat?", "other tasks?", "GPT-4o (paper)", "deterministic", "pass^k"):
        assert said in text


def test_no_class_of_a_table_is_one_that_a_phone_hides(plain: Page) -> None:
    (style,) = plain.raw["style"]
    hidden = re.findall(r"\.([a-z]+) \{ display: none; \}", style)
    assert {"wide", "narrow"} <= set(hidden)
    for name, attributes in plain.tags:
        if name in {"th", "td", "tr", "table"}:
            assert not set(hidden) & set(attributes.get("class", "").split())


def test_names_are_text_whatever_stands_in_them() -> None:
    turned = f"\u202e{HOSTILE}\x1b[31m"
    groups = (episodes(turned), episodes(f"{turned}2", profile=turned, axes={turned: turned}))
    outcomes = [*groups[0], *groups[1]]
    hostile = source(turned, iter(outcomes), damaged={turned: turned}, planned=9999)
    found = page(Material.of(turned, [hostile]))
    assert {name for name, _ in found.tags} & {"script", "img", "iframe", "object"} == set()
    assert not re.search("[\x1b\u202e]", found.source)
    assert "alert(1)" in " ".join(found.texts)


@pytest.mark.parametrize(
    "of",
    [
        material(source("one", episodes(repetitions=1, tasks=("T1",)))),
        material(source("unscored", iter([next(episodes())]), planned=3)),
        material(source("done", episodes(skill=9.0))),
        material(source("own", (o for o in episodes(repetitions=2)), planned=1000)),
        material(source("a"), source("b", episodes(skill=0.2))),
    ],
    ids=["one", "little", "all done", "unfinished", "two"],
)
def test_there_is_a_page_for_whatever_was_played(of: Material) -> None:
    found = page(of)
    assert "nan" not in " ".join(found.texts).lower().split()
    for section in sections(of):
        for table in section.tables:
            assert {len(row.cells) for row in table.rows} <= {len(table.columns)}, table.name


def test_nothing_at_all_has_a_page_too() -> None:
    text = " ".join(page(material(source("none", iter(()), planned=4))).texts)
    assert "0 of 4 episodes" in text


def test_two_studies_are_compared_and_told_apart() -> None:
    both = material(source("old"), source("new", episodes(skill=0.1)))
    text = " ".join(page(both).texts)
    assert "new, openai:gpt-4o less old, openai:gpt-4o" in text or (
        "old, openai:gpt-4o less new, openai:gpt-4o" in text
    )
    assert "could have seen" in text


def test_studies_of_different_models_need_no_names_of_their_own() -> None:
    both = material(source("a", baseline()), source("b", episodes("random")))
    assert {both.name(setting) for setting in both.settings} == {"baseline", "random"}


def test_chips_lead_to_pages_where_there_are_some(tmp_path: Path) -> None:
    outcomes = tuple(episodes())
    of = material(source("mine", iter(outcomes), pages={outcomes[0].key: "x/episode.html"}))
    chips = [
        a for name, a in page(of).tags if name == "a" and a.get("class", "").startswith("chip")
    ]
    assert {chip.get("href") for chip in chips} == {None, "x/episode.html"}
    assert {chip["class"] for chip in chips} <= {"chip c0", "chip c1", "chip c2", "chip c3"}


@pytest.mark.parametrize(
    ("cell", "text"),
    [
        (Cell(0.876, "share"), "0.88"),
        (Cell(None, "share"), "–"),
        (Cell(float("nan"), "share"), "–"),
        (Cell(-0.041, "share", signed=True), "−0.04"),
        (Cell(0.001, "share", signed=True), "0.00"),
        (Cell(-0.001, "share"), "0.00"),
        (Cell(0.5, "share", signed=True), "+0.50"),
        (Cell(12345.6, "tokens"), "12,346"),
        (Cell(0.00123, "dollars"), "$0.0012"),
        (Cell(0.0, "dollars"), "$0.00"),
        (Cell(0.0004, "p"), "< 0.001"),
        (Cell(0.835, "percent"), "83.5 %"),
        (Cell(Interval(0.1, 0.934), "share"), "0.10 to 0.93"),
        (Cell(Interval(-0.1, 0.2), "share", signed=True), "−0.10 to +0.20"),
        (Cell("words"), "words"),
    ],
)
def test_a_value_is_written_as_people_read_it(cell: Cell, text: str) -> None:
    assert cell.text == text
