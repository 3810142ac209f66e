"""What of an extra is needed, and how to get it where it is missing."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec

from adamo_vh.errors import ConfigError


@contextmanager
def extra(name: str, what: str) -> Iterator[None]:
    """Import in the block what an extra brings.

    Args:
        name: Of the extra.
        what: Needs it, in words that begin a sentence.

    Raises:
        ConfigError: A library is missing; says the command that installs it.
    """
    try:
        yield
    except ImportError as error:
        if (error.name or "").partition(".")[0] == "adamo_vh":
            raise
        raise missing(name, what, error.name or "") from None


def needed(module: str, name: str) -> None:
    """Make sure that a library of an extra is here, without importing it.

    Args:
        module: What is imported later.
        name: The extra that brings it.

    Raises:
        ConfigError: It is not; says the command that installs it.
    """
    if find_spec(module) is None:
        raise missing(name, "This", module)


def missing(name: str, what: str, module: str) -> ConfigError:
    """The error of a library that is not here.

    Args:
        name: The extra that brings it.
        what: Needs it, in words that begin a sentence.
        module: The library.
    """
    return ConfigError(f"{what} needs an extra package ({module}): pip install 'adamo-vh[{name}]'.")
