"""Judging an answer by its text alone, and what was done by the world's truth alone.

`false_claims` reads each sentence of an answer and holds what it states against the state of the
world. `holds` evaluates a condition such as ``floor 3 30 & near 34 57`` on that state.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from adamo_vh.engine import ObjectState, WorldState
from adamo_vh.geometry import Vec3

NEAR_M = 0.3
_SAME_M = 0.03
_ON = re.compile(
    r"((?:[A-Za-z]+_)?\d+) (?:now )?(?:rests|stands|lies|is) (?:now )?"
    r"on the ([a-z][a-z0-9 ]*(?:\([a-z ]+\))?)"
)
_TAG = r"(?:[A-Za-z]+_)?\d+"
COLOURS: dict[int, tuple[str, ...]] = {
    0: ("yellow", "brown"),
    2: ("black",),
    3: ("black", "brown"),
    4: ("blue",),
    5: ("red", "grey"),
    8: ("brown", "orange", "red", "white", "yellow"),
    18: ("grey",),
    19: ("red", "white"),
    20: ("orange", "white"),
    21: ("black",),
    23: ("white", "red", "blue"),
    27: ("grey", "white"),
    30: ("green", "grey", "black"),
    34: ("yellow", "brown"),
    36: ("black", "green", "red", "white"),
    37: ("grey", "white"),
    45: ("orange",),
    50: ("green", "brown", "orange"),
    57: ("red",),
}
"""Colours that a person would name, by the object's id."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """An instruction carried out: the world before and after, and what was said."""

    before: WorldState
    after: WorldState
    answer: str

    def moved(self) -> set[int]:
        """Ids of what is not where it was."""
        return {
            item.id
            for item in self.after.objects
            if item.held
            or item.box.center.distance(self.before.object(item.id).box.center) > _SAME_M
        }


def holds(condition: str, outcome: Outcome) -> bool:
    """Whether a condition is met.

    Args:
        condition: Alternatives joined by ``|``, each of them parts joined by ``&``, each part a
            name with ids or words behind it, see `_PARTS`.
        outcome: What happened.
    """
    return any(
        all(_part(part.strip(), outcome) for part in one.split("&")) for one in condition.split("|")
    )


def _part(part: str, outcome: Outcome) -> bool:
    name, _, words = part.partition(" ")
    if name == "says":
        return re.search(words.replace("~", "|"), outcome.answer, re.IGNORECASE) is not None
    if name == "silent":
        return re.search(words.replace("~", "|"), outcome.answer, re.IGNORECASE) is None
    return _PARTS[name](outcome, *words.split())


def _held(outcome: Outcome, *ids: str) -> bool:
    return str(outcome.after.body.held) in ids


def _floor(outcome: Outcome, *ids: str) -> bool:
    return all(_item(outcome, i).support == "floor" for i in ids)


def _only_floor(outcome: Outcome, *ids: str) -> bool:
    found = {str(item.id) for item in outcome.after.objects if item.support == "floor"}
    return found == set(ids)


def _floor_but(outcome: Outcome, *ids: str) -> bool:
    return all((o.support == "floor") != (str(o.id) in ids) for o in outcome.after.objects)


def _one_on_floor(outcome: Outcome, *ids: str) -> bool:
    return sum(_item(outcome, i).support == "floor" for i in ids) == 1


def _on(outcome: Outcome, object_id: str, *words: str) -> bool:
    support = (_item(outcome, object_id).support or "").replace("/", " ")
    return support_named(support, " ".join(words))


def support_named(support: str, words: str) -> bool:
    """Whether a support of the world is what words name: all of the words occur in its name."""
    return bool(support) and support != "floor" and set(words.split()) <= set(support.split())


def _near(outcome: Outcome, one: str, *others: str) -> bool:
    a = _item(outcome, one)
    return any(
        b.support == a.support and _apart(a, b) <= NEAR_M
        for b in (_item(outcome, other) for other in others)
        if b.id != a.id
    )


