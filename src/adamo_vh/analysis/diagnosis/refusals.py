"""What a refused call says of who made it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from adamo_vh import action
from adamo_vh.action import Outcome
from adamo_vh.analysis.diagnosis.cause import Cause
from adamo_vh.analysis.diagnosis.finding import Code
from adamo_vh.analysis.diagnosis.story import PICK, Story, call_text
from adamo_vh.record.trajectory import Acted

_CODES = {
    action.Code.UNKNOWN_TOOL: Code.UNKNOWN_TOOL,
    action.Code.BAD_ARGUMENT: Code.BAD_ARGUMENTS,
    action.Code.UNKNOWN_TAG: Code.UNKNOWN_TAG,
    action.Code.HAND_FULL: Code.WRONG_ORDER,
    action.Code.HAND_EMPTY: Code.WRONG_ORDER,
    action.Code.NOT_HELD: Code.WRONG_ORDER,
}
"""What is more than a refusal: no valid call, no such thing, not now."""
_WINDOW = 6
_MOST = 2 / 3


def is_refused(act: Acted) -> bool:
    """Whether nothing was changed by a call."""
    return act.feedback.outcome is Outcome.REFUSED


def refusal(story: Story, act: Acted, object_id: int | None) -> Cause:
    """What a refused call says.

    Args:
        story: Of the episode.
        act: The call.
        object_id: What was asked for, if the call may have been meant for that.
    """
    text = f"Step {act.step}, {call_text(act)}, was refused: {_why(act)}"
    meant = story.meant(act) if act.name == PICK else None
    if act.feedback.code == action.Code.NOT_SEEN and meant is not None:
        if meant not in story.task.objects:
            return Cause(Code.WRONG_OBJECT, act.step, text, object_id, meant)
        if not story.listed(meant):
            return Cause(Code.NEVER_FOUND, act.step, text, meant)
    code = _CODES.get(action.Code(act.feedback.code)) if _is_ours(act) else None
    return Cause(code or Code.REFUSED, act.step, text, object_id)


def streak(story: Story, acts: Sequence[Acted] | None = None) -> Acted | None:
    """The call that most of the last calls were like, if most of them were refused.

    Returns:
        The first one of its kind among them; None if most were carried out.
    """
    last = (story.acts if acts is None else list(acts))[-_WINDOW:]
    refused = [act for act in last if is_refused(act)]
    if not refused or len(refused) < _MOST * len(last):
        return None
    codes = Counter(act.feedback.code for act in refused)
    code = max(sorted(codes), key=lambda name: codes[name])
    return next(act for act in refused if act.feedback.code == code)


def _is_ours(act: Acted) -> bool:
    return act.feedback.code in set(action.Code)


def _why(act: Acted) -> str:
    return act.feedback.text.partition(": ")[2] or act.feedback.text
