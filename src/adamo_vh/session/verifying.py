"""Whether a recorded episode is what its result says: by digest, by signature and by replay."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, fields, replace
from pathlib import Path

from adamo_vh.action_server import Tool
from adamo_vh.engine import World
from adamo_vh.episode.replay import replay
from adamo_vh.episode.result import (
    EpisodeResult,
    Manifest,
    read_manifest,
    read_result,
    summarise,
)
from adamo_vh.episode.sealing import RUN, read_plain
from adamo_vh.errors import AdamoError, RecordError
from adamo_vh.perception import Tagger
from adamo_vh.record.digest import Seal, differences
from adamo_vh.record.run_folder import EVENTS, MANIFEST, RESULT
from adamo_vh.record.signing import fingerprint, is_signed
from adamo_vh.record.trajectory import (
    Acted,
    Happened,
    Restored,
    Started,
    Trajectory,
    read_trajectory,
)
from adamo_vh.session.bodies import check_handed, open_server, opened


@dataclass(frozen=True, slots=True)
class Verified:
    """What came of checking one run."""

    run: str
    """The run folder."""
    digest: str
    """What its result is sealed with; empty if it has no seal, as older ones."""
    signed_by: str
    """Fingerprint of the public key whose signature was found good; empty if there is none."""
    steps: int | None
    """How many steps were executed again; None if that was not asked for, or cannot be done."""
    frames_differ: int
    """Pictures that came out with other bytes: possible on another machine, no fault there."""
    problems: tuple[str, ...]
    """What is wrong, one line each; nothing, if all that was checked is well."""


def verify_run(
    folder: str | Path,
    *,
    key: str = "",
    replayed: bool = True,
    engine: World | None = None,
    tools: Sequence[Tool] | None = None,
    labeling: Tagger | None = None,
) -> Verified:
    """Check a run: its seal, its signature, its score, and every state by replay.

    Args:
        folder: A run folder.
        key: Public key that must have signed it (see `adamo_vh.record.signing`); any, or none, by
            default.
        replayed: Execute the episode again.
        engine: As when it was recorded; made from the record by default.
        tools: As when it was recorded, if they were handed in.
        labeling: As when it was recorded, if it was handed in.

    Raises:
        RecordError: The folder holds no run.
        ConfigError: There is a signature, and the extra `sign` is missing.
    """
    path = Path(folder)
    if not any((path / name).exists() for name in (MANIFEST, EVENTS, RESULT)):
        raise RecordError(f"{path} is neither a run folder nor the folder of a study.")
    problems: list[str] = []
    try:
        manifest, recorded = read_manifest(path), read_trajectory(path)
        result = read_result(path)
        seal = None if result is None else result.seal
        if result is None:
            problems.append(f"{RESULT} is missing: the episode has not ended, or it was removed")
        else:
            if seal is not None:
                problems.extend(differences(path, recorded, read_plain(path), seal))
            problems.extend(_unfounded(path, manifest, recorded, result))
    except AdamoError as error:
        return Verified(str(path), "", "", None, 0, (str(error),))
    signed_by = _signed_by(seal, key, problems)
    steps, differ = None, 0
    if replayed:
        try:
            with ExitStack() as stack:
                check_handed(path, manifest, recorded, tools, labeling)
                world = opened(stack, manifest.config, engine, (path, manifest))
                problems.extend(_other_start(manifest, recorded, world))
                server = open_server(manifest.config, world, tools, labeling)
                report = replay(server, world, recorded)
            steps, differ = report.steps, report.frames_differ
            problems.extend(report.mismatches)
        except AdamoError as error:
            problems.append(f"it cannot be executed again: {error}")
    digest = "" if seal is None else seal.digest
    return Verified(str(path), digest, signed_by, steps, differ, tuple(problems))


def _signed_by(seal: Seal | None, key: str, problems: list[str]) -> str:
    """Who signed; adds to the problems if somebody should have, or the signature is wrong."""
    signature = None if seal is None else seal.signature
    if seal is None or signature is None:
        if key:
            problems.append(f"it is not signed, by {fingerprint(key)} or anybody")
        return ""
    if not is_signed(RUN, seal.digest, signature):
        problems.append("the signature is not that of its key over this digest")
        return ""
    if key and signature.key != key:
        problems.append(
            f"it is signed by another key: {fingerprint(signature.key)}, not {fingerprint(key)}"
        )
    return fingerprint(signature.key)


def _unfounded(
    folder: Path, manifest: Manifest, recorded: Trajectory, result: EpisodeResult
) -> Iterator[str]:
    """What the result says otherwise than the record gives by today's rules."""
    leads = Started | Acted | Happened | Restored
    states = [event.state_hash for event in recorded.events if isinstance(event, leads)]
    if states and result.state_hash != states[-1]:
        yield f"{RESULT}: the last state is not that of the last step in {EVENTS}"
    if result.final.hash() != result.state_hash:
        yield f"{RESULT}: the world at the end is not in the state that the last step led to"
    if recorded.ended is None:
        yield f"{EVENTS} has no end, and {RESULT} tells of one"
        return
    again = summarise(manifest, recorded, result.final, folder)
    again = replace(again, run=result.run, seal=result.seal)
    for field in fields(EpisodeResult):
        told, found = getattr(result, field.name), getattr(again, field.name)
        if told != found:
            what = "" if field.name != "score" else f" (adamo-vh score {folder} --diff says more)"
            yield f"{RESULT}: {field.name} is not what the record gives{what}"


def _other_start(manifest: Manifest, recorded: Trajectory, world: World) -> Iterator[str]:
    """Whether the episode began in another state than its scene does."""
    now, told = world.state().hash(), manifest.initial.hash()
    if now != told:
        yield f"step 0: the scene begins in state {now[:12]}, and {MANIFEST} says {told[:12]}"
    began = next((e for e in recorded.events if isinstance(e, Started)), None)
    if began is not None and began.state_hash != told:
        yield (
            f"step 0: {EVENTS} begins in state {began.state_hash[:12]}, and {MANIFEST} says "
            f"{told[:12]}"
        )
