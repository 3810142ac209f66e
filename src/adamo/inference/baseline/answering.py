"""The final answer: what was done, and what was not and why."""

from __future__ import annotations

from adamo.inference.baseline.goals import Goal, Plan, Relation
from adamo.inference.baseline.memory import Job, Memory, Status


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
