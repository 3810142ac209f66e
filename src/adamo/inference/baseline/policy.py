"""The next step: what to do now, and the note that says why."""

from __future__ import annotations

from dataclasses import dataclass, replace

from adamo.geometry import Vec3
from adamo.inference.baseline import choosing, placing, searching
from adamo.inference.baseline.answering import final_answer
from adamo.inference.baseline.beliefs import anchor_of, current_job, up_to_date
from adamo.inference.baseline.goals import Goal, Plan, Relation
from adamo.inference.baseline.memory import Job, Memory, Status, Thing, write
from adamo.inference.baseline.prototypes import class_of
from adamo.inference.baseline.reading import Prompt

_MAX_ASIDE = 4
"""Tries to empty the hand in an episode, after which it stays as it is."""


@dataclass(frozen=True, slots=True)
class Step:
    """What the model says and does."""

    note: str
    name: str = ""
    """Tool to call; empty to end the episode."""
    arguments: tuple[tuple[str, str | float], ...] = ()


@dataclass(frozen=True, slots=True)
class _Move:
    """A step with its reasons."""

    conclusion: str
    plan: str
    name: str
    arguments: tuple[tuple[str, str | float], ...]


def decide(prompt: Prompt, plan: Plan) -> Step:
    """Choose the next step.

    Args:
        prompt: The whole prompt, read.
        plan: What the instruction asks for.
    """
    if plan.problem:
        return Step(f"I did nothing, because I did not understand this part: {plan.problem}.")
    memory = up_to_date(prompt, plan)
    move = _next_move(prompt, plan, memory)
    if move is None:
        return Step(final_answer(plan, memory))
    # A look replaces the list, and a walk changes how near things were seen from: then the note
    # must hold all that the list tells.
    told = () if move.name in ("Look", "Walk") else tuple(thing.tag for thing in prompt.things)
    note = (
        f"Evidence: {_evidence(prompt, memory)}\n"
        f"Conclusion: {move.conclusion}\n"
        f"Next: {move.plan}\n" + write(memory, told, _groups(plan))
    )
    return Step(note, move.name, move.arguments)


def _groups(plan: Plan) -> list[int]:
    """Goals whose things are told by comparing many."""
    return [
        index
        for index, goal in enumerate(plan.goals)
        if goal.target.compares or (goal.anchor is not None and goal.anchor.compares)
    ]


def _next_move(prompt: Prompt, plan: Plan, memory: Memory) -> _Move | None:
    """The first step that brings an open goal on; None when all are done or given up."""
    stage = searching.stage(prompt, memory)
    order = sorted(range(len(plan.goals)), key=lambda i: plan.goals[i].relation is Relation.HOLD)
    for index in order:
        goal = plan.goals[index]
        move = _resolve(prompt, goal, index, memory, stage)
        if move:
            return move
        for job in [j for j in memory.jobs if j.goal == index and j.status is Status.TODO]:
            move = _advance(prompt, plan, goal, job, memory)
            if move:
                return move
    return _let_go(prompt, plan, memory)


def _resolve(
    prompt: Prompt, goal: Goal, index: int, memory: Memory, stage: searching.Stage
) -> _Move | None:
    """Find out which things a goal is about; the step is one of the search, if that is needed."""
    if any(job.goal == index for job in memory.jobs):
        return None
    tags = choosing.targets(goal, index, memory, stage)
    if tags is None:
        return _search(prompt, memory, goal.target.text)
    if goal.anchor and tags and goal.relation is Relation.NEAR:
        others = [Job(index, tag) for tag in tags]
        beside = choosing.anchor(goal, index, _with(memory, others), stage)
        if beside is None and stage is not searching.Stage.OVER:
            return _search(prompt, memory, goal.anchor.text)
        if beside is None:
            others = [replace(job, status=Status.FAILED) for job in others]
        tags = [tag for tag in tags if beside is None or tag != beside.tag]
        memory.jobs.extend(job for job in others if job.tag in tags)
        return None
    memory.jobs.extend(Job(index, tag) for tag in tags)
    return None


def _with(memory: Memory, jobs: list[Job]) -> Memory:
    return replace(memory, jobs=[*memory.jobs, *jobs])


def _search(prompt: Prompt, memory: Memory, wanted: str) -> _Move:
    name, point = searching.next_step(prompt, memory)
    why = f"I do not know enough yet to tell which thing is '{wanted}'; I must look round."
    verb = "walk to" if name == "Walk" else "look at"
    return _Move(why, f"{verb} {point} to see another part of the room.", name, _xyz(point))


def _advance(prompt: Prompt, plan: Plan, goal: Goal, job: Job, memory: Memory) -> _Move | None:
    """One step for one job; None if nothing more is to be done for it."""
    if memory.hand and memory.hand != job.tag:
        if goal.relation is Relation.HOLD and _is_held_goal(plan, memory):
            memory.set_job(replace(job, status=Status.FAILED))
            return None
        return _drop_first(prompt, plan, memory)
    if memory.hand == job.tag:
        if goal.relation is Relation.HOLD:
            memory.set_job(replace(job, status=Status.DONE))
            return None
        return _put(prompt, goal, job, memory)
    if job.tries and prompt.event and prompt.event.name == "Pick":
        return _approach(job, memory)
    return _Move(
        f"{job.tag} {_fit_words(goal, job, memory)}; it must be {_wish(goal)}.",
        f"pick {job.tag}.",
        "Pick",
        (("object", job.tag),),
    )


