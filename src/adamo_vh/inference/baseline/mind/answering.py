"""The final answer: composed from what feedback and views bear out, and from nothing else."""

from __future__ import annotations

from dataclasses import dataclass, field

from adamo_vh.inference.baseline.language.plan import Act, Goal, Plan, Relation
from adamo_vh.inference.baseline.language.requests import CAN
from adamo_vh.inference.baseline.mind.asking import bare, tell, verdict
from adamo_vh.inference.baseline.mind.beliefs import OF_CONDITION
from adamo_vh.inference.baseline.mind.evidence import anchor_of, claim, taken_for
from adamo_vh.inference.baseline.mind.memory import Finish, Job, Memory, Status
from adamo_vh.inference.baseline.mind.searching import Stage
from adamo_vh.inference.baseline.prompt.reading import Prompt
from adamo_vh.inference.baseline.sight.kinds import class_of

_SURE = 0.5
_NOTHING_FOUND = 0.6
"""How sure it is that what it looked for all over is not there."""
_FEW = 5


@dataclass(slots=True)
class _Account:
    """Sentences so far."""

    done: list[str] = field(default_factory=list)
    missed: list[str] = field(default_factory=list)
    doubts: list[str] = field(default_factory=list)
    sure: float = 0.98
    open_ended: bool = False
    """Whether there may be more things of a kind of which all were meant."""


def refusal(problem: str) -> Finish:
    """The end of what cannot be done or was not understood."""
    answer = f"I did nothing, because I did not understand this part: {problem}. {CAN}"
    return Finish(answer, "nothing was done", "the room was not searched")


def finish(plan: Plan, memory: Memory, prompt: Prompt, stage: Stage) -> Finish:
    """The end of an instruction: the answer, what it rests on, and what is not known.

    Args:
        plan: What was asked.
        memory: What was done and seen.
        prompt: For the room.
        stage: How far the search went.
    """
    account = _Account()
    for index, goal in enumerate(plan.goals):
        _tell_goal(goal, index, memory, prompt, account)
    for index, act in enumerate(plan.acts):
        _tell_act(act, index, memory, account)
    told = [
        tell(question, index, memory, prompt, stage)
        for index, question in enumerate(plan.questions)
    ]
    sentences = [_summary(account), *account.doubts, *told, *plan.remarks]
    answer = " ".join(sentence for sentence in sentences if sentence)
    verified = f"by the feedback: {'; '.join(account.done)}" if account.done else "nothing"
    unseen = "parts of the room that I did not look at"
    if stage is Stage.OVER:
        unseen = "what is hidden from the places that I looked from"
    if account.doubts:
        unseen += "; " + " ".join(account.doubts)
    sure = account.sure if account.done else _NOTHING_FOUND
    confidence = round(min(max(sure, 0.05), 0.98), 2)
    return Finish(answer or "I did nothing.", verified, unseen, confidence)


def not_met(plan: Plan, memory: Memory, prompt: Prompt) -> Finish:
    """The end of an instruction whose condition does not hold, or cannot be told."""
    assert plan.condition is not None
    holds = verdict(plan.condition, OF_CONDITION, memory, prompt)
    why = tell(plan.condition, OF_CONDITION, memory, prompt, Stage.OVER)
    if holds is None:
        return Finish(f"I did nothing, because I cannot tell whether that is so. {why}", "nothing")
    return Finish(f"I did nothing, because that is not so. {why}", f"by what I saw: {why}")


def _summary(account: _Account) -> str:
    if not account.done and not account.missed:
        return ""
    if not account.missed and account.open_ended:
        return f"As far as I can tell: {'; '.join(account.done)}."
    if not account.missed:
        return f"Done: {'; '.join(account.done)}."
    if not account.done:
        return f"Not done: {'; '.join(account.missed)}."
    return f"Partly done: {'; '.join(account.done)}. Not done: {'; '.join(account.missed)}."


def _tell_goal(goal: Goal, index: int, memory: Memory, prompt: Prompt, account: _Account) -> None:
    jobs = [job for job in memory.jobs if job.goal == index]
    target = goal.target
    if not jobs:
        left = _left_out(goal, index, jobs, memory)
        more = f"I found no more than {left} and left them out" if left else ""
        account.missed.append(more or _not_found(goal, index, memory))
        return
    for job in jobs:
        said = claim(goal, index, job.tag, memory, prompt.room)
        if said:
            account.done.append(said)
            account.sure = min(account.sure, _fit(job, memory))
        else:
            account.missed.append(_why(goal, job, memory))
    if target.every and target.count and len(jobs) < target.count:
        tags = _and([job.tag for job in jobs])
        account.missed.append(f"I found only {len(jobs)} of {target.count} ({tags})")
    if target.every and not target.count and not target.ids:
        account.open_ended = True
    if left := _left_out(goal, index, jobs, memory):
        account.doubts.append(f"I left out {left}.")
    _identity(goal, index, jobs, memory, account)


