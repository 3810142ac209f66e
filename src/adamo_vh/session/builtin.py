"""The one door to the built-in engine for those who need more of it than a `World`.

Scene checks, pictures and a look at the machine: the command line, adapters and pages ask
here, so that nothing but the session knows which engine is built in.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

from adamo_vh.errors import RenderingError, SceneError
from adamo_vh.files import write_whole
from adamo_vh.plugins import ENGINES, plugin_names

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from adamo_vh.engine import World
    from adamo_vh.runtime.builtin import BuiltinEngine
    from adamo_vh.runtime.inspection.finding import SceneFinding
    from adamo_vh.runtime.scenes import Scene

    Picture = NDArray[np.uint8]
    """(H, W, 3) colour."""


@dataclass(frozen=True, slots=True, eq=False)
class SceneReport:
    """What a look over a scene brought."""

    name: str
    findings: tuple[SceneFinding, ...]
    pictures: Mapping[str, Picture]
    """By name; none of a scene that cannot be simulated."""

    @property
    def is_sound(self) -> bool:
        """Whether nothing is wrong with it."""
        return not any(finding.severity == "error" for finding in self.findings)


def scene_names() -> tuple[str, ...]:
    """Names of the scenes that come with the package."""
    from adamo_vh.runtime.scenes import scene_names as names

    return names()


def known_scenes() -> list[Scene]:
    """The scenes that come with the package, as their files say."""
    from adamo_vh.runtime.scenes import load_scene

    return [load_scene(name) for name in scene_names()]


def check_scene(scene: str) -> None:
    """Make sure that there is a scene of this name, and that its file can be read.

    Args:
        scene: As for `adamo_vh.session.bodies.create_engine`.

    Raises:
        SceneError: There is none, or its file is wrong.
    """
    from adamo_vh.runtime.scenes import load_scene

    if scene.partition(":")[0] not in plugin_names(ENGINES):
        load_scene(scene)


def inspect_scene_file(file: str) -> SceneReport:
    """Look a scene over, with a picture from above and one from the start.

    Args:
        file: Scene file or built-in name.

    Raises:
        SceneError: There is no such file.
    """
    from adamo_vh.runtime.builtin import BuiltinEngine
    from adamo_vh.runtime.inspection.arrangement import inspect_arrangement
    from adamo_vh.runtime.inspection.checks import inspect_scene
    from adamo_vh.runtime.inspection.finding import faults_of
    from adamo_vh.runtime.scenes import load_scene

    try:
        scene = load_scene(file)
        findings = inspect_arrangement(scene)
        if any(finding.blocks for finding in findings):
            return SceneReport(scene.name, findings, {})
        engine = BuiltinEngine(scene)
    except SceneError as fault:
        if not Path(file).is_file():
            raise
        return SceneReport(Path(file).stem, faults_of(fault), {})
    try:
        findings = inspect_scene(scene, engine)
        return SceneReport(scene.name, findings, _pictures(scene, engine, ("top", "start")))
    finally:
        engine.close()


def scene_pictures(scene: Scene) -> SceneReport:
    """Draw a scene from above, from each corner and from the start; nothing is looked over.

    Raises:
        SceneError: The physics cannot take it.
    """
    from adamo_vh.runtime.builtin import BuiltinEngine

    engine = BuiltinEngine(scene)
    try:
        return SceneReport(scene.full_name, (), _pictures(scene, engine, None))
    finally:
        engine.close()


def read_scene(file: str, variation: int = 0) -> Scene:
    """A scene, or one of its variations, as data.

    Args:
        file: Scene file or built-in name.
        variation: 0 is the scene as it stands.

    Raises:
        SceneError: The scene is unknown or wrong, or has no such variation.
    """
    from adamo_vh.session.variations import variation_of

    return variation_of(file, variation)


def scene_title(file: str) -> str:
    """What a scene is called among people; empty if it cannot be read."""
    from adamo_vh.runtime.scenes import load_scene

    try:
        return load_scene(file).title
    except SceneError:
        return ""


def scene_glb(file: str, variation: int = 0) -> bytes:
    """A whole scene as one GLB, with its objects where they come to rest.

    It is kept in the cache: whoever asks again, also after a restart, has it at once.

    Args:
        file: Scene file or built-in name.
        variation: 0 is the scene as it stands.

    Raises:
        SceneError: The scene is unknown or wrong.
    """
    from adamo_vh.runtime.assets.bake import cached
    from adamo_vh.runtime.human.looks import VARIANTS
    from adamo_vh.runtime.scenes.glb import SOURCE
    from adamo_vh.runtime.scenes.glb import scene_glb as written
    from adamo_vh.runtime.scenes.writing import scene_toml
    from adamo_vh.session.spare import engine_for

    scene = read_scene(file, variation)

    def make() -> bytes:
        with engine_for(file, VARIANTS[0], variation) as engine:
            engine.reset(0)
            return written(scene, engine.state().objects).content

    digest = sha256(scene_toml(scene).encode() + SOURCE.read_bytes()).hexdigest()[:24]
    return cached(f"scene_{digest}.glb", make)


def light_of(scene: Scene) -> str:
    """How bright a variation is, in a word: normal, low or high."""
    from adamo_vh.runtime.scenes.variation import light_preset

    return light_preset(scene.variation).name


def write_scene(scene: Scene, file: Path) -> Path:
    """Write a scene file that holds a scene.

    Raises:
        FileError: It cannot be written.
    """
    from adamo_vh.runtime.scenes.writing import scene_toml

    return write_whole(file, scene_toml(scene).encode())


def export(file: str, variation: int, folder: Path) -> list[Path]:
    """Write a scene with its meshes for another engine; what was written, scene.json first.

    Args:
        file: Scene file or built-in name.
        variation: 0 is the scene as it stands.
        folder: Where to; is made.

    Raises:
        SceneError: The scene is unknown or wrong.
        FileError: The folder cannot be written.
    """
    from adamo_vh.runtime.builtin import BuiltinEngine
    from adamo_vh.runtime.scenes.exporting import export_scene

    scene = read_scene(file, variation)
    engine = BuiltinEngine(scene)
    try:
        return export_scene(scene, engine.state(), engine.body.info, folder)
    finally:
        engine.close()


def _pictures(
    scene: Scene, engine: BuiltinEngine, names: tuple[str, ...] | None
) -> dict[str, Picture]:
    from adamo_vh.runtime.inspection.checks import cameras

    engine.reset(0)
    chosen = cameras(scene, engine)
    drawn = {}
    for name in names or (*chosen, "start"):
        outside = chosen.get(name)
        view = engine.view(outside) if outside else engine.capture(1920, 1080)
        drawn[name] = view.rgb
    return drawn


def graphics_name() -> str:
    """Which OpenGL this machine draws with.

    Raises:
        RenderingError: None works; names what helps.
    """
    from adamo_vh.runtime.graphics import backend_name

    return backend_name()


def check_machine(faults_of: Callable[[World], Sequence[str]]) -> str:
    """Let somebody live in scene s1 for a moment; what was seen, in words.

    Args:
        faults_of: What an engine does otherwise than the contract says.

    Raises:
        RenderingError: The engine does not keep its contract on this machine.
    """
    from adamo_vh.runtime.builtin import BuiltinEngine

    engine = BuiltinEngine("s1")
    try:
        if faults := faults_of(engine):
            raise RenderingError(f"Scene s1 does not work here: {faults[0]}")
        engine.stage.forget()
        started = time.perf_counter()
        percept = engine.capture(640, 360)
        milliseconds = (time.perf_counter() - started) * 1000
    finally:
        engine.close()
    return f"scene s1, {len(percept.objects)} objects in view, 640x360 in {milliseconds:.0f} ms"
