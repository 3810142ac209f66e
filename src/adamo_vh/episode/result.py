"""One episode as data: how it was set up, what came of it, and the files that keep both."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from adamo_vh.benchmark.checkers import ConditionResult, Score, score
from adamo_vh.engine import WorldState, supporting_object
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import FileError, RecordError
from adamo_vh.files import read_text, write_whole
from adamo_vh.geometry import Vec3
from adamo_vh.inference.model import UNSAFE, Isolation, ModelKind, Reply, Spent, Usage
from adamo_vh.inference.remote.capabilities import Capabilities
from adamo_vh.perception import Labeling
from adamo_vh.record.digest import Seal
from adamo_vh.record.old_format import OLD_FORMAT, upgraded_result
from adamo_vh.record.run_folder import FORMAT, MANIFEST, RESULT, check_begun, read_head
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Trajectory
from adamo_vh.record.witness import states_between

_MOST_BYTES = 50_000_000
_T = TypeVar("_T")


@dataclass(frozen=True, slots=True)
class Manifest:
    """Written when an episode begins."""

    config: EpisodeConfig
    model_name: str
    model_kind: ModelKind
    versions: Mapping[str, str]
    started_at: str
    """ISO 8601, UTC."""
    initial: WorldState
    capabilities: Capabilities | None = None
    """What the probe of a remote model found; None if none was made."""
    engine: str = ""
    """Class of the engine, if it was handed in and no scene's name brings it back."""
    engine_lacks: tuple[str, ...] = ()
    """What the engine cannot do that others can; see `adamo_vh.abilities`."""
    labeling: str = ""
    """Class of the labeling, if it was handed in; `config.labeling` plays no part then."""
    format: int = FORMAT
    isolation: Isolation = ""
    """How far a program that decides is kept from all but its body; see `ModelInfo.isolation`."""
    figure_sha256: str = ""
    """Digest of the file of an own figure, whose copy lies in the run folder."""

    @property
    def is_ranked(self) -> bool:
        """Whether it may be compared with others; see `EpisodeResult.is_ranked`."""
        return self.isolation not in UNSAFE


@dataclass(frozen=True, slots=True)
class FinalObject:
    """Where an object was at the end."""

    id: int
    tag: str
    class_name: str
    position: Vec3
    support: str | None
    held: bool


@dataclass(frozen=True, slots=True)
class EpisodeResult:
    """What came of an episode."""

    task: str | None
    instruction: str
    scene: str
    labeling: Labeling
    profile: str
    """Name of the profile, and the switches that differ from it."""
    model: str
    model_kind: ModelKind
    seed: int
    score: Score | None
    """None without a task, or if the episode broke."""
    termination: TerminationReason
    why: str
    """Why it was stopped, in words, where there is more to say than the reason."""
    answer: str
    steps: int
    """Tool calls that were executed or refused."""
    model_calls: int
    calls: Mapping[str, int]
    """Executed or refused tool calls by kind."""
    missing_notes: int
    """Tool calls without a reasoning note."""
    unreadable: int
    """Protocol failures: replies that were neither a valid call nor an answer."""
    requests: int
    """Requests to the provider, repairs and failed tries included."""
    usage: Usage
    """Tokens of all model calls."""
    cost_usd: float | None
    """What the model calls cost; None if the price of any is unknown."""
    rungs: tuple[str, ...]
    """How the model was asked for its calls; empty without a wire."""
    model_s: float
    world_s: float
    walked_m: float
    """Metres walked."""
    direct_m: float
    """The same from place to place in straight lines: no way could be shorter."""
    run: str | None
    """The run folder."""
    state_hash: str
    final: WorldState
    warnings: tuple[str, ...] = ()
    """What people should know of the replies; see `Reply.warning`."""
    own_labeling: str = ""
    """Class of the labeling, if it was handed in; `labeling` plays no part then."""
    assisted: bool = False
    """Whether a person took part other than by what was said; see `Trajectory.assisted`."""
    isolation: Isolation = ""
    """How far a program that decided was kept from all but its body; empty if a model was asked."""
    seal: Seal | None = None
    """Digests of the files that this rests on, once it is written; older results have none."""

    @property
    def variation(self) -> int:
        """Which variation of the scene it was in; 0 is the scene as it stands."""
        return self.final.scene.variation

    @property
    def completion(self) -> float | None:
        """Fraction of satisfied conditions; None if there is no score."""
        return None if self.score is None else self.score.completion

    @property
    def strict(self) -> float | None:
        """1 or 0; None if there is no score."""
        return None if self.score is None else self.score.strict

    @property
    def conditions(self) -> tuple[ConditionResult, ...]:
        """Each condition of the task, and whether it holds; none without a score."""
        return () if self.score is None else self.score.conditions

    @property
    def violations(self) -> tuple[str, ...]:
        """What speaks against a strict success; none without a score."""
        return () if self.score is None else self.score.violations

    @property
    def is_ranked(self) -> bool:
        """Whether it may be compared with others.

        Not if the player may have seen the answers, nor if a person helped.
        """
        return self.isolation not in UNSAFE and not self.assisted

    @property
    def tokens(self) -> int:
        """Input plus output of all model calls."""
        return self.usage.total_tokens

    def world(self) -> tuple[FinalObject, ...]:
        """Every object at the end, with the support called by its tag."""
        classes = {item.id: item.class_name for item in self.final.objects}

        def support_name(support: str | None) -> str | None:
            below = supporting_object(support) if support else None
            return support if below is None else Labeling.SEM.tag(below, classes[below])

        return tuple(
            FinalObject(
                item.id,
                self.labeling.tag(item.id, item.class_name),
                item.class_name,
                item.box.center.rounded(4),
                support_name(item.support),
                item.held,
            )
            for item in self.final.objects
        )


