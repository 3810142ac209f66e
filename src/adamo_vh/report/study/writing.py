"""Writes a report: the page, and the same tables as Markdown, LaTeX and CSV beside it."""

from __future__ import annotations

from pathlib import Path

from adamo_vh.files import write_whole
from adamo_vh.report.study.contents import sections
from adamo_vh.report.study.every_cell import cell_rows, episode_rows
from adamo_vh.report.study.material import Material
from adamo_vh.report.study.page import played, render_study
from adamo_vh.report.study.texts import comma_separated, latex, markdown

PAGE, MARKDOWN, LATEX, TABLES = "report.html", "report.md", "report.tex", "tables"
"""Names of the files, and of the folder of CSV files."""


def write_report(material: Material, out: Path, figures: Path | None = None) -> tuple[Path, ...]:
    """Write the report of one study, or of several side by side.

    Args:
        material: What it is made of.
        out: Folder that the report is written into.
        figures: Folder that every chart is drawn into as PDF and SVG; none by default.

    Returns:
        The page, and the files beside it.

    Raises:
        FileError: A file cannot be written.
        ConfigError: Figures are wanted, and matplotlib is not installed.
    """
    found = sections(material)
    page = write_whole(out / PAGE, _bytes(render_study(material, found)))
    texts = {
        MARKDOWN: markdown(material.title, played(material), found),
        LATEX: latex(material.title, found),
        **{
            f"{TABLES}/{table.name}.csv": comma_separated(table)
            for section in found
            if section.name != "cells"
            for table in section.tables
        },
        f"{TABLES}/cells.csv": comma_separated(cell_rows(material)),
        f"{TABLES}/episodes.csv": comma_separated(episode_rows(material)),
    }
    written = [write_whole(out / name, _bytes(text)) for name, text in texts.items()]
    if figures is not None:
        from adamo_vh.report.study.figures import write_figures

        charts = [chart for section in found for chart in section.charts]
        written += write_figures(charts, figures)
    return (page, *written)


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "xmlcharrefreplace")
