"""The options of `adamo-vh run` for a body on a server."""

from __future__ import annotations

from typing import Annotated

import typer

from adamo_vh.serving.admission import JUDGE_VARIABLE, TOKEN_VARIABLE

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
    typer.Option(help="What the server of --body asks of players.", envvar=TOKEN_VARIABLE),
]
JudgeToken = Annotated[
    str,
    typer.Option(help="Of the server of --body: print the result too.", envvar=JUDGE_VARIABLE),
]
