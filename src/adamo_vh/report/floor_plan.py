"""The room from above, as numbers for a drawing: things, what became of them, the body's way.

Coordinates are metres with y turned over, as pictures have it: right is +X, up is +Y.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from adamo_vh.benchmark.checkers import MOVED_M
from adamo_vh.engine import FLOOR, ObjectState, SceneInfo, WorldState, supporting_object
from adamo_vh.geometry import Box, Vec3
from adamo_vh.observation import AgentState, BodyState
from adamo_vh.report.timeline import Turn

MARGIN_M = 0.35
"""White space around the room."""
_SAME_PLACE_M = 0.05
_Plan = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Outline:
    """A thing or a place seen from above."""

    label: str
    title: str
    x: float
    y: float
    points: str
    """Corners, as the `points` of an SVG polygon."""


@dataclass(frozen=True, slots=True)
class Move:
    """An object that ended elsewhere than it began."""

    title: str
    start: _Plan
    outline: Outline
    """Where it ended."""


@dataclass(frozen=True, slots=True)
class Pose:
    """The body after a turn."""

    anchor: str
    """Of the turn."""
    x: float
    y: float
    heading_deg: float
    """Clockwise from +X, as SVG turns."""
    gaze: _Plan


@dataclass(frozen=True, slots=True)
class Stop:
    """A place where the body stood, and in which steps."""

    x: float
    y: float
    label: str


@dataclass(frozen=True, slots=True)
class FloorPlan:
    """Everything that the drawing shows."""

    x: float
    y: float
    width: float
    height: float
    areas: tuple[Outline, ...]
    surfaces: tuple[Outline, ...]
    """Around the things that began on the same piece of furniture; no furniture is recorded."""
    objects: tuple[Outline, ...]
    """Where they began."""
    moves: tuple[Move, ...]
    path: str
    """The stops in order, joined by straight lines, as `points` of an SVG polyline."""
    stops: tuple[Stop, ...]
    poses: tuple[Pose, ...]


def floor_plan(initial: WorldState, turns: Sequence[Turn], final: WorldState | None) -> FloorPlan:
    """Measure the drawing.

    Args:
        initial: The world when the episode began.
        turns: The episode.
        final: The world when it ended, if it did.
    """
    scene = initial.scene
    states: list[tuple[str, BodyState | AgentState]] = [("start", initial.body)]
    for turn in turns:
        # A plan may stand at several places in one turn.
        steps = [(str(act.step), act.agent) for act in turn.acts]
        states += steps or ([(turn.label, turn.agent)] if turn.agent else [])
    way = [_plan(state.position) for _, state in states]
    return FloorPlan(
        x=scene.x_min,
        y=-scene.y_max,
        width=scene.x_max - scene.x_min,
        height=scene.y_max - scene.y_min,
        areas=_areas(scene),
        surfaces=_surfaces(initial.objects),
        objects=tuple(_footprint(item) for item in initial.objects if not item.held),
        moves=_moves(initial, final) if final else (),
        path=_points([way[0], *(b for a, b in pairwise(way) if a != b)]),
        stops=_stops(states),
        poses=tuple(_pose(turn.anchor, turn.agent) for turn in turns if turn.agent),
    )


def _areas(scene: SceneInfo) -> tuple[Outline, ...]:
    return tuple(
        _outline(
            area.kind,
            f"{area.kind} area {area.name}",
            [
                (area.x_min, -area.y_min),
                (area.x_max, -area.y_min),
                (area.x_max, -area.y_max),
                (area.x_min, -area.y_max),
            ],
        )
        for area in scene.areas
    )


def _surfaces(objects: Iterable[ObjectState]) -> tuple[Outline, ...]:
    groups: dict[str, list[_Plan]] = {}
    for item in objects:
        if item.support and item.support != FLOOR and supporting_object(item.support) is None:
            groups.setdefault(item.support, []).extend(_corners(item.box))
    return tuple(_outline(name, f"on {name}", _hull(points)) for name, points in groups.items())


def _moves(initial: WorldState, final: WorldState) -> tuple[Move, ...]:
    return tuple(
        Move(
            f"{_name(after)}: {'in the hand' if after.held else f'now on {after.support}'}",
            _plan(before.box.center),
            _footprint(after),
        )
        for before, after in zip(initial.objects, final.objects, strict=False)
        if before.id == after.id and before.box.center.distance(after.box.center) > MOVED_M
    )


def _stops(states: Iterable[tuple[str, BodyState | AgentState]]) -> tuple[Stop, ...]:
    places: list[tuple[Vec3, list[str]]] = []
    for label, state in states:
        for place, labels in places:
            if place.horizontal_distance(state.position) <= _SAME_PLACE_M:
                labels.append(label)
                break
        else:
            places.append((state.position, [label]))
    return tuple(Stop(*_plan(place), _ranges(labels)) for place, labels in places)


def _ranges(labels: Sequence[str]) -> str:
    """Step numbers, with runs of them as ranges: "start, 1–3, 7"."""
    words = [label for label in labels if label and not label.isdigit()]
    runs: list[list[int]] = []
    for number in sorted({int(label) for label in labels if label.isdigit()}):
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    spans = [f"{run[0]}–{run[-1]}" if len(run) > 1 else str(run[0]) for run in runs]
    return ", ".join([*words, *spans])


def _pose(anchor: str, agent: AgentState) -> Pose:
    heading_deg = round(-math.degrees(agent.heading_rad), 1) + 0.0
    return Pose(anchor, *_plan(agent.position), heading_deg, _plan(agent.gaze))


def _footprint(item: ObjectState) -> Outline:
    return _outline(str(item.id), _name(item), _hull(_corners(item.box)))


def _outline(label: str, title: str, points: Sequence[_Plan]) -> Outline:
    x = sum(p[0] for p in points) / len(points)
    y = sum(p[1] for p in points) / len(points)
    return Outline(label, title, round(x, 3), round(y, 3), _points(points))


def _corners(box: Box) -> list[_Plan]:
    return [(float(x), -float(y)) for x, y, _ in box.corners()]


def _hull(points: Iterable[_Plan]) -> list[_Plan]:
    """Convex hull by monotone chains."""
    ordered = sorted(set(points))

    def chain(way: Iterable[_Plan]) -> list[_Plan]:
        kept: list[_Plan] = []
        for p in way:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], p) <= 0:
                kept.pop()
            kept.append(p)
        return kept[:-1]

    return [*chain(ordered), *chain(reversed(ordered))] or ordered


def _turn(a: _Plan, b: _Plan, c: _Plan) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _plan(point: Vec3) -> _Plan:
    return round(point.x, 3), round(-point.y, 3) + 0.0


def _points(points: Iterable[_Plan]) -> str:
    return " ".join(f"{x:.3f},{y:.3f}" for x, y in points)


def _name(item: ObjectState) -> str:
    return f"{item.class_name}_{item.id}"
