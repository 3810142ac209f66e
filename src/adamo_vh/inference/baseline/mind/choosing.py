"""Which things are meant: from how well each fits to the ones to act on."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import lru_cache

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import Description, Goal, Relation, Size
from adamo_vh.inference.baseline.mind.evidence import anchor_of, same_level, side_seen
from adamo_vh.inference.baseline.mind.furniture import heights, may_be_found
from adamo_vh.inference.baseline.mind.memory import Memory, Stand, Thing
from adamo_vh.inference.baseline.mind.searching import Stage
from adamo_vh.inference.baseline.sight.kinds import (
    Beliefs,
    class_of,
    classify,
    likeliest,
    size_of,
)
from adamo_vh.inference.baseline.sight.measures import Sight, colour_words
from adamo_vh.inference.baseline.sight.prototypes import Prototype, prototypes
from adamo_vh.inference.baseline.tags import parts_of

_SURE, _LIKELY, _AT_ALL = 0.5, 0.3, 0.12
_MEMBER = 0.5
"""A thing that fits at least so well belongs to a group."""
_ALMOST = 0.8


def needed_fit(stage: Stage, description: Description | None = None) -> float:
    """How well one thing must fit to be taken: less the more was searched.

    What is told by its looks must look so; a mere kind may be guessed, which the answer says.
    """
    if stage is Stage.OVER:
        return _LIKELY if description is not None and description.by_looks else _AT_ALL
    return _LIKELY if stage is Stage.CLOSE else _SURE


def targets(goal: Goal, index: int, memory: Memory, stage: Stage) -> list[str] | None:
    """The things that a goal is about.

    Args:
        goal: The goal.
        index: Its place in the plan.
        memory: How well things fit.
        stage: How far the search is.

    Returns:
        Tags; None if it takes more looking round to tell.
    """
    over = stage is Stage.OVER or _contradicted(goal.target, memory, stage)
    if goal.target.compares and not goal.target.ids and stage < Stage.CLOSE:
        return None
    fits = memory.fits.get(("goal", index), {})
    taken = {j.tag for j in memory.jobs if j.goal < index} if _is_single_class(goal) else set()
    anchor = _certain_anchor(index, memory)
    free = {t: f for t, f in fits.items() if t in memory.things and t != anchor}
    free = {t: f for t, f in free.items() if t not in taken} or free
    if goal.target.size:
        best = extreme(goal.target, free, memory)
        return best or (None if not over else [])
    if goal.target.every:
        members = _members(goal.target, free, over)
        wanted = len(goal.target.ids) or goal.target.count or 0
        complete = len(members) >= wanted
        return members if over or (members and complete) else None
    if not free:
        return [] if over else None
    fit, tag = max((f, _nearness(t, memory), t) for t, f in free.items())[::2]
    return [tag] if fit >= needed_fit(stage, goal.target) else ([] if over else None)


def _contradicted(description: Description, memory: Memory, stage: Stage) -> bool:
    """Whether there are things of the kind, all of them looked at, and none looks as said."""
    if stage < Stage.CLOSE or not (description.by_looks and description.classes):
        return False
    return any(class_of(tag) in description.classes for tag in memory.things)


def anchor(goal: Goal, index: int, memory: Memory, stage: Stage) -> Thing | None:
    """The thing to be near, if some thing fits well enough by now."""
    if goal.anchor is None:
        return None
    thing = _extreme_anchor(goal, index, memory) if goal.anchor.size else anchor_of(index, memory)
    if thing is None or (goal.anchor.size and stage < Stage.CLOSE):
        return None
    fit = memory.fits[("place", index)].get(thing.tag, 0.0)
    return thing if fit >= needed_fit(stage) else None


def _extreme_anchor(goal: Goal, index: int, memory: Memory) -> Thing | None:
    fits = memory.fits.get(("place", index), {})
    targets_now = {j.tag for j in memory.jobs if j.goal == index}
    known = {t: f for t, f in fits.items() if t in memory.things and t not in targets_now}
    assert goal.anchor is not None
    best = extreme(goal.anchor, known, memory)
    if not best:
        return None
    for tag in known:  # the chosen one stays the best fit from now on
        fits[tag] = 1.0 if tag == best[0] else min(fits[tag], 0.5)
    return memory.things[best[0]]


def _certain_anchor(index: int, memory: Memory) -> str | None:
    fits = memory.fits.get(("place", index), {})
    sure = [tag for tag, fit in fits.items() if fit >= 0.99]
    return sure[0] if len(sure) == 1 else None


def _is_single_class(goal: Goal) -> bool:
    """Phrases like "a lock ... another lock" mean different things; ids may come twice."""
    return bool(goal.target.classes) and not goal.target.ids and not goal.target.every


def _members(description: Description, fits: dict[str, float], over: bool) -> list[str]:
    """Those that belong to a group: also what fits nearly as well as the best of it."""
    ordered = sorted(fits, key=lambda tag: (-fits[tag], tag))
    least = min(_MEMBER, max(_LIKELY, _ALMOST * fits[ordered[0]])) if ordered else _MEMBER
    if description.count:  # as many as were said, once all was looked at
        least = _LIKELY if over else _MEMBER
    members = [tag for tag in ordered if fits[tag] >= least]
    if description.spared:
        return members[: -description.spared]
    return members[: description.count] if description.count else members


def extreme(description: Description, fits: dict[str, float], memory: Memory) -> list[str]:
    """The smallest, largest, tallest or shortest of those that fit; by volume as the text says."""
    things = [memory.things[tag] for tag, fit in fits.items() if fit >= _LIKELY]
    from_what = description.measured_from
    if from_what and not any(kind_of(tag, memory) in from_what for tag in memory.things):
        return []  # what it is to be nearest to was not made out
    if not things:
        return []
    ordered = sorted(things, key=lambda t: (_extent(description, t, memory), t.tag))
    if description.size in (Size.LARGEST, Size.TALLEST, Size.FARTHEST):
        ordered.reverse()
    first = description.rank - 1
    if description.every:  # "the two largest objects"
        return [t.tag for t in ordered[: description.count or 1]]
    return [t.tag for t in ordered[first : first + 1]]


def _extent(description: Description, thing: Thing, memory: Memory) -> float:
    """What a superlative compares: height, distance or volume."""
    if description.size in (Size.TALLEST, Size.SHORTEST):
        return thing.height_m
    if description.size not in (Size.NEAREST, Size.FARTHEST):
        return thing.volume_cm3
    kinds = description.measured_from
    of_kind = [t for t in memory.things.values() if kind_of(t.tag, memory) in kinds]
    if kinds:
        apart = [o.position.horizontal_distance(thing.position) for o in of_kind if o != thing]
        return min(apart, default=math.inf if description.size is Size.NEAREST else -math.inf)
    return memory.began.position.horizontal_distance(thing.position) if memory.began else math.inf


def kind_of(tag: str, memory: Memory) -> str | None:
    """The class that a tag names, or what the thing seems to be by its looks."""
    return class_of(tag) or memory.kinds.get(tag)


def _nearness(tag: str, memory: Memory) -> float:
    """Prefers things that were not handled yet; ties are broken by the tag."""
    return -sum(job.tag == tag for job in memory.jobs)


_NEAR_SOURCE_M, _AROUND_M = 0.3, 0.6
_OFF_M = 0.04
"""A height is an estimate."""
_FLOOR_BOTTOM_M = 0.1
_LEFT_OUT = 0.5
_CONTRADICTS = 0.25
"""Looks that fit less speak against what is said."""
_MAIN = 0.6
"""How well the colour fits that one would name first."""
_NOT_MADE_OUT = 0.4
WELL_SEEN_PX = 60
_A_WORD = 3
"""Letters from which what was read is a word."""


def degree(
    description: Description,
    thing: Thing,
    sight: Sight | None,
    others: Sequence[Thing],
    beliefs: Beliefs | None = None,
    viewer: Stand | None = None,
) -> float:
    """How well a thing fits a description.

    Args:
        description: What is sought; superlatives are left to the caller.
        thing: The candidate.
        sight: Its pixels, if looked at.
        others: All things known, for "from the floor" or "standing near the plate".
        beliefs: What it may be, if that was found out already.
        viewer: Where left and right are told from.

    Returns:
        0 (does not fit) to 1 (fits in every respect).
    """
    if description.ids:
        tag = thing.tag.lower()
        return 1.0 if {parts_of(tag)[1] or tag, tag} & set(description.ids) else 0.0
    beliefs = beliefs or classify(thing.tag, thing.volume_cm3, sight)
    for left in description.but:
        # What seems to be of the kind is rather left out, than moved against the wish.
        seems = likeliest(beliefs) in left.classes
        least = _LIKELY if seems else _LEFT_OUT
        if degree(left, thing, sight, others, beliefs) >= least:
            return 0.0
    factors = _factors(description, thing, beliefs, sight)
    if description.source:
        factors.append(_from_there(description.source, thing, others, viewer))
    if not factors:
        return 1.0
    if min(factors) < 0.02:
        return 0.0
    return math.exp(sum(math.log(f) for f in factors) / len(factors))


def _factors(
    description: Description, thing: Thing, beliefs: Beliefs, sight: Sight | None
) -> list[float]:
    factors = []
    if description.classes:
        # Of one thing, the most usual meaning is likelier; a group has all meanings.
        usual = 1.0 if description.every else 0.85
        fits = [beliefs.get(n, 0.0) * usual**i for i, n in enumerate(description.classes)]
        factors.append(min(sum(fits), 1.0) if description.every else max(fits))
        if class_of(thing.tag):
            said = [_said(f, sight, seen) for f, seen in _looks(description, beliefs, sight)]
            return [min([*factors, *said])]
    looks = _looks(description, beliefs, sight)
    if description.classes and any(f < _CONTRADICTS for f, seen in looks if seen and _well(sight)):
        return [0.0]
    return factors + [f for f, _ in looks]


def _well(sight: Sight | None) -> bool:
    return sight is not None and sight.pixels >= WELL_SEEN_PX


def _said(fit: float, sight: Sight | None, seen: bool) -> float:
    """How far looks bear out what is said of a thing whose noun is settled.

    Args:
        fit: How well they do.
        sight: Its pixels.
        seen: Whether pixels decide, not usual knowledge about the kind.
    """
    if seen and not _well(sight):
        return _NOT_MADE_OUT
    return 0.0 if fit < _CONTRADICTS else 0.5 + fit / 2


def _looks(
    description: Description, beliefs: Beliefs, sight: Sight | None
) -> list[tuple[float, bool]]:
    """For each thing that is said of the looks: how well they fit, and whether pixels decide."""
    factors = [(_colour(colour, beliefs, sight), True) for colour in description.colours]
    factors += [
        (
            _white(beliefs, sight) if colour == "white" else _part_colour(colour, beliefs, sight),
            True,
        )
        for colour in description.part_colours
    ]
    factors += [(_shape(shape, beliefs, sight), False) for shape in description.shapes]
    if description.transparent:
        factors.append((_expect(beliefs, lambda p: 0.95 if p.transparent else 0.02), False))
    if description.label:
        factors.append((_label(beliefs, sight), True))
    return factors


def _colour(colour: str, beliefs: Beliefs, sight: Sight | None) -> float:
    usual = _expect(beliefs, lambda p: dict(p.colours).get(colour, 0.02))
    if sight is None or sight.pixels < 30:
        return usual
    share = sight.share(colour)
    if colour in ("grey", "black", "white"):
        share = max(0.0, share - 0.25)  # shadows and highlights are on everything
    fit = _updated(max(usual, 0.1), _ratio(share, 0.30))
    return max(fit, _MAIN) if colour in colour_words(sight).split(" and ") else fit


def _part_colour(colour: str, beliefs: Beliefs, sight: Sight | None) -> float:
    usual = _expect(beliefs, lambda p: dict(p.colours).get(colour, 0.02))
    if sight is None or sight.pixels < 30:
        return usual
    return _updated(max(usual, 0.1), _ratio(sight.share(colour), 0.08))


def _white(beliefs: Beliefs, sight: Sight | None) -> float:
    usual = _expect(beliefs, lambda p: p.white)
    if sight is None or sight.pixels < 30:
        return usual
    share = sight.share("white")
    # What shines through glass, and its reflections, are not its own.
    share *= (1 - sight.clear) * (1 - _expect(beliefs, lambda p: float(p.transparent)))
    return _updated(usual, _ratio(share, 0.05))


def _label(beliefs: Beliefs, sight: Sight | None) -> float:
    usual = _expect(beliefs, lambda p: p.label)
    if sight is None or sight.pixels < 200:
        return usual
    if any(len(word) >= _A_WORD for word in sight.words):
        return _updated(usual, 4.0)
    return _updated(usual, _ratio(sight.text, 0.08, strength=1.0))


def _shape(shape: str, beliefs: Beliefs, sight: Sight | None) -> float:
    usual = _expect(beliefs, lambda p: 0.9 if shape in p.shape else 0.08)
    if shape == "round" and sight is not None and sight.pixels >= 30:
        return _updated(usual, _ratio(max(0.0, sight.roundness - 0.6), 0.25, strength=1.0))
    return usual


def _expect(beliefs: Beliefs, value: Callable[[Prototype], float]) -> float:
    known = prototypes()
    return sum(p * value(known[name]) for name, p in beliefs.items() if name in known)


def _ratio(share: float, middle: float, strength: float = 1.6) -> float:
    """Logarithm of how much a share of pixels speaks for an attribute; 0 at the middle."""
    return strength * math.tanh(math.log((share + 0.004) / middle)) * 1.6


def _updated(prior: float, log_ratio: float) -> float:
    prior = min(max(prior, 0.01), 0.99)
    return 1 / (1 + math.exp(-(math.log(prior / (1 - prior)) + log_ratio)))


def _from_there(
    source: tuple[Relation, tuple[str, ...]],
    thing: Thing,
    others: Sequence[Thing],
    viewer: Stand | None,
) -> float:
    relation, classes = source
    if relation is Relation.FLOOR:
        return 1.0 if thing.bottom_z < _FLOOR_BOTTOM_M else 0.0
    if relation is Relation.SURFACE:
        low, high = heights(classes[0])
        usual = low - _OFF_M <= thing.bottom_z <= high + _OFF_M
        return float(usual and may_be_found(classes[0]))
    near = [
        other.position.horizontal_distance(thing.position)
        for other in others
        if other.tag != thing.tag
        and class_of(other.tag) in classes
        # What stands on another level is above or below, and next to nothing there.
        and same_level(thing, other)
        and (relation is Relation.NEAR or side_seen(thing, other, viewer) is relation)
    ]
    nearest = min(near, default=math.inf)
    return 1.0 if nearest <= _NEAR_SOURCE_M else 0.6 if nearest < _AROUND_M else 0.1


def thing_of(tag: str, position: Vec3, volume_cm3: float, kind: str = "") -> Thing:
    """A thing with its size estimated from what it is, or most probably is by its volume."""
    width, height = size_of(kind or _kind_by_volume(tag, volume_cm3), volume_cm3)
    return Thing(tag, position, volume_cm3, width, height)


@lru_cache(maxsize=512)
def _kind_by_volume(tag: str, volume_cm3: float) -> str:
    return likeliest(classify(tag, volume_cm3, None))
