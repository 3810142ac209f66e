"""The body: an engine with a scene, the action server in front of it, and what both must offer."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import cast

from adamo_vh.abilities import abilities
from adamo_vh.action import Code, action_name
from adamo_vh.action_server import LEAN_TOOLS, PAPER_TOOLS, LocalActionServer, Tool
from adamo_vh.action_server.frame_cache import FrameCache
from adamo_vh.action_server.local import at_once
from adamo_vh.benchmark.conditions import NEAR_M
from adamo_vh.cognition.instructions import system_prompt
from adamo_vh.engine import World, acting_body
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import Manifest
from adamo_vh.errors import ConfigError, RecordError
from adamo_vh.files import write_whole
from adamo_vh.perception import PerceptionConfig, Tagger
from adamo_vh.record.run_folder import SCENE, SCRIPT
from adamo_vh.record.trajectory import Trajectory
from adamo_vh.session.figures import recorded_figure
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.spare import engine_for

ENGINES, TOOLS = "adamo_vh.engines", "adamo_vh.tools"
"""Entry-point groups under which other packages offer theirs."""
_DEFAULT_SCENE = "s1"


def create_engine(scene: str = "s1", figure: str = "mara", variation: int = 0) -> World:
    """The built-in engine with a scene.

    Args:
        scene: Built-in scene or path of a scene file; or ``NAME:REST`` of an engine that another
            package offers under the entry point NAME of ``adamo_vh.engines``: a function of REST
            and the figure that gives a `World`.
        figure: Who the virtual human is: mara, jonas, amina, ken, or a file of your own, FILE.glb
            or FILE.vrm.
        variation: Of the scene's layout; 0 is the scene as it stands. One that is not known yet is
            looked for first, which takes some ten seconds.

    Raises:
        SceneError: The scene is unknown or wrong, or has no such variation.
        ConfigError: No figure has this name, or the engine of another package has no variations.
    """
    name, _, rest = scene.partition(":")
    if (made := offered_by_others(ENGINES).get(name)) is not None:
        if variation:
            raise ConfigError(
                f"variation is {variation}: the scenes of {name!r} have none; use 0 there."
            )
        return cast(World, made.load()(rest, figure))
    from adamo_vh.session.variations import built_in_engine

    return built_in_engine(scene, figure, variation)


def offered_by_others(group: str) -> dict[str, EntryPoint]:
    """What other packages offer under an entry-point group, by name."""
    return {point.name: point for point in entry_points(group=group)}


def opened(
    stack: ExitStack,
    config: EpisodeConfig,
    engine: World | None,
    recorded: tuple[Path, Manifest] | None = None,
) -> World:
    """The world of an episode, just reset.

    Args:
        stack: Closes what is made here.
        config: Names the scene.
        engine: What was handed in.
        recorded: Run folder and manifest of an episode that is executed again.

    Raises:
        RecordError: It was recorded in an engine that only its maker can hand in.
        ConfigError: The engine cannot do what the profile needs.
    """
    if engine is not None:
        acting_body(engine)
        world = engine
    else:
        scene, variation, figure = config.scene, config.variation, config.figure
        if recorded is not None:
            folder, manifest = recorded
            if manifest.engine:
                raise RecordError(
                    f"{folder} was recorded in an engine that was handed in ({manifest.engine}, "
                    f"scene {config.scene!r}); hand it in again: engine=..."
                )
            if (folder / SCENE).is_file():
                # It is the variation itself, whatever is drawn for its number today.
                scene, variation = str(folder / SCENE), 0
            told = recorded_figure(folder, manifest)
            figure = told.who
            if told.lacks:
                warnings.warn(told.lacks, stacklevel=2)
        if scene.partition(":")[0] in offered_by_others(ENGINES):
            world = create_engine(scene, figure, variation)
            stack.callback(world.close)
        else:
            world = stack.enter_context(engine_for(scene, figure, variation))
    if config.profile.closeups and not abilities(world).closeup:
        raise ConfigError(
            f"This engine draws no close-ups, which profile {config.profile.name!r} is about; "
            "take another one (profile paper) or set closeups=off."
        )
    world.reset(config.seed)
    return world


def as_said(config: EpisodeConfig, world: World) -> EpisodeConfig:
    """The settings with scene and figure as an engine that was handed in tells them."""
    scene = world.scene
    name = scene.source if Path(scene.source).is_file() else scene.name
    if config.scene.lower() not in (name.lower(), scene.name.lower(), _DEFAULT_SCENE):
        raise ConfigError(
            f"The engine is of scene {scene.name!r}, and the settings say {config.scene!r}; leave "
            "the scene out."
        )
    variation = 0 if _is_variation(name) else scene.variation
    if config.variation not in (0, variation):
        raise ConfigError(
            f"The engine is of {scene.full_name}, and the settings say variation "
            f"{config.variation}; leave the variation out."
        )
    figure = acting_body(world).info.figure
    return replace(config, scene=name, variation=variation, figure=figure)


def _is_variation(scene: str) -> bool:
    """Whether a scene file holds a variation: then no number brings it back, only the file."""
    if not Path(scene).is_file():
        return False
    from adamo_vh.runtime.scenes.scene import load_scene

    return load_scene(scene).variation > 0


def own_engine(world: World) -> str:
    """What an engine is, if a scene's name alone does not bring it back; empty if it does."""
    source = world.scene.source
    made = world.lender.world if isinstance(world, LentWorld) else world
    return "" if source == "built-in" or Path(source).is_file() else type(made).__name__


