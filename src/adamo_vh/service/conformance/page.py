"""The report on an engine: in words, as JSON, and as one page."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from markupsafe import Markup

from adamo_vh.report.templating import csp_hash, environment, template_text
from adamo_vh.service.conformance.running import Conformance, Verdict


def summary(report: Conformance) -> str:
    """The whole in a sentence."""
    counts = {verdict: report.count(verdict) for verdict in Verdict}
    told = ", ".join(f"{count} {verdict}" for verdict, count in counts.items() if count)
    return f"{'Conforms' if report.conforms else 'Does not conform'}: {told}."


def as_json(report: Conformance) -> dict[str, Any]:
    """The report as plain data."""
    return {
        "engine": report.engine,
        "scene": report.scene,
        "conforms": report.conforms,
        "abilities": asdict(report.abilities),
        "checks": [{**asdict(item), "seconds": round(item.seconds, 3)} for item in report.findings],
        "latency_ms": {item.call: round(item.median_ms, 2) for item in report.latencies},
    }


def page(report: Conformance) -> str:
    """One self-contained page."""
    style = template_text("palette.css") + template_text("conformance.css")
    template = environment().get_template("conformance.html.j2")
    # Ours, and named by its hash in the page's policy.
    own = {"style": Markup(style), "style_hash": csp_hash(style)}
    return template.render(report=report, summary=summary(report), **own)
