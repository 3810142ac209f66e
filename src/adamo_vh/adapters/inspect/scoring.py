"""The score of an episode in Inspect's words: two numbers, or unscored, which is not zero."""

from __future__ import annotations

from typing import TYPE_CHECKING

from adamo_vh.episode.result import EpisodeResult

if TYPE_CHECKING:
    from inspect_ai.scorer import Score


def score_of(result: EpisodeResult | None) -> Score:
    """What an episode is worth.

    Args:
        result: What came of it; None if it did not get that far.
    """
    from inspect_ai.scorer import Score

    if result is None:
        return Score.unscored(reason="unfinished", explanation="The record stops before its end.")
    ending = f"Ended: {result.termination}" + (f" ({result.why})" if result.why else "")
    if result.score is None:
        why = "no task" if result.task is None else str(result.termination)
        return Score.unscored(reason=why, answer=result.answer, explanation=ending)
    score = result.score
    conditions = [f"{'met' if c.satisfied else 'open'}: {c.text}" for c in score.conditions]
    return Score(
        value={"completion": score.completion, "strict": score.strict},
        answer=result.answer,
        explanation="\n".join([*conditions, *score.violations, ending]),
        metadata={"steps": result.steps, "walked_m": result.walked_m},
    )
