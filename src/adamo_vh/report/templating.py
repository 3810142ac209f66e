"""The templates of pages, and the one place where text enters them."""

from __future__ import annotations

import base64
import hashlib
import math
import re
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any

from adamo_vh.geometry import Vec3
from adamo_vh.readable import readable

if TYPE_CHECKING:
    from jinja2 import Environment

_SHOWN = 420
"""Letters of a long text that are shown before the rest is asked for."""
_WORTH_FOLDING = 220
"""Fewer letters than these are not worth a click."""


def template_text(name: str) -> str:
    """A file of the templates."""
    folder = resources.files(__package__) / "templates"
    return (folder / name).read_text(encoding="utf-8")


def csp_hash(text: str) -> str:
    """A source expression that allows exactly this inline text."""
    digest = hashlib.sha256(text.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode('ascii')}'"


@cache
def environment() -> Environment:
    """The templates, with escaping: whatever they print was made readable first."""
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    made = Environment(
        loader=FunctionLoader(template_text),
        undefined=StrictUndefined,
        autoescape=True,
        finalize=_shown,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters.update(
        place=Vec3.text,
        degrees=_degrees,
        seconds=_seconds,
        thousands=_thousands,
        dollars=_dollars,
        folded=_folded,
    )
    return made


def _shown(value: Any) -> Any:
    """What a template prints: numbers and finished markup as they are, all else made readable."""
    if hasattr(value, "__html__") or isinstance(value, int | float):
        return value
    return readable(str(value), lines=True)


def _folded(text: str) -> tuple[str, str]:
    """A long text in two: what is shown at once, and the rest; a short one has no rest."""
    if len(text) <= _SHOWN + _WORTH_FOLDING:
        return text, ""
    # Where a paragraph, a sentence or at least a word ends.
    for end in (r"\n+", r"(?<=[.!?])\s", r"\s"):
        found = [match.end() for match in re.finditer(end, text[:_SHOWN])]
        if found and found[-1] > _SHOWN / 2:
            return text[: found[-1]].rstrip(), text[found[-1] :].lstrip("\n")
    return text[:_SHOWN], text[_SHOWN:]


def _degrees(angle_rad: float) -> str:
    return f"{round(math.degrees(angle_rad)) % 360}°" if math.isfinite(angle_rad) else "unknown"


def _seconds(value: float) -> str:
    if not math.isfinite(value):
        return "unknown time"
    if value < 1:
        return f"{value * 1000:.0f} ms"
    return f"{value:.1f} s" if value < 120 else f"{value // 60:.0f} min {value % 60:.0f} s"


def _thousands(value: int) -> str:
    return f"{value:,}"


def _dollars(value: float) -> str:
    return f"${value:.2f}" if value >= 1 else f"${value:.4f}"
