"""Read a tool call that a model wrote into its text instead of calling the tool.

Servers leave a call in the text when they do not know the model's format, and models fall back to
the formats that they were trained on. A call that is written with its marks, or as JSON or Python
on lines of its own, is read; whatever else looks like a call is said to be one that cannot be
read. So no call is ever taken for a final answer, and no mention of one for a call.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from adamo_vh.action import ToolSchema
from adamo_vh.inference.arguments import dump_arguments
from adamo_vh.inference.call_syntax import (
    GAP,
    MARK,
    OPENING,
    Syntax,
    WrittenCall,
    command,
    suspicious,
)
from adamo_vh.inference.json_scan import JsonScan, whole_json
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.tool_names import NAMESPACE, fresh_id

_BROKEN = "holds a call in its text that is not complete or not well formed."
_INLINE = "holds a call in the middle of its text, so that it is not clear whether it is meant."
_SEVERAL = "holds calls with other text between them, so that it is not clear which is meant."
_NAMELESS = "holds arguments without the name of a tool."
_COMMAND = "holds a line that is written like a command, which calls nothing."
_FENCE = re.compile(r"```[\w+-]*")
_LABEL = re.compile(r"\A\s*+(?:\*\*)?Thought(?:\*\*)?\s?:(?:\*\*)?", re.IGNORECASE)
_LONGEST_NAME = 60


@dataclass(frozen=True, slots=True)
class UnparsedCall:
    """A text that holds a call which cannot be read."""

    problem: str
    """What is wrong, as a sentence without its subject, for the model."""


@dataclass(frozen=True, slots=True)
class _Place:
    """Where calls stand in a text."""

    start: int
    end: int
    calls: tuple[WrittenCall, ...]
    is_marked: bool


def read_calls(
    text: str, tools: Sequence[ToolSchema], taken: Collection[str]
) -> AIMessage | UnparsedCall | None:
    """Read the calls that stand in a text.

    Args:
        text: Text of an answer without a native call, and without reasoning.
        tools: The tools on offer.
        taken: Call ids of the conversation, which the new ids must differ from.

    Returns:
        The calls, with the rest of the text as their note; or that there is one which cannot be
        read; None if there is none.
    """
    places = list(_places(text, tools))
    rest = _rest(text, places)
    calls = [call for place in places for call in place.calls]
    if problem := _problem(text, places, rest, tools):
        return UnparsedCall(problem)
    if not calls:
        return None
    note = "\n".join(line for piece in rest if (line := _as_note(piece)))
    ids: set[str] = {*taken}
    read: list[ToolCall] = []
    seed = fresh_id(text, ())
    for number, call in enumerate(calls):
        call_id = fresh_id(f"{seed} {number}", ids)
        ids.add(call_id)
        read.append(ToolCall(call_id, call.name, call.arguments, dump_arguments(call.arguments)))
    return AIMessage(note, tuple(read))


def _places(text: str, tools: Sequence[ToolSchema]) -> Iterator[_Place]:
    """Where calls stand, from the beginning to the end, with all marks and fences round them."""
    syntax, anchor = Syntax(text, tools), _anchor(tools)
    position = 0
    while found := anchor.search(text, position):
        start, is_mark = found.start(), found["mark"] is not None
        begin = _behind_gap(text, start)
        read = syntax.at(begin) if begin < len(text) else None
        if read is None:
            position = max(begin, start + 1)
            continue
        is_marked = is_mark or OPENING.match(text, begin) is not None
        # A fence or a list of calls goes on with the next one: marks hold for all of them.
        position = _behind_gap(text, read[0])
        yield _Place(start, position, tuple(read[1]), is_marked)


def _anchor(tools: Sequence[ToolSchema]) -> re.Pattern[str]:
    """Where a call may begin."""
    names = "|".join(re.escape(tool.name) for tool in tools) or r"(?!)"
    return re.compile(
        rf"(?P<mark>{MARK.pattern})|{OPENING.pattern}|```|\[(?=\s{{0,9}}[\w{{])|\{{"
        rf"|(?<![\w.])(?:print\()?(?:{NAMESPACE})?(?:{names})\b|\bAction\s?:",
        re.IGNORECASE,
    )


def _behind_gap(text: str, position: int) -> int:
    gap = GAP.match(text, position)
    return gap.end() if gap else position


def _rest(text: str, places: Sequence[_Place]) -> list[str]:
    """What stands before, between and after the calls."""
    ends = [0, *(place.end for place in places)]
    starts = [*(place.start for place in places), len(text)]
    return [text[end:start] for end, start in zip(ends, starts, strict=True)]


def _as_note(piece: str) -> str:
    """A piece of text beside calls as a note; empty if there is no word in it."""
    bare = _LABEL.sub("", _FENCE.sub("", piece)).strip()
    return bare if any(letter.isalnum() for letter in bare) else ""


def _problem(
    text: str, places: Sequence[_Place], rest: Sequence[str], tools: Sequence[ToolSchema]
) -> str:
    """Why the calls of a text cannot be carried out; empty if they can, or if there are none."""
    unknown = [call for place in places for call in place.calls if not call.is_known]
    if unknown:
        name = unknown[0].name[:_LONGEST_NAME]
        return f'holds a call of "{name}" in its text, and there is no such tool.'
    looks_like_call = suspicious(tools)
    if any(MARK.search(piece) or looks_like_call.search(piece) for piece in rest):
        return _BROKEN
    if not places:
        if _is_bare_arguments(text, tools):
            return _NAMELESS
        return _COMMAND if _has_command(text, tools) else ""
    plain = [place for place in places if not place.is_marked]
    if any(not _stands_alone(text, place) for place in plain):
        return _INLINE
    if plain and any(piece.strip(" \n\r\t,;`") for piece in rest[1:-1]):
        return _SEVERAL
    has_more = any(True for piece in rest for _ in JsonScan(piece).objects())
    return _SEVERAL if plain and has_more else ""


def _stands_alone(text: str, place: _Place) -> bool:
    """Whether nothing else is on the lines of a call."""
    before = text[text.rfind("\n", 0, place.start) + 1 : place.start]
    inside = text[place.start : place.end].rstrip()
    if inside.endswith("```") or "\n" in text[place.start + len(inside) : place.end]:
        after = ""
    else:
        line_end = text.find("\n", place.end)
        after = text[place.end : len(text) if line_end < 0 else line_end]
    return not before.strip(" \t>*`-") and not after.strip(" \t.,;`")


def _has_command(text: str, tools: Sequence[ToolSchema]) -> bool:
    """Whether a line is a call without the form of one, or a text is nothing but a list of such."""
    command_line = command(tools)
    found = [command_line.fullmatch(line) for line in text.splitlines() if line.strip()]
    return any(line and not line["bullet"] for line in found) or (bool(found) and all(found))


def _is_bare_arguments(text: str, tools: Sequence[ToolSchema]) -> bool:
    """Whether a text is nothing but a JSON object with arguments of a tool."""
    value = whole_json(_FENCE.sub("", text))
    if not isinstance(value, dict) or not value:
        return False
    return any(value.keys() <= tool.parameters.get("properties", {}).keys() for tool in tools)
