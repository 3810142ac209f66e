"""Why each condition of a task was not met, told from the states and the calls."""

from __future__ import annotations

from dataclasses import replace

from adamo_vh import action
from adamo_vh.analysis.claims import claims_success
from adamo_vh.analysis.diagnosis.cause import Cause
from adamo_vh.analysis.diagnosis.endings import (
    loop_moves,
    loop_of,
    protocol_cause,
    stopped_by_limit,
    untouched,
)
from adamo_vh.analysis.diagnosis.finding import Code
from adamo_vh.analysis.diagnosis.placing import anchor_of, misplaced, with_object
from adamo_vh.analysis.diagnosis.refusals import is_refused, refusal, streak
from adamo_vh.analysis.diagnosis.sight import on_text
from adamo_vh.analysis.diagnosis.story import DROP, PICK, Moment, Putting, Story, call_text
from adamo_vh.benchmark.checkers import MOVED_M
from adamo_vh.benchmark.conditions import Aim, Condition, counted, holds
from adamo_vh.benchmark.goals import open_goals
from adamo_vh.engine import ObjectState
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Acted

_BACK_M = 0.15
"""An object this close to where it was at the start was put back."""


def causes(story: Story) -> list[Cause]:
    """One cause for each condition that is not met at the end, in the order of the task."""
    pairs = zip(counted(story.task.conditions), story.result.conditions, strict=True)
    found = [
        _cause_of(story, condition, number)
        for number, (condition, result) in enumerate(pairs)
        if not result.satisfied
    ]
    return [cause for cause in found if cause is not None]


def _cause_of(story: Story, condition: Condition, number: int) -> Cause | None:
    """The cause by where one object is; None for what only waits for the others."""
    states = [moment.state for moment in story.moments]
    *past, end = states
    if holds(condition, end, past):
        if not isinstance(condition, Aim):
            return None
        text = f"{story.name(condition.id)} was put as asked before what was to come first."
        step = next(m.step for m in story.moments if holds(condition, m.state, past[:1]))
        return Cause(Code.WRONG_ORDER, step, text, condition.id)
    if isinstance(condition, Aim):
        return _cause(story, condition, number)
    for goal in open_goals(condition, end, past):
        if isinstance(goal.condition, Aim) and not goal.is_undoing:
            return _cause(story, goal.condition, number)
    kept = [i for i, state in enumerate(states) if holds(condition, state, states[:i])]
    broken = story.moments[min((kept[-1] if kept else 0) + 1, len(states) - 1)]
    text = f"After step {broken.step} it was no longer as asked: {condition}."
    return Cause(Code.EXTRA_GOAL, broken.step, text)


def _cause(story: Story, condition: Aim, number: int) -> Cause:
    undone = _undone(story, condition)
    loop = loop_of(story)
    if undone is not None:
        return loop if loop and loop_moves(story, loop) else undone
    if story.held_at(condition.id):
        return _handled(story, condition, loop, number)
    return _never_held(story, condition, number)


def _undone(story: Story, condition: Aim) -> Cause | None:
    """Whether it was met once, and by which step it was undone."""
    met = [m for m in story.moments if _is_met(story, condition, m)]
    if not met:
        return None
    after = story.moments[story.moments.index(met[-1]) + 1 :]
    act = after[0].act if after else None
    if act is None:
        return None  # Nothing that the agent did.
    item, start = after[-1].object(condition.id), story.moments[0].object(condition.id)
    name = story.name(condition.id)
    text = f"{name} was as asked after step {met[-1].step}; {call_text(act)} undid it."
    if item is None or start is None:
        return Cause(Code.EXTRA_GOAL, act.step, text, condition.id)
    code = Code.PUT_BACK if _is_back(item, start) else Code.EXTRA_GOAL
    return Cause(code, act.step, text, condition.id)


def _is_back(item: ObjectState, start: ObjectState) -> bool:
    """Whether a thing is where it was at the start."""
    return item.support == start.support and item.box.center.distance(start.box.center) < _BACK_M


def _is_met(story: Story, condition: Aim, moment: Moment) -> bool:
    here = {item.id for item in moment.state.objects}
    return condition.objects <= here and condition.satisfied(moment.state, (story.start,))


def _handled(story: Story, condition: Aim, loop: Cause | None, number: int) -> Cause:
    """The object was in the hand, and is not where it belongs."""
    if loop is not None and loop_moves(story, loop):
        return loop
    puttings = story.puttings(condition.id)
    if story.final.body.held != condition.id and puttings:
        if moved := _anchor_moved(story, condition, puttings[-1].moment):
            return moved
        if _was_given_up(story, puttings[-1]):
            return _given_up(story, condition, number)
        return misplaced(story, condition, puttings[-1])
    return _still_held(story, condition, loop)


def _was_given_up(story: Story, putting: Putting) -> bool:
    """Whether a thing was put back where it stood, and on purpose, by one who does not say done."""
    start = story.moments[0].object(putting.item.id)
    if start is None or not _is_back(putting.item, start):
        return False
    aim = putting.aim
    meant = aim is None or aim.horizontal_distance(start.box.center) < _BACK_M
    return meant and not claims_success(story.manifest.config.instruction, story.ended.answer)


def _given_up(story: Story, condition: Aim, number: int) -> Cause:
    """The object was taken and put back where it stood: nothing came of it.

    Where it was to be brought to something, that is what the agent may have lacked.
    """
    anchor = anchor_of(condition)
    cause = untouched(story, condition.id if anchor is None else anchor, number)
    name = story.name(condition.id)
    return replace(cause, text=f"{name} was taken and put back where it stood. {cause.text}")


