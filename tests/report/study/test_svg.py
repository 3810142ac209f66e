"""Charts as SVG: where things are drawn, and that all text is in the picture and has room."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from itertools import pairwise

import pytest
from tests.report.study.material import baseline, episodes, material, source
from tests.report.test_page import HOSTILE

from adamo_vh.analysis.statistics import Interval
from adamo_vh.report.study.chart import (
    Axis,
    Chart,
    Line,
    Mark,
    Panel,
    Part,
    Series,
    Style,
    places,
    scale,
    shares,
)
from adamo_vh.report.study.contents import sections
from adamo_vh.report.study.svg import drawn, tone_class

WIDTHS = (348.0, 548.0, 1120.0)
LETTER_PX = 6.0
"""Of the style sheet's type, about."""


def chart(*series: Series, x: Axis | None = None, y: Axis | None = None) -> Chart:
    tasks = x or places([f"T{n}" for n in range(1, 16)])
    return Chart("c", "Title", "Caption.", (Panel("Panel", tasks, y or shares("y"), series),))


def series(style: Style, *marks: Mark, tone: int = 0, **more: tuple) -> Series:
    return Series("one", tone, style, marks, **more)


def parsed(of: Chart, width: float = 548.0) -> list[ET.Element]:
    return [ET.fromstring(str(picture)) for picture in drawn(of, width)]


def found(picture: ET.Element, tag: str) -> list[dict[str, str]]:
    return [element.attrib for element in picture.iter(tag)]


def test_a_bar_stands_on_zero_and_is_as_tall_as_its_value() -> None:
    (picture,) = parsed(chart(series("bars", Mark(0, 0.5), Mark(1, 1.0), Mark(2, 0.0))))
    half, whole, nothing = found(picture, "rect")
    assert float(whole["height"]) == pytest.approx(2 * float(half["height"]), abs=0.2)
    feet = {round(float(bar["y"]) + float(bar["height"]), 1) for bar in (half, whole, nothing)}
    assert max(feet) - min(feet) <= 0.2
    assert float(nothing["height"]) > 0  # Something that is 0 is there all the same.


def test_a_bar_below_zero_hangs_from_it() -> None:
    (picture,) = parsed(chart(series("bars", Mark(0, -0.5), Mark(1, 0.5)), y=shares("y", -1.0)))
    down, up = found(picture, "rect")
    assert float(down["y"]) == pytest.approx(float(up["y"]) + float(up["height"]), abs=0.2)
    assert down["height"] == up["height"]


def test_bars_of_one_place_stand_side_by_side() -> None:
    two = [Series(name, n, "bars", (Mark(3, 0.5),)) for n, name in enumerate(("a", "b"))]
    (picture,) = parsed(chart(*two))
    first, second = found(picture, "rect")
    assert float(first["x"]) + float(first["width"]) <= float(second["x"]) + 0.1


def test_an_interval_is_a_line_between_its_ends() -> None:
    mark = Mark(0, 0.5, Interval(0.25, 0.75))
    (picture,) = parsed(chart(series("bars", mark)))
    (bar,) = found(picture, "rect")
    (line,) = [one for one in found(picture, "line") if one.get("class") == "whisker"]
    tall = abs(float(line["y1"]) - float(line["y2"]))
    assert tall == pytest.approx(float(bar["height"]), abs=0.2)
    assert float(line["y2"]) < float(bar["y"]) < float(line["y1"])


def test_what_is_beyond_an_axis_is_drawn_at_its_end() -> None:
    (picture,) = parsed(chart(series("points", Mark(3.0, 7.0), Mark(3.0, -7.0))))
    top, bottom = (float(dot["cy"]) for dot in found(picture, "circle"))
    assert 0 < top < bottom < 250


def test_a_line_goes_through_its_points() -> None:
    (picture,) = parsed(chart(series("line", Mark(0, 0.1), Mark(1, 0.9), Mark(2, 0.4))))
    (line,) = found(picture, "polyline")
    dots = [f"{dot['cx']},{dot['cy']}" for dot in found(picture, "circle")]
    assert line["points"].split() == dots


def test_a_fit_is_drawn_between_its_ends() -> None:
    fitted = series("points", Mark(0, 0.0), Mark(10, 1.0), fit=((0.0, 0.0), (10.0, 1.0)))
    (picture,) = parsed(chart(fitted, x=scale("level", [10.0])))
    (line,) = [one for one in found(picture, "line") if one.get("class") == "fit"]
    first, last = found(picture, "circle")
    assert (line["x1"], line["y1"]) == (first["cx"], first["cy"])
    assert (line["x2"], line["y2"]) == (last["cx"], last["cy"])


def test_the_papers_marks_differ_in_shape() -> None:
    both = [Series(str(tone), tone, "marks", (Mark(1, 0.5),)) for tone in (-1, -2)]
    (picture,) = parsed(chart(*both))
    assert len(found(picture, "path")) == len(found(picture, "circle")) == 1


