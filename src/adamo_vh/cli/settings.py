"""Settings that are written KEY=VALUE on the command line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

from adamo_vh.cognition.budget import Budget
from adamo_vh.errors import ConfigError

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
