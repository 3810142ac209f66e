"""How models write a call into their text: the shapes and syntaxes of many families.

Two things are told apart: a mark, which stands for nothing but a call (``<tool_call>``,
``[TOOL_CALLS]``, ``<|python_tag|>``, ...), and what is written behind it: JSON, a name with the
JSON of its arguments, XML, or Python. Each reader begins at a position and says where it ended.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.inference.arguments import dump_arguments, read_arguments
from adamo_vh.inference.json_scan import JsonScan, whole_json
from adamo_vh.inference.tool_names import NAMESPACE, meant_tool

NAME_KEYS = (
    "name", "tool", "tool_name", "function", "function_name", "action", "recipient_name",
)  # fmt: skip
"""Keys under which models write the name of a tool."""
_ARGUMENT_KEYS = (
    "arguments", "parameters", "args", "params", "kwargs", "input", "tool_input", "action_input",
)  # fmt: skip
_LISTS = ("tool_calls", "tool_call", "function_call", "function_calls", "calls", "action")
_BESIDE = frozenset(
    {"id", "type", "call_id", "tool_call_id", "index", "content", "role", "thought", "note"}
)
_PRINT = "print("
_BLANKS = re.compile(r"\s*+")
_BRACKETS = {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}
_LONGEST_PYTHON = 2000
_EFFORT = 50_000
"""Letters of Python that are looked at in one text, at most."""

MARK = re.compile(
    r"</?[|｜]?/?[\w▁:.|｜-]{0,30}?(?:tools?[_▁-]?(?:call|use|sep|code|name|input|arg|param|output"
    r"|response|result|prefix|suffix)|func(?!tion=)|python_|plugin|invoke|parameter"
    r"|arg_(?:key|value)|use_tool|action_(?:start|end))[\w▁:.|｜-]{0,30}/?>|</?tools?>|</?call>"
    r"|\bfunction\s?<[|｜]tool[▁_]sep[|｜]>"
    r"|\[/?(?:TOOL_?CALLS?|FUNCTION_?CALLS?|ARGS)\]|\[CALL_ID\]\w{1,40}"
    r"|\bfunctools(?=\[)|\bto=(?=functions\.)",
    re.IGNORECASE,
)
"""Stands for nothing but a call."""
_SKIP = rf"(?:\s|```[\w+-]*|{MARK.pattern}|<\|(?:im_end|end|eom_id|eot_id)\|>)"
GAP = re.compile(rf"{_SKIP}*+", re.IGNORECASE)
"""Marks, code fences and blanks in a row."""
_BEFORE_ARGUMENTS = re.compile(rf"(?:{_SKIP}|:\d+|\bjson\b|\(\))*+(?=\{{)", re.IGNORECASE)
_NAME = re.compile(rf"(?:call:)?(?:{NAMESPACE})?[A-Za-z_][\w.-]{{0,80}}")
_SPACE = r"(?:[\w|｜]{1,12}[:｜|])?"
OPENING = re.compile(
    rf"<{_SPACE}(?:function|invoke|tool)(?:=|\s{{1,5}}name\s?=\s?)"
    r"[\"']?(?P<name>[^\"'<>\s]{1,80})[\"']?\s?>",
    re.IGNORECASE,
)
"""A call in XML, with its name."""
_FIELD = re.compile(
    rf"\s*+<{_SPACE}parameter(?:=|\s{{1,5}}name\s?=\s?)"
    r"[\"']?(?P<key>[^\"'<>\s]{1,80})[\"']?[^<>]{0,60}>",
    re.IGNORECASE,
)
_PAIR = re.compile(r"\s*+<arg_key>\s{0,9}(?P<key>[^<>\s]{1,80})\s{0,9}</arg_key>\s*+<arg_value>")
_FIELD_END = re.compile(
    rf"<(?P<close>/?){_SPACE}(?:parameter|arg_value|arg_key|function|invoke|tool)\b"
)
_CLOSED = re.compile(rf"\s*+</{_SPACE}(?:function|invoke|tool\w{{0,9}})\s?>", re.IGNORECASE)
_REACT = re.compile(
    r"Action\s{0,3}:\s{0,9}(?P<name>[\w.-]{1,80})\s*+Action[ _]?Input\s{0,3}:\s*+(?:```\w*\s*+)?",
    re.IGNORECASE,
)


@dataclass(frozen=True, slots=True)
class WrittenCall:
    """A call as it stands in a text."""

    name: str
    """The tool on offer, or the name as it is written if it means none."""
    arguments: Mapping[str, Any]
    is_known: bool


_Read = tuple[int, list[WrittenCall]]
"""Where calls end, and what they are."""


class Syntax:
    """Reads calls out of one text."""

    def __init__(self, text: str, tools: Sequence[ToolSchema]) -> None:
        """Know the text and the tools on offer."""
        self._text = text
        self._tools = {tool.name: tool for tool in tools}
        self._scan = JsonScan(text)
        self._effort = _EFFORT

    def at(self, position: int) -> _Read | None:
        """The calls that begin at a position, and where they end; None if there are none."""
        text = self._text
        if text.startswith(("{", "["), position):
            return self._json(position) or self._python_list(position)
        if opening := OPENING.match(text, position):
            return self._xml(opening)
        if react := _REACT.match(text, position):
            return self._named(react["name"], react.end())
        begin = position + len(_PRINT) if text.startswith(_PRINT, position) else position
        if (name := _NAME.match(text, begin)) is None:
            return None
        if text.startswith("(", name.end()) and (found := self._python(begin)):
            end, call = found
            return end + (begin != position and text.startswith(")", end)), [call]
        return self._fields(name[0], name.end(), _PAIR) or self._named(name[0], name.end())

    def of_value(self, value: Any) -> list[WrittenCall]:
        """The calls that a JSON value stands for; empty if it is none, or not all of it is."""
        if isinstance(value, list):
            calls = [self.of_value(item) for item in value]
            return [call for some in calls for call in some] if all(calls) else []
        if not isinstance(value, dict):
            return []
        keys = value.keys() - _BESIDE
        if len(keys) == 1:
            (key,) = keys
            inner = value[key]
            if key in _LISTS or (key == "function" and isinstance(inner, dict)):
                return self.of_value(inner)
            if isinstance(inner, dict) and meant_tool(key, self._tools):
                return self._call(key, inner)
        names, given = keys & {*NAME_KEYS}, keys & {*_ARGUMENT_KEYS}
        if len(keys) != 2 or len(names) != 1 or len(given) != 1:
            return []
        name, arguments = value[names.pop()], value[given.pop()]
        return self._call(name, arguments) if isinstance(name, str) else []

    def _json(self, position: int) -> _Read | None:
        found = self._scan.at(position)
        calls = self.of_value(found[0]) if found else []
        return (found[1], calls) if found and calls else None

    def _named(self, name: str, position: int) -> _Read | None:
        """A name with the JSON of its arguments behind it."""
        gap = _BEFORE_ARGUMENTS.match(self._text, position)
        found = self._scan.at(gap.end()) if gap else None
        calls = self._call(name, found[0]) if found else []
        return (found[1], calls) if found and calls else None

    def _xml(self, opening: re.Match[str]) -> _Read | None:
        name, begin = opening["name"], opening.end()
        if closed := _CLOSED.match(self._text, begin):
            return closed.end(), self._call(name, {})
        return self._named(name, begin) or self._fields(name, begin, _FIELD)

    def _fields(self, name: str, position: int, field: re.Pattern[str]) -> _Read | None:
        """A call whose arguments stand in tags of their own, each of which must be closed."""
        text, written = self._text, dict[str, str]()
        while begin := field.match(text, position):
            end = _FIELD_END.search(text, begin.end())
            if end is None or not end["close"] or begin["key"] in written:
                return None
            written[begin["key"]] = text[begin.end() : end.start()].strip()
            position = text.find(">", end.end()) + 1 or len(text)
        fields = self._fields_of(name)
        values = {key: _typed(value, fields.get(key, {})) for key, value in written.items()}
        return (position, self._call(name, values)) if written else None

    def _python_list(self, position: int) -> _Read | None:
        calls: list[WrittenCall] = []
        position = self._behind_blanks(position + 1)
        while found := self._python(position):
            calls.append(found[1])
            position = self._behind_blanks(found[0])
            if self._text.startswith("]", position):
                return position + 1, calls
            if not self._text.startswith(",", position):
                return None
            position = self._behind_blanks(position + 1)
        return None

    def _python(self, position: int) -> tuple[int, WrittenCall] | None:
        name = _NAME.match(self._text, position)
        if name is None or not self._text.startswith("(", name.end()):
            return None
        end = self._closing(name.end())
        if end is None:
            return None
        arguments = self._python_arguments(name[0], self._text[name.end() : end])
        calls = [] if arguments is None else self._call(name[0], arguments)
        return (end, calls[0]) if calls else None

    def _python_arguments(self, name: str, written: str) -> dict[str, Any] | None:
        try:
            call = ast.parse(f"f{written}", mode="eval").body
            if not isinstance(call, ast.Call) or any(word.arg is None for word in call.keywords):
                return None
            given = {str(word.arg): _constant(word.value) for word in call.keywords}
            placed = [_constant(value) for value in call.args]
        except (SyntaxError, ValueError, RecursionError, MemoryError, TypeError):
            return None
        fields = [*self._fields_of(name)]
        if len(placed) == 1 and not given and isinstance(placed[0], dict):
            return {str(key): value for key, value in placed[0].items()}
        if len(placed) > len(fields) or {*fields[: len(placed)]} & given.keys():
            return None
        return {**dict(zip(fields, placed, strict=False)), **given}

    def _closing(self, position: int) -> int | None:
        """Where the bracket that opens at a position is closed, behind it."""
        depth, quote, start = 0, "", position
        end = min(len(self._text), position + _LONGEST_PYTHON, position + self._effort)
        while position < end:
            letter = self._text[position]
            position += 1
            if quote:
                position += letter == "\\"
                quote = "" if letter == quote else quote
            elif letter in "\"'":
                quote = letter
            elif letter in _BRACKETS:
                depth += _BRACKETS[letter]
                if depth == 0:
                    break
        self._effort -= position - start
        return position if depth == 0 else None

    def _behind_blanks(self, position: int) -> int:
        blanks = _BLANKS.match(self._text, position)
        return blanks.end() if blanks else position

    def _fields_of(self, name: str) -> Mapping[str, Any]:
        """The arguments of a tool with their schemas; none if there is no such tool."""
        tool = self._tools.get(meant_tool(name, self._tools) or "")
        found: Mapping[str, Any] = tool.parameters.get("properties", {}) if tool else {}
        return found

    def _call(self, name: str, arguments: Any) -> list[WrittenCall]:
        """A list of one call; empty if its arguments are no arguments."""
        if arguments is None:
            arguments = {}
        if isinstance(arguments, dict):
            arguments = dump_arguments(arguments)
        readable = read_arguments(arguments) if isinstance(arguments, str) else None
        if readable is None:
            return []
        meant = meant_tool(name.removeprefix("call:"), self._tools)
        return [WrittenCall(meant or name, readable, meant is not None)]


def suspicious(tools: Sequence[ToolSchema]) -> re.Pattern[str]:
    """Finds what looks like part of a call of one of some tools, however it is spoilt."""
    names = "|".join(re.escape(tool.name) for tool in tools) or r"(?!)"
    keys = "|".join(NAME_KEYS)
    known = {re.escape(key) for tool in tools for key in tool.parameters.get("properties", {})}
    fields = "|".join(sorted(known)) or r"(?!)"
    return re.compile(
        rf"[\"'](?:{names})[\"']\s{{0,9}}:\s{{0,9}}[\"'\d{{\[]"
        rf"|[\"'](?:{keys})[\"']\s{{0,9}}:\s{{0,9}}[\"'](?:{NAMESPACE})?(?:{names})[\"']"
        rf"|\b(?:{names})(?:\s?\{{|\((?:\s{{0,9}}\w{{1,40}}\s?=|\s{{0,9}}[\"'\d{{\[-]))"
        rf"|</?(?:{names})\b|<{_SPACE}(?:function|invoke)\b"
        rf"|^[ \t*`]{{0,9}}Action\s{{0,3}}:[ \t*`]{{0,9}}(?:{names})\b"
        rf"|^[ \t*`_-]{{0,9}}(?:{keys}|[a-z]{{0,9}} ?(?:tool|function|call))[ \t*`_]{{0,4}}[:=]"
        rf"[ \t*`_\"']{{0,9}}(?:{NAMESPACE})?(?:{names})[ \t*`_\"',]{{0,9}}$"
        rf"|\b(?:{names})\b[^.!?{{}}]{{0,40}}\{{\s{{0,9}}[\"']?(?:{fields})\b[\"']?\s{{0,9}}:",
        re.IGNORECASE | re.MULTILINE,
    )


def command(tools: Sequence[ToolSchema]) -> re.Pattern[str]:
    """Matches a line that is nothing but a tool's name with tags and numbers behind it.

    Its group ``bullet`` is what makes it an item of a list.
    """
    names = "|".join(re.escape(tool.name) for tool in tools) or r"(?!)"
    known = {re.escape(key) for tool in tools for key in tool.parameters.get("properties", {})}
    key = rf"(?:(?:{'|'.join(sorted(known)) or '(?!)'})\s?[=:]\s?)?"
    tag, number = r"[a-z]\w{0,40}_\d{1,9}", r"(?:[a-z]{1,20} )?[+-]?\d[\d.]{0,20}"
    value = rf"{key}[\"'`#(\[<{{]{{0,3}}(?:{tag}|{number})[\"'`)\]>}}]{{0,3}}"
    between = r"[ \t]{0,3}(?:[,;]|\b(?:at|to|on|and)\b)?[ \t]{0,3}[(\[]?"
    return re.compile(
        r"[ \t]{0,9}(?P<bullet>(?:\d{1,2}[.)]|[-*•])[ \t]{1,3})?"
        rf"(?:[>/!@*`_$ \t]{{0,9}}(?:{NAMESPACE})?(?:{names})\b[*`_]{{0,3}}[ \t]{{0,3}}[:=(\[<{{]?"
        rf"(?:[ \t]{{0,3}}\b(?:at|to))?[ \t]{{0,3}}{value}(?:{between}{value}){{0,5}}"
        r"[ \t.;,*`)\]>}]{0,9}"
        rf"|[>/!@*`$]{{0,3}}(?:{names})[*`() ]{{0,3}})",
        re.IGNORECASE,
    )


def _typed(text: str, schema: Mapping[str, Any]) -> Any:
    """A value that was written without quotes, in the type that its tool wants."""
    if schema.get("type") == "string":
        return text
    value = whole_json(text)
    return text if value is None else value


def _constant(node: ast.expr) -> Any:
    if isinstance(node, ast.Name) and node.id in ("true", "false", "null"):
        return {"true": True, "false": False, "null": None}[node.id]
    return ast.literal_eval(node)