def test_a_mark_says_what_it_is_and_leads_on() -> None:
    mark = Mark(0, 0.5, title="T1: 0.50", href="#e0-0-0-0")
    (picture,) = parsed(chart(series("bars", mark)))
    (link,) = picture.iter("a")
    assert link.attrib["href"] == "#e0-0-0-0"
    assert link.findtext("title") == "T1: 0.50"


def test_rows_show_both_intervals_and_parts() -> None:
    lines = (
        Line("one", 0, 0.5, Interval(0.4, 0.6), Interval(0.2, 0.8)),
        Line("two", 1, 0.5),
        Line("paper", -1, 0.5, Interval(0.4, 0.6)),
    )
    (picture,) = parsed(Chart("c", "T", "C.", lines=lines, axis=shares("x")), 1120.0)
    kinds = [line.get("class") for line in found(picture, "line")]
    assert (kinds.count("inner"), kinds.count("outer")) == (2, 1)
    parts = (Part("a", 0, 0.25, "a: 1 of 4"), Part("b", 1, 0.75))
    divided = Chart("c", "T", "C.", lines=(Line("all", parts=parts),), axis=shares("x"))
    (picture,) = parsed(divided, 1120.0)
    first, second = (float(bar["width"]) + 1 for bar in found(picture, "rect"))
    assert second == pytest.approx(3 * first, abs=0.5)
    assert "25 %" in "".join(picture.itertext()) and "75 %" in "".join(picture.itertext())


def texts(picture: ET.Element) -> Iterator[tuple[float, float, float]]:
    """Left, right and baseline of each text that is not turned."""
    for element in picture.iter("text"):
        if "transform" in element.attrib:
            continue
        wide = LETTER_PX * len("".join(element.itertext()))
        x, y = float(element.attrib["x"]), float(element.attrib["y"])
        left = {"start": x, "middle": x - wide / 2, "end": x - wide}[element.attrib["text-anchor"]]
        yield left, left + wide, y


@pytest.mark.parametrize("width", WIDTHS)
def test_no_text_covers_another_or_leaves_the_picture(width: float) -> None:
    of = material(source("mine", episodes("some-provider:a-model-of-a-long-name"), baseline()))
    charts = [one for section in sections(of) for one in section.charts]
    assert len(charts) >= 6
    for one in charts:
        for picture in parsed(one, width):
            placed = sorted(texts(picture), key=lambda text: (text[2], text[0]))
            for (_, right, y), (left, _, below) in pairwise(placed):
                assert abs(y - below) > 9 or left >= right - 1, one.name
            for left, right, y in placed:
                assert left > -9 and right < width + 9, one.name
                assert y <= float(picture.attrib["height"])


def test_ticks_without_room_are_shortened_or_left_out() -> None:
    tasks = chart(series("bars", Mark(0, 1.0)))
    names = [text for text in parsed(tasks, 348.0)[0].itertext() if text.strip().isdecimal()]
    assert "15" in names and not any(n.startswith("T") for n in names)
    long = chart(series("bars", Mark(0, 1.0)), x=places(["a long name of a setting"] * 9))
    (picture,) = parsed(long, 348.0)
    assert any("…" in "".join(element.itertext()) for element in picture.iter("text"))


def test_names_are_text_in_a_picture_too() -> None:
    bad = Series(HOSTILE, 0, "bars", (Mark(0, 0.5, title=HOSTILE, href="#x"),))
    panel = Panel(HOSTILE, places([HOSTILE]), shares(HOSTILE), (bad,))
    for of in (
        Chart("c", HOSTILE, HOSTILE, (panel,)),
        Chart("c", HOSTILE, "", lines=(Line(HOSTILE, 0, 0.5),), axis=shares(HOSTILE)),
    ):
        for picture in drawn(of, 548.0):
            assert not re.search(r"<(script|img)", str(picture))
            ET.fromstring(str(picture))


@pytest.mark.parametrize(
    ("values", "ticks"),
    [
        ([0.93, 0.2], ["0", "0.5", "1"]),
        ([5.71, 9.2], ["0", "5", "10"]),
        ([42963.0], ["0", "20k", "40k", "60k"]),
        ([], ["0", "0.5", "1"]),
        ([0.0], ["0", "0.5", "1"]),
        ([0.0013], ["0", "0.0005", "0.001", "0.0015"]),
    ],
)
def test_an_axis_has_round_ticks_that_hold_its_values(
    values: list[float], ticks: list[str]
) -> None:
    axis = scale("y", values)
    assert [name for _, name in axis.ticks] == ticks
    assert axis.low <= min([0.0, *values]) and axis.high >= max([0.0, *values])


def test_colours_begin_anew_where_there_are_no_more() -> None:
    assert [tone_class(tone) for tone in (0, 7, 8, -1, -2)] == ["t0", "t7", "t0", "p0", "p1"]


def test_a_legend_names_each_series_once() -> None:
    one = series("bars", Mark(0, 1.0))
    panel = Panel("p", places(["a"]), shares("y"), (one, Series("empty", 1, "bars", ())))
    assert Chart("c", "", "", (panel, panel)).legend == (("one", 0, "bars"),)
