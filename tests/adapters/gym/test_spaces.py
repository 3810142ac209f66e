"""Actions of Gymnasium as tool calls, and texts that stay within their space."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
from gymnasium import spaces
from PIL import Image

from adamo_vh.adapters.gym.spaces import (
    MOST_OBJECTS,
    action_space,
    observation_space,
    picture,
    read_structured,
    read_text_call,
    text_within,
)
from adamo_vh.engine import SceneInfo
from adamo_vh.errors import ConfigError
from adamo_vh.observation import Frame

TOOLS = ("Look", "Walk", "Pick", "Drop", "Inspect", "Survey", "Finish")
ROOM = SceneInfo("room", -3.0, -5.0, 3.0, 3.0, 2.5, ())
TAGS = ("Plate_57", "Glass_37")


def structured(
    tool: str, *, number: int = 0, point: Any = (0, 0, 0), held: str | None = None
) -> Any:
    action = {
        "tool": np.int64(TOOLS.index(tool)),
        "object": np.int64(number),
        "point": np.array(point, np.float32),
    }
    return read_structured(action, TOOLS, TAGS, held, ROOM)


@pytest.mark.parametrize(
    ("text", "call"),
    [
        ('{"name": "Survey"}', ("Survey", {})),
        (
            '{"name": "Pick", "arguments": {"object": "Plate_57"}}',
            ("Pick", {"object": "Plate_57"}),
        ),
        ({"name": "Pick", "arguments": {"object": "57"}}, ("Pick", {"object": "57"})),
        ('{"name": "Pick", "arguments": [1]}', ("Pick", None)),
        ('{"name": ["Pick"]}', ("", None)),
        ("Pick", ("", None)),
        ("[]", ("", None)),
        ("", ("", None)),
        ('{"name": "Look", "arguments": {"x": NaN}}', ("", None)),
    ],
)
def test_a_call_is_read_from_its_text(text: Any, call: Any) -> None:
    assert read_text_call(text) == call


def test_a_point_spans_the_room() -> None:
    assert structured("Walk", point=(-1, -1, -1)) == ("Walk", {"x": -3.0, "y": -5.0, "z": 0.0})
    assert structured("Walk", point=(1, 1, 1)) == ("Walk", {"x": 3.0, "y": 3.0, "z": 2.5})
    assert structured("Look", point=(0, 0, 0)) == ("Look", {"x": 0.0, "y": -1.0, "z": 1.25})


def test_an_object_is_one_of_the_last_view() -> None:
    assert structured("Pick", number=1) == ("Pick", {"object": "Glass_37"})
    assert structured("Inspect", number=0) == ("Inspect", {"object": "Plate_57"})
    # A number without an object is refused by the body, like a tag that was never seen.
    assert structured("Pick", number=2) == ("Pick", {"object": "none"})


def test_drop_takes_what_is_in_the_hand() -> None:
    name, arguments = structured("Drop", number=1, point=(0, 0, -1), held="Cup_45")
    assert (name, arguments["object"], arguments["z"]) == ("Drop", "Cup_45", 0.0)
    assert structured("Drop")[1]["object"] == "none"


@pytest.mark.parametrize("tool", ["Survey", "Finish"])
def test_what_a_tool_does_not_need_is_not_looked_at(tool: str) -> None:
    assert structured(tool, number=63, point=(9, 9, 9)) == (tool, {})


def test_every_structured_action_is_a_call() -> None:
    space = action_space("structured", TOOLS)
    space.seed(0)
    for _ in range(50):
        name, arguments = read_structured(space.sample(), TOOLS, TAGS, None, ROOM)
        assert name in TOOLS and isinstance(arguments, dict)
    assert isinstance(space, spaces.Dict)
    assert space["object"].contains(np.int64(MOST_OBJECTS - 1))


def test_a_text_stays_within_its_space() -> None:
    space = observation_space(16, 9)["text"]
    told = text_within(["Pick “the plate”, 3 cm³ – now.", "", "Zweite Zeile: ä"])
    assert told == "Pick ?the plate?, 3 cm? ? now.\n\nZweite Zeile: ?"
    assert space.contains(told)
    assert space.contains(text_within(["x" * 50_000]))
    assert space.contains(text_within([]))


def test_a_picture_is_pixels() -> None:
    data = io.BytesIO()
    Image.new("L", (16, 9), 200).save(data, "PNG")
    pixels = picture(Frame(data.getvalue(), "image/png", 16, 9))
    assert pixels.shape == (9, 16, 3) and pixels.dtype == np.uint8
    pixels[0, 0] = 0  # It is the caller's own.
    assert observation_space(16, 9)["image"].contains(pixels)


def test_an_unknown_kind_of_actions_names_those_there_are() -> None:
    with pytest.raises(ConfigError, match="Use call or structured"):
        action_space("joystick", TOOLS)