def _anchor_moved(story: Story, condition: Aim, moment: int) -> Cause | None:
    """Whether it would be met, had the agent left the anchor alone."""
    anchor = anchor_of(condition)
    if anchor is None or not story.held_at(anchor):
        return None
    first, then = story.moments[0].object(anchor), story.moments[moment].object(condition.id)
    if first is None or then is None or first.support != then.support:
        return None
    state = story.moments[moment].state
    objects = tuple(first if item.id == anchor else item for item in state.objects)
    if not condition.satisfied(replace(state, objects=objects), (story.start,)):
        return None
    step = story.moments[story.held_at(anchor)[0]].step
    text = f"{story.name(anchor)} was taken from its place, and was to stay there."
    return Cause(Code.EXTRA_GOAL, step, text, condition.id, anchor)


def _still_held(story: Story, condition: Aim, loop: Cause | None) -> Cause:
    """The object is in the hand at the end, and was to be put down."""
    taken = story.moments[story.held_at(condition.id)[-1]]
    first = story.moments[story.held_at(condition.id)[0]]
    name = story.name(condition.id)
    drops = [act for act in story.acts if act.name == DROP and is_refused(act)]
    if drops and drops[-1].step > first.step:
        return refusal(story, drops[-1], condition.id)
    if (cause := protocol_cause(story)) is not None:
        return cause
    since = [act for act in story.acts if act.step > first.step]
    last = streak(story, since)
    if last is not None and last.feedback.code != action.Code.HAND_FULL:
        return refusal(story, last, condition.id)
    early = [act for act in drops if act.feedback.code == action.Code.HAND_EMPTY]
    if early:
        text = f"Step {early[0].step}, {call_text(early[0])}, came before {name} was taken."
        return Cause(Code.WRONG_ORDER, early[0].step, text, condition.id)
    if story.ended.reason is not TerminationReason.ANSWERED and last is None:
        return loop or stopped_by_limit(story, condition.id)
    text = f"{name} was taken in step {first.step} and is still in the hand; it was to be put down."
    return Cause(Code.NOT_RELEASED, taken.step, text, condition.id)


def _never_held(story: Story, condition: Aim, number: int) -> Cause:
    """The object never was in the hand."""
    found = [*_wrong_objects(story, condition), *_refused_picks(story, condition)]
    if found:
        return min(found, key=lambda cause: cause.step)
    return protocol_cause(story) or untouched(story, condition.id, number)


def _wrong_objects(story: Story, condition: Aim) -> list[Cause]:
    """What was taken and is not asked for: the first, or the one that was put as this one should.

    What the task wants moved for another condition is no mistake.
    """
    handled = [(i, x) for i, x in story.handled() if x not in story.task.targets]
    if not handled:
        return []
    end = story.moments[-1]
    as_asked = [
        (i, x)
        for i, x in handled
        if end.object(x) and _is_met(story, with_object(condition, x), end)
    ]
    i, taken = (as_asked or handled)[0]
    step, asked, other = story.moments[i].step, story.name(condition.id), story.name(taken)
    if taken == anchor_of(condition):
        text = f"{other} was taken in step {step}; it was to stay, and {asked} to be brought to it."
        return [Cause(Code.WRONG_ROLE, step, text, condition.id, taken)]
    text = f"{other} was taken in step {step}; {asked} was asked for, and never taken."
    return [Cause(Code.WRONG_OBJECT, step, text, condition.id, taken)]


def _refused_picks(story: Story, condition: Aim) -> list[Cause]:
    """Refused Picks that may have been meant for this object, unless it was still taken."""
    found: list[Cause] = []
    for act in story.acts:
        if act.name != PICK or not is_refused(act):
            continue
        meant = story.meant(act)
        if meant == condition.id or (meant is None and not found):
            found.append(_refused_pick(story, condition, act))
        elif meant is not None and meant not in story.task.objects:
            text = (
                f"Step {act.step}, {call_text(act)}, went for {story.name(meant)}, and not for it."
            )
            found.append(Cause(Code.WRONG_OBJECT, act.step, text, condition.id, meant))
    return found[-1:]


def _refused_pick(story: Story, condition: Aim, act: Acted) -> Cause:
    cause = refusal(story, act, condition.id)
    held = story.moments[[m.step for m in story.moments].index(act.step)].state.body.held
    is_kept = held is not None and held == story.final.body.held and held in story.task.targets
    if act.feedback.code == action.Code.HAND_FULL and is_kept and held is not None:
        text = f"{story.name(held)} was never put down, so nothing else could be taken."
        return Cause(Code.NOT_RELEASED, act.step, text, held)
    return cause


def strict_causes(story: Story) -> list[Cause]:
    """What speaks against a strict success, where every condition is met."""
    found = []
    for i, taken in story.handled():
        before, after = story.moments[0].object(taken), story.moments[-1].object(taken)
        if taken in story.task.targets or before is None or after is None:
            continue
        if (
            after.support != before.support
            or after.box.center.distance(before.box.center) > MOVED_M
        ):
            step = story.moments[i].step
            text = (
                f"{story.name(taken)} was taken in step {step} and is {on_text(after, story)} now; "
                "nobody asked for that."
            )
            found.append(Cause(Code.EXTRA_GOAL, step, text, None, taken))
    if not found and story.result.violations:
        text = f"{'; '.join(story.result.violations)}."
        found.append(Cause(Code.UNSOUND_PLACE, story.last, text))
    return found
