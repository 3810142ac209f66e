"""Render a prompt that lies as a text file in a package; a missing variable is an error."""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import TYPE_CHECKING

from adamo_vh.errors import ConfigError

if TYPE_CHECKING:
    from jinja2 import Template


@cache
def _template(package: str, name: str) -> Template:
    from jinja2 import Environment, StrictUndefined

    text = (resources.files(package) / f"{name}.md").read_text(encoding="utf-8")
    environment = Environment(undefined=StrictUndefined, autoescape=False, trim_blocks=True)
    return environment.from_string(text)


def render_from(package: str, name: str, **variables: object) -> str:
    """Render a prompt file.

    Args:
        package: Package that holds the file.
        name: File name without ".md".
        variables: Every variable of the file.

    Raises:
        ConfigError: A variable of the file has no value.
    """
    from jinja2 import UndefinedError

    try:
        return _template(package, name).render(**variables).strip()
    except UndefinedError as error:
        raise ConfigError(f"prompt {name}.md: {error.message}") from None
