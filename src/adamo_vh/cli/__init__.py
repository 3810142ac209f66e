"""The command line: parses, builds, calls; no logic."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from functools import cache
from typing import Any

from adamo_vh.errors import (
    AdamoError,
    ConfigError,
    FileError,
    ModelConfigError,
    RecordError,
    SceneError,
)

TRACEBACK = "ADAMO_VH_TRACEBACK"
"""Environment variable: show where a fault of ADAMO came from."""

_WRONG = (ConfigError, FileError, ModelConfigError, RecordError, SceneError)


def main() -> None:
    """Entry point of `adamo-vh`: every error becomes one line, not a traceback."""
    from adamo_vh.cli import terminal
    from adamo_vh.cli.exits import Exit

    terminal.prepare()
    code = _run()
    if lost := terminal.finish():
        terminal.complain(f"not all could be printed: {lost.strerror}. Print to another place.")
        code = code or Exit.NO
    sys.exit(code)


def _run() -> int:
    from typer import TyperException

    from adamo_vh.cli.exits import Exit
    from adamo_vh.cli.terminal import complain, is_text
    from adamo_vh.files import cannot

    try:
        for words in sys.argv[1:]:
            if not is_text(words):
                raise ConfigError(
                    f"{os.fsencode(words).decode('utf-8', 'replace')!r} is not UTF-8 text: set "
                    "the terminal to UTF-8 (export LC_ALL=C.UTF-8), and type it again."
                )
        code = _command()(standalone_mode=False)
        if code == Exit.STOPPED:
            complain("stopped; what happened so far is in the run folder")
        return code if isinstance(code, int) else Exit.DONE
    except KeyboardInterrupt:
        complain("stopped; what happened so far is in the run folder")
        return Exit.STOPPED
    except AdamoError as error:
        complain(error)
        return Exit.WRONG if isinstance(error, _WRONG) else Exit.NO
    except OSError as error:
        complain(cannot("used", error.filename or "a file or a connection", error))
        return Exit.WRONG
    except TyperException as error:
        if told := _usage(error):
            complain(told)
        return Exit.WRONG
    except Exception as error:
        if os.environ.get(TRACEBACK):
            raise
        complain(
            f"a fault in ADAMO itself: {type(error).__name__}: {error}. Please report it; "
            f"{TRACEBACK}=1 shows where it came from."
        )
        return Exit.FAULT


@cache
def _command() -> Callable[..., Any]:
    """The tree of commands: to make it takes longer than many a command."""
    from typer.main import get_command

    from adamo_vh.cli.app import app

    if sys.flags.optimize > 1:
        from adamo_vh.cli.kept_help import keep_help

        keep_help(app)
    return get_command(app)


def _usage(error: Exception) -> str:
    """What is wrong with the command, and where its help is; empty if that was just shown."""
    said = str(getattr(error, "format_message", error.__str__)())
    context = getattr(error, "ctx", None)
    command = getattr(context, "command_path", "adamo-vh")
    return f"{said} See: {command} --help" if said else ""