def store_sources(folder: Path, config: EpisodeConfig, world: World) -> None:
    """Put the files that an episode rests on into its run folder: an own scene, a script."""
    scene = Path(world.scene.source)
    if config.variation and not own_engine(world):
        from adamo_vh.runtime.scenes.writing import scene_toml
        from adamo_vh.session.variations import variation_of

        varied = variation_of(config.scene, config.variation)
        write_whole(folder / SCENE, scene_toml(varied).encode())
    elif scene.suffix == ".toml" and scene.is_file():
        write_whole(folder / SCENE, scene.read_bytes())
    kind, _, path = config.model.partition(":")
    if kind == "scripted" and Path(path).is_file():
        write_whole(folder / SCRIPT, Path(path).read_bytes())


def check_task(config: EpisodeConfig, world: World) -> None:
    """Make sure that a scene has what a task is about.

    Raises:
        ConfigError: It has not, or the task is unknown.
    """
    task = config.scored_task
    if task is None:
        return
    if task.scenes and world.scene.name not in task.scenes:
        raise ConfigError(
            f"Task {task.id} is for scene {', '.join(task.scenes)}, not for {world.scene.name!r}. "
            "Choose one of these, or take the scenes out of the task."
        )
    lacking = sorted(task.objects - set(world.object_names))
    areas = sorted(task.areas - {area.kind for area in world.scene.areas})
    carriers = {s.support for piece in world.state().furniture for s in piece.surfaces}
    known = carriers | {support.partition("/")[0] for support in carriers}
    surfaces = sorted(task.surfaces - known) if known else []
    if lacking or areas or surfaces:
        what = [
            *(f"object {number}" for number in lacking),
            *(f"a {kind}" for kind in areas),
            *(f"a place called {name!r}" for name in surfaces),
        ]
        raise ConfigError(
            f"Task {task.id} needs {', '.join(what)}, which scene {world.scene.name!r} does not "
            "have. Choose another task or scene, or give an instruction instead."
        )


def check_handed(
    folder: Path,
    manifest: Manifest,
    recorded: Trajectory,
    tools: Sequence[Tool] | None,
    labeling: Tagger | None,
) -> None:
    """Make sure that everything that was done can be done again.

    Raises:
        RecordError: A tool or the labeling is missing; names it.
    """
    config = manifest.config
    if manifest.labeling and labeling is None:
        raise RecordError(
            f"{folder} was recorded with a labeling that was handed in ({manifest.labeling}); "
            "hand it in again: labeling=..."
        )
    here = {action_name(tool.action_type) for tool in tools_for(config, tools)}
    done = {act.name for act in recorded.acts if act.feedback.code != Code.UNKNOWN_TOOL}
    if lacking := sorted(done - here):
        raise RecordError(
            f"{folder} was recorded with the tool {', '.join(lacking)}, which is not here; hand "
            "it in: tools=(*PAPER_TOOLS, ...)"
        )


def tools_for(config: EpisodeConfig, tools: Sequence[Tool] | None = None) -> Sequence[Tool]:
    """The body's primitives in an episode.

    Those that were handed in, or else those of the profile and the ones that the settings name,
    which other packages offer under the entry points ``adamo_vh.tools``.

    Raises:
        ConfigError: A tool is not installed.
    """
    if tools is not None:
        return tools
    own = LEAN_TOOLS if config.profile.closeups else PAPER_TOOLS
    found = offered_by_others(TOOLS) if config.added_tools else {}
    if unknown := [name for name in config.added_tools if name not in found]:
        offer = ", ".join(found) or "none is installed"
        raise ConfigError(f"There is no tool {unknown[0]!r} from another package ({offer}).")
    return (*own, *(cast(Tool, found[name].load()) for name in config.added_tools))


def instructions(
    config: EpisodeConfig,
    engine: World,
    server: LocalActionServer,
    labeling: Tagger | None = None,
) -> str:
    """The system prompt of an episode: what its scene, labeling, tools and profile call for."""
    tagger = labeling or config.labeling
    return system_prompt(engine.scene, tagger, server.actions, NEAR_M, config.profile)


def open_server(
    config: EpisodeConfig,
    engine: World,
    tools: Sequence[Tool] | None = None,
    labeling: Tagger | None = None,
    frames: FrameCache | None = None,
) -> LocalActionServer:
    """The action server of an episode.

    Args:
        config: Labeling, grid, resolution and profile.
        engine: The world, just reset.
        tools: The body's primitives; those of the profile by default.
        labeling: Makes the tags; that of the settings by default.
        frames: Keeps views; each is drawn without.
    """
    perception = PerceptionConfig(
        labeling=labeling or config.labeling,
        grid=config.grid,
        points_below_m=acting_body(engine).info.reach_top_m if config.profile.terse else math.inf,
        points_on_walls=not config.profile.terse,
    )
    return LocalActionServer(
        engine,
        perception=perception,
        resolution=config.resolution,
        tools=tools_for(config, tools),
        turn=engine.turn if isinstance(engine, LentWorld) else at_once,
        frames=frames,
    )
