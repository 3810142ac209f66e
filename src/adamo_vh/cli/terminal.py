"""The terminal: the one place that prints, so that nothing steers it and nothing stops the work.

Whatever is printed goes through `readable` first. What a terminal cannot show becomes a question
mark, and what nobody takes any more (`| head`, a full disk) is dropped: an episode that was paid
for goes on to its end.
"""

from __future__ import annotations

import io
import json
import os
import sys
import warnings
from typing import Any, TextIO

from rich.console import Console
from rich.text import Text

from adamo_vh.readable import readable

_WIDE = 150
"""Letters of a line where there is no terminal that is narrower."""
_LONGEST = 4000
"""Letters of a complaint; an error may quote what it is about."""


class _Way(io.RawIOBase):
    """A way out that may end: what nobody takes is dropped, and the reason kept."""

    def __init__(self, handle: int) -> None:
        super().__init__()
        self._handle = handle
        self.lost: OSError | None = None

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._handle

    def isatty(self) -> bool:
        return os.isatty(self._handle)

    def write(self, data: Any) -> int:
        if self.lost is None:
            try:
                return os.write(self._handle, data)
            except OSError as error:
                self.lost = error
        return len(data)


def prepare() -> None:
    """Make the three streams of this process ones that never raise for what goes through them."""
    sys.stdout, sys.stderr = _patient(sys.stdout), _patient(sys.stderr)
    if sys.stdin is None:
        sys.stdin = io.StringIO()  # Closed by the caller: nothing is said.
    elif isinstance(sys.stdin, io.TextIOWrapper):
        # What is no text comes through, to be refused in words; see `is_text`.
        sys.stdin.reconfigure(errors="surrogateescape")
    warnings.showwarning = lambda message, *_, **__: complain(f"warning: {message}")


def _patient(stream: TextIO | None) -> TextIO:
    if not isinstance(stream, io.TextIOWrapper):
        return stream or io.StringIO()  # Closed by the caller, or not a real stream.
    stream.flush()
    return io.TextIOWrapper(
        io.BufferedWriter(_Way(stream.fileno())),
        encoding=stream.encoding,
        errors="replace",
        line_buffering=True,
    )


def finish() -> OSError | None:
    """Let everything out; what could not be printed, except to a reader that went away."""
    sys.stdout.flush()
    sys.stderr.flush()
    buffer = getattr(sys.stdout, "buffer", None)
    lost = getattr(getattr(buffer, "raw", None), "lost", None)
    return None if isinstance(lost, BrokenPipeError) else lost


def is_text(words: str) -> bool:
    """Whether what was typed is text: the bytes of another encoding come as lone surrogates."""
    return not any("\ud800" <= letter <= "\udfff" for letter in words)


def say(text: object, style: str = "", *, console: Console | None = None) -> None:
    """Print a text: its lines stay, nothing in it is taken for a command or a style."""
    words = Text(readable(str(text), lines=True), style)
    (console or Console()).print(words, soft_wrap=True)


def wide_console() -> Console:
    """A console for tables: without a terminal nobody needs them narrow, and nothing is cut off."""
    console = Console()
    if console.is_terminal or "COLUMNS" in os.environ:
        return console
    return Console(width=max(console.width, _WIDE))


def line(label: str, text: str, style: str = "", *, console: Console | None = None) -> None:
    """Print a label and what belongs to it; further lines are set in, so none looks like one."""
    words = readable(text.strip(), lines=True).replace("\n", f"\n{'':12}")
    head = Text(f"{label:<11} ", "bold")
    (console or Console()).print(head + Text(words, style), soft_wrap=True)


def marked(mark: str, colour: str, what: str, found: str, fix: str = "") -> None:
    """Print a line of a check: whether it is well, what was looked at, what was found, the fix."""
    head = Text(f"{mark:<4}", colour) + Text(f" {what} ", "bold")
    Console().print(head + Text(readable(found)), soft_wrap=True)
    if fix:
        say(f"     fix: {fix}")


def put_json(value: Any) -> None:
    """Print one JSON object: in ASCII, which every terminal and every reader takes."""
    print(json.dumps(value))


def complain(text: object) -> None:
    """Print an error, beside the results."""
    words = readable(str(text), lines=True)
    words = words if len(words) <= _LONGEST else f"{words[:_LONGEST]} ..."
    print(f"adamo-vh: {words}", file=sys.stderr)
