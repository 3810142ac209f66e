"""`adamo-vh explain`: why a recorded episode failed, in words or as JSON."""

from __future__ import annotations

from pathlib import Path

from adamo_vh.cli.terminal import line, put_json, say
from adamo_vh.session.explaining import explain_run


def explain_and_show(folder: Path, *, as_json: bool) -> None:
    """Explain an episode."""
    found = explain_run(folder)
    if as_json:
        put_json({"run": str(folder), **found.json()})
        return
    say(found.summary)
    if found.class_ is None or found.code is None:
        return
    say("")
    line("class", f"{found.class_} ({found.code.replace('_', ' ')})")
    for item in found.evidence:
        line(f"step {item.step}" if item.step else "start", item.text)
        if item.frame:
            box = ", ".join(map(str, item.box_px)) if item.box_px else "nowhere"
            line("", f"picture {folder / 'frames' / item.frame}, pixels {box}", "dim")
    line("distance", " ".join(map(str, found.distance)))
