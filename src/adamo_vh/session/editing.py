"""What a scene editor needs of the built-in engine: the catalog, and a look at a draft."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from adamo_vh.errors import ConfigError, SceneError
from adamo_vh.files import write_whole

if TYPE_CHECKING:
    from adamo_vh.runtime.inspection.finding import SceneFinding
    from adamo_vh.runtime.scenes.scene import Scene

DRAFT = "scene"
"""What a draft is called in messages."""


@dataclass(frozen=True, slots=True)
class Examined:
    """A draft of a scene, and what is wrong with it."""

    scene: Scene | None
    """None if it cannot be read as a scene."""
    findings: tuple[SceneFinding, ...]

    @property
    def is_sound(self) -> bool:
        """Whether rooms can be opened in it."""
        return self.scene is not None and not any(f.severity == "error" for f in self.findings)

    @property
    def toml(self) -> str:
        """Its text; empty if it is no scene."""
        from adamo_vh.runtime.scenes.writing import scene_toml

        return "" if self.scene is None else scene_toml(self.scene)

    @property
    def data(self) -> dict[str, Any] | None:
        """The same as data."""
        return None if self.scene is None else asdict(self.scene)

    def write(self, file: Path) -> None:
        """Write it as a scene file.

        Raises:
            FileError: It cannot be written.
        """
        write_whole(file, self.toml.encode())


def examine(told: str | Mapping[str, Any]) -> Examined:
    """Look over a draft without simulating anything, so that it can be done at every change.

    Args:
        told: TOML, or the same as data.
    """
    from adamo_vh.runtime.inspection.arrangement import inspect_arrangement
    from adamo_vh.runtime.inspection.finding import faults_of
    from adamo_vh.runtime.scenes.scene import parse_scene, scene_from

    try:
        scene = parse_scene(told, DRAFT) if isinstance(told, str) else scene_from(told, DRAFT)
    except SceneError as fault:
        return Examined(None, faults_of(fault))
    return Examined(scene, inspect_arrangement(scene))


def examine_file(file: str) -> Examined:
    """A scene that is there already.

    Args:
        file: Scene file or built-in name.

    Raises:
        SceneError: It is unknown or wrong.
    """
    from adamo_vh.runtime.scenes.scene import load_scene

    return Examined(load_scene(file), ())


def catalog() -> dict[str, list[dict[str, Any]]]:
    """Everything that can stand in a scene: name, class, size in metres and what carries things."""
    from adamo_vh.runtime.assets.bake import load_asset
    from adamo_vh.runtime.assets.catalog import FURNITURE, OBJECTS

    def told(name: str) -> dict[str, Any]:
        asset = load_asset(name)
        surfaces = [asdict(surface) for surface in asset.surfaces]
        size = list(asset.size)
        return {"name": name, "class_name": asset.class_name, "size": size, "surfaces": surfaces}

    return {
        "furniture": [told(name) for name in sorted(FURNITURE)],
        "objects": [told(name) for name in sorted(OBJECTS)],
    }


def asset_mesh(name: str) -> bytes:
    """A piece of furniture or an object as a GLB, with Y up.

    Raises:
        ConfigError: The catalog has none of this name.
    """
    from adamo_vh.runtime.assets.bake import load_asset
    from adamo_vh.runtime.assets.catalog import FURNITURE, OBJECTS
    from adamo_vh.runtime.assets.glb_writing import asset_glb

    if name not in FURNITURE and name not in OBJECTS:
        raise ConfigError(f"There is no asset {name[:40]!r}; the catalog has others.")
    return asset_glb(load_asset(name), name)
