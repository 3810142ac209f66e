"""The body: an engine with a scene, and the action server in front of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from adamo_vh.action_server import LEAN_TOOLS, PAPER_TOOLS, LocalActionServer, Tool
from adamo_vh.engine import World, acting_body
from adamo_vh.perception import PerceptionConfig

if TYPE_CHECKING:
    from adamo_vh.cognition.profile import Profile
    from adamo_vh.episode.result import EpisodeConfig


def create_engine(scene: str = "s1", figure: str = "mara") -> World:
    """The built-in engine with a scene.

    Args:
        scene: Built-in scene or path of a scene file.
        figure: Who the virtual human is: mara, jonas, amina or ken.

    Raises:
        SceneError: The scene is unknown or wrong.
        ConfigError: No figure has this name.
    """
    from adamo_vh.runtime.builtin import BuiltinEngine

    return BuiltinEngine(scene, figure)


def tools_of(profile: Profile) -> Sequence[Tool]:
    """The body's primitives that a profile offers."""
    return LEAN_TOOLS if profile.closeups else PAPER_TOOLS


def instructions(config: EpisodeConfig, engine: World, server: LocalActionServer) -> str:
    """The system prompt of an episode: what its scene, labeling, tools and profile call for."""
    from adamo_vh.benchmark.conditions import NEAR_M
    from adamo_vh.cognition.instructions import system_prompt

    return system_prompt(engine.scene, config.labeling, server.actions, NEAR_M, config.profile)


def open_server(
    config: EpisodeConfig, engine: World, tools: Sequence[Tool] | None = None
) -> LocalActionServer:
    """The action server of an episode.

    Args:
        config: Labeling, grid, resolution and profile.
        engine: The world, just reset.
        tools: The body's primitives; those of the profile by default.
    """
    perception = PerceptionConfig(
        labeling=config.labeling,
        grid=config.grid,
        points_below_m=acting_body(engine).info.reach_top_m if config.profile.terse else math.inf,
        points_on_walls=not config.profile.terse,
    )
    return LocalActionServer(
        engine,
        perception=perception,
        resolution=config.resolution,
        tools=tools_of(config.profile) if tools is None else tools,
    )
