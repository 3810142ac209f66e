"""From the records of an episode to its diagnosis."""

from __future__ import annotations

from collections.abc import Iterator

from adamo_vh.analysis.diagnosis.cause import Cause
from adamo_vh.analysis.diagnosis.finding import Code, Diagnosis, Evidence, FailureClass
from adamo_vh.analysis.diagnosis.goals import causes, strict_causes
from adamo_vh.analysis.diagnosis.likeness import shared
from adamo_vh.analysis.diagnosis.refusals import is_refused
from adamo_vh.analysis.diagnosis.sight import sight_of
from adamo_vh.analysis.diagnosis.story import Story, call_text, quoted, several, story_of
from adamo_vh.benchmark.tasks import Task
from adamo_vh.engine import World
from adamo_vh.episode.result import EpisodeResult, Manifest
from adamo_vh.perception import Tagger
from adamo_vh.record.trajectory import Trajectory

_MIXED_UP = (Code.WRONG_OBJECT, Code.WRONG_ANCHOR)
_MOST_REFUSALS = 3


def diagnose(
    manifest: Manifest,
    trajectory: Trajectory,
    result: EpisodeResult | None,
    world: World,
    *,
    task: Task | None = None,
    labeling: Tagger | None = None,
) -> Diagnosis:
    """Say why an episode failed: from its records and the states in them.

    The same records give the same diagnosis. Nothing is played again: the saved states are put
    back into the world one after another and read.

    Args:
        manifest: How the episode was set up.
        trajectory: What happened.
        result: What came of it; None if it did not get that far.
        world: Of the same scene and variation; is left in another state.
        task: What was asked, in place of what the record says.
        labeling: Makes and reads the tags, if it was handed in.

    Returns:
        The diagnosis; without a class if nothing failed or nothing was scored, which its summary
        says.

    Raises:
        EngineError: A saved state is damaged, or of another scene.
        ConfigError: There is no such task.
    """
    if (nothing := _nothing_to_say(manifest, result)) is not None:
        return nothing
    assert result is not None
    asked = task or manifest.config.scored_task
    assert asked is not None
    story = story_of(manifest, trajectory, result, world, asked, labeling)
    if story is None:
        return Diagnosis(None, None, "The record has no first view or no end: nothing can be told.")
    found = causes(story) or strict_causes(story)
    if not found:
        return Diagnosis(None, None, _success(result), (), _distance(story))
    first = min(found, key=lambda cause: cause.step)
    return Diagnosis(
        first.code.failure_class,
        first.code,
        _summary(story, first),
        tuple(_evidence(story, first, found)),
        _distance(story),
        _left_path(story),
    )


def _nothing_to_say(manifest: Manifest, result: EpisodeResult | None) -> Diagnosis | None:
    """The answer for an episode that did not fail, or about which nothing is known."""
    if result is None:
        return Diagnosis(None, None, "The episode has not ended, so there is nothing to explain.")
    if not result.termination.is_scored:
        return Diagnosis(
            None,
            None,
            "The episode is unscored: it broke through a fault that is not the agent's "
            f"({quoted(result.answer or result.termination)}).",
        )
    if manifest.config.task is None or result.score is None:
        return Diagnosis(
            None,
            None,
            "No task was set, so nobody can say whether the instruction was carried out.",
        )
    return None


def _success(result: EpisodeResult) -> str:
    count = len(result.conditions)
    all_of = "The condition holds" if count == 1 else f"All {count} conditions hold"
    return f"Nothing failed. {all_of}, and nothing else was moved."


def _distance(story: Story) -> tuple[int, ...]:
    return tuple(moment.left for moment in story.moments)


def _left_path(story: Story) -> int | None:
    """The first step after which more was left to do than before it."""
    pairs = zip(story.moments, story.moments[1:], strict=False)
    return next((after.step for before, after in pairs if after.left > before.left), None)


def _summary(story: Story, cause: Cause) -> str:
    """What was asked, what came of it, what went wrong: as a person would tell it."""
    results = story.result.conditions
    met = sum(condition.satisfied for condition in results)
    came = (
        f"{met} of {len(results)} conditions hold at the end"
        if len(results) > 1
        else ("it is so at the end" if met else "it is not so at the end")
    )
    steps = f"{story.last} {'step' if story.last == 1 else 'steps'}"
    asked = story.manifest.config.instruction.rstrip(".")
    return f"Asked: {asked}. After {steps} {came}. {cause.text}"


def _evidence(story: Story, first: Cause, found: list[Cause]) -> Iterator[Evidence]:
    yield Evidence(first.step, first.text)
    if first.object is not None:
        yield sight_of(story, first.object)
    if first.other is not None:
        yield sight_of(story, first.other)
    if first.code in _MIXED_UP and first.object is not None and first.other is not None:
        alike = shared(story, first.object, first.other)
        both = several([story.name(first.object), story.name(first.other)])
        text = f"{both} share {several(alike)}." if alike else f"{both} share no plain attribute."
        yield Evidence(first.step, text)
    yield from _path(story)
    yield from _refusals(story)
    for cause in found:
        if cause is not first and cause.text != first.text:
            yield Evidence(cause.step, f"Besides: {cause.text}")
    if first.code.failure_class is not FailureClass.PROTOCOL:
        said = quoted(story.ended.answer)
        how = story.ended.why or story.ended.reason.replace("_", " ")
        text = f"The agent ended it: “{said}”" if said else f"What ended it: {how.rstrip('.')}."
        yield Evidence(story.last, text)


def _path(story: Story) -> Iterator[Evidence]:
    """Where the calls left the oracle's path."""
    step = _left_path(story)
    if step is None:
        return
    number = next(i for i, moment in enumerate(story.moments) if moment.step == step)
    before, after = story.moments[number - 1], story.moments[number]
    assert after.act is not None
    text = (
        f"{call_text(after.act)} left the shortest way: {before.left} calls were left before it, "
        f"{after.left} after it."
    )
    yield Evidence(step, text)


def _refusals(story: Story) -> Iterator[Evidence]:
    refused = [act for act in story.acts if is_refused(act)]
    for act in refused[:_MOST_REFUSALS]:
        yield Evidence(act.step, f"{call_text(act)}: {act.feedback.text}")
    if len(refused) > _MOST_REFUSALS:
        rest = refused[_MOST_REFUSALS:]
        text = f"{len(rest)} more {'call was' if len(rest) == 1 else 'calls were'} refused."
        yield Evidence(rest[0].step, text)
