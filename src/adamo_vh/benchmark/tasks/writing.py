"""A task as the text of a task file; reading it gives the same task."""

from __future__ import annotations

import json
from collections.abc import Sequence

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
from adamo_vh.benchmark.tasks.task import Task

_WIDTH = 100


def task_text(task: Task) -> str:
    """A task as TOML."""
    lines = [
        f"id = {_text(task.id)}",
        f"prompt = {_text(task.prompt)}",
        f"family = {_text(task.family)}",
        f"units = {_list([_text(unit) for unit in task.units])}",
    ]
    if task.printed != task.computed:
        level = task.printed
        figures = f"act = {level.act}, ref = {level.ref}, rel = {level.rel}, total = {level.total}"
        lines.append(f"printed = {{ {figures} }}")
    if task.scenes:
        lines.append(f"scenes = {_list([_text(name) for name in task.scenes])}")
    lines.append(f"conditions = {_list([_condition(c) for c in task.conditions])}")
    if task.oracle:
        lines.append(f"oracle = {_list([_condition(c) for c in task.oracle])}")
    return "\n".join(lines) + "\n"


def _condition(condition: Condition) -> str:
    match condition:
        case Holds(id=item) | OnFloor(id=item) | Stays(id=item):
            inner = str(item)
        case On(id=item, surface=surface):
            inner = f"{{ object = {item}, surface = {_text(surface)} }}"
        case Near(id=item, anchor=anchor) | Beside(id=item, anchor=anchor):
            inner = f"{{ object = {item}, anchor = {anchor} }}"
        case InArea(id=item, kind=kind):
            inner = f"{{ object = {item}, area = {_text(kind)} }}"
        case NothingElseMoved():
            inner = "true"
        case And(parts=parts) | Or(parts=parts) | Ordered(parts=parts):
            inner = f"[{', '.join(map(_condition, parts))}]"
        case Not(part=part) | Once(part=part):
            inner = _condition(part)
    key = f"{condition.side}_of" if isinstance(condition, Beside) else condition.type
    return f"{{ {key} = {inner} }}"


def _list(items: Sequence[str]) -> str:
    line = f"[{', '.join(items)}]"
    if len(line) <= _WIDTH - len("conditions = ") and "{" not in line:
        return line
    return "[\n" + "".join(f"  {item},\n" for item in items) + "]"


def _text(text: str) -> str:
    """A text in quotes: JSON's escapes are TOML's too."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
