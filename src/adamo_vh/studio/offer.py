"""What may be chosen in a studio: scenes, tasks, models, profiles, figures and recorded runs."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from adamo_vh.benchmark.tasks import builtin_tasks
from adamo_vh.cognition.profile import PROFILES
from adamo_vh.errors import ConfigError
from adamo_vh.inference.players.outside import HUMAN
from adamo_vh.inference.registry import is_remote
from adamo_vh.perception import Labeling
from adamo_vh.readable import readable
from adamo_vh.session.builtin import known_scenes, scene_title
from adamo_vh.session.figures import figure_names

BASELINE = "baseline"
_PROVIDERS: Mapping[str, tuple[str, str]] = {
    "openai": ("OPENAI_API_KEY", "openai:NAME"),
    "anthropic": ("ANTHROPIC_API_KEY", "anthropic:NAME"),
    "google": ("GOOGLE_API_KEY", "google:NAME"),
}
"""The key of each provider, and how its models are called."""


class Offer:
    """What may be chosen; nothing that a page names is read as a path."""

    def __init__(
        self,
        models: Sequence[str] = (),
        scenes: Sequence[Path] = (),
        figures: Sequence[Path] = (),
    ) -> None:
        """Begin.

        Args:
            models: URIs that may be chosen beside the baseline and a person.
            scenes: Scene files that may be chosen beside the built-in scenes.
            figures: Files of own figures, which stand before those that come with the package.
        """
        self._models = tuple(dict.fromkeys(models))
        self._scenes = {path.name: path for path in scenes}
        self._figures = {path.name: path for path in figures}

    def scene(self, name: str) -> str:
        """The scene of a name: a built-in one, or the path of a file.

        Raises:
            ConfigError: There is none of this name.
        """
        if name in self._scenes:
            return str(self._scenes[name])
        known = [scene.name for scene in known_scenes()]
        if name.lower() in known:
            return name.lower()
        raise ConfigError(f"There is no scene {_told(name)}. Scenes: {', '.join(self.scenes())}.")

    def scenes(self) -> tuple[str, ...]:
        """Names of the scenes."""
        return (*(scene.name for scene in known_scenes()), *self._scenes)

    def figure(self, name: str) -> str:
        """The figure of a name: one that comes with the package, or the path of a file.

        Raises:
            ConfigError: There is none of this name.
        """
        if name in self._figures:
            return str(self._figures[name])
        if name in figure_names():
            return name
        raise ConfigError(
            f"There is no figure {_told(name)}. Figures: {', '.join(self.figures())}."
        )

    def figures(self) -> tuple[str, ...]:
        """Names of the figures, the default first."""
        return (*self._figures, *figure_names())

    def add_scene(self, path: Path) -> None:
        """Let a scene file be chosen too."""
        self._scenes[path.name] = path

    def check(self, model: str, scene: str, figure: str, task: str | None) -> None:
        """Make sure that all of it is on offer.

        Raises:
            ConfigError: Something is not; says what is.
        """
        self.scene(scene)
        self.figure(figure)
        if task is not None and task.upper() not in [known.id for known in builtin_tasks()]:
            offer = ", ".join(known.id for known in builtin_tasks())
            raise ConfigError(f"There is no task {_told(task)}. Tasks: {offer}.")
        # An address in a model's name would be sent the key of its provider.
        is_free = is_remote(model) and "@" not in model
        if not (model in (BASELINE, HUMAN, *self._models) or is_free):
            raise ConfigError(
                f"There is no model {_told(model)} here. Choose one that is on offer, write "
                "PROVIDER:NAME, or start the studio with --model for any other."
            )

    def told(self) -> dict[str, Any]:
        """All of it as JSON, but for the runs."""
        return {
            "scenes": [{"name": name, "title": self._title(name)} for name in self.scenes()],
            "tasks": [
                {"id": task.id, "instruction": task.prompt, "scenes": list(task.scenes)}
                for task in builtin_tasks()
            ],
            "models": list(self._models_told()),
            "profiles": list(PROFILES),
            "labelings": [labeling.value for labeling in Labeling],
            "figures": list(self.figures()),
        }

    def _title(self, name: str) -> str:
        return scene_title(str(self._scenes.get(name, name))) or name

    def _models_told(self) -> list[dict[str, Any]]:
        told = [
            _model(BASELINE, "Rules, no key: reads the symbolic state and the picture."),
            _model(HUMAN, "You are the mind, with the same four tools."),
            *(_model(uri, "From the command line.") for uri in self._models),
        ]
        for variable, form in _PROVIDERS.values():
            has_key = bool(os.environ.get(variable))
            note = f"Any model of it; the key is in {variable}."
            told.append({"name": form, "note": note, "needs_key": True, "has_key": has_key})
        return told


def _model(name: str, note: str) -> dict[str, Any]:
    return {"name": name, "note": note, "needs_key": False, "has_key": True}


def _told(name: str) -> str:
    return repr(readable(name)[:40])
