"""What the prompt says: messages read back into data, as any reader of the text could."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import radians
from typing import Any

from adamo.geometry import Vec3
from adamo.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    SystemMessage,
    TextPart,
    ToolMessage,
)

_NUMBER = r"(-?\d+(?:\.\d+)?)"
_POINT = re.compile(rf"\(\s*{_NUMBER}\s*,\s*{_NUMBER}\s*,\s*{_NUMBER}\s*\)")
_SPAN = re.compile(rf"x from {_NUMBER} to {_NUMBER} and y from {_NUMBER} to {_NUMBER}")
_CORNER = re.compile(rf"{_NUMBER} x {_NUMBER} m squares")
_NEAR = re.compile(rf"within {_NUMBER} m horizontally")
_VOLUME = re.compile(rf"volume {_NUMBER}")
_BOX = re.compile(r"box \[(\d+), (\d+), (\d+), (\d+)\]")


@dataclass(frozen=True, slots=True)
class Room:
    """What the fixed instructions say about the room, metres."""

    x_min: float = -3.0
    x_max: float = 3.0
    y_min: float = -3.0
    y_max: float = 3.0
    corner_m: float = 1.0
    near_m: float = 0.3

    def clamp(self, point: Vec3, margin_m: float) -> Vec3:
        """The nearest point that keeps a distance to the walls."""
        x = min(max(point.x, self.x_min + margin_m), self.x_max - margin_m)
        y = min(max(point.y, self.y_min + margin_m), self.y_max - margin_m)
        return Vec3(x, y, point.z)

    def corners(self) -> tuple[Vec3, ...]:
        """Centres of the four corner areas."""
        half = self.corner_m / 2
        return tuple(
            Vec3(x, y, 0.0)
            for x in (self.x_min + half, self.x_max - half)
            for y in (self.y_min + half, self.y_max - half)
        )


@dataclass(frozen=True, slots=True)
class Listed:
    """One line of the object list."""

    tag: str
    position: Vec3
    """Centre of the box, world metres."""
    volume_cm3: float
    box_px: tuple[int, int, int, int] | None = None


@dataclass(frozen=True, slots=True)
class Body:
    """The agent's own state; what the text form leaves out is None."""

    position: Vec3
    heading_rad: float | None = None
    gaze: Vec3 | None = None
    hand: str | None = None
    """"empty" or the tag of the held object."""


@dataclass(frozen=True, slots=True)
class Event:
    """The latest tool call and what came back."""

    name: str
    arguments: Mapping[str, Any]
    outcome: str
    """"done", "corrected" or "refused"."""
    text: str

    @property
    def point(self) -> Vec3 | None:
        """The last coordinates in the feedback."""
        return first_point(self.text, last=True)


@dataclass(frozen=True, slots=True)
class Prompt:
    """The whole prompt, read."""

    instruction: str
    room: Room
    things: tuple[Listed, ...]
    points: tuple[Vec3, ...]
    """Reference points, world metres."""
    body: Body
    frame: ImagePart | None
    """The latest frame."""
    note: str
    """The last own note; empty at the start."""
    event: Event | None
    """None before the first tool call."""

    @property
    def points_key(self) -> tuple[tuple[float, float, float], ...]:
        """The reference points as plain tuples."""
        return tuple((p.x, p.y, p.z) for p in self.points)


def first_point(text: str, last: bool = False) -> Vec3 | None:
    """The first or the last "(x, y, z)" in a text."""
    found = _POINT.findall(text)
    return Vec3.of([float(v) for v in found[-1 if last else 0]]) if found else None


def read_prompt(messages: Sequence[Message]) -> Prompt:
    """Read all messages; parts that are missing read as empty.

    Args:
        messages: The prompt, oldest first.
    """
    system = [m.text for m in messages if isinstance(m, SystemMessage)]
    human = [m for m in messages if isinstance(m, HumanMessage)]
    own = [m for m in messages if isinstance(m, AIMessage)]
    state = next((text for text in system if "## Visible objects" in text), "")
    frames = [p for m in human for p in m.parts if isinstance(p, ImagePart)]
    return Prompt(
        instruction=_instruction(human),
        room=_room("\n".join(text for text in system if text is not state)),
        things=tuple(_things(_section(state, "Visible objects"))),
        points=tuple(
            point
            for line in _section(state, "Reference points").splitlines()
            if (point := first_point(line))
        ),
        body=_body(_section(state, "You")),
        frame=frames[-1] if frames else None,
        note=next((m.text for m in reversed(own) if m.text), ""),
        event=_event(messages),
    )


def _instruction(human: Sequence[HumanMessage]) -> str:
    if not human:
        return ""
    texts = [part.text for part in human[0].parts if isinstance(part, TextPart)]
    return texts[0].strip() if texts else ""


def _room(text: str) -> Room:
    span, corner, near = _SPAN.search(text), _CORNER.search(text), _NEAR.search(text)
    usual = Room()
    x_min, x_max, y_min, y_max = (
        (float(v) for v in span.groups())
        if span
        else (usual.x_min, usual.x_max, usual.y_min, usual.y_max)
    )
    return Room(
        x_min,
        x_max,
        y_min,
        y_max,
        float(corner.group(1)) if corner else usual.corner_m,
        float(near.group(1)) if near else usual.near_m,
    )


def _section(text: str, title: str) -> str:
    found = re.search(rf"^## {title}\s*$(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    return found.group(1).strip() if found else ""


def _things(section: str) -> list[Listed]:
    things = []
    for line in section.splitlines():
        head = re.match(r"-\s*([^:\s]+)\s*:", line)
        point = first_point(line)
        if not head or not point:
            continue
        volume, box = _VOLUME.search(line), _BOX.search(line)
        pixels = tuple(int(v) for v in box.groups()) if box else None
        things.append(
            Listed(
                head.group(1),
                point,
                float(volume.group(1)) if volume else 0.0,
                (pixels[0], pixels[1], pixels[2], pixels[3]) if pixels else None,
            )
        )
    return things


def _body(section: str) -> Body:
    lines = section.splitlines()
    position = gaze = heading = hand = None
    for line in lines:
        if "position" in line:
            position = first_point(line)
        elif "gaze" in line:
            gaze = first_point(line)
        elif "heading" in line and (number := re.search(_NUMBER, line)):
            heading = radians(float(number.group(1)))
        elif "hand:" in line:
            hand = line.split("hand:")[1].strip()
    return Body(position or Vec3(0.0, 0.0, 0.0), heading, gaze, hand)


def _event(messages: Sequence[Message]) -> Event | None:
    """The last call that got feedback; a turn may have had several, the first is executed."""
    tools = {m.call_id: m for m in messages if isinstance(m, ToolMessage)}
    for message in reversed(messages):
        if isinstance(message, AIMessage) and message.calls:
            call = message.calls[0]
            feedback = tools.get(call.id)
            if feedback is None:
                return None
            word = re.match(r"\W*(\w+)", feedback.text)
            return Event(
                call.name,
                dict(call.arguments or {}),
                word.group(1).lower() if word else "",
                feedback.text,
            )
    return None
