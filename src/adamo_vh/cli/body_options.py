"""The options of `adamo-vh run` for a body on a server."""

from __future__ import annotations

from typing import Annotated

import typer

BodyUrl = Annotated[
    str | None,
    typer.Option(
        help="The body is on a server: the URL that adamo-vh serve says. The record and the score "
        "are kept there.",
        show_default=False,
    ),
]
BodyToken = Annotated[
    str,
    typer.Option(help="What the server of --body asks of players.", envvar="ADAMO_VH_TOKEN"),
]
JudgeToken = Annotated[
    str,
    typer.Option(
        help="Of the server of --body: print the result too.", envvar="ADAMO_VH_JUDGE_TOKEN"
    ),
]