def _side(sign_right: int, sign_away: int) -> Callable[..., bool]:
    def check(outcome: Outcome, one: str, other: str) -> bool:
        a, b = _item(outcome, one), _item(outcome, other)
        right, away = _seen(outcome, a.box.center, b.box.center)
        if a.support != b.support or _apart(a, b) > 0.6:
            return False
        if sign_right:
            return sign_right * right > 0 and abs(right) >= abs(away) * 0.7
        return sign_away * away > 0 and abs(away) >= abs(right) * 0.7

    return check


def _seen(outcome: Outcome, point: Vec3, origin: Vec3) -> tuple[float, float]:
    """How far a point is to the right of another one and behind it, for the body at the start."""
    body = outcome.before.body
    line = origin - body.position
    length = math.hypot(line.x, line.y)
    away = (line.x / length, line.y / length) if length > 0.3 else _heading(outcome)
    off = point - origin
    return off.x * away[1] - off.y * away[0], off.x * away[0] + off.y * away[1]


def _heading(outcome: Outcome) -> tuple[float, float]:
    angle = outcome.before.body.heading_rad
    return math.cos(angle), math.sin(angle)


def _between(outcome: Outcome, one: str, *ends: str) -> bool:
    p, a, b = (_item(outcome, i).box.center for i in (one, *ends))
    length = a.horizontal_distance(b)
    along = ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / length**2
    aside = abs((p.x - a.x) * (b.y - a.y) - (p.y - a.y) * (b.x - a.x)) / length
    return 0.1 < along < 0.9 and aside < max(0.12, length / 3)


def _far(outcome: Outcome, one: str, other: str, least_m: str = "1") -> bool:
    a, b = _item(outcome, one), _item(outcome, other)
    return a.support is not None and _apart(a, b) >= float(least_m)


def _shifted(outcome: Outcome, object_id: str, right_m: str, away_m: str) -> bool:
    item, before = _item(outcome, object_id), outcome.before.object(int(object_id))
    right, away = _seen(outcome, item.box.center, before.box.center)
    return abs(right - float(right_m)) < 0.2 and abs(away - float(away_m)) < 0.2 and not item.held


def _home(outcome: Outcome, object_id: str) -> bool:
    item, before = _item(outcome, object_id), outcome.before.object(int(object_id))
    return not item.held and item.box.center.distance(before.box.center) <= 0.05


def _corner(outcome: Outcome, object_id: str) -> bool:
    item = _item(outcome, object_id)
    p = item.box.center
    return item.support == "floor" and any(
        area.x_min <= p.x <= area.x_max and area.y_min <= p.y <= area.y_max
        for area in outcome.after.scene.areas
        if area.kind == "corner"
    )


def _under(outcome: Outcome, object_id: str, *words: str) -> bool:
    item = _item(outcome, object_id)
    p = item.box.center
    return item.support == "floor" and any(
        _inside(piece.points, p.x, p.y)
        for piece in outcome.after.furniture
        if set(words) <= set(piece.name.split()) and piece.top_m > 0.3
    )


def _edge(outcome: Outcome, object_id: str, within_m: str = "0.15") -> bool:
    item, before = _item(outcome, object_id), outcome.before.object(int(object_id))
    if item.support is None or item.support != before.support:
        return False
    piece = next(f for f in outcome.after.furniture if f.name == item.support.split("/")[0])
    p = item.box.center
    return _to_outline(piece.points, p.x, p.y) <= float(within_m)


def _still(outcome: Outcome) -> bool:
    return not outcome.moved()


def _refuses(outcome: Outcome) -> bool:
    denies = r"did nothing|not done|cannot|do not|found no|know of no|not understand|did not"
    ok = re.search(denies, outcome.answer, re.IGNORECASE) is not None
    return ok and not re.match(r"done\b", outcome.answer, re.IGNORECASE)


def _looks_at(outcome: Outcome, object_id: str) -> bool:
    return outcome.after.body.gaze.distance(_item(outcome, object_id).box.center) < 0.3


def _walked_to(outcome: Outcome, object_id: str, within_m: str = "1.2") -> bool:
    body = outcome.after.body.position
    return body.horizontal_distance(_item(outcome, object_id).box.center) <= float(within_m)


def _turned(outcome: Outcome, degrees: str, within: str = "40") -> bool:
    turn = (
        outcome.after.body.heading_rad
        - outcome.before.body.heading_rad
        - math.radians(float(degrees))
    )
    return abs(math.degrees(math.atan2(math.sin(turn), math.cos(turn)))) <= float(within)


