"""Scenes that are made on the page: checked as they are made, and saved as files."""

from __future__ import annotations

import re
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar

from pydantic import ConfigDict, Field

from adamo_vh.errors import ConfigError
from adamo_vh.session.editing import Examined, examine, examine_file
from adamo_vh.studio.offer import Offer

MAX_SCENE_BYTES = 500_000
_NAME = re.compile(r"[a-z0-9][a-z0-9_-]{0,40}")


@dataclass(frozen=True, slots=True)
class Draft:
    """A scene as the page tells it: as TOML, or as data."""

    __pydantic_config__: ClassVar[ConfigDict] = ConfigDict(extra="forbid")

    toml: Annotated[str, Field(max_length=MAX_SCENE_BYTES)] = ""
    data: dict[str, Any] | None = None
    name: Annotated[str, Field(max_length=60)] = ""
    """Of the file, to save it."""
    replace: bool = False
    """Whether a file of this name may be replaced."""


class Editor:
    """Checks and saves scenes; may be used from any threads."""

    def __init__(self, folder: Path, offer: Offer) -> None:
        """Begin.

        Args:
            folder: Takes the files; is made when the first one is saved.
            offer: Learns of what is saved.
        """
        self._folder = folder
        self._offer = offer
        for file in sorted(folder.glob("*.toml")):
            offer.add_scene(file)  # Saved before.

    def show(self, scene: str) -> dict[str, Any]:
        """A scene to begin with, as TOML and as data.

        Raises:
            ConfigError: There is none of this name.
        """
        return {"name": scene, **_told(examine_file(self._offer.scene(scene)))}

    def check(self, draft: Draft) -> dict[str, Any]:
        """What is wrong with a scene, and the scene as it is read."""
        return _told(_examined(draft))

    def save(self, draft: Draft) -> dict[str, Any]:
        """Save a scene; rooms can be opened in it from then on.

        Raises:
            ConfigError: The name is none, or taken, or the scene is wrong.
            FileError: It cannot be written.
        """
        if not _NAME.fullmatch(draft.name):
            raise ConfigError(
                "The name of a scene has small letters, digits, - and _, 41 at most; choose such."
            )
        found = _examined(draft)
        if not found.is_sound:
            first = next(f for f in found.findings if f.severity == "error")
            raise ConfigError(f"The scene is not saved: {first.where}: {first.problem}")
        file = self._folder / f"{draft.name}.toml"
        if file.exists() and not draft.replace:
            raise ConfigError(f"There is a scene {draft.name!r} already; choose another name.")
        found.write(file)
        self._offer.add_scene(file)
        return {"scene": file.name, **_told(found)}


def _examined(draft: Draft) -> Examined:
    if not draft.toml and draft.data is None:
        raise ConfigError("Send the scene as toml or as data.")
    return examine(draft.toml or draft.data or {})


def _told(found: Examined) -> dict[str, Any]:
    findings = [asdict(finding) for finding in found.findings]
    return {"findings": findings, "toml": found.toml, "data": found.data}
