"""What an MCP client is told beside what any model is told: text files, rendered strictly."""

from __future__ import annotations

from adamo_vh.render import render_from


def render(name: str, **variables: object) -> str:
    """Render a prompt file of this folder.

    Args:
        name: File name without ".md".
        variables: Every variable of the file, no more is needed and no less accepted.

    Raises:
        ConfigError: A variable of the file has no value.
    """
    return render_from(__name__, name, **variables)