def summarise(
    manifest: Manifest,
    trajectory: Trajectory,
    final: WorldState,
    run: Path | None,
) -> EpisodeResult:
    """Score and count an episode that has ended: a pure function over its records.

    Args:
        manifest: How it was set up.
        trajectory: What happened.
        final: The world at its end.
        run: The run folder.

    Raises:
        RecordError: The trajectory has no end, or lacks states that the task asks for.
        ConfigError: There is no such task.
    """
    ended = trajectory.ended
    if ended is None:
        raise RecordError("The episode has not ended; it cannot be scored.")
    config = manifest.config
    scored = judged(manifest, trajectory, final) if ended.reason.is_scored else None
    thoughts = trajectory.thoughts
    replies = [thought.reply for thought in thoughts]
    answers: list[Reply | Spent] = [*replies, *trajectory.lost]
    kinds = Counter(act.name for act in trajectory.acts)
    stops = [manifest.initial.body.position, *(act.agent.position for act in trajectory.acts)]
    return EpisodeResult(
        task=config.task,
        instruction=config.instruction,
        scene=config.scene,
        labeling=config.labeling,
        profile=str(config.profile),
        model=manifest.model_name,
        model_kind=manifest.model_kind,
        seed=config.seed,
        score=scored,
        termination=ended.reason,
        why=ended.why,
        answer=ended.answer,
        steps=ended.steps,
        model_calls=len(replies),
        calls=dict(sorted(kinds.items())),
        missing_notes=sum(bool(t.turn.wishes) and not t.turn.note for t in thoughts),
        unreadable=sum(reply.ending.is_failure for reply in replies),
        requests=sum(took.requests for took in answers),
        usage=sum((took.usage for took in answers), Usage()),
        cost_usd=total_cost(answers),
        warnings=_warnings(replies),
        own_labeling=manifest.labeling,
        assisted=trajectory.assisted,
        isolation=manifest.isolation,
        rungs=tuple(sorted({str(reply.rung) for reply in replies if reply.rung is not None})),
        model_s=sum(reply.seconds for reply in replies),
        world_s=sum(act.world_s for act in trajectory.acts),
        walked_m=sum(act.feedback.walked_m for act in trajectory.acts),
        direct_m=sum(a.horizontal_distance(b) for a, b in pairwise(stops)),
        run=None if run is None else str(run),
        state_hash=trajectory.state_hash,
        final=final,
    )


