"""Settings that are written KEY=VALUE on the command line."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import typer

from adamo_vh.cognition.budget import Budget
from adamo_vh.errors import ConfigError

if TYPE_CHECKING:
    from adamo_vh.study.cluster import Cluster

_WHOLE = ("tokens", "calls")
"""Caps that are counts."""


def pairs(given: Sequence[str] | None, option: str) -> dict[str, str]:
    """Read KEY=VALUE texts.

    Raises:
        ConfigError: One has another form.
    """
    found = {}
    for text in given or ():
        key, equals, value = text.partition("=")
        if not (key.strip() and equals and value.strip()):
            raise ConfigError(f"--{option} {text!r}: write KEY=VALUE.")
        found[key.strip()] = value.strip()
    return found


def read_budget(caps: dict[str, str]) -> Budget:
    """A budget from its caps.

    Raises:
        ConfigError: A cap is unknown or no positive number.
    """
    known = [field.name for field in fields(Budget)]
    if unknown := sorted(caps.keys() - set(known)):
        raise ConfigError(f"--budget {unknown[0]}: use {', '.join(known)}.")
    values: dict[str, float | int] = {}
    for key, text in caps.items():
        try:
            values[key] = int(text) if key in _WHOLE else float(text)
        except ValueError:
            whole = "whole " if key in _WHOLE else ""
            raise ConfigError(f"--budget {key}={text}: {text!r} is no {whole}number.") from None
    return Budget(**values)  # type: ignore[arg-type]


def refuse_others(context: typer.Context, *allowed: str) -> None:
    """Make sure that nothing but some parameters of a command was given.

    Raises:
        ConfigError: Something else was; names it.
    """
    given = [
        parameter.opts[0]
        for parameter in context.command.params
        if parameter.name not in allowed
        and (source := context.get_parameter_source(str(parameter.name))) is not None
        and source.name != "DEFAULT"
    ]
    if given:
        raise ConfigError(
            f"--{allowed[0]} goes on with the recorded settings, and takes no {', '.join(given)}: "
            f"leave it out (with --{allowed[0]} you can give "
            f"{', '.join(f'--{name}' for name in allowed[1:])})."
        )


def refuse_if_given(context: typer.Context, why: str, *unfit: str) -> None:
    """Make sure that some parameters of a command were not given.

    Args:
        context: The command.
        why: What is wrong with it, and the fix; follows the name of the option.
        unfit: The parameters.

    Raises:
        ConfigError: One was; names it.
    """
    for parameter in context.command.params:
        source = context.get_parameter_source(str(parameter.name))
        if parameter.name in unfit and source is not None and source.name != "DEFAULT":
            raise ConfigError(f"{parameter.opts[0]} {why}")


def values_of(given: Sequence[str] | None) -> dict[str, Any]:
    """Read settings that are written NAME=VALUE, as in a study file but for the quotes of texts.

    Raises:
        ConfigError: One has another form.
    """
    return {name: _value(text) for name, text in pairs(given, "set").items()}


def axes_of(given: Sequence[str] | None) -> dict[str, list[Any]]:
    """Read axes that are written NAME=VALUE,VALUE or NAME=[...].

    Raises:
        ConfigError: One has another form.
    """
    axes = {}
    for name, text in pairs(given, "axis").items():
        whole = _value(text)
        texts = [part for part in text.split(",") if part.strip()]
        axes[name] = whole if isinstance(whole, list) else [_value(part) for part in texts]
    return axes


def _value(text: str) -> Any:
    """A value as TOML writes it; else the text itself."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (tomllib.TOMLDecodeError, RecursionError):
        return text.strip()


def read_cluster(executor: str, address: str, shared: str) -> Cluster | None:
    """The cluster to play on; None for this machine.

    Raises:
        ConfigError: There is no such executor, or it is told of a cluster and needs none.
    """
    if executor == "ray":
        from adamo_vh.study.cluster import Cluster

        return Cluster(address, shared)
    if executor != "local":
        raise ConfigError(f"--executor {executor!r}: use local or ray.")
    if address or shared:
        raise ConfigError("--cluster and --shared are for --executor ray; add it.")
    return None


def read_shard(text: str) -> tuple[int, int]:
    """I/N as two numbers.

    Raises:
        ConfigError: The text has another form.
    """
    match = re.fullmatch(r"([0-9]{1,6})/([0-9]{1,6})", text.strip())
    if match is None:
        raise ConfigError(f"--shard {text!r}: write I/N, for example 1/4.")
    return int(match[1]), int(match[2])
