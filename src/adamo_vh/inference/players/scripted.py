"""A model that answers from a list: for tests, demonstrations and replays."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.errors import ConfigError, FileError
from adamo_vh.files import read_json
from adamo_vh.inference.messages import AIMessage, Message, ToolCall
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling

FINISHED = "The script is finished."
"""Final answer after the last reply of a script."""

_KEYS = frozenset({"tool", "args", "note"})
_USAGE = 'e.g. {"tool": "Pick", "args": {"object": "Plate_57"}, "note": "I see the plate."}'


class ScriptedModel:
    """Answers with given messages in their order, whatever it is asked.

    With `ModelKind.REPLAY` and the messages of a recorded episode it is the model of a replay.
    """

    def __init__(
        self, name: str, replies: Sequence[AIMessage], kind: ModelKind = ModelKind.SCRIPTED
    ) -> None:
        """Take the replies.

        Args:
            name: As in the URI that made it.
            replies: What to answer, in order; after the last one comes a final answer.
            kind: `SCRIPTED`, or `REPLAY` if the replies were recorded.
        """
        self._name = name
        self._kind = kind
        self._replies = tuple(replies)
        self._next = 0

    @property
    def info(self) -> ModelInfo:
        """Scripted or replay."""
        return ModelInfo(self._name, self._kind)

    def skip(self, count: int) -> None:
        """Leave out the next replies: they were given before an interruption."""
        self._next += count

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Give the next reply; the arguments play no part."""
        if self._next >= len(self._replies):
            return Reply(AIMessage(FINISHED))
        self._next += 1
        return Reply(self._replies[self._next - 1])


def load_script(path: str | Path) -> tuple[AIMessage, ...]:
    """Read the replies of a script file.

    The file is a JSON list of ``{"tool": ..., "args": {...}, "note": ...}``. The note is optional;
    an entry with a note alone is a final answer.

    Args:
        path: The JSON file.

    Returns:
        One message an entry, with call ids ``call_1``, ``call_2``, ...

    Raises:
        ConfigError: The file is missing or wrong: names the file, the entry and the fix.
    """
    try:
        entries = read_json(path)
    except FileError as error:
        raise ConfigError(f"Script {error}") from error
    if not isinstance(entries, list):
        raise ConfigError(f"Script {path} must be a JSON list of entries, {_USAGE}.")
    return read_script(entries, f"Script {path}")


def read_script(entries: Sequence[Any], where: str) -> tuple[AIMessage, ...]:
    """Read the replies of a script that is at hand as data.

    Args:
        entries: As in the list of a script file; see `load_script`.
        where: Begins what is said of a wrong one.

    Raises:
        ConfigError: An entry is wrong: names it and the fix.
    """
    return tuple(
        _reply(entry, f"{where}, entry {number}", number)
        for number, entry in enumerate(entries, start=1)
    )


def _reply(entry: Any, where: str, number: int) -> AIMessage:
    if not isinstance(entry, dict):
        raise ConfigError(f"{where}: must be an object, {_USAGE}.")
    if unknown := sorted(entry.keys() - _KEYS):
        raise ConfigError(f"{where}: unknown key {unknown[0]!r}; use tool, args and note.")
    note, tool, args = entry.get("note", ""), entry.get("tool"), entry.get("args")
    if not isinstance(note, str):
        raise ConfigError(f'{where}: "note" must be a text, {_USAGE}.')
    if tool is None:
        if args is not None or not note:
            raise ConfigError(f'{where}: give a "tool", or a "note" alone as the final answer.')
        return AIMessage(note)
    if not isinstance(tool, str) or not tool:
        raise ConfigError(f'{where}: "tool" must be the name of a tool, {_USAGE}.')
    if not isinstance(args, dict):
        raise ConfigError(f'{where}: "args" must be an object, {_USAGE}.')
    raw = json.dumps(args, ensure_ascii=False)
    return AIMessage(note, (ToolCall(f"call_{number}", tool, args, raw),))
