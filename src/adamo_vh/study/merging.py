"""Parts of one study put together: what several machines have played, as if one had."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from adamo_vh.analysis.outcome import Outcome
from adamo_vh.errors import ConfigError, RecordError
from adamo_vh.record.run_folder import FolderLock
from adamo_vh.record.signing import Signer
from adamo_vh.study.plan import Planned, Study
from adamo_vh.study.publishing import copy_whole
from adamo_vh.study.store import Store, episode_folder, gathered, read_outcomes, read_planned


def merge(out: Path, parts: Sequence[Path], signer: Signer | None = None) -> tuple[int, int]:
    """Copy the episodes of several folders into one; the parts stay as they are.

    An episode appears in the folder whole or not at all, and one that is there already is not
    touched, so that an interrupted merge is simply given again.

    Args:
        out: The folder of the whole; may be one of the same study already.
        parts: Folders of studies of which one has all episodes of the others.
        signer: Signs what is added to the whole.

    Returns:
        How many episodes were copied, and how many of the study have a score now.

    Raises:
        RecordError: The parts are of different studies, or came to different ends.
        FolderInUseError: One of them is being played now.
        FileError: The folder cannot be written.
    """
    if out.resolve() in [part.resolve() for part in parts]:
        raise ConfigError(f"{out} is one of the parts; name another folder for the whole.")
    plans = [read_planned(part) for part in parts]
    study, episodes = max(plans, key=lambda found: len(found[1]))
    _check_same(parts, plans, episodes)
    with ExitStack() as stack:
        for part in parts:
            stack.enter_context(FolderLock(part))
        store = stack.enter_context(Store(out, study, episodes, signer))
        copied = 0
        for part in parts:
            for outcome in read_outcomes(part)[0]:
                copied += _taken(store, part, outcome)
        found, _ = gathered(out, {}, episodes)
        return copied, sum(outcome.is_scored for outcome in found.values())


def _check_same(
    parts: Sequence[Path],
    plans: Sequence[tuple[Study, tuple[Planned, ...]]],
    episodes: Sequence[Planned],
) -> None:
    whole = {one.key: one for one in episodes}
    for part, (_, its) in zip(parts, plans, strict=True):
        if any(whole.get(one.key) != one for one in its):
            raise RecordError(
                f"{part} holds another study than the largest of the parts; merge parts of one "
                "study, and show several side by side: adamo-vh report RUN RUN"
            )


def _taken(store: Store, part: Path, outcome: Outcome) -> bool:
    """Copy an episode, unless the whole has it, or a better one, already."""
    mine = store.outcomes.get(outcome.key)
    if mine is not None and mine.is_scored:
        if outcome.is_scored and _end(mine) != _end(outcome):
            raise RecordError(
                f"{outcome.key} has come to different ends in {store.folder} and {part}: played "
                "twice? Take it out of one of them, and merge again."
            )
        return False
    if mine is not None and not outcome.is_scored:
        return False
    copy_whole(episode_folder(part, outcome.key), episode_folder(store.folder, outcome.key))
    store.add(outcome)
    return True


def _end(outcome: Outcome) -> tuple[object, ...]:
    return outcome.completion, outcome.strict, outcome.state_hash, outcome.model_calls