def _stands(outcome: Outcome, x: str, y: str, within_m: str = "0.5") -> bool:
    return outcome.after.body.position.horizontal_distance(Vec3(float(x), float(y), 0.0)) <= float(
        within_m
    )


def _at(outcome: Outcome, object_id: str, x: str, y: str, within_m: str = "0.1") -> bool:
    item = _item(outcome, object_id)
    place = Vec3(float(x), float(y), 0.0)
    return not item.held and item.box.center.horizontal_distance(place) <= float(within_m)


def _gazes(outcome: Outcome, x: str, y: str, z: str, within_m: str = "0.2") -> bool:
    point = Vec3(float(x), float(y), float(z))
    return outcome.after.body.gaze.distance(point) <= float(within_m)


_PARTS: dict[str, Callable[..., bool]] = {
    "at": _at,
    "gazes": _gazes,
    "holds": _held,
    "floor": _floor,
    "only_floor": _only_floor,
    "floor_but": _floor_but,
    "one_on_floor": _one_on_floor,
    "on": _on,
    "near": _near,
    "left": _side(-1, 0),
    "right": _side(1, 0),
    "front": _side(0, -1),
    "behind": _side(0, 1),
    "between": _between,
    "far": _far,
    "shifted": _shifted,
    "home": _home,
    "corner": _corner,
    "under": _under,
    "edge": _edge,
    "still": _still,
    "refuses": _refuses,
    "looks_at": _looks_at,
    "walked_to": _walked_to,
    "turned": _turned,
    "stands": _stands,
    "anything": lambda outcome: True,
}


def false_claims(outcome: Outcome, met: bool | None = None) -> list[str]:
    """Sentences of an answer that are not so.

    Args:
        outcome: What happened.
        met: Whether the whole instruction is fulfilled; an answer that begins with "Done" says
            that it is. None not to judge that.
    """
    answer, found = outcome.answer, []
    if met is False and re.match(r"\s*done\b", answer, re.IGNORECASE):
        found.append(f"says that it is done: {answer}")
    for listed in re.findall(r"On the floor I know of \d+ things?: ([^.]*)", answer):
        off = [t for t in re.findall(_TAG, listed) if _tagged(outcome, t).support != "floor"]
        found += [f"{tag} is not on the floor" for tag in off]
    for claim in re.split(r"(?<=[.!?;:])\s+|, because ", answer):
        found += [f"{claim} [{why}]" for why in _untrue(claim, outcome)]
    return found


def _untrue(claim: str, outcome: Outcome) -> Iterable[str]:
    for tag, support in _ON.findall(claim):
        real = (_tagged(outcome, tag).support or "").replace("/", " ").split()
        told = re.sub(r"[()]", " ", support).split()
        if not real or told[: len(real)] != real:
            yield f"{tag} rests on {' '.join(real) or 'nothing'}"
    for tag in re.findall(rf"I (?:still )?hold ({_TAG})", claim):
        if outcome.after.body.held != _number(tag):
            yield f"{tag} is not held"
    if re.search(r"I hold nothing|my hand is empty", claim) and outcome.after.body.held is not None:
        yield "the hand is not empty"
    yield from _untrue_measures(claim, outcome)
    yield from _untrue_distances(claim, outcome)
    for tag, colours in re.findall(rf"({_TAG}) looks ([a-z]+(?: and [a-z]+)?)", claim):
        if not set(colours.split(" and ")) & set(COLOURS[_number(tag)]):
            yield f"{tag} is {COLOURS[_number(tag)]}"
    if "in a corner of the room" in claim:
        out = [
            t
            for t in re.findall(rf"({_TAG}) rests", claim)
            if not _corner(outcome, str(_number(t)))
        ]
        yield from (f"{tag} is in no corner" for tag in out)
    for tag in re.findall(rf"did not move ({_TAG})", claim):
        if _number(tag) in outcome.moved():
            yield f"{tag} was moved"
    if re.search(r"\bI (?:did|moved) nothing", claim) and outcome.moved():
        yield f"{outcome.moved()} were moved"


