"""The oracle: a privileged player that proves that a task can be done with the four tools.

It reads the whole truth and decides anew at each step, so it needs no feedback: what went another
way than planned shows in the next state. It obeys the rule that an object must have been seen
before it can be picked.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Container, Iterator, Sequence
from dataclasses import replace

from adamo_vh.action import Drop, Look, Pick, Walk
from adamo_vh.benchmark.conditions import (
    Atom,
    Beside,
    Condition,
    InArea,
    Near,
    Not,
    On,
    OnFloor,
    Stays,
    atoms,
    flat,
    holds,
)
from adamo_vh.benchmark.goals import Goal, open_goals
from adamo_vh.benchmark.spots import area_spots, floor_spots, near_spots, surface_spots
from adamo_vh.engine import FLOOR, BodyInfo, ObjectState, WorldState, WorldSurface
from adamo_vh.geometry import Vec3

PATIENCE = 14
"""Actions that the oracle spends on one goal before it gives it up."""
_SAME_PLACE_M = 0.10
_WALL_M = 0.40
_TRIED_M: dict[type[Atom], float] = {
    Near: 0.08,
    Beside: 0.05,
    On: 0.10,
    OnFloor: 0.30,
    InArea: 0.25,
}
"""A spot this close to one that was tried in vain is not tried."""
_ASIDE_MOST_M = 0.45
"""Centre distance up to which spots left and right of an anchor are looked for."""
_HANDY_M = 1.0
"""Levels at about this height are tried first."""


class Oracle:
    """Plays towards conditions, in their order."""

    def __init__(
        self,
        conditions: Sequence[Condition],
        tag_of: Callable[[int], str],
        body: BodyInfo,
        past: Sequence[WorldState] = (),
    ) -> None:
        """Prepare to play one episode, or to go on in one.

        Args:
            conditions: What to bring about, e.g. `task.goals`.
            tag_of: The tag of an object id under the labeling in use.
            body: How large the body is and how far it reaches.
            past: The states before the one that it is asked about first, the start of the episode
                first; none if that is the start.
        """
        self._body = body
        self._conditions = tuple(conditions)
        self._limits = [c for c in flat(conditions) if isinstance(c, Not)]
        self._wishes = list(atoms([c for c in flat(conditions) if not isinstance(c, Not)]))
        self._tag_of = tag_of
        self._past = list(past)
        self._spent: Counter[Goal] = Counter()
        self._visited: list[Vec3] = []
        self._looked_from: defaultdict[int, list[Vec3]] = defaultdict(list)
        self._vantages: dict[int, Iterator[Vec3]] = {}
        self._tried: defaultdict[Atom, list[Vec3]] = defaultdict(list)

    def next_action(
        self, state: WorldState, seen: Container[int]
    ) -> Look | Walk | Pick | Drop | None:
        """Decide the next action.

        Args:
            state: The world now; it is asked about every state of an episode, in order.
            seen: Ids of the objects that have been listed in an observation so far.

        Returns:
            An action, or None when every condition holds or was given up.
        """
        if not _is_among(state.body.position, self._visited, _SAME_PLACE_M):
            self._visited.append(state.body.position)
        action = self._decided(state, seen)
        self._past.append(state)
        return action

    def _decided(self, state: WorldState, seen: Container[int]) -> Look | Walk | Pick | Drop | None:
        for condition in self._conditions:
            for goal in open_goals(condition, state, self._past):
                if self._spent[goal] >= PATIENCE:
                    continue
                action = self._pursue(goal, state, seen)
                if action is not None:
                    self._spent[goal] += 1
                    return action
        return None

    def _pursue(
        self, goal: Goal, state: WorldState, seen: Container[int]
    ) -> Look | Walk | Pick | Drop | None:
        held = state.body.held
        if held == goal.id and not goal.is_undoing:
            return self._put_down(state, goal.condition, held)
        if held is not None:
            # Left over from a goal that was given up or undone: the hand must be free.
            return self._lay_down(state, held)
        if goal.id in seen:
            return Pick(self._tag_of(goal.id))
        return self._search(state, state.object(goal.id))

    def _search(self, state: WorldState, item: ObjectState) -> Look | Walk | None:
        """Look at an object from here; if that was in vain, from elsewhere."""
        here, there = state.body.position, item.box.center.rounded()
        if not _is_among(here, self._looked_from[item.id], _SAME_PLACE_M):
            self._looked_from[item.id].append(here)
            return Look(there.x, there.y, there.z)
        vantages = self._vantages.setdefault(item.id, iter(_vantages(state, item)))
        place = next(vantages, None)
        return None if place is None else Walk(place.x, place.y, place.z)

    def _lay_down(self, state: WorldState, held: int) -> Drop | None:
        """Put down what is in the way: on the floor, else on any furniture."""
        places: list[Atom] = [OnFloor(held), *(On(held, s.support) for s in _surfaces(state))]
        for place in places:
            if (drop := self._put_down(state, place, held)) is not None:
                return drop
        return None

    def _put_down(self, state: WorldState, condition: Atom, held: int) -> Drop | None:
        """Drop what is held for a condition, at the best spot that was not tried yet."""
        tried, apart_m = self._tried[condition], _TRIED_M.get(type(condition), _SAME_PLACE_M / 20)
        spots = self._spots(state, condition, state.object(held))
        for _, spot in self._best(state, condition, held, spots):
            if not _is_among(spot, tried, apart_m):
                tried.append(spot)
                return Drop(self._tag_of(held), spot.x, spot.y, spot.z)
        return None

    def _best(
        self, state: WorldState, condition: Atom, held: int, spots: list[tuple[str, Vec3]]
    ) -> list[tuple[str, Vec3]]:
        """The spots that break no limit, those first that serve other wishes as well."""
        limits = [limit for limit in self._limits if held in limit.objects]
        wishes = [wish for wish in self._wishes if held in wish.moves and wish != condition]
        if not (limits or wishes or isinstance(condition, Beside)):
            return spots
        ranked = []
        for support, spot in spots:
            then = _put(state, held, support, spot)
            if isinstance(condition, Beside) and not holds(condition, then, self._past):
                continue
            if all(holds(limit, then, self._past) for limit in limits):
                served = sum(holds(wish, then, self._past) for wish in wishes)
                ranked.append((served, (support, spot)))
        return [place for _, place in sorted(ranked, key=lambda pair: -pair[0])]

    def _spots(
        self, state: WorldState, condition: Atom, item: ObjectState
    ) -> list[tuple[str, Vec3]]:
        """Where an object can be put for a condition: the support, and a point on it."""
        match condition:
            case Near(anchor=anchor):
                other = state.object(anchor)
                return _on(other.support, near_spots(state, item, other))
            case Beside(anchor=anchor):
                other = state.object(anchor)
                return _on(other.support, near_spots(state, item, other, _ASIDE_MOST_M))
            case InArea(kind=kind):
                return _on(FLOOR, area_spots(state, item, kind))
            case OnFloor():
                return _on(FLOOR, floor_spots(state, item, self._visited, self._body))
            case On():
                found = [s for s in _surfaces(state) if condition.means(s.support)]
                return [p for s in found for p in _on(s.support, surface_spots(state, item, s))]
            case Stays():
                before = self._past[0].object(item.id)
                low = replace(before.box.center, z=before.box.bottom_z)
                return _on(before.support, [low.rounded()])
            case _:
                return []


def _on(support: str | None, spots: list[Vec3]) -> list[tuple[str, Vec3]]:
    return [(support or FLOOR, spot) for spot in spots]


def _surfaces(state: WorldState) -> list[WorldSurface]:
    """What furniture carries things on, those at a handy height first."""
    found = [surface for piece in state.furniture for surface in piece.surfaces]
    return sorted(found, key=lambda surface: round(abs(surface.center.z - _HANDY_M), 2))


def _put(state: WorldState, item_id: int, support: str, spot: Vec3) -> WorldState:
    """The world as it will be when an object lies somewhere."""
    item = state.object(item_id)
    center = Vec3(spot.x, spot.y, spot.z + item.box.center.z - item.box.bottom_z)
    lying = replace(item, box=replace(item.box, center=center), support=support, held=False)
    objects = tuple(lying if other.id == item_id else other for other in state.objects)
    return replace(state, objects=objects, body=replace(state.body, held=None))


def _vantages(state: WorldState, item: ObjectState) -> list[Vec3]:
    """Places to see an object from: close to it, then around it, beginning on the body's side."""
    scene, body, center = state.scene, state.body.position, item.box.center
    towards_body = math.atan2(body.y - center.y, body.x - center.x)
    places = [Vec3(center.x, center.y, 0.0)]
    for distance_m in (1.5, 2.5):
        for turn in (0, 45, -45, 90, -90, 135, -135, 180):
            angle = towards_body + math.radians(turn)
            x = center.x + distance_m * math.cos(angle)
            y = center.y + distance_m * math.sin(angle)
            if (
                scene.x_min + _WALL_M <= x <= scene.x_max - _WALL_M
                and scene.y_min + _WALL_M <= y <= scene.y_max - _WALL_M
            ):
                places.append(Vec3(x, y, 0.0))
    return [place.rounded() for place in places]


def _is_among(point: Vec3, points: Sequence[Vec3], distance_m: float) -> bool:
    return any(point.horizontal_distance(other) < distance_m for other in points)
