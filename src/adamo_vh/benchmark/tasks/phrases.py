"""How a generated task names things: each way to call an object, with what it costs."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from adamo_vh.benchmark.taxonomy import Ref, Unit
from adamo_vh.engine import ObjectState, WorldState

_CLEARLY = 1.3
"""What is called the smallest or largest is so by this factor of volume at least."""
_PLURALS = {"pills", "binoculars"}
"""Names of one object that are several in grammar."""


@dataclass(frozen=True, slots=True)
class Named:
    """One way to call one object."""

    id: int
    text: str
    """With its article: "the plate"."""
    units: tuple[Unit, ...]
    them: str = "it"
    """The pronoun that stands for it."""


@dataclass(frozen=True, slots=True)
class Group:
    """All objects of a class that has several."""

    ids: tuple[int, ...]
    text: str
    units: tuple[Unit, ...] = (Ref.GROUP_SIMPLE, Ref.TAG)


def spoken(class_name: str) -> str:
    """The name of a class as people say it: "peanut butter" for PeanutButter."""
    return " ".join(re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|[0-9]+", class_name)).lower()


def names_of(world: WorldState) -> tuple[Named, ...]:
    """Every way to call every object of a world that means no other one."""
    kinds = _kinds(world)
    found = [Named(item.id, f"the object tagged as {item.id}", (Ref.ID,)) for item in world.objects]
    for kind, items in kinds.items():
        them = "them" if kind in _PLURALS else "it"
        if len(items) == 1:
            found.append(Named(items[0].id, f"the {kind}", (Ref.TAG,), them))
        for item, word in _extremes(items, ("smaller", "larger"), ("smallest", "largest")):
            found.append(Named(item.id, f"the {word} {kind}", (Ref.SUPER_EXTREMUM, Ref.TAG), them))
    for item, word in _extremes(world.objects, ("smaller", "larger"), ("smallest", "largest")):
        found.append(Named(item.id, f"the {word} object", (Ref.SUPER_EXTREMUM,)))
    return tuple(found)


def groups_of(world: WorldState) -> tuple[Group, ...]:
    """Every class of which a world has two or more."""
    return tuple(
        Group(tuple(item.id for item in items), f"all {_plural(kind)}")
        for kind, items in _kinds(world).items()
        if len(items) > 1
    )


def _kinds(world: WorldState) -> dict[str, list[ObjectState]]:
    kinds: defaultdict[str, list[ObjectState]] = defaultdict(list)
    for item in sorted(world.objects, key=lambda item: item.id):
        kinds[spoken(item.class_name)].append(item)
    return dict(kinds)


def _extremes(
    items: Sequence[ObjectState], of_two: tuple[str, str], of_many: tuple[str, str]
) -> list[tuple[ObjectState, str]]:
    """The clearly smallest and the clearly largest of several, with the words for them."""
    if len(items) < 2:
        return []
    ranked = sorted(items, key=lambda item: (item.box.volume_m3, item.id))
    words = of_two if len(items) == 2 else of_many
    pairs = ((ranked[0], ranked[1], words[0]), (ranked[-2], ranked[-1], words[1]))
    return [
        (small if word == words[0] else large, word)
        for small, large, word in pairs
        if large.box.volume_m3 >= _CLEARLY * small.box.volume_m3
    ]


def _plural(kind: str) -> str:
    if kind in _PLURALS:
        return kind
    if kind.endswith("y") and kind[-2:-1] not in "aeiou":
        return f"{kind[:-1]}ies"
    return f"{kind}es" if kind.endswith(("s", "x", "ch", "sh")) else f"{kind}s"