def _untrue_measures(claim: str, outcome: Outcome) -> Iterable[str]:
    """Distances between things, sizes, and where the body stands."""
    for one, metres, other in re.findall(rf"({_TAG}) is (\d+\.\d+) m from ({_TAG}|me)\b", claim):
        there = outcome.after.body.position
        if other != "me":
            there = _tagged(outcome, other).box.center
        apart = _tagged(outcome, one).box.center.horizontal_distance(there)
        if abs(apart - float(metres)) > 0.05:
            yield f"{one} is {apart:.2f} m from {other}"
    for tag, volume in re.findall(
        rf"({_TAG}) (?:has|is .*) (?:a box|a volume) of (\d+) cm3", claim
    ):
        real = _tagged(outcome, tag).box.volume_m3 * 1e6
        if abs(real - float(volume)) > max(2.0, 0.02 * real):
            yield f"{tag} has {real:.0f} cm3"
    if found := re.search(r"I stand at \((-?[\d.]+), (-?[\d.]+),", claim):
        place = Vec3(float(found[1]), float(found[2]), 0.0)
        if outcome.after.body.position.horizontal_distance(place) > 0.05:
            yield f"it stands at {outcome.after.body.position}"


def _untrue_distances(claim: str, outcome: Outcome) -> Iterable[str]:
    subject = re.search(rf"({_TAG}) (?:rests|is at)", claim)
    if subject is None:
        return
    item = _tagged(outcome, subject[1])
    for metres, tag in re.findall(rf"(\d+\.\d+) m from ({_TAG})", claim):
        if abs(_apart(item, _tagged(outcome, tag)) - float(metres)) > 0.05:
            yield f"{_apart(item, _tagged(outcome, tag)):.2f} m"
    yield from _untrue_sides(claim, item, outcome)


def _untrue_sides(claim: str, item: ObjectState, outcome: Outcome) -> Iterable[str]:
    sides = {"to the left of": "left", "to the right of": "right", "in front of": "front",
             "behind": "behind"}  # fmt: skip
    for words, name in sides.items():
        for tag in re.findall(rf"{words} ({_TAG})", claim):
            if not _PARTS[name](outcome, str(item.id), str(_number(tag))):
                yield f"not {words} {tag}"
    if found := re.search(rf"between ({_TAG}) and ({_TAG})", claim):
        ends = (str(_number(found[1])), str(_number(found[2])))
        if not _between(outcome, str(item.id), *ends):
            yield "not between"
    if found := re.search(r"is at \((-?[\d.]+), (-?[\d.]+), (-?[\d.]+)\)", claim):
        place = Vec3(*(float(v) for v in found.groups()))
        if item.box.center.distance(place) > 0.05:
            yield f"it is at {item.box.center}"
    if found := re.search(r"(\d+) cm from where it was before", claim):
        moved = item.box.center.horizontal_distance(outcome.before.object(item.id).box.center)
        if abs(moved * 100 - int(found[1])) > 4:
            yield f"{moved * 100:.0f} cm"


def _number(tag: str) -> int:
    return int(tag.rsplit("_", 1)[-1])


def _tagged(outcome: Outcome, tag: str) -> ObjectState:
    return outcome.after.object(_number(tag))


def _item(outcome: Outcome, object_id: str) -> ObjectState:
    return outcome.after.object(int(object_id))


def _apart(one: ObjectState, other: ObjectState) -> float:
    return one.box.center.horizontal_distance(other.box.center)


def _inside(outline: Iterable[tuple[float, float]], x: float, y: float) -> bool:
    points = list(outline)
    turns = [
        (bx - ax) * (y - ay) - (by - ay) * (x - ax)
        for (ax, ay), (bx, by) in zip(points, points[1:] + points[:1], strict=True)
    ]
    return all(t >= -1e-6 for t in turns)


def _to_outline(outline: Iterable[tuple[float, float]], x: float, y: float) -> float:
    points = list(outline)
    best = math.inf
    for (ax, ay), (bx, by) in zip(points, points[1:] + points[:1], strict=True):
        length = math.hypot(bx - ax, by - ay)
        t = max(0.0, min(1.0, ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / max(length**2, 1e-9)))
        best = min(best, math.hypot(x - ax - t * (bx - ax), y - ay - t * (by - ay)))
    return best
