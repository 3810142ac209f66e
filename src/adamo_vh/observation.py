"""From what the engine captures (`Percept`) to what the agent is shown (`Observation`)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Box, Camera, Vec3

NOTHING = -1
"""Value of a pixel in an id image that shows no interactable object."""


@dataclass(frozen=True, slots=True)
class BodyState:
    """The body as the engine knows it."""

    position: Vec3
    """Where the body stands, on the floor, metres."""
    heading_rad: float
    """Yaw of the body; 0 faces +X."""
    gaze: Vec3
    """The point that the eyes look at, metres."""
    eyes: Vec3
    """Where the eyes are, metres."""
    held: int | None = None
    """Id of the object in the hand."""
    held_box: Box | None = None
    """The box of the object in the hand, which one feels also with the eyes elsewhere."""


@dataclass(frozen=True, slots=True)
class SeenObject:
    """An interactable object with at least one pixel in a percept."""

    id: int
    class_name: str
    box: Box


@dataclass(frozen=True, slots=True, eq=False)
class Percept:
    """One raw egocentric capture."""

    rgb: NDArray[np.uint8]
    """(H, W, 3) colour image."""
    id_layers: tuple[NDArray[np.int16], ...]
    """Each (H, W): object id at each pixel or `NOTHING`. First what is in front; a second layer,
    if there is one, shows the view without transparent things, so what stands behind glass."""
    objects: Mapping[int, SeenObject]
    """By id; exactly those with a pixel in a layer. The object in the hand may be among them."""
    body: BodyState
    camera: Camera
    from_boxes: bool = False
    """The engine told boxes and numbers of pixels alone, and the layers were painted from them: box
    and number of an object are right, which pixels of its box show it is not known."""


@dataclass(frozen=True, slots=True)
class AgentState:
    """The body as the agent is told about it: like `BodyState`, with a tag for the held object."""

    position: Vec3
    heading_rad: float
    gaze: Vec3
    eyes: Vec3
    held: str | None = None


@dataclass(frozen=True, slots=True)
class ObservedObject:
    """One line of the object list, and one box in the frame."""

    tag: str
    position: Vec3
    """Centre of the object's box, metres."""
    volume_m3: float
    """Volume of the object's box; does not change when the object turns."""
    box_px: tuple[int, int, int, int]
    """Tight around the visible pixels: left, top, right, bottom; right and bottom are exclusive."""
    pixels: int
    """How many pixels show the object."""
    short: str = ""
    """The shortest name that its labeling understands; the tag itself if empty."""


@dataclass(frozen=True, slots=True)
class ReferencePoint:
    """A stable 3D anchor: where a ray of the grid meets the world."""

    tag: str
    """P0, P1, ..."""
    position: Vec3
    pixel: tuple[float, float]
    """u, v in the frame."""


@dataclass(frozen=True, slots=True)
class Frame:
    """An encoded picture."""

    data: bytes
    media_type: str
    width_px: int
    height_px: int


@dataclass(frozen=True, slots=True)
class Observation:
    """One egocentric view: annotated frame and, in the same words, its text mirror's data."""

    frame: Frame
    objects: tuple[ObservedObject, ...]
    points: tuple[ReferencePoint, ...]
    agent: AgentState
    camera: Camera
