"""The page of a study: one HTML file without scripts that opens from a disk, without a network."""

from __future__ import annotations

from dataclasses import dataclass

from markupsafe import Markup

from adamo_vh.analysis.statistics import Interval
from adamo_vh.report.study.chart import Chart
from adamo_vh.report.study.material import Material, Source, shown_labeling, shown_scene
from adamo_vh.report.study.section import Section
from adamo_vh.report.study.svg import drawn, tone_class
from adamo_vh.report.study.table import Cell
from adamo_vh.report.templating import csp_hash, environment, template_text

_WIDE_PX, _HALF_PX = 1120.0, 548.0
_MOST_CARDS = 8


@dataclass(frozen=True, slots=True)
class _Card:
    """The headline figure of a setting."""

    name: str
    kind: str
    tone: str
    href: str
    completion: str
    repeat: str
    task: str
    strict: str
    episodes: str


def render_study(material: Material, sections: tuple[Section, ...]) -> str:
    """Render the page of a study.

    Args:
        material: What it is made of.
        sections: What stands on it.

    Returns:
        A complete HTML document. Its links lead within it, to the tables beside it and to the
        pages of episodes.
    """
    style = template_text("palette.css") + template_text("study.css")
    damaged = [item for source in material.sources for item in source.damaged.items()]
    return (
        environment()
        .get_template("study.html.j2")
        .render(
            material=material,
            sections=sections,
            played=played(material),
            unfinished=[line for s in material.sources for line in _unfinished(material, s)],
            cards=_cards(material),
            damaged=damaged,
            drawn=drawn,
            wide=_width,
            tone_class=tone_class,
            style=Markup(style),  # Ours, and named by its hash in the page's policy.
            style_hash=csp_hash(style),
        )
    )


def _width(chart: Chart) -> float:
    """A chart of rows or of one panel takes the whole width."""
    return _WIDE_PX if chart.lines or len(chart.panels) == 1 else _HALF_PX


def played(material: Material) -> str:
    """What was played, in a sentence."""
    models = sorted({setting.model for setting in material.settings})
    parts = [
        _several("task", len(material.tasks)),
        "in " + " and ".join(map(shown_scene, material.scenes)),
        "under " + " and ".join(map(shown_labeling, material.labelings)),
        "with " + " and ".join(models),
    ]
    scored = sum(outcome.is_scored for outcome in material.outcomes)
    variations = {outcome.variation for outcome in material.outcomes}
    count = f"{_several('scored episode', scored)}"
    if variations != {0}:
        count += f" over {_several('variation', len(variations))} of the scenes"
    return f"{' '.join(parts)}: {count}."


def _unfinished(material: Material, source: Source) -> list[str]:
    """What is missing of a study, a line each."""
    name = f"{source.name}: " if len(material.sources) > 1 else ""
    lines = []
    played_count = len(source.outcomes)
    if played_count + len(source.damaged) < source.planned:
        lines.append(
            f"{name}not finished: {played_count:,} of {source.planned:,} episodes have been "
            "played. The same bench command goes on."
        )
    unscored = sum(not outcome.is_scored for outcome in source.outcomes)
    if unscored:
        lines.append(
            f"{name}{_several('episode', unscored)} unscored: ended by a fault that is not the "
            "agent’s, and in no figure."
        )
    if source.damaged:
        lines.append(f"{name}{_several('record', len(source.damaged))} damaged, in no figure.")
    return lines


def _several(word: str, count: int) -> str:
    return f"{count:,} {word}{'' if count == 1 else 's'}"


def _cards(material: Material) -> list[_Card]:
    cards = []
    for setting in material.settings[:_MOST_CARDS]:
        row = material.mean(setting)
        assert row is not None
        found = row.figures
        cards.append(
            _Card(
                name=material.name(setting),
                kind=setting.model_kind,
                tone=tone_class(material.tone(setting)),
                href=material.link(setting),
                completion=Cell(found.completion.mean, "share").text,
                repeat=_interval(found.completion.repeat, found.why.repeat),
                task=_interval(found.completion.task, found.why.task),
                strict=Cell(found.strict.mean, "share").text,
                episodes=f"{found.n:,}",
            )
        )
    return cards


def _interval(found: Interval | None, why: str) -> str:
    return why.split(":", maxsplit=1)[0] if found is None else Cell(found, "share").text