def judged(manifest: Manifest, trajectory: Trajectory, final: WorldState) -> Score | None:
    """The score of an episode that has ended, by today's checkers; None without a task.

    Args:
        manifest: How it was set up, with its first state.
        trajectory: What happened, with the states between where the task asks for them.
        final: The world at its end.

    Raises:
        RecordError: The record lacks states that the task asks for.
        ConfigError: There is no such task.
    """
    task = manifest.config.scored_task
    if task is None:
        return None
    between = states_between(trajectory, manifest.initial) if task.needs_history else ()
    return score(manifest.initial, final, task, between)


def total_cost(answers: Sequence[Reply | Spent]) -> float | None:
    """What all answers cost; None if any price is unknown, because that is not 0.

    Args:
        answers: The answers, and those that never came.
    """
    costs = [answer.cost_usd for answer in answers]
    known = [cost for cost in costs if cost is not None]
    return sum(known) if known and len(known) == len(costs) else None


@cache
def _codecs() -> Mapping[str, TypeAdapter[Any]]:
    """The codecs of records: they take longer to make than to use."""
    return {kind.__name__: TypeAdapter(kind) for kind in (Manifest, EpisodeResult)}


def _codec(kind: type[object]) -> TypeAdapter[Any]:
    return _codecs()[kind.__name__]


def to_json(record: Manifest | EpisodeResult) -> Any:
    """A record as plain JSON data."""
    return _codec(type(record)).dump_python(record, mode="json")


def record_json(record: Manifest | EpisodeResult) -> bytes:
    """A record as its file holds it."""
    return _codec(type(record)).dump_json(record, indent=1)


def write_record(
    folder: Path, name: str, record: Manifest | EpisodeResult, *, durable: bool = True
) -> None:
    """Write a record into a run folder, whole or not at all.

    Args:
        folder: The run folder.
        name: Of the file.
        record: What it holds.
        durable: See `write_whole`.
    """
    write_whole(folder / name, record_json(record), durable=durable)


def read_manifest(folder: Path) -> Manifest:
    """Read how an episode was set up.

    Raises:
        RecordError: The folder holds no run, or one of another version.
    """
    check_begun(folder)
    form = read_head(folder).get("format", FORMAT)
    if form not in (OLD_FORMAT, FORMAT):
        raise RecordError(
            f"{folder / MANIFEST}: the record has format {form}, and this version of ADAMO reads "
            f"formats {OLD_FORMAT} and {FORMAT}; use the version that wrote it."
        )
    return _read(folder / MANIFEST, Manifest)


def read_result(folder: Path) -> EpisodeResult | None:
    """Read what came of an episode; None if it has not ended.

    Raises:
        RecordError: The file is damaged.
    """
    path = folder / RESULT
    if not path.exists():
        return None
    return _read(path, EpisodeResult, is_old=read_head(folder).get("format") == OLD_FORMAT)


def result_from(data: bytes, source: str) -> EpisodeResult:
    """A result as somebody else tells it.

    Args:
        data: JSON.
        source: Who tells it.

    Raises:
        RecordError: It cannot be read.
    """
    try:
        result: EpisodeResult = _codec(EpisodeResult).validate_json(data)
    except ValidationError:
        raise RecordError(
            f"{source} tells of a result that cannot be read; is it of another version of ADAMO?"
        ) from None
    return result


def _read(path: Path, record_type: type[_T], *, is_old: bool = False) -> _T:
    try:
        text = read_text(path, max_bytes=_MOST_BYTES)
        if is_old:
            text = json.dumps(upgraded_result(json.loads(text)))
        record: _T = _codec(record_type).validate_json(text)
        return record
    except FileError as error:
        raise RecordError(str(error)) from None
    except (ValueError, LookupError, RecursionError) as error:
        if not isinstance(error, ValidationError):
            raise RecordError(f"{path} is damaged; written by another version?") from None
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise RecordError(
            f"{path}: {where or 'file'}: {first['msg']}; written by another version?"
        ) from None


def _warnings(replies: Sequence[Reply]) -> tuple[str, ...]:
    """What is to say of the replies, once: the same with other numbers is no news."""
    first: dict[str, str] = {}
    for reply in replies:
        if reply.warning:
            first.setdefault(re.sub(r"\d[\d,.]*", "", reply.warning), reply.warning)
    return tuple(first.values())
