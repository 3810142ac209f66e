"""Which things are meant: from how well each fits to the ones to act on."""

from __future__ import annotations

from adamo_vh.inference.baseline.goals import Description, Goal, Size
from adamo_vh.inference.baseline.happenings import anchor_of
from adamo_vh.inference.baseline.memory import Memory, Thing
from adamo_vh.inference.baseline.searching import Stage

_SURE, _LIKELY, _AT_ALL = 0.5, 0.3, 0.12
_MEMBER = 0.5
"""A thing that fits at least so well belongs to a group."""


def needed_fit(stage: Stage) -> float:
    """How well one thing must fit to be taken: less the more was searched."""
    if stage is Stage.OVER:
        return _AT_ALL
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
    over = stage is Stage.OVER
    if goal.target.compares and not goal.target.ids and stage < Stage.CLOSE:
        return None
    fits = memory.fits.get(("goal", index), {})
    taken = {j.tag for j in memory.jobs if j.goal < index} if _is_single_class(goal) else set()
    anchor = _certain_anchor(index, memory)
    free = {t: f for t, f in fits.items() if t in memory.things and t != anchor}
    free = {t: f for t, f in free.items() if t not in taken} or free
    if goal.target.size:
        best = _extreme(goal.target, free, memory)
        return best or (None if not over else [])
    if goal.target.every:
        members = _members(goal.target, free)
        complete = not goal.target.ids or len(members) == len(goal.target.ids)
        return members if over or (members and complete) else None
    if not free:
        return [] if over else None
    fit, tag = max((f, _nearness(t, memory), t) for t, f in free.items())[::2]
    return [tag] if fit >= needed_fit(stage) else ([] if over else None)


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
    best = _extreme(goal.anchor, known, memory)
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


def _members(description: Description, fits: dict[str, float]) -> list[str]:
    ordered = sorted(fits, key=lambda tag: (-fits[tag], tag))
    members = [tag for tag in ordered if fits[tag] >= _MEMBER]
    return members[: description.count] if description.count else members


def _extreme(description: Description, fits: dict[str, float], memory: Memory) -> list[str]:
    """The smallest, largest, tallest or shortest of those that fit; by volume as the text says."""
    things = [memory.things[tag] for tag, fit in fits.items() if fit >= _LIKELY]
    if not things:
        return []
    match description.size:
        case Size.SMALLEST:
            chosen = min(things, key=lambda t: (t.volume_cm3, t.tag))
        case Size.LARGEST:
            chosen = max(things, key=lambda t: (t.volume_cm3, t.tag))
        case Size.SHORTEST:
            chosen = min(things, key=lambda t: (t.height_m, t.tag))
        case _:
            chosen = max(things, key=lambda t: (t.height_m, t.tag))
    return [chosen.tag]


def _nearness(tag: str, memory: Memory) -> float:
    """Prefers things that were not handled yet; ties are broken by the tag."""
    return -sum(job.tag == tag for job in memory.jobs)
