"""What of an extra is needed, and how to get it where it is missing."""

from __future__ import annotations

from importlib.util import find_spec

from adamo_vh.errors import ConfigError


def needed(module: str, extra: str) -> None:
    """Make sure that a library of an extra is here.

    Args:
        module: What is imported.
        extra: Brings it.

    Raises:
        ConfigError: It is not; says the command that installs it.
    """
    if find_spec(module) is None:
        raise ConfigError(
            f"{module} is not installed; install it with: pip install 'adamo-vh[{extra}]'"
        )
