"""What a model is told about the form of its answers, and what a probe asks, as text files."""

from __future__ import annotations

from adamo_vh.render import render_from


def render(name: str, **variables: object) -> str:
    """Render a prompt file of this folder, strictly; see `render_from`."""
    return render_from(__name__, name, **variables)
