"""Which variations may be scored: of every number, the first attempt that is fair to every task.

Fair means: the scene is sound, every object can be seen from somewhere, and each task that the
scene has the objects for is unsatisfied at the start, can be done by the oracle without any side
effect, and is not done by doing nothing, under both labelings. The accepted attempts of the
built-in scenes' first numbers come with the package; others are found at first use and kept.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import lru_cache
from importlib import resources
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from adamo_vh.benchmark.conditions import NEAR_M, Near
from adamo_vh.benchmark.tasks import TASKS, Task
from adamo_vh.benchmark.verify import verify_tasks
from adamo_vh.errors import FileError, SceneError
from adamo_vh.files import cache_folder, parse_toml, read_json, write_whole
from adamo_vh.perception import Labeling

if TYPE_CHECKING:
    from adamo_vh.runtime.builtin import BuiltinEngine
    from adamo_vh.runtime.scenes.scene import Scene

TABLE = "variations.toml"
"""In `adamo_vh.runtime.scenes`: the accepted attempts, made by `tools/variations.py`."""
FIRST = {"dev": 1, "test": 1000}
"""Number of the first variation of each split: all is tuned on `dev` (1 to 999) alone."""
MOST_ATTEMPTS = 60


def variation_of(scene: str, number: int) -> Scene:
    """A variation that may be scored.

    Args:
        scene: Built-in scene or path of a scene file.
        number: 0 is the scene as it stands.

    Raises:
        SceneError: The scene is unknown or wrong, or a variation itself, or no attempt was fair.
    """
    from adamo_vh.runtime.scenes.scene import load_scene

    loaded = load_scene(scene)
    return _proven(loaded, number) if number else loaded


@lru_cache(maxsize=8)
def _proven(scene: Scene, number: int) -> Scene:
    from adamo_vh.runtime.scenes.variation import varied

    attempt = _known(scene, number)
    if attempt is None:
        attempt = first_fair_attempt(scene, number)
        _keep(scene, number, attempt)
    return varied(scene, number, attempt)


def first_fair_attempt(scene: Scene, number: int) -> int:
    """Draw until a variation is fair; takes some ten seconds.

    Raises:
        SceneError: None was; says what was wrong with the last one.
    """
    from adamo_vh.runtime.scenes.variation import varied

    problem = ""
    for attempt in range(MOST_ATTEMPTS):
        try:
            problem = unfair(varied(scene, number, attempt))
        except SceneError as error:
            if scene.variation:
                raise
            problem = str(error)
        if not problem:
            return attempt
    raise SceneError(
        f"{scene.name} variation {number}: none of {MOST_ATTEMPTS} attempts is fair to every task "
        f"(the last one: {problem}). Use another number, or give the scene more room."
    )


def unfair(scene: Scene) -> str:
    """Why a variation may not be scored; empty if it may.

    Args:
        scene: The variation.
    """
    from adamo_vh.runtime.builtin import BuiltinEngine
    from adamo_vh.runtime.inspection.checks import inspect_scene
    from adamo_vh.runtime.inspection.soundness import Soundness

    tasks = _fitting(scene)
    if task := _near_already(scene, tasks):
        return f"{task.id} begins with its objects near each other"
    engine = BuiltinEngine(scene)
    try:
        engine.reset(0)
        if faults := Soundness(engine.world).faults(engine.state()):
            return faults[0]
        if findings := inspect_scene(scene, engine):
            return findings[0].problem
        for labeling in Labeling:
            for played in verify_tasks(engine, labeling, tasks):
                if not played.is_sound:
                    return (
                        f"{played.task} {labeling}: oracle {played.oracle:.2f}, strict "
                        f"{played.oracle_strict:.0f}, idle {played.idle:.2f}"
                    )
    finally:
        engine.close()
    return ""


def _fitting(scene: Scene) -> tuple[Task, ...]:
    """The tasks that a scene has the objects and areas for."""
    objects = {item.id for item in scene.objects}
    kinds = {area.kind for area in scene.areas}
    return tuple(task for task in TASKS if task.objects <= objects and task.areas <= kinds)


def _near_already(scene: Scene, tasks: Sequence[Task]) -> Task | None:
    """A task that asks for a nearness that is there already: seen without any simulation."""
    placed = {item.id: item for item in scene.objects}
    for task in tasks:
        for condition in task.conditions:
            if isinstance(condition, Near):
                a, b = placed[condition.id], placed[condition.anchor]
                dx, dy = a.position[0] - b.position[0], a.position[1] - b.position[1]
                if a.on == b.on and dx * dx + dy * dy <= NEAR_M * NEAR_M:
                    return task
    return None


def _known(scene: Scene, number: int) -> int | None:
    """The accepted attempt, if it was found before: here, or by who made the package."""
    if scene in _built_in().values():
        for split, first in FIRST.items():
            attempts = accepted().get(scene.name, {}).get(split, [])
            if 0 <= number - first < len(attempts):
                return attempts[number - first]
    try:
        kept = read_json(_kept_file(scene, number))
    except FileError:
        return None
    attempt = kept.get("attempt") if isinstance(kept, dict) else None
    return attempt if isinstance(attempt, int) and 0 <= attempt < MOST_ATTEMPTS else None


@lru_cache(maxsize=1)
def _built_in() -> dict[str, Scene]:
    from adamo_vh.runtime.scenes.scene import load_scene, scene_names

    return {name: load_scene(name) for name in scene_names()}


@lru_cache(maxsize=1)
def accepted() -> Mapping[str, Mapping[str, Sequence[int]]]:
    """By scene and split, the accepted attempt of one number after another."""
    from adamo_vh.runtime.scenes.variation import GENERATION

    text = (resources.files("adamo_vh.runtime.scenes") / TABLE).read_text(encoding="utf-8")
    table: dict[str, Any] = parse_toml(text, TABLE)
    return table["scenes"] if table["generation"] == GENERATION else {}


def _keep(scene: Scene, number: int, attempt: int) -> None:
    """Remember an accepted attempt on this machine; where it cannot be kept, it is found again."""
    line = json.dumps({"scene": scene.name, "number": number, "attempt": attempt})
    with suppress(FileError):
        write_whole(_kept_file(scene, number), line.encode())


def _kept_file(scene: Scene, number: int) -> Path:
    """Covers all that an attempt was accepted for: what is drawn, and the version that proves."""
    from adamo_vh.runtime.scenes.variation import GENERATION

    what = f"{version('adamo-vh')} {GENERATION} {number} {scene!r}"
    return cache_folder() / "variations" / f"{hashlib.sha256(what.encode()).hexdigest()[:32]}.json"


def built_in_scene(scene: str, variation: int = 0) -> Scene:
    """A built-in scene, or that of a file, or one of its variations.

    Raises:
        SceneError: The scene is unknown or wrong, or has no such variation.
    """
    from adamo_vh.runtime.scenes.scene import load_scene

    return variation_of(scene, variation) if variation else load_scene(scene)


def built_in_engine(scene: str, figure: str, variation: int = 0) -> BuiltinEngine:
    """The built-in engine with a scene or one of its variations.

    Raises:
        SceneError: The scene is unknown or wrong, or has no such variation.
        ConfigError: No figure has this name.
    """
    from adamo_vh.runtime.builtin import BuiltinEngine

    return BuiltinEngine(built_in_scene(scene, variation), figure, origin=scene)
