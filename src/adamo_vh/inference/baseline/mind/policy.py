"""The next turn: what to do now, and the note that says why."""

from __future__ import annotations

from dataclasses import dataclass, replace

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import Act, Plan, Relation
from adamo_vh.inference.baseline.mind import asking, choosing, furniture, placing, searching
from adamo_vh.inference.baseline.mind.answering import finish, not_met, refusal
from adamo_vh.inference.baseline.mind.beliefs import (
    OF_CONDITION,
    look,
    needs_pixels,
    recalled,
)
from adamo_vh.inference.baseline.mind.evidence import anchor_of, second_of
from adamo_vh.inference.baseline.mind.happenings import MAX_TRIES, current_job, imagined
from adamo_vh.inference.baseline.mind.memory import (
    Decision,
    Finish,
    Job,
    Memory,
    Move,
    Search,
    Status,
    Thing,
    to_point,
)
from adamo_vh.inference.baseline.mind.remembering import carried_over
from adamo_vh.inference.baseline.prompt.reading import Prompt
from adamo_vh.inference.baseline.prompt.speaking import Manner
from adamo_vh.inference.baseline.sight.kinds import class_of
from adamo_vh.inference.baseline.sight.printed import WordReader

_MAX_ASIDE = 4
"""Tries to empty the hand in an episode, after which it stays as it is."""

_DOUBT = 0.5
"""Below this fit a thing is inspected before it is picked."""

_VIEWS_FOR_FURNITURE = 8
"""Steps of the search after which no further furniture is looked for."""


def decide(
    prompt: Prompt, plan: Plan, manner: Manner | None = None, reader: WordReader | None = None
) -> Decision:
    """Choose the next turn.

    Args:
        prompt: The whole prompt, read.
        plan: What the instruction asks for.
        manner: How the agent wants to be spoken to; the paper's way by default.
        reader: Reads printed words; None to do without.
    """
    manner = manner or Manner()
    if plan.problem:
        return Decision(finish=refusal(plan.problem))
    memory = recalled(prompt, plan)
    before = memory.copy()
    look(prompt, plan, memory, reader)
    turn = Choice(prompt, plan, memory, manner)
    move, end = turn.first_move()
    if end is not None:
        return Decision(finish=end)
    assert move is not None
    plan, known = turn.plan, memory.copy()
    moves = _plan_on(turn, move, known)
    note = (
        f"Evidence: {_evidence(prompt, known)} Conclusion: {move.conclusion} "
        f"Next: {', '.join(m.describe() for m in moves)}. "
    )
    return Decision(note + carried_over(prompt, plan, known, before, moves), tuple(moves))


def _plan_on(turn: Choice, first: Move, known: Memory) -> list[Move]:
    """The calls of a turn: as many as follow without a further view.

    What further goals turn out to be about on the way is added to what is known.
    """
    moves = [first]
    while len(moves) < turn.manner.plan:
        last = moves[-1]
        if last.name == "Inspect" or (last.name == "Pick" and last.confidence < _DOUBT):
            break
        if last.search is not Search.NONE and last.search is not Search.ASIDE:
            pixels = needs_pixels(turn.plan, turn.memory)
            if last.name == "Look" and (pixels or last.search is Search.NEARER):
                break
        prompt, memory = imagined(turn.prompt, turn.memory, last, turn.plan)
        turn = replace(turn, prompt=prompt, memory=memory)
        move = turn.next_move()
        if move is None or not _follows(move, last):
            break
        moves.append(move)
    found = {job.goal for job in known.jobs}
    new = [job for job in turn.memory.jobs if job.goal not in found]
    known.jobs += [Job(job.goal, job.tag) for job in new if job.status is not Status.FAILED]
    return moves


def _follows(move: Move, last: Move) -> bool:
    """Whether a call may stand behind another in one turn."""
    if last.search in (Search.ROUND, Search.APPROACH, Search.NEARER):
        return move.name == "Look" and move.search is not Search.NONE
    return True


