"""What it takes: calls, tokens, time and money; and how the agents behave."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from adamo_vh.analysis.cells import Setting
from adamo_vh.analysis.figures import KINDS, Figures
from adamo_vh.analysis.paper.published import PublishedFigures, chosen, published_figures
from adamo_vh.report.study.chart import Axis, Chart, Mark, Panel, Series, shares
from adamo_vh.report.study.headline import paper_name
from adamo_vh.report.study.material import Material, shown_labeling
from adamo_vh.report.study.section import Section
from adamo_vh.report.study.table import Cell, Form, Row, Table, text

_NOT_TOLD = "the paper does not tell"
_MOST_TICKS = 8

Column = tuple[
    str, Form, Callable[[Figures], float | None], Callable[[PublishedFigures], float] | None
]
"""Name, form, ours and the paper's."""


def effort(material: Material) -> Section:
    """Calls, tokens, seconds and money."""
    others = sorted(
        {name for row in material.cells for name in row.figures.calls} - {*KINDS, "total"}
    )
    estimated = any(row.figures.tokens_estimated for row in material.cells)
    return Section(
        "effort",
        "What it takes",
        "Means per episode, each task counted once. Unscored episodes are left out.",
        (
            _table(
                material,
                "calls",
                "Calls",
                "Tool calls by kind, calls of the model, and requests to its provider, which count "
                "repairs and failed tries too. Look leaves out the first view, which nobody asks "
                "for.",
                _calls(others),
            ),
            _table(
                material,
                "tokens",
                "Tokens and money",
                "Tokens of all model calls of an episode; cached ones are part of those that went "
                "in. Cost is what was spent at list prices; cost and tokens per solved task count "
                "the failed episodes too."
                + (
                    " Some tokens are estimated, where a provider did not count."
                    if estimated
                    else ""
                ),
                _TOKENS,
                kinds=_unpriced,
            ),
            _table(
                material,
                "time",
                "Time",
                "Seconds an episode: of the model, of the world that carries the calls out, and of "
                "waits for rate limits and retries, which count against no limit.",
                _TIMES,
            ),
        ),
    )


def _calls(others: Iterable[str]) -> tuple[Column, ...]:
    paper: dict[str, Callable[[PublishedFigures], float]] = {
        "Walk": lambda p: p.walk,
        "Look": lambda p: p.look,
        "Pick": lambda p: p.pick,
        "Drop": lambda p: p.drop,
    }

    def kind(name: str) -> Callable[[Figures], float | None]:
        return lambda figures: figures.calls.get(name, 0.0)

    return (
        *((name, "number", kind(name), paper.get(name)) for name in (*KINDS, *others)),
        ("all tools", "number", kind("total"), lambda p: p.tool_calls),
        ("model calls", "number", lambda f: f.model_calls, lambda p: p.model_calls),
        ("requests", "number", lambda f: f.requests, None),
    )


_TOKENS: tuple[Column, ...] = (
    ("tokens", "tokens", lambda f: f.tokens, lambda p: p.tokens),
    ("in", "tokens", lambda f: f.input_tokens, lambda p: p.tokens - p.output_tokens),
    ("cached", "tokens", lambda f: f.cached_tokens, None),
    ("out", "tokens", lambda f: f.output_tokens, lambda p: p.output_tokens),
    ("reasoning", "tokens", lambda f: f.reasoning_tokens, None),
    ("tokens per solved", "tokens", lambda f: f.tokens_per_solved, None),
    ("cost", "dollars", lambda f: f.cost_usd, None),
    ("cost per solved", "dollars", lambda f: f.cost_per_solved_usd, None),
    ("solved", "count", lambda f: f.solved, None),
)
_TIMES: tuple[Column, ...] = (
    ("model s/call", "seconds", lambda f: f.seconds_per_call, lambda p: p.seconds_per_call),
    ("model s", "seconds", lambda f: f.model_s, lambda p: p.model_s),
    ("world s", "seconds", lambda f: f.world_s, None),
    ("waited s", "seconds", lambda f: f.waited_s, None),
)
_CONDUCT: tuple[Column, ...] = (
    ("completion", "share", lambda f: f.completion.mean, lambda p: p.completion),
    ("strict", "share", lambda f: f.strict.mean, None),
    ("early stops", "percent", lambda f: f.early_stops, None),
    ("false claims", "percent", lambda f: f.false_claims, None),
    ("refused calls", "number", lambda f: f.refused, None),
    ("corrected calls", "number", lambda f: f.corrected, None),
    ("protocol failures", "number", lambda f: f.protocol_failures, None),
    ("missing notes", "number", lambda f: f.missing_notes, None),
    ("cut prompts", "number", lambda f: f.cut_prompts, None),
    ("walked, m", "metres", lambda f: f.walked_m, None),
    ("path / oracle’s", "number", lambda f: f.path_ratio, None),
)


