"""The exit codes of the command line: what a script may rest on."""

from __future__ import annotations

from enum import IntEnum


class Exit(IntEnum):
    """How a command ended; `MEANING` says what each is."""

    DONE = 0
    NO = 1
    WRONG = 2
    FAULT = 70
    STOPPED = 130


MEANING = {
    Exit.DONE: "done; an episode was scored, whatever its score",
    Exit.NO: "unscored, not sound, not the same or not reachable; or the world failed",
    Exit.WRONG: "a setting, a file or a folder is wrong; nothing was lost",
    Exit.FAULT: "a fault in ADAMO itself",
    Exit.STOPPED: "stopped with Ctrl+C; the run folder holds what happened so far",
}
"""The one table of what the codes mean, for help and documentation."""


def listed() -> str:
    """The table as text for the help."""
    told = "; ".join(f"{code.value} {said}" for code, said in MEANING.items())
    return f"Exit codes: {told}."
