"""The oracle: a privileged player that proves that a task can be done with the four tools.

It reads the whole truth and decides anew at each step, so it needs no feedback: what went another
way than planned shows in the next state. It obeys the rule that an object must have been seen
before it can be picked.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Container, Iterator, Sequence

from adamo_vh.action import Drop, Look, Pick, Walk
from adamo_vh.benchmark.conditions import Condition, Holds, InArea, Near, OnFloor
from adamo_vh.benchmark.spots import area_spots, floor_spots, near_spots
from adamo_vh.engine import BodyInfo, ObjectState, WorldState
from adamo_vh.geometry import Vec3

PATIENCE = 14
"""Actions that the oracle spends on one condition before it gives it up."""
_SAME_PLACE_M = 0.10
_WALL_M = 0.40
_TRIED_M = {Near: 0.08, OnFloor: 0.30, InArea: 0.25}
"""A spot this close to one that was tried in vain is not tried."""


def first_half(conditions: Sequence[Condition]) -> tuple[Condition, ...]:
    """Goals of half a plan: the first half of the conditions.

    With an odd number the one in the middle is begun, not finished: its object is only picked.
    Played to its end, the oracle of n conditions satisfies exactly n // 2 of them.
    """
    half, odd = divmod(len(conditions), 2)
    begun = conditions[half : half + odd]
    return (
        *conditions[:half],
        *(Holds(condition.id) for condition in begun if not isinstance(condition, Holds)),
    )


class Oracle:
    """Plays towards conditions, in their order."""

    def __init__(
        self, conditions: Sequence[Condition], tag_of: Callable[[int], str], body: BodyInfo
    ) -> None:
        """Prepare to play one episode.

        Args:
            conditions: What to bring about, e.g. `task.conditions` or `first_half` of them.
            tag_of: The tag of an object id under the labeling in use.
            body: How large the body is and how far it reaches.
        """
        self._body = body
        self._conditions = tuple(conditions)
        self._tag_of = tag_of
        self._spent: Counter[Condition] = Counter()
        self._visited: list[Vec3] = []
        self._looked_from: defaultdict[int, list[Vec3]] = defaultdict(list)
        self._vantages: dict[int, Iterator[Vec3]] = {}
        self._tried: defaultdict[Condition, list[Vec3]] = defaultdict(list)

    def next_action(
        self, state: WorldState, seen: Container[int]
    ) -> Look | Walk | Pick | Drop | None:
        """Decide the next action.

        Args:
            state: The world now.
            seen: Ids of the objects that have been listed in an observation so far.

        Returns:
            An action, or None when every condition holds or was given up.
        """
        if not _is_among(state.body.position, self._visited, _SAME_PLACE_M):
            self._visited.append(state.body.position)
        for condition in self._conditions:
            if condition.satisfied(state) or self._spent[condition] >= PATIENCE:
                continue
            action = self._pursue(condition, state, seen)
            if action is not None:
                self._spent[condition] += 1
                return action
        return None

    def _pursue(
        self, condition: Condition, state: WorldState, seen: Container[int]
    ) -> Look | Walk | Pick | Drop | None:
        held = state.body.held
        if held == condition.id:
            return self._put_down(state, condition)
        if held is not None:
            # Left over from a condition that was given up: the hand must be free.
            return self._put_down(state, OnFloor(held))
        if condition.id in seen:
            return Pick(self._tag_of(condition.id))
        return self._search(state, state.object(condition.id))

    def _search(self, state: WorldState, item: ObjectState) -> Look | Walk | None:
        """Look at an object from here; if that was in vain, from elsewhere."""
        here, there = state.body.position, item.box.center.rounded()
        if not _is_among(here, self._looked_from[item.id], _SAME_PLACE_M):
            self._looked_from[item.id].append(here)
            return Look(there.x, there.y, there.z)
        vantages = self._vantages.setdefault(item.id, iter(_vantages(state, item)))
        place = next(vantages, None)
        return None if place is None else Walk(place.x, place.y, place.z)

    def _put_down(self, state: WorldState, condition: Condition) -> Drop | None:
        """Drop what the condition is about at the best spot that was not tried yet."""
        tried, apart_m = self._tried[condition], _TRIED_M.get(type(condition), 0.0)
        for spot in self._spots(state, condition):
            if not _is_among(spot, tried, apart_m):
                tried.append(spot)
                return Drop(self._tag_of(condition.id), spot.x, spot.y, spot.z)
        return None

    def _spots(self, state: WorldState, condition: Condition) -> list[Vec3]:
        item = state.object(condition.id)
        match condition:
            case Near(anchor=anchor):
                return near_spots(state, item, state.object(anchor))
            case InArea(kind=kind):
                return area_spots(state, item, kind)
            case OnFloor():
                return floor_spots(state, item, self._visited, self._body)
            case Holds():
                return []


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
