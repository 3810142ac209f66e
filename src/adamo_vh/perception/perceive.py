"""Perceive: from a raw percept to the observation that the agent is shown."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from adamo_vh.errors import ConfigError, EngineError
from adamo_vh.observation import AgentState, BodyState, Observation, ObservedObject, Percept
from adamo_vh.perception.clutter import Clutter
from adamo_vh.perception.labeling import Labeling, Tagger
from adamo_vh.perception.overlay import BEST_QUALITY, ImageFormat, draw_overlay
from adamo_vh.perception.reference_points import Raycast, reference_points
from adamo_vh.perception.visibility import VisibleObject, visible_objects


@dataclass(frozen=True, slots=True)
class PerceptionConfig:
    """How a view is turned into an observation; the defaults are the paper's baseline."""

    labeling: Tagger = Labeling.SEM
    """How objects are called: one of the two that are shipped, or an own one."""
    grid: int = 6
    """Reference points along each side of the picture; 0 shows none."""
    points_below_m: float = math.inf
    """Reference points higher than this get no number."""
    points_on_walls: bool = True
    """Whether reference points on the walls get a number: nothing can be put there."""
    min_pixels: int = 20
    """Visible pixels that an object needs at 1920x1080; scaled with the picture's area."""
    image_format: ImageFormat = ImageFormat.JPEG
    """How the frame is encoded."""
    jpeg_quality: int = 88
    """1 to 95; PNG ignores it."""

    def __post_init__(self) -> None:
        if self.grid < 0:
            raise ConfigError(f"grid is {self.grid}: use 0 for no reference points, or more.")
        if not 1 <= self.jpeg_quality <= BEST_QUALITY:
            raise ConfigError(f"jpeg_quality is {self.jpeg_quality}: use 1 to {BEST_QUALITY}.")


def perceive(
    percept: Percept, raycast: Raycast, config: PerceptionConfig, names: Mapping[int, str]
) -> Observation:
    """Label what is visible, anchor reference points, and draw both into the frame.

    Partial observability is strict: nothing in the observation comes from an object with fewer
    visible pixels than the threshold. The one exception is the object in the hand, whose tag the
    agent always knows.

    Args:
        percept: The raw capture.
        raycast: First hits in the world, like `adamo_vh.engine.Engine.raycast`.
        config: How to perceive.
        names: Class by id; asked only for the object in the hand, which may be out of view.

    Returns:
        The annotated frame with its data; objects by ascending id.
    """
    visible = visible_objects(percept, config.min_pixels)
    objects = tuple(_observed(item, percept, config.labeling) for item in visible)
    points = reference_points(percept.camera, raycast, config.grid)
    clutter = Clutter.of(percept.id_layers, visible)
    frame = draw_overlay(
        percept.rgb, objects, points, clutter, config.image_format, config.jpeg_quality
    )
    agent = agent_state(percept.body, config.labeling, names)
    return Observation(frame, objects, points, agent, percept.camera)


def agent_state(body: BodyState, labeling: Tagger, names: Mapping[int, str]) -> AgentState:
    """The body as the agent is told about it.

    Args:
        body: The body as the engine knows it.
        labeling: How the held object is called.
        names: Class by id, with the held object among them.
    """
    held = None if body.held is None else labeling.tag(body.held, names[body.held])
    return AgentState(body.position, body.heading_rad, body.gaze, body.eyes, held)


def _observed(item: VisibleObject, percept: Percept, labeling: Tagger) -> ObservedObject:
    seen = percept.objects.get(item.id)
    if seen is None:
        raise EngineError(
            f"The percept shows object {item.id} but does not describe it: an engine must put "
            "every id of its id layers into Percept.objects."
        )
    return ObservedObject(
        tag=labeling.tag(item.id, seen.class_name),
        position=seen.box.center,
        volume_m3=seen.box.volume_m3,
        box_px=item.box_px,
        pixels=item.pixels,
        short=labeling.short(item.id, seen.class_name),
    )
