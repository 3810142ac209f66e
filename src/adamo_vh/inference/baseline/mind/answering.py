"""The final answer: what was done, and what was not and why."""

from __future__ import annotations

from adamo_vh.inference.baseline.language.plan import Goal, Plan, Relation
from adamo_vh.inference.baseline.mind.memory import Finish, Job, Memory, Status
from adamo_vh.inference.baseline.mind.searching import Stage

_SURE = 0.5
_NOTHING_FOUND = 0.6
"""How sure it is that what it looked for all over is not there."""


def finish(plan: Plan, memory: Memory, stage: Stage) -> Finish:
    """The end of an episode: the answer, what it rests on, and what is not known.

    Args:
        plan: What was asked.
        memory: What was done.
        stage: How far the search went.
    """
    done = [job for job in memory.jobs if job.status is Status.DONE]
    said = [f"{job.tag} {_place(plan.goals[job.goal])}" for job in done]
    verified = f"by the feedback: {', '.join(said)}" if said else "nothing"
    unseen = "nothing that matters" if stage is Stage.OVER else "parts of the room not looked at"
    unsure = [job.tag for job in done if _fit(job, memory) < _SURE]
    if unsure:
        unseen += f"; not sure that {_and(unsure)} is what was meant"
    sure = min((_fit(job, memory) for job in done), default=_NOTHING_FOUND)
    confidence = round(min(max(sure, 0.05), 0.98), 2)
    return Finish(final_answer(plan, memory), verified, unseen, confidence)


def _fit(job: Job, memory: Memory) -> float:
    return memory.fits.get(("goal", job.goal), {}).get(job.tag, 0.0)


def final_answer(plan: Plan, memory: Memory) -> str:
    """A short, truthful report on every goal.

    Args:
        plan: What was asked.
        memory: What was done.
    """
    done: list[str] = []
    missed: list[str] = []
    for index, goal in enumerate(plan.goals):
        jobs = [job for job in memory.jobs if job.goal == index]
        good = [_named(goal, job) for job in jobs if job.status is Status.DONE]
        bad = [_named(goal, job) for job in jobs if job.status is not Status.DONE]
        if good:
            done.append(f"{_and(good)} {'is' if len(good) == 1 else 'are'} {_place(goal)}")
        if bad:
            missed.append(f"{_and(bad)} not {_place(goal)}, {_why(goal, index, memory)}")
        if not jobs:
            what = "anything that is one of" if goal.target.every else ""
            missed.append(f"I could not find {what} {goal.target.text}".replace("  ", " "))
    if not missed:
        return f"Done: {'; '.join(done)}."
    if not done:
        return f"Not done: {'; '.join(missed)}."
    return f"Partly done: {'; '.join(done)}. Not done: {'; '.join(missed)}."


def _named(goal: Goal, job: Job) -> str:
    """A thing as the user called it, with its tag."""
    return job.tag if goal.target.every else f"{goal.target.text} ({job.tag})"


def _why(goal: Goal, index: int, memory: Memory) -> str:
    if goal.relation is Relation.HOLD and memory.hand:
        return f"because my hand holds one object only and has {memory.hand}"
    if goal.relation is Relation.NEAR and not memory.fits.get(("place", index)):
        return f"because I could not find {goal.anchor.text if goal.anchor else 'the place'}"
    return "although I tried"


def _place(goal: Goal) -> str:
    match goal.relation:
        case Relation.HOLD:
            return "in my hand"
        case Relation.FLOOR:
            return "on the floor"
        case Relation.CORNER:
            return "on the floor in a corner of the room"
        case Relation.SURFACE:
            return f"on the {goal.furniture}"
        case Relation.NEAR:
            return f"near {goal.anchor.text if goal.anchor else 'it'}"


def _and(tags: list[str]) -> str:
    return tags[0] if len(tags) == 1 else ", ".join(tags[:-1]) + f" and {tags[-1]}"
