"""Task files: what they may hold, how they are read, and what is wrong with them.

A file is untrusted data: every field is checked, counts, lengths and depths are limited.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from adamo_vh.benchmark.conditions import (
    And,
    Beside,
    Condition,
    Holds,
    InArea,
    Near,
    Not,
    NothingElseMoved,
    On,
    Once,
    OnFloor,
    Or,
    Ordered,
    Stays,
)
from adamo_vh.benchmark.tasks.task import Family, Task
from adamo_vh.benchmark.taxonomy import Act, Difficulty, Ref, Rel, Unit
from adamo_vh.errors import ConfigError, FileError
from adamo_vh.files import parse_toml, read_text
from adamo_vh.readable import readable

MOST_CONDITIONS = 60
"""Atomic conditions of a task: as many as an episode has steps."""
_DEEPEST = 6
"""Conditions inside each other."""
_FIELDS = ("id", "prompt", "family", "units", "printed", "scenes", "conditions", "oracle")
_UNITS: Mapping[str, Unit] = {unit.value: unit for kind in (Act, Ref, Rel) for unit in kind}
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9 _/.-]{0,99}")
_ID = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,39}")
_T = TypeVar("_T")


def read_task(path: str | Path) -> Task:
    """Read a task file.

    Raises:
        FileError: It cannot be read, or is no valid TOML; names the line.
        ConfigError: A field is missing or wrong; names the field and the fix.
    """
    return parse_task(read_text(path), str(path))


def parse_task(text: str, source: str) -> Task:
    """Parse the text of a task file.

    Args:
        text: TOML.
        source: Its file, for messages.

    Raises:
        FileError: It is no valid TOML; names the line.
        ConfigError: A field is missing or wrong; names the field and the fix.
    """
    try:
        return _task(parse_toml(text, source))
    except _WrongError as error:
        raise ConfigError(f"{source}: {error}") from None
    except RecursionError:
        raise FileError(f"{source}: too much inside each other; make it flatter.") from None


class _WrongError(Exception):
    """A field is wrong: where, and what."""


def _wrong(where: str, problem: str) -> NoReturn:
    raise _WrongError(f"{where}: {problem}.")


def _task(data: Mapping[str, Any]) -> Task:
    _only(data, _FIELDS, "")
    units = tuple(_list(data, "units", _unit, most=200))
    conditions = tuple(_list(data, "conditions", _condition, most=MOST_CONDITIONS))
    oracle = tuple(_list(data, "oracle", _condition, most=MOST_CONDITIONS, optional=True))
    read = Task(
        id=_text(_needed(data, "id"), "id", _ID),
        prompt=_prompt(_needed(data, "prompt")),
        family=_family(data.get("family"), conditions),
        units=units,
        printed=_printed(data["printed"]) if "printed" in data else Difficulty.of(units),
        conditions=conditions,
        scenes=tuple(_list(data, "scenes", _scene, most=50, optional=True)),
        oracle=oracle,
    )
    but = tuple(sorted(read.targets))
    return replace(
        read,
        conditions=tuple(_told(condition, but) for condition in conditions),
        oracle=tuple(_told(condition, but) for condition in oracle),
    )


def _prompt(value: Any) -> str:
    if not isinstance(value, str):
        _wrong("prompt", f"must be a text, not {_shown(value)}; put it into quotes")
    if not value.strip() or len(value) > 2000:
        _wrong("prompt", "has no letters, or more than 2000; say in a sentence what to do")
    if readable(value) != value:
        _wrong("prompt", "holds control characters; write it on one line")
    return value


def _family(value: Any, conditions: tuple[Condition, ...]) -> Family:
    if value is None:
        moved = frozenset().union(*(condition.moves for condition in conditions))
        return Family.SEVERAL if len(moved) > 1 else Family.SINGLE
    try:
        return Family(value)
    except ValueError:
        _wrong("family", f"there is no family {_shown(value)}; use one of {_listed(Family)}")


def _unit(value: Any, where: str) -> Unit:
    unit = _UNITS.get(value) if isinstance(value, str) else None
    if unit is None:
        _wrong(where, f"there is no unit {_shown(value)}; use one of {_listed(_UNITS)}")
    return unit


def _printed(value: Any) -> Difficulty:
    parts = ("act", "ref", "rel", "total")
    table = _table(value, parts, "printed")
    return Difficulty(*(_number(table[part], f"printed.{part}", 1000) for part in parts))


def _scene(value: Any, where: str) -> str:
    return _text(value, where, _NAME)


# --- conditions -------------------------------------------------------------------------------


def _condition(value: Any, where: str, depth: int = 1) -> Condition:
    """A condition: a table with one key, which says of which kind it is."""
    if depth > _DEEPEST:
        _wrong(where, f"more than {_DEEPEST} conditions inside each other; make it flatter")
    if not isinstance(value, dict) or len(value) != 1:
        _wrong(where, f"must be a table with one key ({_listed(_KINDS)}), not {_shown(value)}")
    ((kind, inner),) = value.items()
    if kind not in _KINDS:
        _wrong(where, f"there is no condition {_shown(kind)}; use one of {_listed(_KINDS)}")
    return _KINDS[kind](inner, f"{where}.{kind}", depth)


def _parts(value: Any, where: str, depth: int) -> tuple[Condition, ...]:
    if not isinstance(value, list) or not 2 <= len(value) <= MOST_CONDITIONS:
        _wrong(where, f"must be a list of 2 to {MOST_CONDITIONS} conditions, not {_shown(value)}")
    return tuple(_condition(v, f"{where}[{i}]", depth + 1) for i, v in enumerate(value))


def _inner(value: Any, where: str, depth: int) -> Condition:
    return _condition(value, where, depth + 1)


def _on(value: Any, where: str, depth: int) -> Condition:
    table = _table(value, ("object", "surface"), where)
    return On(_object(table, "object", where), _named(table, "surface", where))


def _near(value: Any, where: str, depth: int) -> Condition:
    return Near(*_pair(value, where))


def _in_area(value: Any, where: str, depth: int) -> Condition:
    table = _table(value, ("object", "area"), where)
    return InArea(_object(table, "object", where), _named(table, "area", where))


def _nothing_else(value: Any, where: str, depth: int) -> Condition:
    if value is not True:
        _wrong(where, f"must be true, not {_shown(value)}; leave it out if other things may move")
    return NothingElseMoved(())


_KINDS: Mapping[str, Callable[[Any, str, int], Condition]] = {
    "holds": lambda value, where, _: Holds(_number(value, where)),
    "on_floor": lambda value, where, _: OnFloor(_number(value, where)),
    "on": _on,
    "near": _near,
    "in_area": _in_area,
    "left_of": lambda value, where, _: Beside(*_pair(value, where), "left"),
    "right_of": lambda value, where, _: Beside(*_pair(value, where), "right"),
    "stays": lambda value, where, _: Stays(_number(value, where)),
    "nothing_else_moved": _nothing_else,
    "and": lambda value, where, depth: And(_parts(value, where, depth)),
    "or": lambda value, where, depth: Or(_parts(value, where, depth)),
    "not": lambda value, where, depth: Not(_inner(value, where, depth)),
    "once": lambda value, where, depth: Once(_inner(value, where, depth)),
    "ordered": lambda value, where, depth: Ordered(_parts(value, where, depth)),
}
"""How the value of each kind of condition is read: from it, its field, and how deep it lies."""


def _told(condition: Condition, but: tuple[int, ...]) -> Condition:
    """A condition that knows which objects the task moves."""
    match condition:
        case NothingElseMoved():
            return NothingElseMoved(but)
        case And(parts=parts) | Or(parts=parts) | Ordered(parts=parts):
            return replace(condition, parts=tuple(_told(part, but) for part in parts))
        case Not(part=part) | Once(part=part):
            return replace(condition, part=_told(part, but))
        case _:
            return condition


def _pair(value: Any, where: str) -> tuple[int, int]:
    table = _table(value, ("object", "anchor"), where)
    item, anchor = _object(table, "object", where), _object(table, "anchor", where)
    if item == anchor:
        _wrong(f"{where}.anchor", f"{anchor} is the object itself; name another one")
    return item, anchor


# --- values -----------------------------------------------------------------------------------


def _needed(data: Mapping[str, Any], field: str) -> Any:
    if field not in data:
        _wrong(field, "is missing; add it")
    return data[field]


def _only(data: Mapping[str, Any], fields: tuple[str, ...], where: str) -> None:
    for field in data:
        if field not in fields:
            name = f"{where}.{_brief(field)}".lstrip(".")
            _wrong(name, f"there is no such field; use {_listed(fields)}")


def _list(
    data: Mapping[str, Any],
    field: str,
    read: Callable[[Any, str], _T],
    *,
    most: int,
    optional: bool = False,
) -> Iterator[_T]:
    values = data.get(field, []) if optional else _needed(data, field)
    if not isinstance(values, list):
        _wrong(field, f"must be a list, not {_shown(values)}; put it into brackets")
    if not (optional or values):
        _wrong(field, "is empty; give at least 1")
    if len(values) > most:
        _wrong(field, f"has {len(values)} entries; use at most {most}")
    for i, value in enumerate(values):
        yield read(value, f"{field}[{i}]")


def _table(value: Any, fields: tuple[str, ...], where: str) -> Mapping[str, Any]:
    if not isinstance(value, dict):
        form = ", ".join(f"{field} = ..." for field in fields)
        _wrong(where, f"must be a table {{{form}}}, not {_shown(value)}")
    _only(value, fields, where)
    for field in fields:
        if field not in value:
            _wrong(f"{where}.{field}", "is missing; add it")
    return value


def _object(table: Mapping[str, Any], field: str, where: str) -> int:
    return _number(table[field], f"{where}.{field}")


def _named(table: Mapping[str, Any], field: str, where: str) -> str:
    return _text(table[field], f"{where}.{field}", _NAME)


def _number(value: Any, where: str, most: int = 9999) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        _wrong(where, f"must be a whole number, not {_shown(value)}; write it without quotes")
    if not 0 <= value <= most:
        _wrong(where, f"{_shown(value)} is out of range; use 0 to {most}")
    return value


def _text(value: Any, where: str, form: re.Pattern[str]) -> str:
    if not isinstance(value, str):
        _wrong(where, f"must be a text, not {_shown(value)}; put it into quotes")
    if form.fullmatch(value) is None:
        _wrong(where, f"{_shown(value)} is no name; use letters and digits, a few words at most")
    return value


def _shown(value: Any) -> str:
    """A value as the file spells it, in brief."""
    return _brief(json.dumps(value, ensure_ascii=False, default=str))


def _brief(text: str) -> str:
    text = readable(text)
    return text if len(text) <= 60 else f"{text[:60]}..."


def _listed(names: Any) -> str:
    return ", ".join(map(str, names))
