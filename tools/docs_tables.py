"""Tables of the documentation that are made from the code, so that they cannot differ from it.

A page names one in a comment, `<!-- table: exit codes -->`; mkdocs calls `on_page_markdown`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Any

MARK = re.compile(r"<!-- table: ([\w ]+) -->")


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Put every table that a page names in its place.

    Raises:
        KeyError: There is no such table.
    """
    return MARK.sub(lambda found: TABLES[found[1]](), markdown)


def _table(head: tuple[str, ...], rows: Iterator[tuple[str, ...]]) -> str:
    lines = [head, ("---",) * len(head), *rows]
    return "\n".join(
        "| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines
    )


def exit_codes() -> str:
    """What each exit code of the command line means."""
    from adamo_vh.cli.exits import MEANING

    rows = ((f"`{code.value}`", meaning) for code, meaning in MEANING.items())
    return _table(("code", "meaning"), rows)


def model_uris() -> str:
    """What a model may be called."""
    from adamo_vh.inference.uris import markdown_table

    return markdown_table()


def failures() -> str:
    """Every way to fail that a diagnosis tells, by class."""
    from adamo_vh.analysis.diagnosis.finding import CODES

    rows = (
        (kind.value, f"`{code}`", meaning)
        for kind, codes in CODES.items()
        for code, meaning in codes.items()
    )
    return _table(("class", "code", "meaning"), rows)


def commands() -> str:
    """Every command with its arguments and options."""
    import typer

    from adamo_vh.cli.app import app

    return "\n\n".join(_command("adamo-vh", typer.main.get_command(app)))


def _command(path: str, command: Any) -> Iterator[str]:
    inner = getattr(command, "commands", {})
    for name in sorted(inner):
        yield from _command(f"{path} {name}", inner[name])
    if command.callback is None or (inner and path == "adamo-vh"):
        return
    yield f"## `{path}`"
    yield command.help or ""
    rows = [
        (f"`{' '.join(p.opts) if p.param_type_name == 'option' else p.name.upper()}`", _help(p))
        for p in command.params
        if not p.hidden
    ]
    if rows:
        yield _table(("argument or option", "meaning"), iter(rows))


def _help(parameter: Any) -> str:
    return " ".join((getattr(parameter, "help", "") or "").split())


TABLES: dict[str, Callable[[], str]] = {
    "commands": commands,
    "exit codes": exit_codes,
    "failures": failures,
    "model uris": model_uris,
}
