"""What was read so far of an instruction, and what later words refer to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from adamo_vh.inference.baseline.language.cursor import NotUnderstood
from adamo_vh.inference.baseline.language.plan import Description, Goal, Plan, Relation
from adamo_vh.inference.baseline.language.words import Token
from adamo_vh.inference.baseline.sight.kinds import class_of


@dataclass(frozen=True, slots=True)
class Place:
    """A destination, as far as it was read."""

    relation: Relation
    anchor: Description | None = None
    furniture: str = ""
    second: Description | None = None
    distance_m: float | None = None
    direction: str = ""


TOGETHER = Place(Relation.NEAR)


@dataclass(slots=True)
class Reading:
    """Goals read so far, and what pronouns refer to."""

    goals: list[Goal] = field(default_factory=list)
    waiting: list[Description] = field(default_factory=list)
    """Taken, and not placed yet."""
    last: list[Description] = field(default_factory=list)
    """What "it" and "them" mean when nothing waits."""
    earlier: list[Description] = field(default_factory=list)
    """What they mean before the instruction named anything: what was spoken of before it."""
    place: Place | None = None
    """What "there" means."""
    before: list[Description] = field(default_factory=list)
    """What was meant before the latest, for a second "it"."""
    pointed: list[Description] = field(default_factory=list)
    """What the latest pronoun for things to handle meant."""
    remarks: list[str] = field(default_factory=list)

    def take(self, things: Sequence[Description]) -> None:
        """Things are picked up."""
        self.waiting.extend(things)
        self.before, self.last = self.last, list(things)

    def put(self, things: Sequence[Description], place: Place) -> None:
        """Things are put to a place."""
        if place.relation is Relation.HOLD:
            self.take(things)
            return
        for thing in things:
            known = next((w for w in self.waiting if _same(w, thing)), None)
            if known:
                self.waiting.remove(known)
            target = known or thing
            self.goals = [g for g in self.goals if g.target != target or g.mutual]
            anchor = place.anchor and _of_the_same(place.anchor, target)
            rest = (place.furniture, place.second, place.distance_m, place.direction)
            self.goals.append(Goal(target, place.relation, anchor, *rest))
        self.last = list(things)
        self.place = place

    def together(self, things: Sequence[Description]) -> None:
        """All but one of a group go near that one."""
        first, *rest = things
        if not rest:
            if not first.every:
                raise NotUnderstood(f"'{first.text}' (together with what?)")
            rest = [first]
        self.waiting = [w for w in self.waiting if w not in things]
        self.goals += [Goal(thing, Relation.NEAR, first, mutual=True) for thing in rest]
        self.last = list(things)

    def meant(self, token: Token) -> list[Description]:
        """What a pronoun means."""
        group = self.spoken_of()
        return group[-1:] if token.value in ("it", "this one", "that one") else list(group)

    def spoken_of(self) -> list[Description]:
        """What was named last, in this instruction or before it."""
        return list(self.waiting or self.last or self.earlier)

    def plan(self) -> Plan:
        """All wishes; what was taken and not put is held."""
        # A hand holds one thing: "any" is one of them here, not all of them.
        holds = tuple(
            Goal(replace(thing, every=False) if thing.text.startswith("any ") else thing)
            for thing in self.waiting
        )
        return Plan(tuple(self.goals) + holds, remarks=tuple(self.remarks))


def _of_the_same(anchor: Description, target: Description) -> Description:
    """Read "the larger one" behind "the smaller battery" as the larger battery."""
    if not anchor.classes and not anchor.ids and "one" in anchor.text.split():
        return replace(anchor, classes=target.classes)
    if anchor.other and not anchor.classes:
        return replace(anchor, classes=target.classes)
    return anchor


def _same(one: Description, other: Description) -> bool:
    """Whether a later phrase repeats an earlier one ("the plate ... the plate")."""
    if one.ids or other.ids:
        return one.ids == other.ids
    return replace(one, text="", every=False) == replace(other, text="", every=False)


def resolved_other(thing: Description, reading: Reading) -> Description:
    """Read "the other one" behind "the lock" as another lock."""
    named = reading.last or reading.earlier
    if not thing.other or not named:
        return thing
    if thing.every and not thing.classes and "other objects" in thing.text:
        spoken = [*(goal.target for goal in reading.goals), *reading.waiting, *named]
        return replace(thing, but=(*thing.but, *dict.fromkeys(spoken)), other=False)
    known = named[-1]
    kind = thing if thing.classes else replace(thing, classes=_classes(known))
    if replace(known, text="", definite=False, count=None) == Description("", classes=kind.classes):
        return kind  # "a battery ... the other one": what was taken first is not taken again
    return replace(kind, but=(*thing.but, known), other=True)


def _classes(known: Description) -> tuple[str, ...]:
    if known.classes or not known.ids:
        return known.classes
    kind = class_of(known.ids[0])
    return (kind,) if kind else ()
