"""What other installed packages add: models, engines, tools, found by their entry points.

A package offers a thing in its own pyproject.toml::

    [project.entry-points."adamo_vh.models"]
    mine = "my_package:make_model"

Nothing of it is imported before it is asked for by name.
"""

from __future__ import annotations

from importlib.metadata import EntryPoint, entry_points
from typing import Any

from adamo_vh.errors import ConfigError

MODELS, ENGINES, TOOLS = "adamo_vh.models", "adamo_vh.engines", "adamo_vh.tools"
"""Groups of entry points."""


def plugin_names(group: str) -> tuple[str, ...]:
    """Names that installed packages add to a group, in the order of the alphabet."""
    return tuple(sorted({point.name for point in entry_points(group=group)}))


def load_plugin(group: str, name: str) -> Any:
    """What an installed package offers under a name; None if there is no such name.

    Args:
        group: `MODELS`, `ENGINES` or `TOOLS`.
        name: As in the package's own table.

    Raises:
        ConfigError: It cannot be imported, or two packages offer the same name.
    """
    found = list({point.value: point for point in entry_points(group=group, name=name)}.values())
    if not found:
        return None
    if len(found) > 1:
        offers = " and ".join(sorted(_origin(point) for point in found))
        raise ConfigError(f"{offers} both offer {name!r} in {group}; uninstall one of them.")
    (point,) = found
    try:
        return point.load()
    except Exception as error:
        # Somebody else's code: whatever it raises is a fault of that package.
        raise ConfigError(
            f"{_origin(point)} offers {name!r} in {group}, but {point.value} cannot be loaded: "
            f"{type(error).__name__}: {error}. Update or uninstall it."
        ) from error


def _origin(point: EntryPoint) -> str:
    return point.dist.name if point.dist is not None else point.value
