"""What an agent sees and does, as spaces of Gymnasium, and how an action is read as a tool call."""

from __future__ import annotations

import io
import string
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from adamo_vh.action import Drop, Inspect, Look, Pick, Walk, action_name
from adamo_vh.engine import SceneInfo
from adamo_vh.errors import ConfigError
from adamo_vh.inference.arguments import read_arguments
from adamo_vh.observation import Frame

CALL, STRUCTURED = "call", "structured"
"""Kinds of actions: a tool call as JSON text, or numbers."""
MOST_OBJECTS = 64
"""Objects that a structured action can point at."""
_LONGEST_CALL, _LONGEST_TEXT = 4_000, 20_000
"""Letters of a call, and of the text of an observation."""
_LETTERS = string.ascii_letters + string.digits + string.punctuation + " \n"
_KNOWN = frozenset(_LETTERS)
_WITH_OBJECT = (action_name(Pick), action_name(Inspect))
_WITH_POINT = (action_name(Look), action_name(Walk), action_name(Drop))

Call = tuple[str, Mapping[str, Any] | None]
"""Name and arguments of a tool call; None for arguments that could not be read."""


def observation_space(width_px: int, height_px: int) -> spaces.Dict:
    """The view as a picture, and as text the instruction, the last feedback and the state.

    Args:
        width_px: Of the frames.
        height_px: Of the frames.
    """
    text = spaces.Text(_LONGEST_TEXT, min_length=0, charset=_LETTERS)
    picture = spaces.Box(0, 255, (height_px, width_px, 3), np.uint8)
    return spaces.Dict({"image": picture, "text": text})


def action_space(kind: str, tools: Sequence[str]) -> spaces.Space[Any]:
    """What can be done.

    Args:
        kind: "call": a tool call as JSON text; "structured": a tool, an object and a point.
        tools: Names of the tools on offer.

    Raises:
        ConfigError: There is no such kind.
    """
    if kind == CALL:
        return spaces.Text(_LONGEST_CALL, min_length=0, charset=_LETTERS)
    if kind == STRUCTURED:
        return spaces.Dict(
            {
                "tool": spaces.Discrete(len(tools)),
                "object": spaces.Discrete(MOST_OBJECTS),
                "point": spaces.Box(-1.0, 1.0, (3,), np.float32),
            }
        )
    raise ConfigError(f"There are no actions {kind!r}. Use {CALL} or {STRUCTURED}.")


def read_text_call(action: str | Mapping[str, Any]) -> Call:
    """A tool call from its text, ``{"name": "Pick", "arguments": {"object": "Plate_57"}}``.

    Args:
        action: The text, or the same as a mapping.
    """
    told = read_arguments(action) if isinstance(action, str) else action
    if not isinstance(told, Mapping) or not isinstance(name := told.get("name"), str):
        return "", None
    arguments = told.get("arguments", {})
    return name, arguments if isinstance(arguments, Mapping) else None


def read_structured(
    action: Mapping[str, Any],
    tools: Sequence[str],
    objects: Sequence[str],
    held: str | None,
    scene: SceneInfo,
) -> Call:
    """A tool call from numbers.

    Args:
        action: `tool` counts the tools, `object` the objects of the last view, and `point` spans
            the room from -1 to 1 along each axis. What a tool does not need is not looked at; Drop
            takes what is in the hand.
        tools: Names of the tools on offer.
        objects: Tags of the last view, in the order of its list.
        held: Tag of what is in the hand.
        scene: The room.
    """
    name = tools[int(action["tool"])]
    arguments: dict[str, Any] = {}
    if name in _WITH_OBJECT:
        number = int(action["object"])
        arguments["object"] = objects[number] if number < len(objects) else "none"
    if name == action_name(Drop):
        arguments["object"] = held or "none"
    if name in _WITH_POINT:
        low = np.array([scene.x_min, scene.y_min, 0.0])
        high = np.array([scene.x_max, scene.y_max, scene.height_m])
        point = low + (np.asarray(action["point"], float) + 1) / 2 * (high - low)
        # As fine as everything that is told: the record holds no digits of noise.
        arguments |= {axis: round(float(v), 3) for axis, v in zip("xyz", point, strict=True)}
    return name, arguments


def picture(frame: Frame) -> NDArray[np.uint8]:
    """A frame's pixels, (H, W, 3)."""
    from PIL import Image

    return np.array(Image.open(io.BytesIO(frame.data)).convert("RGB"))


def text_within(parts: Sequence[str]) -> str:
    """A text of the observation space: in its letters, and no longer than it allows."""
    joined = "\n\n".join(part for part in parts if part)
    return "".join(letter if letter in _KNOWN else "?" for letter in joined)[:_LONGEST_TEXT]
