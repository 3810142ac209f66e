"""What the end of an episode says of a condition for whose object nothing was done."""

from __future__ import annotations

import json
import re
from collections import Counter

from adamo_vh.analysis.claims import claims_success
from adamo_vh.analysis.diagnosis.cause import Cause
from adamo_vh.analysis.diagnosis.finding import Code
from adamo_vh.analysis.diagnosis.refusals import is_refused, refusal, streak
from adamo_vh.analysis.diagnosis.story import (
    DROP,
    PICK,
    WALK,
    Moment,
    Story,
    call_text,
    quoted,
)
from adamo_vh.benchmark.taxonomy import Ref
from adamo_vh.inference.model import Ending
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Acted

_FAILED = {
    Ending.EMPTY: Code.EMPTY,
    Ending.CUT_OFF: Code.CUT_OFF,
    Ending.FILTERED: Code.FILTERED,
}
_HALF = 0.5
_REPEATS = 3
"""The same call into the same state so often is a loop."""
_SEARCH = 2
"""So many views elsewhere are a search; one is not."""
_AT_M = 0.3
"""A gaze that ends this close to an object is at it."""
_LATE = 3
"""Progress within the last part of the steps, one of so many, means that it was on its way."""
_SOON = 6
"""So does progress within so many last steps."""


def protocol_cause(story: Story) -> Cause | None:
    """Whether it ended, or was spent, on replies that are no calls."""
    failures = [t.reply.ending for t in story.thoughts if t.reply.ending.is_failure]
    reason = story.ended.reason
    ended_so = reason in (TerminationReason.PROTOCOL, TerminationReason.EMPTY_REPLY)
    if not ended_so and (len(failures) <= _HALF * len(story.thoughts) or _said_the_end(story)):
        return _without_calls(story)
    kind = Counter(failures).most_common(1)[0][0] if failures else Ending.EMPTY
    code = Code.EMPTY if reason is TerminationReason.EMPTY_REPLY else _FAILED.get(kind)
    text = (
        f"{len(failures) or 1} of {len(story.thoughts)} replies were neither a call nor an answer "
        f"({kind.replace('_', ' ')})."
    )
    return Cause(code or Code.UNREADABLE, story.last, text)


def _said_the_end(story: Story) -> bool:
    return story.ended.reason is TerminationReason.ANSWERED


def _without_calls(story: Story) -> Cause | None:
    """Whether no call was ever made, and what was said is no claim and no admission."""
    if story.acts:
        return None
    answer = story.ended.answer
    said = claims_success(story.manifest.config.instruction, answer)
    if _said_the_end(story) and (said is not None or _gives_up(answer)):
        return None
    text = f"No call was made; the agent only wrote text: “{quoted(answer)}”"
    return Cause(Code.NO_CALL, 0, text)


def _gives_up(answer: str) -> bool:
    return bool(re.search(r"\b(?:stop|end|quit|finish|leave it|enough)\b", answer, re.IGNORECASE))


def loop_of(story: Story) -> Cause | None:
    """The call that was carried out again and again to the same state."""
    counted: Counter[tuple[str, str]] = Counter()
    first: dict[tuple[str, str], Acted] = {}
    for act in story.acts:
        if not is_refused(act):
            call = json.dumps([act.name, act.arguments], sort_keys=True, default=str)
            first.setdefault((call, act.state_hash), act)
            counted[call, act.state_hash] += 1
    if not counted or story.ended.reason is TerminationReason.ANSWERED:
        return None
    most, count = counted.most_common(1)[0]
    if count < _REPEATS:
        return None
    act = first[most]
    text = f"{call_text(act)} was carried out {count} times, each time to the same state."
    return Cause(Code.LOOP, act.step, text)


def loop_moves(story: Story, loop: Cause) -> bool:
    """Whether what was repeated took or put something."""
    return any(act.step == loop.step and act.name in (PICK, DROP) for act in story.acts)


def untouched(story: Story, object_id: int, number: int) -> Cause:
    """Why nothing was done for a condition.

    Args:
        story: Of the episode.
        object_id: What it is about.
        number: Of the condition in the task.
    """
    last = streak(story)
    if story.ended.reason is not TerminationReason.ANSWERED:
        if last is not None:
            return refusal(story, last, object_id)
        return loop_of(story) or _at_a_limit(story, object_id)
    if last is not None and is_refused(story.acts[-1]):
        return refusal(story, last, object_id)
    return _ended_early(story, object_id, number)


