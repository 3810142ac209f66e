"""The tables of a report as Markdown, LaTeX and CSV: the same figures in other clothes."""

from __future__ import annotations

import csv
import io
import re
import textwrap
from collections.abc import Iterable, Iterator, Sequence

from adamo_vh.analysis.statistics import Interval
from adamo_vh.readable import readable
from adamo_vh.report.study.section import Section
from adamo_vh.report.study.table import Cell, Table, Value

_MARKS = re.compile(r"([\\`*_{}\[\]<>#|~$&])")
_TEX = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "%": r"\%",
    "#": r"\#",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    "\u2212": r"$-$",
    "–": "--",
    "“": "``",
    "”": "''",
    "’": "'",
    "×": r"$\times$",
    "ρ": r"$\rho$",
    "…": r"\ldots{}",
}
_HEAD_WIDTH = 14
"""Letters in a line of a column's head in LaTeX; an interval has about so many."""
_FORMULAS = ("=", "+", "-", "@", "\t", "\r")
"""With these a spreadsheet takes a text for a formula."""


def markdown(title: str, lead: str, sections: Iterable[Section]) -> str:
    """All tables as one Markdown text.

    Args:
        title: Of the report.
        lead: What was played.
        sections: With the tables.
    """
    parts = [f"# {_plain(title)}", _plain(lead)]
    for section in sections:
        if not section.tables and not section.remark:
            continue
        parts.append(f"## {_plain(section.title)}")
        parts += [_plain(text) for text in (section.lead, section.remark) if text]
        for table in section.tables:
            parts += [f"### {_plain(table.title)}", _plain(table.caption), _markdown_table(table)]
            if table.notes:
                notes = (f"({letter}) {why}" for why, letter in table.notes.items())
                parts.append(_plain("; ".join(notes)) + ".")
    return "\n\n".join(parts) + "\n"


def _plain(text: str) -> str:
    return _MARKS.sub(r"\\\1", readable(text))


def _markdown_table(table: Table) -> str:
    notes = table.notes
    rule = ("---:" if number else "---" for number in table.numbers)
    lines = [" | ".join(map(_plain, table.columns)), " | ".join(rule)]
    for row in table.rows:
        lines.append(
            " | ".join(_plain(_noted(cell, notes.get(cell.why, ""))) for cell in row.cells)
        )
    return "\n".join(f"| {line} |" for line in lines)


def _noted(cell: Cell, letter: str) -> str:
    return f"{cell.text} ({letter})" if cell.value is None and letter else cell.text


def latex(title: str, sections: Iterable[Section]) -> str:
    """All tables as LaTeX, each a `table` to be taken over into a paper.

    Args:
        title: Of the report, for a comment.
        sections: With the tables.
    """
    parts = [
        f"% {readable(title)}",
        r"% Needs \usepackage{booktabs}; wide tables may want \resizebox or table*.",
    ]
    for section in sections:
        parts += [_latex_table(table) for table in section.tables]
    return "\n\n".join(parts) + "\n"


def _tex(text: str) -> str:
    return "".join(_TEX.get(letter, letter) for letter in readable(text))


def _latex_table(table: Table) -> str:
    notes = table.notes
    told = "; ".join(f"({letter}) {why}" for why, letter in notes.items())
    caption = f"{table.title}. {table.caption}{f' {told}.' if told else ''}"
    lines = [
        r"\begin{table}",
        r"  \centering\footnotesize",
        f"  \\caption{{{_tex(caption)}}}",
        f"  \\label{{tab:{re.sub('[^a-z0-9-]', '-', table.name.lower())}}}",
        f"  \\begin{{tabular}}{{{''.join('r' if n else 'l' for n in table.numbers)}}}",
        r"    \toprule",
        f"    {' & '.join(map(_tex_head, table.columns, table.numbers))} \\\\",
    ]
    for block in table.blocks:
        lines.append(r"    \midrule")
        for row in block:
            cells = [_tex(_noted(cell, notes.get(cell.why, ""))) for cell in row.cells]
            if row.is_paper:
                cells = [rf"\textit{{{cell}}}" for cell in cells]
            lines.append(f"    {' & '.join(cells)} \\\\")
    lines += [r"    \bottomrule", r"  \end{tabular}", r"\end{table}"]
    return "\n".join(lines)


def _tex_head(name: str, is_number: bool) -> str:
    """The head of a column, in lines that are no wider than its figures."""
    lines = [_tex(line) for line in textwrap.wrap(name, _HEAD_WIDTH, break_long_words=False)]
    side, stacked = "r" if is_number else "l", r"\\".join(lines)
    return rf"\shortstack[{side}]{{{stacked}}}" if len(lines) > 1 else stacked


def comma_separated(table: Table) -> str:
    """A table as CSV: full numbers, empty where nothing is known, an interval in two columns."""
    split = [
        any(isinstance(row.cells[at].value, Interval) for row in table.rows)
        for at in range(len(table.columns))
    ]
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(
        [name for at, name in enumerate(table.columns) for name in _heads(name, split[at])]
    )
    for row in table.rows:
        writer.writerow(
            [part for at, cell in enumerate(row.cells) for part in _values(cell.value, split[at])]
        )
    return out.getvalue()


def _heads(name: str, is_split: bool) -> Sequence[str]:
    return (f"{name} (low)", f"{name} (high)") if is_split else (name,)


def _values(value: Value, is_split: bool) -> Iterator[str | int | float]:
    if isinstance(value, Interval):
        yield from (round(value.low, 6), round(value.high, 6))
        return
    if value is None:
        yield ""
    elif isinstance(value, str):
        text = readable(value)
        yield f"'{text}" if text.startswith(_FORMULAS) else text
    else:
        yield round(value, 6) if isinstance(value, float) else value
    if is_split:
        yield ""
