"""What all commands that serve have in common: until when, under which names, for whom."""

from __future__ import annotations

import secrets
import signal
import threading
from collections.abc import Sequence

from adamo_vh.errors import ConfigError
from adamo_vh.serving.loopback import is_loopback

NEW = "new"
"""In place of a token: one is made up, and told once."""
_SHORTEST = 12
"""Letters of a token that keeps others out."""
_EVERYWHERE = ("0.0.0.0", "::")


def told_to_stop() -> threading.Event:
    """Is set when the process is told to stop."""
    stop = threading.Event()
    # Set anew because a shell may have told its background jobs to ignore Ctrl+C.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    return stop


def names_of(address: str, more: Sequence[str]) -> tuple[str, ...]:
    """Under which names a machine may be asked, beside those of loopback.

    Args:
        address: Where it listens.
        more: Further names.
    """
    is_name = not (is_loopback(address) or address in _EVERYWHERE)
    return (*((address,) if is_name else ()), *more)


def key_of(told: str, option: str) -> str:
    """A token: as it is told, or made up.

    Raises:
        ConfigError: It is too short to keep anybody out.
    """
    if told == NEW:
        return secrets.token_urlsafe(24)
    if told and (len(told) < _SHORTEST or not told.isascii() or not told.isprintable()):
        raise ConfigError(
            f"{option}: use at least {_SHORTEST} letters, digits and signs; or {NEW}, to have one "
            "made up."
        )
    return told
