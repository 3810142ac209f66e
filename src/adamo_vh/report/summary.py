"""What a page says of an episode as a whole: how it ended, and what the model took."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from adamo_vh.episode.result import EpisodeResult, Manifest, total_cost
from adamo_vh.inference.model import Ending, ModelKind, Reply, Usage
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import Ended, Trajectory

_ENDINGS = {
    TerminationReason.ANSWERED: ("ended", "Answered", "The model ended the episode."),
    TerminationReason.EMPTY_REPLY: (
        "truncated",
        "Empty reply",
        "The model said nothing, also after a reminder.",
    ),
    TerminationReason.PROTOCOL: (
        "truncated",
        "Unreadable",
        "{limits.max_unreadable} replies in a row were neither a call nor an answer.",
    ),
    TerminationReason.LOOP: (
        "truncated",
        "Loop",
        "Stopped: {limits.max_repeats} times the same call into the same state, or no call.",
    ),
    TerminationReason.STOPPED: (
        "truncated",
        "Stopped",
        "A person stopped it.",
    ),
    TerminationReason.BUDGET: (
        "truncated",
        "Budget",
        "Stopped: the budget of the episode is used up.",
    ),
    TerminationReason.STEP_LIMIT: (
        "truncated",
        "Step limit",
        "Stopped after {limits.max_steps} steps.",
    ),
    TerminationReason.TIME_LIMIT: (
        "truncated",
        "Time limit",
        "Stopped after {limits.max_seconds:g} s.",
    ),
    TerminationReason.RUN_BUDGET: (
        "broken",
        "Unscored",
        "The budget of the whole run was used up; the episode does not count.",
    ),
    TerminationReason.BROKEN: (
        "broken",
        "Unscored",
        "The episode broke through a fault that is not the model's; it does not count.",
    ),
}
KINDS = {
    ModelKind.VLM: "vision-language model",
    ModelKind.RULE_BASED: "rule-based player, no VLM",
    ModelKind.RANDOM: "random player, no VLM",
    ModelKind.SCRIPTED: "scripted player, no VLM",
    ModelKind.REPLAY: "recorded answers, no live model",
    ModelKind.HUMAN: "a person, no VLM",
    ModelKind.OUTSIDE: "a program from outside, which may be no VLM",
}
"""What kind of player a model is, so that nobody takes one for another."""
FAILURES = {
    Ending.CUT_OFF: "cut off",
    Ending.UNPARSED_CALL: "unparsed call",
    Ending.EMPTY: "empty",
    Ending.FILTERED: "filtered",
}
"""Replies that are neither a call nor an answer."""


def verdict(
    manifest: Manifest, ended: Ended | None, result: EpisodeResult | None
) -> tuple[str, str, str]:
    """How the episode ended: a tone for the colour, a headline and a sentence."""
    if ended is None:
        return (
            "unfinished",
            "Not finished",
            "The record has no end: the run was stopped, or it is still going on.",
        )
    if result is None and manifest.config.task and ended.reason.is_scored:
        return "unfinished", "Not scored", "The episode ended, but its result cannot be read."
    return ending(manifest.config.limits, ended)


def ending(limits: Limits, ended: Ended) -> tuple[str, str, str]:
    """How one instruction ended: a tone for the colour, a headline and a sentence."""
    tone, headline, sentence = _ENDINGS[ended.reason]
    told = sentence.format(limits=limits)
    if not ended.why:
        return tone, headline, told
    return tone, headline, f"{told} {ended.why}" if tone == "broken" else ended.why


@dataclass(frozen=True, slots=True)
class Account:
    """What the episode took; from the result where there is one, so that lost events cost none."""

    steps: int
    calls: Mapping[str, int]
    """Executed or refused tool calls by kind."""
    model_calls: int
    requests: int
    usage: Usage
    estimated: str
    """"estimated" if no provider counted the tokens, "partly estimated", or empty."""
    cost_usd: float | None
    """None if the price of any answer is unknown: an unknown price is not 0."""
    rungs: tuple[str, ...]
    """How calls were asked for."""
    unreadable: int
    """Protocol failures."""
    failures: Mapping[str, int]
    """The same by what was wrong."""
    model_s: float
    world_s: float

    @classmethod
    def of(cls, trajectory: Trajectory, result: EpisodeResult | None) -> Account:
        """Count."""
        thoughts, acts = trajectory.thoughts, trajectory.acts
        replies = [thought.reply for thought in thoughts]
        failures = Counter(FAILURES[r.ending] for r in replies if r.ending.is_failure)
        if result is not None:
            return cls(
                result.steps,
                result.calls,
                result.model_calls,
                result.requests,
                result.usage,
                _estimated(replies) or ("estimated" if result.usage.estimated else ""),
                result.cost_usd,
                result.rungs,
                failures.total() or result.unreadable,
                failures,
                result.model_s,
                result.world_s,
            )
        return cls(
            len(acts),
            dict(sorted(Counter(act.name for act in acts).items())),
            len(thoughts),
            sum(reply.requests for reply in replies),
            sum((reply.usage for reply in replies), Usage()),
            _estimated(replies),
            total_cost([thought.reply for thought in thoughts]),
            tuple(sorted({reply.rung.value for reply in replies if reply.rung})),
            failures.total(),
            failures,
            sum(reply.seconds for reply in replies),
            sum(act.world_s for act in acts),
        )


def _estimated(replies: Sequence[Reply]) -> str:
    guesses = [reply.usage.estimated for reply in replies]
    return "" if not any(guesses) else "estimated" if all(guesses) else "partly estimated"
