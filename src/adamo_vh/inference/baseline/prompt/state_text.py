"""The symbolic state read back from text: told whole, or as what changed."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from math import radians

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.tags import parts_of

_NUMBER = r"(-?\d+(?:\.\d+)?)"
_POINT = re.compile(rf"\(\s*{_NUMBER}\s*,\s*{_NUMBER}\s*,\s*{_NUMBER}\s*\)")
# "- Cup_45: center (x, y, z), volume 2 cm3", or tersely "- Cup_45 (x,y,z), 2 cm3"
_LINE = re.compile(r"^-\s*([^:\s()]+?)\s*(?::\s*center\b|(?=\())(.*cm3.*)$", re.MULTILINE)
_VOLUME = re.compile(rf"{_NUMBER} cm3")
_BOX = re.compile(r"box \[(\d+), (\d+), (\d+), (\d+)\]")
_IN_VIEW = re.compile(r"^In view: (.*)$", re.MULTILINE)
_TAG_IN_VIEW = re.compile(r"([^\s,\[\]]+)(?: \[(\d+), (\d+), (\d+), (\d+)\])?(?:, |$)")
_POINTS_NOW = re.compile(r"^Reference points: (.*)$", re.MULTILINE)
_YOU = re.compile(r"^You: (.*)$", re.MULTILINE)
_WHOLE = "## Visible objects"

PixelBox = tuple[int, int, int, int]


@dataclass(frozen=True, slots=True)
class Listed:
    """An object as the text tells it."""

    tag: str
    position: Vec3
    """Centre of the box, world metres."""
    volume_cm3: float
    box_px: PixelBox | None = None


@dataclass(frozen=True, slots=True)
class Body:
    """The agent's own state; what the text leaves out is None."""

    position: Vec3
    heading_rad: float | None = None
    gaze: Vec3 | None = None
    hand: str | None = None
    """"empty" or the tag of the held object."""


@dataclass(slots=True)
class StateReader:
    """Takes texts in, oldest first, and knows what they told."""

    told: dict[str, Listed] = field(default_factory=dict)
    """The latest word about each object."""
    told_at: dict[str, int] = field(default_factory=dict)
    """The turn of that word."""
    told_from_m: dict[str, float] = field(default_factory=dict)
    """How far the body was from it at that word, where the two were told together."""
    turn: int = 0
    in_view: dict[str, PixelBox | None] = field(default_factory=dict)
    points: tuple[Vec3, ...] = ()
    body: Body = field(default_factory=lambda: Body(Vec3(0.0, 0.0, 0.0)))
    views: int = 0
    """How many lists of what is in view were read."""

    def read_whole(self, text: str) -> bool:
        """Take in a text with the whole state; False if it has none."""
        if _WHOLE not in text:
            return False
        things = list(_things(_section(text, "Visible objects")))
        self.told.update({thing.tag: thing for thing in things})
        self.in_view = {thing.tag: thing.box_px for thing in things}
        self.points = tuple(_points(_section(text, "Reference points")))
        self.body = _body(_section(text, "You"))
        return True

    def read_changes(self, text: str) -> bool:
        """Take in what changed; True if it tells of a new view."""
        for you in _YOU.findall(text):
            self.body = _body(you)
        for thing in _things(text):
            self.told[thing.tag] = thing
            self.told_at[thing.tag] = self.turn
            distance = thing.position.horizontal_distance(self.body.position)
            self.told_from_m[thing.tag] = round(distance, 1)
        if points := _POINTS_NOW.findall(text):
            self.points = tuple(_points(points[-1]))
        views: list[str] = _IN_VIEW.findall(text)
        for view in views:
            self.in_view = {} if view == "none" else _boxes(view)
        self.views += len(views)
        return bool(views)

    def things(self) -> tuple[Listed, ...]:
        """What is in the latest view, which may name things by their numbers alone."""
        whole = {parts_of(tag)[1]: tag for tag in self.told}
        tags = {
            tag if tag in self.told else whole.get(tag, tag): box
            for tag, box in self.in_view.items()
        }
        return tuple(
            Listed(tag, self.told[tag].position, self.told[tag].volume_cm3, box)
            for tag, box in tags.items()
            if tag in self.told
        )


def first_point(text: str, last: bool = False) -> Vec3 | None:
    """The first or the last "(x, y, z)" in a text."""
    found = _POINT.findall(text)
    return Vec3.of([float(v) for v in found[-1 if last else 0]]) if found else None


def _points(text: str) -> list[Vec3]:
    return [Vec3.of([float(v) for v in found]) for found in _POINT.findall(text)]


def _section(text: str, title: str) -> str:
    found = re.search(rf"^## {title}\s*$(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    return found.group(1).strip() if found else ""


def _things(text: str) -> list[Listed]:
    things = []
    for tag, rest in _LINE.findall(text):
        point = first_point(rest)
        if point is None:
            continue
        volume, box = _VOLUME.search(rest), _BOX.search(rest)
        things.append(
            Listed(
                tag, point, float(volume.group(1)) if volume else 0.0, _box(box and box.groups())
            )
        )
    return things


def _boxes(text: str) -> dict[str, PixelBox | None]:
    return {tag: _box(box) for tag, *box in _TAG_IN_VIEW.findall(text)}


def _box(numbers: object) -> PixelBox | None:
    if not isinstance(numbers, list | tuple) or len(numbers) != 4 or not numbers[0]:
        return None
    left, top, right, bottom = (int(number) for number in numbers)
    return left, top, right, bottom


def _body(text: str) -> Body:
    """Read lines of "- position (...)", "- heading ...", or the same in one line."""

    def after(word: str) -> str:
        return text.partition(word)[2].lstrip(": ")

    position = first_point(after("position"))
    heading = re.match(_NUMBER, after("heading"))
    gaze = first_point(after("gaze"))
    hand = after("hand").split()
    return Body(
        position or Vec3(0.0, 0.0, 0.0),
        radians(float(heading.group(1))) if heading else None,
        gaze,
        hand[0].rstrip(",") if hand else None,
    )
