"""What a study varies: how the values of an axis are read, and how a folder's name spells them."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Mapping
from dataclasses import fields
from typing import Any

from adamo_vh.cognition.budget import Budget
from adamo_vh.cognition.profile import SWITCHES
from adamo_vh.errors import ConfigError
from adamo_vh.inference.model import Sampling
from adamo_vh.record.termination import Limits

_GROUPS: Mapping[str, type[Any]] = {"sampling": Sampling, "limits": Limits, "budget": Budget}
"""Settings that are made of several."""
_SWITCHES = "switches"
_TEXTS = ("figure", "tool_calls", "resolution", "text_form")
_NUMBERS = ("k", "grid")
_LISTS = ("added_tools",)
SETTINGS = (*_TEXTS, *_NUMBERS, *_LISTS, *_GROUPS, _SWITCHES)
"""What a study may set for all of its episodes, or vary."""
_LONGEST = 60
"""Letters of a folder's name."""


def check_name(name: str) -> None:
    """Make sure that a setting may be set, or varied, by a study.

    Args:
        name: As in `SETTINGS`, or one part of a group: "sampling.temperature", "switches.plan".

    Raises:
        ConfigError: It may not.
    """
    group, dot, part = name.partition(".")
    if not dot and group in SETTINGS:
        return
    if dot and part in _parts(group):
        return
    if dot and _parts(group):
        raise ConfigError(
            f"There is no {part!r} in {group}. Use one of {', '.join(_parts(group))}."
        )
    raise ConfigError(
        f"A study cannot set or vary {name!r}. Settings: {', '.join(SETTINGS)}, and their parts, "
        "e.g. sampling.temperature, limits.max_steps, switches.plan."
    )


def _parts(group: str) -> tuple[str, ...]:
    if group == _SWITCHES:
        return SWITCHES
    made = _GROUPS.get(group)
    return tuple(field.name for field in fields(made)) if made else ()


def settings_of(values: Mapping[str, Any]) -> dict[str, Any]:
    """Settings as `EpisodeConfig.of` takes them, from those of a study and its axes.

    Args:
        values: By name; a later part of a group ("limits.max_steps") goes into what stands there.

    Raises:
        ConfigError: A name or a value is wrong.
    """
    found: dict[str, Any] = {}
    for name, value in values.items():
        check_name(name)
        group, dot, part = name.partition(".")
        if dot:
            found[group] = {**found.get(group, {}), part: value}
        elif _parts(group):
            if not isinstance(value, Mapping):
                raise ConfigError(
                    f"{name} is {value!r}: write a table, e.g. {{{_parts(group)[0]} = ...}}."
                )
            for key in value:
                check_name(f"{group}.{key}")
            found[group] = {**found.get(group, {}), **value}
        else:
            found[group] = value
    return {name: _made(name, value) for name, value in found.items()}


def _made(name: str, value: Any) -> Any:
    if name in _GROUPS:
        for part, number in value.items():
            if not isinstance(number, int | float):
                raise ConfigError(f"{name}.{part} is {number!r}: write a number.")
        return _GROUPS[name](**value)
    if name in _NUMBERS and not isinstance(value, int):
        raise ConfigError(f"{name} is {value!r}: write a whole number.")
    if name in _TEXTS and not isinstance(value, str):
        raise ConfigError(f"{name} is {value!r}: write a text.")
    if name in _LISTS:
        texts = [value] if isinstance(value, str) else value
        if not isinstance(texts, list | tuple) or not all(isinstance(v, str) for v in texts):
            raise ConfigError(f"{name} is {value!r}: write a list of texts.")
        return tuple(texts)
    return value


def switches_of(axes: Iterable[tuple[str, str]]) -> frozenset[str]:
    """The switches of the profile that axes set, by their names and values as they are spelled."""
    found = set()
    for name, value in axes:
        if name == _SWITCHES:
            found |= {part.partition("=")[0] for part in value.split(",")}
        elif name.startswith(f"{_SWITCHES}."):
            found.add(name.partition(".")[2])
    return frozenset(found)


def spelled(value: Any) -> str:
    """A value as it is written in keys, tables and reports."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, Mapping):
        return ",".join(f"{key}={spelled(part)}" for key, part in value.items()) or "none"
    if isinstance(value, list | tuple):
        return "+".join(map(spelled, value)) or "none"
    return f"{value:g}" if isinstance(value, float) else str(value)


def slug(text: str) -> str:
    """A text as one folder's name, the same on every system.

    Where letters were lost, a short digest keeps it apart from all others.
    """
    short = re.sub(r"[^a-z0-9._=,+]+", "-", text.lower()).strip("-.")
    if short and short == text and len(short) <= _LONGEST:
        return short
    digest = hashlib.sha256(text.encode("utf-8", "replace")).hexdigest()[:6]
    return f"{short[:_LONGEST].strip('-.') or 'x'}-{digest}"
