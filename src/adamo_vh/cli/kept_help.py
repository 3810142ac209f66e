"""The help of the commands where Python drops docstrings (`python -OO`): out of their source."""

from __future__ import annotations

from types import FunctionType

import typer

from adamo_vh.action import docstring_in_source


def keep_help(app: typer.Typer) -> None:
    """Give every command of an app that has lost its help the words in its source."""
    for command in app.registered_commands:
        made = command.callback
        if not command.help and isinstance(made, FunctionType) and made.__doc__ is None:
            command.help = docstring_in_source(made)
    for group in app.registered_groups:
        if group.typer_instance is not None:
            keep_help(group.typer_instance)