@dataclass(frozen=True, slots=True)
class Choice:
    """The choice of one call."""

    prompt: Prompt
    plan: Plan
    memory: Memory
    """Is changed: jobs that are found out about, done or given up."""
    manner: Manner

    def stage(self) -> searching.Stage:
        """How far the search is."""
        return searching.stage(self.prompt, self.memory)

    def first_move(self) -> tuple[Move | None, Finish | None]:
        """The first call, or the end."""
        if self.plan.condition is not None and self.memory.decided is None:
            ready = asking.ready(self.plan.condition, OF_CONDITION, self.memory, self.stage())
            if not ready:
                return self._search("whether the condition holds"), None
            self.memory.decided = asking.verdict(
                self.plan.condition, OF_CONDITION, self.memory, self.prompt
            )
        if self.plan.condition is not None and not self.memory.decided:
            return None, self._otherwise()
        move = self.next_move()
        if move is not None:
            return move, None
        return None, finish(self.plan, self.memory, self.prompt, self.stage())

    def _otherwise(self) -> Finish:
        return not_met(self.plan, self.memory, self.prompt)

    def next_move(self) -> Move | None:
        """The first call that brings an open goal on; None when all are done or given up."""
        goals = self.plan.goals
        for index in sorted(range(len(goals)), key=lambda i: goals[i].relation is Relation.HOLD):
            move = self._resolve(index)
            if move:
                return move
            for job in self._open_jobs(index):
                move = self._advance(job)
                if move:
                    return move
        return self._let_go() or self._next_act() or self._find_out()

    def _next_act(self) -> Move | None:
        """The next act of the body that was asked for."""
        done = self.memory.acts
        if done >= len(self.plan.acts):
            return None
        act = self.plan.acts[done]
        if act.target:
            fits = self.memory.fits.get(("act", done), {})
            known = [(f, t) for t, f in fits.items() if t in self.memory.things]
            if not known or max(known)[0] < _DOUBT:
                if self.stage() is searching.Stage.OVER:
                    return None
                return self._search(act.target.text)
            return self._body(act, self.memory.things[max(known)[1]].position)
        point = searching.aim(act, self.prompt, self.memory)
        return self._body(act, point) if point else None

    def _body(self, act: Act, point: Vec3) -> Move:
        why = f"I was asked to {act.name} {act.target.text if act.target else act.text}.".strip()
        if act.name == "walk":
            point = Vec3(point.x, point.y, 0.0)
        return Move(why, act.name.capitalize(), to_point(point), Search.ACT)

    def _find_out(self) -> Move | None:
        """A step of the search if a question cannot be answered yet."""
        for index, question in enumerate(self.plan.questions):
            if not asking.ready(question, index, self.memory, self.stage()):
                what = question.target.text if question.target else "what I was asked for"
                return self._search(what)
        return None

    def _open_jobs(self, goal: int) -> list[Job]:
        jobs = self.memory.jobs
        return [job for job in jobs if job.goal == goal and job.status is Status.TODO]

    def _resolve(self, index: int) -> Move | None:
        """Find out which things a goal is about; the call is one of the search, if needed."""
        goal, memory, stage = self.plan.goals[index], self.memory, self.stage()
        if any(job.goal == index for job in memory.jobs):
            return None
        tags = choosing.targets(goal, index, memory, stage)
        if tags is None:
            return self._search(goal.target.text)
        jobs = [Job(index, tag) for tag in tags]
        if goal.anchor and tags and goal.relation is not Relation.FLOOR:
            trial = replace(memory, jobs=[*memory.jobs, *jobs])
            beside = choosing.anchor(goal, index, trial, stage)
            if goal.second and beside and second_of(index, trial) is None:
                beside = None
            if beside is None and stage is not searching.Stage.OVER:
                return self._search((goal.second or goal.anchor).text)
            if beside is None:
                jobs = [replace(job, status=Status.FAILED) for job in jobs]
            jobs = [job for job in jobs if beside is None or job.tag != beside.tag]
        if goal.relation in (Relation.SURFACE, Relation.UNDER) and jobs:
            found = furniture.candidates(self.prompt, memory, jobs[0].tag, goal.furniture)
            looking = furniture.may_be_found(goal.furniture) and memory.views < _VIEWS_FOR_FURNITURE
            if looking and not any(surface.firm for surface in found):
                return self._search(f"the {goal.furniture}")
            if not found or not (found[0].sure or furniture.may_be_found(goal.furniture)):
                jobs = [replace(job, status=Status.FAILED) for job in jobs]
        if move := self._inspect_first(index, jobs):
            return move
        memory.jobs.extend(jobs)
        return None

    def _inspect_first(self, index: int, jobs: list[Job]) -> Move | None:
        """A close-up of a thing that may not be the right one, while it is in view."""
        target = self.plan.goals[index].target
        if not self.manner.inspects or target.ids or (target.size and not target.by_looks):
            return None
        in_view = {thing.tag for thing in self.prompt.things}
        for job in jobs:
            fit = self._fit(job)
            if fit < _DOUBT and job.tag in in_view and job.tag not in self.memory.inspected:
                words = f"{job.tag} may be '{target.text}', but I am not sure ({fit:.2f})."
                return Move(words, "Inspect", (("object", job.tag),), confidence=0.9)
        return None

    def _search(self, wanted: str) -> Move:
        step = searching.next_step(self.prompt, self.memory)
        why = f"I cannot tell yet which is '{wanted}'; I look round."
        return Move(why, step.name, to_point(step.point), step.search, 0.8)

    def _fit(self, job: Job) -> float:
        return self.memory.fits.get(("goal", job.goal), {}).get(job.tag, 0.0)

    def _advance(self, job: Job) -> Move | None:
        """One call for one job; None if nothing more is to be done for it."""
        memory, goal = self.memory, self.plan.goals[job.goal]
        if memory.hand and memory.hand != job.tag:
            if goal.relation is Relation.HOLD and self._holds_what_it_should():
                memory.set_job(replace(job, status=Status.FAILED))
                return None
            return self._drop_first()
        if memory.hand == job.tag:
            if goal.relation is Relation.HOLD:
                memory.set_job(replace(job, status=Status.DONE))
                return None
            return self._put(job)
        event = self.prompt.event
        if job.tries and event and event.name == "Pick":
            return self._approach(job)
        words = f"{job.tag} {self._fit_words(job)}; it must be {goal.wish()}."
        sure = min(max(self._fit(job), 0.05), 0.98)
        thing = memory.things.get(job.tag)
        arguments = (("object", job.tag),)
        origin = thing.position if thing else None
        return Move(words, "Pick", arguments, confidence=round(sure, 2), origin=origin)

    def _approach(self, job: Job) -> Move | None:
        """After a refused pick: look at the thing, then try again."""
        thing = self.memory.things.get(job.tag)
        if thing is None:
            self.memory.set_job(replace(job, status=Status.FAILED))
            return None
        words = f"{job.tag} could not be picked; I must see it better."
        return Move(words, "Look", to_point(thing.position))

    def _put(self, job: Job) -> Move | None:
        goal, memory = self.plan.goals[job.goal], self.memory
        thing = memory.things.get(job.tag) or self._unknown(job.tag)
        spot = placing.spot(self.prompt, memory, goal, job, thing, anchor_of(job.goal, memory))
        if goal.relation is Relation.SURFACE and job.tries >= MAX_TRIES - 1:
            spot = None
        if spot is None:
            if goal.relation is Relation.SURFACE and memory.views < _VIEWS_FOR_FURNITURE:
                return self._search(f"the {goal.furniture}")
            memory.set_job(replace(job, status=Status.FAILED))
            return self._put_back(thing) or self._drop_at_feet()
        again = " The last place was not good enough." if job.tries else ""
        words = f"{job.tag} is in my hand; it must be {goal.wish()}.{again}"
        return Move(words, "Drop", (("object", job.tag), *to_point(spot)))

    def _put_back(self, thing: Thing) -> Move | None:
        """What could not be brought to its place goes back where it came from."""
        origin = self.memory.came_from.get(thing.tag)
        if origin is None or self.memory.aside >= _MAX_ASIDE:
            return None
        foot = Vec3(origin.x, origin.y, max(0.0, origin.z - thing.height_m / 2))
        words = f"I know no such place for {thing.tag}; I put it back."
        return Move(words, "Drop", (("object", thing.tag), *to_point(foot)), Search.ASIDE)

    def _drop_first(self) -> Move | None:
        """Empty the hand: where the held thing belongs, if a goal says so."""
        job = current_job(self.memory.hand, self.memory)
        if job and self.plan.goals[job.goal].relation is not Relation.HOLD:
            move = self._put(job)
            if move:
                return move
        return self._drop_at_feet()

    def _drop_at_feet(self) -> Move | None:
        memory, tag = self.memory, self.memory.hand
        if memory.aside >= _MAX_ASIDE:
            return None
        thing = memory.things.get(tag) or self._unknown(tag)
        spot = placing.floor_spot(self.prompt, memory, thing, None, memory.aside)
        words = f"My hand holds {tag}, which has no place to go; it must be empty."
        return Move(words, "Drop", (("object", tag), *to_point(spot)), Search.ASIDE)

    def _let_go(self) -> Move | None:
        """At the end nothing stays in the hand that was not to be held."""
        memory = self.memory
        if not memory.hand or self._holds_what_it_should():
            return None
        if not any(job.tag == memory.hand for job in memory.jobs):
            return None
        return self._drop_at_feet()

    def _holds_what_it_should(self) -> bool:
        return any(
            job.tag == self.memory.hand and self.plan.goals[job.goal].relation is Relation.HOLD
            for job in self.memory.jobs
        )

    def _unknown(self, tag: str) -> Thing:
        return Thing(tag, self.prompt.body.position, 500.0, 0.1, 0.1)

    def _fit_words(self, job: Job) -> str:
        """How sure it is that this thing is meant, and by what."""
        target, fit = self.plan.goals[job.goal].target, self._fit(job)
        if target.ids or (target.classes and class_of(job.tag) in target.classes):
            how = "by its tag"
        elif target.by_looks or target.classes:
            how = "by its looks and size"
        else:
            how = "by the listed volumes"
        sure = "is" if fit >= 0.95 else "is probably" if fit >= 0.5 else "is my best guess for"
        return f"{sure} '{target.text}' {how}"


def _evidence(prompt: Prompt, memory: Memory) -> str:
    """What happened last, in as few words as tell it."""
    if prompt.event is None:
        return f"{len(prompt.things)} objects in view."
    outcome = prompt.event.outcome or "gave no feedback"
    return f"{prompt.event.name} {outcome}; {len(memory.things)} objects known."