def conduct(material: Material) -> Section:
    """How the agents behave: when they stop, what they claim, what is refused; and pass^k."""
    curve = _pass_hats(material)
    return Section(
        "conduct",
        "How they behave",
        "",
        (
            _table(
                material,
                "conduct",
                "Stops, claims, refusals and ways",
                "Early stops: share of episodes that the agent ended with conditions open. False "
                "claims: those in which it said that all was done. Refused calls changed nothing, "
                "corrected ones were carried out otherwise than asked; protocol failures are "
                "replies that were neither a call nor an answer; cut prompts no longer held every "
                "reply before; each per episode. Path / oracle’s "
                "is metres walked over those of the oracle, in complete episodes for which these "
                "are known: those in a scene as it is.",
                _CONDUCT,
            ),
            *([curve] if curve else []),
        ),
    )


def _rows(material: Material) -> Iterable[tuple[str, Setting | None, str]]:
    """Labeling (empty for all) and setting of each row; no setting where the paper's stand."""
    for labeling in ("", *(material.labelings if len(material.labelings) > 1 else ())):
        shown = shown_labeling(labeling) if labeling else "all labelings"
        for setting in material.settings:
            yield labeling, setting, shown
        yield labeling, None, shown


def _unpriced(figures: Figures) -> str:
    return "nothing was solved" if not figures.solved else "the price of some call is unknown"


def _no_way(figures: Figures) -> str:
    del figures
    return "nobody knows"


def _table(
    material: Material,
    name: str,
    title: str,
    caption: str,
    columns: tuple[Column, ...],
    *,
    kinds: Callable[[Figures], str] = _no_way,
) -> Table:
    """A table of means with one row for each labeling and setting, and the paper's below."""
    rows: list[Row] = []
    for labeling, setting, shown in _rows(material):
        if setting is None:
            under = [labeling] if labeling else material.labelings
            cells = chosen(scenes=material.scenes, labelings=under, tasks=material.tasks)
            rows += [_paper_row(shown, found, columns) for found in published_figures(cells)]
            continue
        where = {"labeling": labeling} if labeling else {}
        mean = material.mean(setting, **where)
        if mean is None:
            continue
        link, why = material.link(setting), kinds(mean.figures)
        ours = (Cell(of(mean.figures), form, why=why) for _, form, of, _ in columns)
        head = (text(shown), text(material.name(setting), href=link))
        rows.append(Row((*head, *ours)))
    heads = ("labeling", "model", *(head for head, *_ in columns))
    return Table(name, title, caption, heads, tuple(rows), is_grouped=True)


def _paper_row(shown: str, found: PublishedFigures, columns: tuple[Column, ...]) -> Row:
    return Row(
        (
            text(shown),
            text(paper_name(found.model)),
            *(Cell(of(found) if of else None, form, why=_NOT_TOLD) for _, form, _, of in columns),
        ),
        is_paper=True,
    )


def _pass_hats(material: Material) -> Chart | None:
    series = []
    for setting in material.settings:
        row = material.mean(setting)
        hats = row.figures.strict.pass_hat if row else ()
        marks = tuple(
            Mark(k, value, title=f"{material.name(setting)}: pass^{k} {value:.2f}")
            for k, value in enumerate(hats, start=1)
        )
        if len(marks) > 1:
            series.append(Series(material.name(setting), material.tone(setting), "line", marks))
    if not series:
        return None
    most = max(len(one.marks) for one in series)
    step = -(-most // _MOST_TICKS)
    ticks = tuple((float(k), str(k)) for k in range(1, most + 1, step))
    panel = Panel("", Axis("k", 0.5, most + 0.5, ticks), shares("pass^k"), tuple(series))
    return Chart(
        "pass-k",
        "pass^k: how reliably",
        "How likely k episodes of a cell are all strict successes: the mean over cells, estimated "
        "without bias, as far as the cell with the fewest episodes goes. A flat line means the "
        "same tasks always work; a falling one, that luck decides.",
        panels=(panel,),
    )