def _approach(job: Job, memory: Memory) -> _Move | None:
    """After a refused pick: look at the thing, then try again."""
    thing = memory.things.get(job.tag)
    if thing is None:
        memory.set_job(replace(job, status=Status.FAILED))
        return None
    return _Move(
        f"{job.tag} could not be picked; I must see it better.",
        f"look at {thing.position}.",
        "Look",
        _xyz(thing.position),
    )


def _put(prompt: Prompt, goal: Goal, job: Job, memory: Memory) -> _Move | None:
    thing = memory.things.get(job.tag) or Thing(job.tag, prompt.body.position, 500.0, 0.1, 0.1)
    spot = _spot(prompt, goal, job, thing, memory)
    if spot is None:
        memory.set_job(replace(job, status=Status.FAILED))
        return _drop_at_feet(prompt, memory)
    again = " The last place was not good enough; I try another." if job.tries else ""
    return _Move(
        f"{job.tag} is in my hand and must be {_wish(goal)}.{again}",
        f"drop {job.tag} at {spot}.",
        "Drop",
        (("object", job.tag), *_xyz(spot)),
    )


def _spot(prompt: Prompt, goal: Goal, job: Job, thing: Thing, memory: Memory) -> Vec3 | None:
    anchor = anchor_of(job.goal, memory)
    match goal.relation:
        case Relation.NEAR if anchor:
            return placing.near_spot(prompt, memory, thing, anchor, job.tries)
        case Relation.CORNER:
            return placing.corner_spot(prompt, memory, thing, job.tries)
        case Relation.FLOOR:
            near = anchor.position if anchor else None
            return placing.floor_spot(prompt, memory, thing, near, job.tries)
        case Relation.SURFACE:
            return placing.surface_spot(prompt, memory, thing, goal.furniture, job.tries)
        case _:
            return None


def _drop_first(prompt: Prompt, plan: Plan, memory: Memory) -> _Move | None:
    """Empty the hand: where the held thing belongs, if a goal says so."""
    job = current_job(memory.hand, memory)
    if job and plan.goals[job.goal].relation is not Relation.HOLD:
        move = _put(prompt, plan.goals[job.goal], job, memory)
        if move:
            return move
    return _drop_at_feet(prompt, memory)


def _drop_at_feet(prompt: Prompt, memory: Memory) -> _Move | None:
    tag = memory.hand
    if memory.aside >= _MAX_ASIDE:
        return None
    memory.aside += 1
    thing = memory.things.get(tag) or Thing(tag, prompt.body.position, 500.0, 0.1, 0.1)
    spot = placing.floor_spot(prompt, memory, thing, None, memory.aside - 1)
    return _Move(
        f"my hand holds {tag}, which has no place to go; it must be empty.",
        f"drop {tag} at {spot}.",
        "Drop",
        (("object", tag), *_xyz(spot)),
    )


def _let_go(prompt: Prompt, plan: Plan, memory: Memory) -> _Move | None:
    """At the end nothing stays in the hand that was not to be held."""
    if not memory.hand or _is_held_goal(plan, memory):
        return None
    if not any(job.tag == memory.hand for job in memory.jobs):
        return None
    return _drop_at_feet(prompt, memory)


def _is_held_goal(plan: Plan, memory: Memory) -> bool:
    return any(
        job.tag == memory.hand and plan.goals[job.goal].relation is Relation.HOLD
        for job in memory.jobs
    )


def _wish(goal: Goal) -> str:
    match goal.relation:
        case Relation.HOLD:
            return "held"
        case Relation.FLOOR:
            return "put on the floor"
        case Relation.CORNER:
            return "put on the floor in a corner of the room"
        case Relation.SURFACE:
            return f"put on the {goal.furniture}"
        case Relation.NEAR:
            return f"put near {goal.anchor.text if goal.anchor else 'it'}"


def _fit_words(goal: Goal, job: Job, memory: Memory) -> str:
    """How sure it is that this thing is meant, and by what."""
    target, fit = goal.target, memory.fits.get(("goal", job.goal), {}).get(job.tag, 0.0)
    if target.ids or (target.classes and class_of(job.tag) in target.classes):
        how = "by its tag"
    elif target.by_looks or target.classes:
        how = "by its looks, its volume and what such things usually are"
    else:
        how = "by the listed volumes"
    sure = "fits" if fit >= 0.95 else "probably fits" if fit >= 0.5 else "is my best guess for"
    return f"{sure} '{target.text}', {how}"


def _evidence(prompt: Prompt, memory: Memory) -> str:
    if prompt.event is None:
        return f"{len(prompt.things)} objects are in view; {len(memory.things)} are known."
    said = prompt.event.text.strip()
    return f"{prompt.event.name}: {said}" if said else f"{prompt.event.name} gave no feedback."


def _xyz(point: Vec3) -> tuple[tuple[str, float], ...]:
    p = point.rounded(3)
    return (("x", p.x), ("y", p.y), ("z", p.z))
