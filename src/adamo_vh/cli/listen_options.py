"""The options of commands that serve others: where, and under which names."""

from __future__ import annotations

from typing import Annotated

import typer

Address = Annotated[
    str, typer.Option(help="Where to listen; others than this machine need --token.")
]
AllowedHosts = Annotated[
    list[str] | None,
    typer.Option(help="One more name under which this machine is asked; may be repeated."),
]
