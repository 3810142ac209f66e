"""The room from above, as numbers for a drawing: furniture, things, what became of them, the way.

Coordinates are metres with y turned over, as pictures have it: right is +X, up is +Y.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from adamo_vh.benchmark.checkers import MOVED_M
from adamo_vh.engine import FLOOR, ObjectState, SceneInfo, WorldState, supporting_object
from adamo_vh.geometry import Box, Plan, Vec3, hull
from adamo_vh.observation import AgentState, BodyState
from adamo_vh.perception import Labeling
from adamo_vh.report.map_labels import Ground, Label, Wish, placed
from adamo_vh.report.timeline import ShownTurn
from adamo_vh.report.whereabouts import Whereabouts

_MARGIN_M = 0.35
"""Space around the room."""
_AROUND_M = 0.7
"""Space around what there is to see; the rest of a bare room is left out."""
_USUAL_M = (6.7, 8.7)
"""A drawing of this size has labels of the sizes below; in a smaller one they are smaller too."""
_SAME_PLACE_M = 0.05
_OVERHEAD_M = 1.9
"""What begins higher hangs over the floor."""
_ON_THE_WALL_M = 0.5


@dataclass(frozen=True, slots=True)
class Outline:
    """A thing or a place seen from above."""

    label: str
    title: str
    x: float
    y: float
    points: str
    """Corners, as the `points` of an SVG polygon."""
    kind: str = ""
    """Of furniture: "flat", "standing", "wall" or "hanging"."""
    area_m2: float = 0.0


@dataclass(frozen=True, slots=True)
class Move:
    """An object that ended elsewhere than it began."""

    title: str
    start: Plan
    outline: Outline
    """Where it ended; its label is the name."""


@dataclass(frozen=True, slots=True)
class Pose:
    """The body after a turn."""

    anchor: str
    """Of the turn."""
    x: float
    y: float
    heading_deg: float
    """Clockwise from +X, as SVG turns."""
    gaze: Plan


@dataclass(frozen=True, slots=True)
class Stop:
    """A place where the body stood, and in which steps."""

    x: float
    y: float
    label: str


@dataclass(frozen=True, slots=True)
class View:
    """A rectangle of the drawing, metres."""

    x: float
    y: float
    width: float
    height: float

    @property
    def scale(self) -> float:
        """Size of its labels, in parts of the usual one."""
        return max(self.width / _USUAL_M[0], self.height / _USUAL_M[1])


@dataclass(frozen=True, slots=True)
class FloorPlan:
    """Everything that the drawing shows."""

    x: float
    y: float
    width: float
    height: float
    """The room."""
    view: View
    """The part of it that is drawn."""
    areas: tuple[Outline, ...]
    furniture: tuple[Outline, ...]
    """What covers others comes later."""
    surfaces: tuple[Outline, ...]
    """Around the things that began on the same piece, where the record knows no furniture."""
    objects: tuple[Outline, ...]
    """Where they began."""
    moves: tuple[Move, ...]
    path: str
    """The stops in order, joined by straight lines, as `points` of an SVG polyline."""
    stops: tuple[Stop, ...]
    poses: tuple[Pose, ...]
    labels: Mapping[str, tuple[Label, ...]]
    """For the "small" drawing beside the steps, and for the "large" one."""


def floor_plan(
    initial: WorldState,
    turns: Sequence[ShownTurn],
    final: WorldState | None,
    told: Mapping[str, Whereabouts] | None = None,
) -> FloorPlan:
    """Measure the drawing.

    Args:
        initial: The world when the episode began.
        turns: The episode.
        final: The world when it ended, if it is known.
        told: What the feedback says became of the things, if it is not.
    """
    scene = initial.scene
    states: list[tuple[str, BodyState | AgentState]] = [("start", initial.body)]
    for turn in turns:
        # A plan may stand at several places in one turn.
        steps = [(str(act.step), act.agent) for act in turn.acts]
        states += steps or ([(turn.label, turn.agent)] if turn.agent else [])
    # A damaged record may tell of places that no drawing can hold.
    states = [item for item in states if scene.is_within_walls(item[1].position, _AROUND_M)]
    way = [_plan(state.position) for _, state in states]
    way = way[:1] + [b for a, b in pairwise(way) if a != b]
    furniture = _furniture(initial)
    surfaces = () if furniture else _surfaces(initial.objects)
    objects = tuple(_footprint(item) for item in initial.objects if not item.held)
    moves = _moves(initial, final) if final else _told_moves(initial, told or {})
    stops = _stops(states)
    view = _view(scene, way, (*furniture, *objects, *(move.outline for move in moves)))
    ground = _ground(view, way, objects)
    small = _small_labels(stops, moves, furniture or surfaces)
    large = _large_labels(stops, moves, objects, furniture or surfaces)
    return FloorPlan(
        x=scene.x_min,
        y=-scene.y_max,
        width=scene.x_max - scene.x_min,
        height=scene.y_max - scene.y_min,
        view=view,
        areas=_areas(scene),
        furniture=furniture,
        surfaces=surfaces,
        objects=objects,
        moves=moves,
        path=_points(way),
        stops=stops,
        poses=tuple(
            _pose(turn.anchor, turn.agent)
            for turn in turns
            if turn.agent and scene.is_within_walls(turn.agent.position, _AROUND_M)
        ),
        labels={
            "small": _placed(small, ground, view.scale),
            "large": _placed(large, ground, view.scale),
        },
    )


def _view(scene: SceneInfo, way: Sequence[Plan], things: Sequence[Outline]) -> View:
    """What is drawn: all that is there and all that happened, with some floor around it."""
    corners = [tuple(map(float, p.split(","))) for item in things for p in item.points.split()]
    xs, ys = zip(*(corners or [(scene.x_min, -scene.y_max)]), *way, strict=True)
    left = max(min(xs) - _AROUND_M, scene.x_min - _MARGIN_M)
    right = min(max(xs) + _AROUND_M, scene.x_max + _MARGIN_M)
    top = max(min(ys) - _AROUND_M, -scene.y_max - _MARGIN_M)
    bottom = min(max(ys) + _AROUND_M, -scene.y_min + _MARGIN_M)
    return View(*(round(value, 3) for value in (left, top, right - left, bottom - top)))


def _ground(view: View, way: Sequence[Plan], objects: Sequence[Outline]) -> Ground:
    """What labels stand on: they had better not cover stops, ways and things."""
    busy = [(item.x, item.y) for item in objects] + [stop for stop in way for _ in range(4)]
    for (ax, ay), (bx, by) in pairwise(way):
        parts = min(200, 1 + int(math.hypot(bx - ax, by - ay) / 0.1))
        busy += [(ax + (bx - ax) * i / parts, ay + (by - ay) * i / parts) for i in range(parts)]
    edge = 0.03 * view.scale
    right, bottom = view.x + view.width - edge, view.y + view.height - edge
    return Ground(view.x + edge, view.y + edge, right, bottom, busy)


def _placed(wishes: Sequence[Wish], ground: Ground, scale: float) -> tuple[Label, ...]:
    return placed([replace(wish, size=round(wish.size * scale, 4)) for wish in wishes], ground)


def _small_labels(
    stops: Sequence[Stop], moves: Sequence[Move], furniture: Sequence[Outline]
) -> list[Wish]:
    large = [item for item in furniture if item.area_m2 > 0.3 or not item.kind]
    return [
        *(Wish(stop.label, "stop", stop.x, stop.y, 0.24, 0.18) for stop in stops),
        *(Wish(m.outline.label, "moved", m.outline.x, m.outline.y, 0.2, 0.12) for m in moves),
        *_names(large, 0.19),
    ]


def _large_labels(
    stops: Sequence[Stop],
    moves: Sequence[Move],
    objects: Sequence[Outline],
    furniture: Sequence[Outline],
) -> list[Wish]:
    return [
        *(Wish(stop.label, "stop", stop.x, stop.y, 0.15, 0.18) for stop in stops),
        *(Wish(m.outline.label, "moved", m.outline.x, m.outline.y, 0.13, 0.08) for m in moves),
        *(Wish(item.label, "object", item.x, item.y, 0.11, 0.0) for item in objects),
        *_names(furniture, 0.13),
    ]


def _names(furniture: Sequence[Outline], size: float) -> list[Wish]:
    """The names of what stands on the floor, the large pieces first."""
    standing = [item for item in furniture if item.kind in ("standing", "")]
    standing.sort(key=lambda item: -item.area_m2)
    return [Wish(item.label, "name", item.x, item.y, size, 0.0, 0.5) for item in standing]


def _furniture(world: WorldState) -> tuple[Outline, ...]:
    found = []
    for piece in world.furniture:
        if len(piece.points) < 3:
            continue
        points = [_plan(Vec3(x, y, 0.0)) for x, y in piece.points]
        kind = "hanging" if piece.bottom_m > _OVERHEAD_M else "standing"
        if piece.top_m < 0.03:
            kind = "flat"
        elif _ON_THE_WALL_M < piece.bottom_m <= _OVERHEAD_M:
            kind = "wall"
        found.append(_outline(piece.name, piece.name, points, kind))
    order = ("flat", "wall", "standing", "hanging")
    # A table covers the chairs that are pushed under it.
    return tuple(sorted(found, key=lambda item: (order.index(item.kind), item.area_m2)))


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
    groups: dict[str, list[Plan]] = {}
    for item in objects:
        if item.support and item.support != FLOOR and supporting_object(item.support) is None:
            groups.setdefault(item.support, []).extend(_corners(item.box))
    return tuple(_outline(name, f"on {name}", hull(points)) for name, points in groups.items())


def _moves(initial: WorldState, final: WorldState) -> tuple[Move, ...]:
    return tuple(
        Move(
            f"{_name(after)}: {'in the hand' if after.held else f'now on {after.support}'}",
            _plan(before.box.center),
            _footprint(after, _name(after)),
        )
        for before, after in zip(initial.objects, final.objects, strict=False)
        if before.id == after.id and before.box.center.distance(after.box.center) > MOVED_M
    )


def _told_moves(initial: WorldState, told: Mapping[str, Whereabouts]) -> tuple[Move, ...]:
    """The same from the feedback; a thing that is in the hand has no place on the map."""
    found = []
    for item in initial.objects:
        tags = (labeling.tag(item.id, item.class_name) for labeling in Labeling)
        now = next((told[tag] for tag in tags if tag in told), None)
        if now is None or now.plan is None:
            continue
        x, y = now.plan
        center = Vec3(x, y, item.box.center.z)
        if item.box.center.horizontal_distance(center) > MOVED_M:
            there = replace(item, box=replace(item.box, center=center))
            place = f"{_name(item)}: now {now.place}"
            found.append(Move(place, _plan(item.box.center), _footprint(there, _name(item))))
    return tuple(found)


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


def _footprint(item: ObjectState, label: str = "") -> Outline:
    return _outline(label or str(item.id), _name(item), hull(_corners(item.box)))


def _outline(label: str, title: str, points: Sequence[Plan], kind: str = "") -> Outline:
    """A polygon, with its label in the middle of its extent."""
    xs, ys = [p[0] for p in points], [p[1] for p in points]
    x, y = (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2
    around = zip(points, [*points[1:], points[0]], strict=True)
    area = abs(sum(ax * by - bx * ay for (ax, ay), (bx, by) in around)) / 2
    return Outline(label, title, round(x, 3), round(y, 3), _points(points), kind, area)


def _corners(box: Box) -> list[Plan]:
    return [(float(x), -float(y)) for x, y, _ in box.corners()]


def _plan(point: Vec3) -> Plan:
    return round(point.x, 3), round(-point.y, 3) + 0.0


def _points(points: Iterable[Plan]) -> str:
    return " ".join(f"{x:.3f},{y:.3f}" for x, y in points)


def _name(item: ObjectState) -> str:
    return f"{item.class_name}_{item.id}"
