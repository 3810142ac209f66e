"""A study as people write it: a TOML file, the name of one of the paper's, or options."""

from __future__ import annotations

import re
from collections.abc import Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from adamo_vh.benchmark.tasks import TASKS
from adamo_vh.errors import ConfigError
from adamo_vh.files import read_toml
from adamo_vh.session.builtin import scene_names
from adamo_vh.study.axes import SETTINGS, check_name
from adamo_vh.study.named import NAMED
from adamo_vh.study.plan import Study

_LISTS = ("tasks", "scenes", "labelings", "models", "profiles")
_ONE = {"task": "tasks", "scene": "scenes", "labeling": "labelings", "model": "models"}
_ONE |= {"profile": "profiles", "variation": "variations", "repetition": "repetitions"}
"""What somebody may write in place of a list's name."""
_OWN = (*_LISTS, "repetitions", "variations", "axes", "study", "name")
_MOST_VARIATION = 9999
_ALL = "all"


def read_study(source: str | None, options: Mapping[str, Any]) -> Study:
    """A study from a file or a name, with what was given beside it.

    Args:
        source: One of the paper's studies by name, or a TOML file; None for options alone.
        options: By the names of a study file; they replace what the file says.

    Raises:
        ConfigError: Something is wrong with it; names the place and the fix.
        FileError: The file cannot be read.
    """
    told: dict[str, Any] = {}
    where, name = "", ""
    if source is not None and source.lower() in NAMED:
        name = source.lower()
        told = dict(NAMED[name])
    elif source is not None:
        path = Path(source)
        if not path.is_file():
            raise ConfigError(
                f"There is no study {source!r}: name {', '.join(NAMED)}, or a TOML file."
            )
        where, name = f"{source}: ", path.stem
        told = _from_file(read_toml(path), where)
        name = str(told.pop("name", told.pop("study", name)))
    axes = told.pop("axes", {})
    if not isinstance(axes, Mapping):
        raise ConfigError(
            f"{where}axes is {axes!r}: write a table [axes] with a list for each setting."
        )
    axes = {**axes, **options.get("axes", {})}
    told |= {key: value for key, value in options.items() if key != "axes"}
    for varied in axes.keys() & options.keys():
        del axes[varied]  # Set on the command line, it is not varied any more.
    try:
        return _study(told, axes, name)
    except ConfigError as error:
        raise ConfigError(f"{where}{error}") from None


def _from_file(told: dict[str, Any], where: str) -> dict[str, Any]:
    base = told.get("study")
    if base is None:
        return told
    if not isinstance(base, str) or base.lower() not in NAMED:
        raise ConfigError(f"{where}study is {base!r}: name one of {', '.join(NAMED)}.")
    start = dict(NAMED[base.lower()])
    axes = told.get("axes", {})
    if isinstance(axes, Mapping):
        told = {**told, "axes": {**start.get("axes", {}), **axes}}
    return {**start, **told}


def _study(told: dict[str, Any], axes: Mapping[str, Any], name: str) -> Study:
    lists = {key: _texts(key, told.pop(key)) for key in _LISTS if key in told}
    lists["tasks"] = _tasks(lists.get("tasks", (_ALL,)))
    if "scenes" in lists:
        lists["scenes"] = tuple(map(_scene, lists["scenes"]))
    variations = _variations(told.pop("variations", 0))
    repetitions = told.pop("repetitions", 1)
    for key in told:
        if key not in SETTINGS and "." not in key:
            raise ConfigError(_unknown(key))
        check_name(key)
    return Study(
        **lists,
        repetitions=repetitions,
        variations=variations,
        settings=told,
        axes=_axes(axes),
        name=name,
    )


def _unknown(key: str) -> str:
    known = [*_OWN, *SETTINGS]
    meant = _ONE.get(key) or next(iter(get_close_matches(key, known, 1)), None)
    guess = f" Did you mean {meant}?" if meant else ""
    return f"There is no setting {key!r} of a study.{guess} Settings: {', '.join(known)}."


def _texts(key: str, value: Any) -> tuple[str, ...]:
    values = [value] if isinstance(value, str) else value
    if not isinstance(values, list | tuple) or not all(isinstance(v, str) for v in values):
        raise ConfigError(f'{key} is {value!r}: write a list of texts, e.g. {key} = ["..."].')
    return tuple(text.strip() for text in values)


def _tasks(names: tuple[str, ...]) -> tuple[str, ...]:
    if [name.lower() for name in names] == [_ALL]:
        return tuple(task.id for task in TASKS)
    return tuple(name.upper() if re.fullmatch(r"[tT][0-9]+", name) else name for name in names)


def _scene(name: str) -> str:
    return name.lower() if name.lower() in scene_names() else name


def _variations(value: Any) -> tuple[int, ...]:
    """Numbers of variations from 0, "0-4", "0,2,7-9", or a list of these."""
    found: list[int] = []
    for part in value if isinstance(value, list | tuple) else [value]:
        if isinstance(part, int) and not isinstance(part, bool):
            found.append(part)
        elif isinstance(part, str):
            found.extend(number for piece in part.split(",") for number in _range(piece.strip()))
        else:
            raise ConfigError(_no_variation(part))
    if wrong := [number for number in found if not 0 <= number <= _MOST_VARIATION]:
        raise ConfigError(_no_variation(wrong[0]))
    return tuple(found)


def _range(text: str) -> range:
    match = re.fullmatch(r"([0-9]{1,4})(?:\s*-\s*([0-9]{1,4}))?", text)
    if match is None or int(match[2] or match[1]) < int(match[1]):
        raise ConfigError(_no_variation(text))
    return range(int(match[1]), int(match[2] or match[1]) + 1)


def _no_variation(given: object) -> str:
    return (
        f"variations: {given!r} is none. Write a number from 0 to {_MOST_VARIATION}, a range as "
        '"0-4", or several, as "0,2,7-9".'
    )


def _axes(told: Mapping[str, Any]) -> dict[str, tuple[Any, ...]]:
    axes: dict[str, tuple[Any, ...]] = {}
    for name, values in _flat(told):
        check_axis(name)
        if not isinstance(values, list | tuple):
            raise ConfigError(f"axis {name} is {values!r}: write the list of its values.")
        axes[name] = tuple(values)
    return axes


def _flat(told: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """Axes by name, with the parts of a group ([axes.limits], limits.max_steps) by their own."""
    found: list[tuple[str, Any]] = []
    for name, values in told.items():
        if isinstance(values, Mapping):
            found.extend((f"{name}.{part}", inner) for part, inner in values.items())
        else:
            found.append((name, values))
    return found


def check_axis(name: str) -> None:
    """Make sure that a setting may be an axis.

    Raises:
        ConfigError: It may not, or has a list of its own.
    """
    own = name if name in _OWN else _ONE.get(name)
    if own:
        raise ConfigError(f"{name} is no further axis: list its values under {own}.")
    check_name(name)