def _left_out(goal: Goal, index: int, jobs: list[Job], memory: Memory) -> str:
    """Those that "all but one" left out."""
    fits, taken = memory.fits.get(("goal", index), {}), {job.tag for job in jobs}
    left = sorted(t for t, fit in fits.items() if fit >= _SURE and t not in taken)
    return _and(left) if left and goal.target.spared else ""


def _identity(goal: Goal, index: int, jobs: list[Job], memory: Memory, account: _Account) -> None:
    """Say which was taken where several fit, and where looks had to decide."""
    target = goal.target
    if target.source and target.source[0] is Relation.SURFACE and jobs:
        account.open_ended = True
        account.doubts.append(f"I cannot tell by sight that it was on the {target.source[1][0]}.")
    if goal.relation is Relation.SURFACE and goal.furniture:
        rests = [memory.rests.get(job.tag, "") for job in jobs]
        for body in sorted({taken_for(goal.furniture, where) for where in rests} - {""}):
            account.open_ended = True
            account.doubts.append(f"I took {body} for the {goal.furniture}.")
    if not target.ids:
        unsure = [job.tag for job in jobs if _fit(job, memory) < _SURE]
        opaque = [j.tag for j in jobs if class_of(j.tag) is None and j.tag not in unsure]
        if unsure:
            account.open_ended = True
            is_or_are = "is" if len(unsure) == 1 else "are"
            account.doubts.append(f"I am not sure that {_and(unsure)} {is_or_are} {target.text}.")
        if opaque and (target.classes or target.by_looks):
            account.open_ended = True
            account.doubts.append(f"By the looks I took {_and(opaque)} for {target.text}.")
    if target.every or target.ids or target.size or len(jobs) != 1 or target.but:
        return
    fits = memory.fits.get(("goal", index), {})
    others = sorted(t for t, fit in fits.items() if fit >= _SURE and t in memory.things)
    if len(others) > 1 and jobs[0].tag in others:
        which = _and(others) if len(others) <= _FEW else f"{len(others)} things"
        account.doubts.append(f"Several fit '{target.text}' ({which}); I chose {jobs[0].tag}.")


def _not_found(goal: Goal, index: int, memory: Memory) -> str:
    target = goal.target
    words = f"I found {'nothing that is' if target.every and not target.classes else 'no'} "
    words += bare(target).removeprefix("any ")
    if target.source and target.source[0] is Relation.SURFACE:
        words += f" on what may be a {target.source[1][0]}"
    kin = [tag for tag in memory.things if class_of(tag) in target.classes]
    if target.by_looks and kin:
        looks = [f"{t} looks {memory.looks[t]}" for t in kin if t in memory.looks]
        return f"{words}; of that kind I saw only {_and(sorted(kin))}" + (
            f" ({', '.join(looks)})" if looks else ""
        )
    if target.classes and kin:
        return f"{words} besides {_and(sorted(kin))}"
    del index
    return words


def _why(goal: Goal, job: Job, memory: Memory) -> str:
    """What is to be said of a thing that is not where it was wished."""
    tag = job.tag
    if goal.relation is Relation.HOLD and memory.hand and memory.hand != tag:
        return f"my hand holds one thing only and has {memory.hand}, so I did not take {tag}"
    now = f"{tag} rests {memory.rests[tag]}" if tag in memory.rests else f"I did not move {tag}"
    if memory.hand == tag:
        now = f"I still hold {tag}"
    return f"{now}, because {_reason(goal, job, memory)}"


def _reason(goal: Goal, job: Job, memory: Memory) -> str:
    anchor = goal.anchor and anchor_of(job.goal, memory)
    if goal.relation in (Relation.SURFACE, Relation.UNDER):
        return f"I found no {goal.furniture} that I could tell to be one"
    if goal.anchor and anchor is None:
        return f"I found no {bare(goal.anchor).removeprefix('any ')}"
    if refused := memory.refusals.get(job.tag):
        return f"I was told: '{refused.strip().rstrip('.')}'"
    if job.status is Status.TODO:
        return "I did not get to it"
    return "I found no free place where that holds"


def _tell_act(act: Act, index: int, memory: Memory, account: _Account) -> None:
    what = act.target.text if act.target else act.text
    if memory.acts <= index:
        account.missed.append(f"I did not {act.name} {what}".rstrip())
    elif act.name == "walk":
        account.done.append(memory.walked.partition(": ")[2].rstrip(". ") or "walked")
    elif act.target:
        seen = [t for t, f in memory.fits.get(("act", index), {}).items() if f >= _SURE]
        account.done.append(f"I turned my eyes to {_and(sorted(seen)[:1]) if seen else what}")
    else:
        account.done.append("I turned my eyes as asked")


def _fit(job: Job, memory: Memory) -> float:
    return memory.fits.get(("goal", job.goal), {}).get(job.tag, 0.0)


def _and(tags: list[str]) -> str:
    return tags[0] if len(tags) == 1 else ", ".join(tags[:-1]) + f" and {tags[-1]}"