def _at_a_limit(story: Story, object_id: int) -> Cause:
    name, limit = story.name(object_id), story.ended.reason.replace("_", " ")
    if not story.listed(object_id):
        text = f"{name} was never found before the {limit}."
        return Cause(Code.NEVER_FOUND, story.last, text, object_id)
    if not story.is_told_by_tag(object_id) and _views_since(story, object_id) >= _SEARCH:
        text = f"{name} was in view, and the agent went on searching until the {limit}."
        return Cause(Code.NOT_RECOGNISED, story.last, text, object_id)
    return stopped_by_limit(story, object_id)


def stopped_by_limit(story: Story, object_id: int) -> Cause:
    """Cut short on its way, or without getting anywhere."""
    limit, last = story.ended.reason.replace("_", " "), story.last
    pairs = zip(story.moments, story.moments[1:], strict=False)
    closer = [after.step for before, after in pairs if after.left < before.left]
    if closer and last - closer[-1] <= max(_SOON, last // _LATE):
        text = f"The {limit} came while it was still getting closer, last in step {closer[-1]}."
        return Cause(Code.RAN_OUT, last, text, object_id)
    since = closer[-1] if closer else 0
    text = f"From step {since} to the {limit} at step {last} it came no closer to done."
    return Cause(Code.NO_PROGRESS, since + 1, text, object_id)


def _ended_early(story: Story, object_id: int, number: int) -> Cause:
    name, answer, last = story.name(object_id), story.ended.answer, story.last
    claims = claims_success(story.manifest.config.instruction, answer) is True
    views = _views_since(story, object_id)
    if not story.listed(object_id) and (views or not claims):
        text = f"The agent ended without ever having seen {name}."
        return Cause(Code.NEVER_FOUND, last, text, object_id)
    is_looked_for = _is_passed_over(story) or (views >= _SEARCH and not claims)
    if story.listed(object_id) and not story.is_told_by_tag(object_id) and is_looked_for:
        text = f"{name} was in view, and the agent ended without taking it for what was asked."
        return Cause(Code.NOT_RECOGNISED, last, text, object_id)
    if _is_forgotten(story, object_id, number):
        text = f"The agent did the rest and ended; it never named {name} nor did anything for it."
        return Cause(Code.GOAL_FORGOTTEN, last, text, object_id)
    return ended_by_agent(story, object_id)


def ended_by_agent(story: Story, object_id: int) -> Cause:
    """Ended too early, with or without a claim."""
    answer, last = story.ended.answer, story.last
    claims = claims_success(story.manifest.config.instruction, answer) is True
    what = "and said that all was done" if claims else "and did not say that all was done"
    left = story.moments[-1].left
    text = (
        f"The agent ended after step {last}, when at least {left} more "
        f"{'call was' if left == 1 else 'calls were'} needed, {what}: “{quoted(answer)}”"
    )
    return Cause(Code.FALSE_CLAIM if claims else Code.GAVE_UP, last, text, object_id)


def _views_since(story: Story, object_id: int) -> int:
    """How many views of other places the agent got, after all that it did with its hand.

    What it did before the object was in view does not count: then there was reason to look. Nor
    does a look at the object itself, nor a walk that showed nothing new.
    """
    since = max(
        [m.step for m in story.moments if m.is_done and m.act and m.act.name in (PICK, DROP)],
        default=0,
    )
    seen = [m.step for m in story.moments if object_id in m.seen]
    since = max(since, seen[0] if seen else 0)
    shown = {view.step for view in story.views}
    later = (m for m in story.moments if m.step > since and m.is_done and m.step in shown)
    return sum(not _at(m, object_id) for m in later)


def _at(moment: Moment, object_id: int) -> bool:
    """Whether an act was a look at an object."""
    item, act = moment.object(object_id), moment.act
    is_look = act is not None and act.name not in (WALK, PICK, DROP)
    gaze = moment.state.body.gaze
    return is_look and item is not None and gaze.distance(item.box.center) <= _AT_M


def _is_passed_over(story: Story) -> bool:
    """Whether it is one of a group that the instruction describes, of which most were found."""
    conditions = story.result.conditions
    met = sum(condition.satisfied for condition in conditions)
    return Ref.GROUP_SIMPLE in story.task.units and met >= _HALF * len(conditions)


def _is_forgotten(story: Story, object_id: int, number: int) -> bool:
    """Whether all else was done, or something later, without a word about this one."""
    conditions = story.result.conditions
    met = [condition.satisfied for condition in conditions]
    rest = any(met[number + 1 :]) or (sum(met) == len(met) - 1 and len(met) > 1)
    is_free = story.final.body.held is None
    return rest and is_free and not story.names_object(story.said(), object_id)
