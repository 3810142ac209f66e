"""Cassettes: record what a model was asked and answered, and run it again without the model.

A cassette is a folder: ``cassette.json`` says whose answers they are, ``calls.jsonl`` holds one
call a line, each written at once, so that a kill loses at most the line in flight.
"""

from __future__ import annotations

import difflib
import itertools
import json
from collections.abc import Sequence
from itertools import zip_longest
from pathlib import Path

from pydantic import ValidationError

from adamo_vh.action import ToolSchema
from adamo_vh.errors import CassetteError, FileError, RecordError
from adamo_vh.files import append_line, read_json, write_whole
from adamo_vh.inference.messages import Message
from adamo_vh.inference.model import Model, ModelInfo, ModelKind, Reply, Sampling
from adamo_vh.inference.players.calls import Call, Request, clean_reply, codec, request_of, sections
from adamo_vh.inference.players.wrapper import Ask, Wrapped
from adamo_vh.readable import encodable

LABEL, CALLS = "cassette.json", "calls.jsonl"
FOLDER = "cassette"
"""Folder of the cassette within a run folder."""
_VERSION = 1
_DIFF_LINES = 40
_FIX = (
    "Give the settings of the recording (profile, labeling, k, ...), undo the change, or record "
    "it again."
)


def taped(model: Model, folder: str | Path, *, known: int | None = None) -> Model:
    """A model whose every call is written into a folder.

    Keys are blacked out, and pictures are stored as hash and size.

    Args:
        model: Who answers.
        folder: Is made if it is missing.
        known: Go on with the cassette that is there, behind so many calls; a later one, whose
            answer was lost to a kill, is taken off and will be asked for again.

    Raises:
        RecordError: The folder holds calls already; or, when it is resumed, calls of another
            model or too few.
    """
    path, numbers = Path(folder) / CALLS, itertools.count((known or 0) + 1)
    first: bytes | None = None
    if known is not None and path.exists():
        first = _first(path, known, model.info)
    elif known:
        raise RecordError(f"{folder} holds no cassette to go on with.")
    else:
        _begin(path, model.info)

    def write(
        ask: Ask, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        reply = ask(messages, tools, sampling)
        call = Call(next(numbers), request_of(messages, tools, sampling), clean_reply(reply))
        nonlocal first
        if first is not None:
            # Only now is it sure that the episode goes on where it was left.
            write_whole(path, first)
            first = None
        append_line(path, codec().dump_json(call))
        return reply

    return Wrapped(model, write)


def _begin(path: Path, who: ModelInfo) -> None:
    """A new cassette."""
    folder = path.parent
    if path.exists():
        raise RecordError(f"{folder} already holds a cassette; choose another folder.")
    label = {"version": _VERSION, "model": who.name, "kind": who.kind}
    write_whole(folder / LABEL, json.dumps(label).encode() + b"\n")


def _first(path: Path, count: int, who: ModelInfo) -> bytes:
    """The first calls of a cassette."""
    folder = path.parent
    name, kind = _read_label(folder)
    if (name, kind) != (who.name, who.kind):
        raise RecordError(
            f"{folder} is a cassette of {name}, not of {who.name}; go on with that model."
        )
    lines = _whole_lines(path).splitlines(keepends=True)
    if len(lines) < count:
        raise RecordError(
            f"{folder} holds {len(lines)} calls, and {count} were answered. Delete it to go "
            "on without a recording."
        )
    return b"".join(lines[:count])


class Cassette:
    """A model that gives recorded answers, if it is asked what was asked then."""

    def __init__(self, folder: str | Path) -> None:
        """Read a cassette.

        Args:
            folder: The cassette, or a run folder with one in it.

        Raises:
            RecordError: It is missing, damaged or of another version.
        """
        inner = Path(folder) / FOLDER
        self._folder = inner if inner.is_dir() else Path(folder)
        self._model, self._kind = _read_label(self._folder)
        self._calls = _read_calls(self._folder)
        self._next = 0

    @property
    def info(self) -> ModelInfo:
        """Kind and rung of the recorded model, under the name of the cassette."""
        rung = self._calls[0].reply.rung if self._calls else None
        return ModelInfo(f"cassette:{self._folder}", self._kind, rung)

    @property
    def model(self) -> str:
        """Name of the model that was recorded."""
        return self._model

    def __len__(self) -> int:
        """How many calls it holds."""
        return len(self._calls)

    def skip(self, count: int) -> None:
        """Leave out the next calls: they were answered before an interruption."""
        self._next += count

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Give the next recorded reply.

        Raises:
            CassetteError: The prompt, the tools or the settings are not those of the recording, or
                there are no more calls.
        """
        if self._next >= len(self._calls):
            raise CassetteError(
                f"{self.info.name} has {len(self._calls)} calls, and call {self._next + 1} is "
                "asked for. The episode went on longer than when it was recorded; record it again."
            )
        call = self._calls[self._next]
        # A key may be in the environment of only one of the two machines.
        asked = request_of(messages, tools, sampling)
        if sections(asked) != sections(call.request):
            plain = request_of(messages, tools, sampling, clean=encodable)
            if sections(plain) != sections(call.request):
                raise CassetteError(f"{self.info.name}, {_difference(call, asked)}")
        self._next += 1
        return call.reply


def _difference(call: Call, asked: Request) -> str:
    """Where a request first leaves the recorded one, and how."""
    then, now = sections(call.request), sections(asked)
    for old, new in zip_longest(then, now):
        if old == new:
            continue
        title = (old or new)[0]
        if new is None:
            what = f"{title} was recorded and is missing now"
        elif old is None:
            what = f"{title} is new"
        elif old[0] != new[0]:
            what = f"{new[0]} is asked where {old[0]} was recorded"
        else:
            what = f"{title} differs"
        break
    counts = f"{len(call.request.messages)} messages recorded, {len(asked.messages)} asked"
    lines = list(
        difflib.unified_diff(
            old[1].splitlines() if old else [],
            new[1].splitlines() if new else [],
            "recorded",
            "asked now",
            lineterm="",
            n=2,
        )
    )
    if len(lines) > _DIFF_LINES:
        left_out = len(lines) - _DIFF_LINES
        lines = [*lines[:_DIFF_LINES], f"... {left_out} more lines"]
    head = f"call {call.number}: {what} ({counts}). {_FIX}"
    return "\n".join([head, *lines])


def _read_label(folder: Path) -> tuple[str, ModelKind]:
    path = folder / LABEL
    try:
        label = read_json(path)
    except FileError as error:
        if path.exists():
            raise RecordError(f"{error} The cassette is damaged; record it again.") from None
        raise RecordError(
            f"{folder} is no cassette: {LABEL} is missing. `adamo-vh run --record` makes one."
        ) from None
    if not isinstance(label, dict) or label.get("version") != _VERSION:
        raise RecordError(f"{path} is not of version {_VERSION}; record the cassette again.")
    try:
        return str(label["model"]), ModelKind(label["kind"])
    except (KeyError, ValueError) as error:
        raise RecordError(f"{path} is damaged: {error}.") from None


def _whole_lines(path: Path) -> bytes:
    """The file without what a kill left of a line that was being written."""
    content = path.read_bytes()
    return content[: content.rfind(b"\n") + 1]


def _read_calls(folder: Path) -> tuple[Call, ...]:
    path = folder / CALLS
    if not path.is_file():
        return ()
    calls: list[Call] = []
    for number, line in enumerate(_whole_lines(path).split(b"\n")[:-1], start=1):
        try:
            calls.append(codec().validate_json(line))
        except ValidationError as error:
            problem = error.errors()[0]["msg"]
            raise RecordError(f"{path}, line {number} is damaged: {problem}.") from None
    return tuple(calls)
