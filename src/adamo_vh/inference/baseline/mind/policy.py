"""The next turn: what to do now, and the note that says why."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.language.plan import Plan, Relation
from adamo_vh.inference.baseline.mind import choosing, ledger, placing, searching
from adamo_vh.inference.baseline.mind.answering import finish
from adamo_vh.inference.baseline.mind.beliefs import (
    judge_by_text,
    look,
    needs_pixels,
    recalled,
    settled,
    since_whole,
)
from adamo_vh.inference.baseline.mind.happenings import FAR_M, anchor_of, current_job, imagined
from adamo_vh.inference.baseline.mind.memory import (
    Finish,
    Job,
    Memory,
    Move,
    Search,
    Status,
    Step,
    Thing,
    to_point,
)
from adamo_vh.inference.baseline.prompt.reading import Prompt
from adamo_vh.inference.baseline.prompt.speaking import Manner
from adamo_vh.inference.baseline.sight.kinds import class_of
from adamo_vh.inference.baseline.sight.printed import WordReader

_MAX_ASIDE = 4
"""Tries to empty the hand in an episode, after which it stays as it is."""
_SAME_M = 0.02
"""Feedback rounds places to a centimetre."""
_DOUBT = 0.5
"""Below this fit a thing is inspected before it is picked."""


def decide(
    prompt: Prompt, plan: Plan, manner: Manner | None = None, reader: WordReader | None = None
) -> Step:
    """Choose the next turn.

    Args:
        prompt: The whole prompt, read.
        plan: What the instruction asks for.
        manner: How the agent wants to be spoken to; the paper's way by default.
        reader: Reads printed words; None to do without.
    """
    manner = manner or Manner()
    if plan.problem:
        answer = f"I did nothing, because I did not understand this part: {plan.problem}."
        return Step(finish=Finish(answer, "nothing was done", "the room was not searched"))
    memory = recalled(prompt, plan)
    before = memory.copy()
    look(prompt, plan, memory, reader)
    turn = _Turn(prompt, plan, memory, manner)
    move = turn.next_move()
    if move is None:
        return Step(finish=finish(plan, memory, turn.stage()))
    known = memory.copy()
    moves = _plan_on(turn, move, known)
    note = (
        f"Evidence: {_evidence(prompt, known)} Conclusion: {move.conclusion} "
        f"Next: {', '.join(m.describe() for m in moves)}. "
    )
    return Step(note + _line(prompt, plan, known, before, moves), tuple(moves))


def _plan_on(turn: _Turn, first: Move, known: Memory) -> list[Move]:
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


def _line(prompt: Prompt, plan: Plan, memory: Memory, before: Memory, moves: list[Move]) -> str:
    """The line of the note that carries what the messages do not tell."""
    numbers = [ledger.read(turn.note).number for turn in prompt.turns]
    number = (numbers[-1] if numbers else 0) + 1
    whole = number == 2 or _first_falls_out(prompt)
    codes = [str(move.search) or "." for move in moves]
    head = ["q" + "".join(codes)] if any(move.search for move in moves) else []
    lasting = _lasting(prompt, memory, whole, moves)
    groups = [
        index
        for index, goal in enumerate(plan.goals)
        if goal.target.compares or (goal.anchor is not None and goal.anchor.compares)
    ]
    start = before
    if whole:
        start = Memory(things=memory.things)
        judge_by_text(start, plan)
        lasting |= _done_with(plan, memory)
    distances = _distances(plan, memory, start)
    entry = ledger.Entry(number, whole, head)
    return ledger.write(memory, start, lasting, groups, distances, entry)


def _distances(plan: Plan, memory: Memory, before: Memory) -> list[str]:
    """Things of which it must be noted from how near they were seen."""
    if settled(plan, memory):
        return []
    new = {tag: m for tag, m in memory.seen_m.items() if before.seen_m.get(tag) != m}
    if needs_pixels(plan, memory):
        return list(new)
    return [tag for tag, m in new.items() if max(m, before.seen_m.get(tag, m)) > FAR_M]


def _done_with(plan: Plan, memory: Memory) -> set[str]:
    """Things that no goal is about any more, once it is known what all goals are about."""
    if not settled(plan, memory):
        return set()
    open_jobs = [job for job in memory.jobs if job.status is Status.TODO]
    anchors = [anchor_of(job.goal, memory) for job in open_jobs]
    # Where things were put matters for where to put the next ones.
    needed = {job.tag for job in memory.jobs} | {thing.tag for thing in anchors if thing}
    return set(memory.things) - needed - {memory.hand}


def _lasting(prompt: Prompt, memory: Memory, whole: bool, moves: list[Move]) -> set[str]:
    """Things whose places the next prompt will tell without this note."""
    told = {tag: thing.position for tag, thing in prompt.told.items()}
    if prompt.lasting:
        return _still_there(memory, told) & prompt.pinned if whole else set(told)
    looks = any(move.name == "Look" for move in moves)
    kept = set() if looks else _still_there(memory, told)
    if whole:
        return kept
    notes = [turn.note for turn in since_whole(prompt.turns)]
    noted = ledger.things_noted(notes)
    return kept | _still_there(memory, {tag: thing.position for tag, thing in noted.items()})


def _still_there(memory: Memory, places: Mapping[str, Vec3]) -> set[str]:
    things = memory.things
    return {t for t, place in places.items() if things[t].position.distance(place) < _SAME_M}


def _first_falls_out(prompt: Prompt) -> bool:
    """Whether older turns have left the prompt, and with the next one the last whole line would."""
    entries = [ledger.read(turn.note) for turn in prompt.turns]
    if not entries or entries[0].number <= 1:
        return False
    return not any(entry.whole for entry in entries[1:])


@dataclass(frozen=True, slots=True)
class _Turn:
    """The choice of one call."""

    prompt: Prompt
    plan: Plan
    memory: Memory
    """Is changed: jobs that are found out about, done or given up."""
    manner: Manner

    def stage(self) -> searching.Stage:
        """How far the search is."""
        return searching.stage(self.prompt, self.memory)

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
        return self._let_go()

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
        if goal.anchor and tags and goal.relation is Relation.NEAR:
            trial = replace(memory, jobs=[*memory.jobs, *jobs])
            beside = choosing.anchor(goal, index, trial, stage)
            if beside is None and stage is not searching.Stage.OVER:
                return self._search(goal.anchor.text)
            if beside is None:
                jobs = [replace(job, status=Status.FAILED) for job in jobs]
            jobs = [job for job in jobs if beside is None or job.tag != beside.tag]
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
        return Move(words, "Pick", (("object", job.tag),), confidence=round(sure, 2))

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
        if spot is None:
            memory.set_job(replace(job, status=Status.FAILED))
            return self._drop_at_feet()
        again = " The last place was not good enough." if job.tries else ""
        words = f"{job.tag} is in my hand; it must be {goal.wish()}.{again}"
        return Move(words, "Drop", (("object", job.tag), *to_point(spot)))

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
