"""The options of `adamo-vh run` for a program that plays instead of a model."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

AgentCmd = Annotated[
    str | None,
    typer.Option(
        help="A program plays instead of a model, over MCP: its command, in which {url}, {token}, "
        "{instruction} and {episode} are filled in. See docs/mcp.md.",
        show_default=False,
    ),
]
AgentEnv = Annotated[
    list[str] | None,
    typer.Option(help="A variable that --agent-cmd gets, by its name; may be repeated."),
]
AgentBind = Annotated[
    list[Path] | None,
    typer.Option(help="A file or folder that --agent-cmd may read; may be repeated."),
]
Isolation = Annotated[
    str,
    typer.Option(help="How --agent-cmd is confined: auto, bwrap or none (never ranked)."),
]
