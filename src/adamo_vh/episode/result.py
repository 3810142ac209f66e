"""One episode as data: how it was set up, what came of it, and the files that keep both."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from adamo_vh.benchmark.checkers import ConditionResult, score
from adamo_vh.benchmark.tasks import task
from adamo_vh.cognition.budget import Budget
from adamo_vh.cognition.profile import PAPER, Profile
from adamo_vh.engine import WorldState, supporting_object
from adamo_vh.errors import ConfigError, FileError, RecordError
from adamo_vh.files import read_text, write_whole
from adamo_vh.geometry import Vec3
from adamo_vh.inference.model import ModelKind, Sampling, Usage
from adamo_vh.inference.remote.capabilities import Capabilities
from adamo_vh.perception import Labeling, TextForm
from adamo_vh.record.run_folder import MANIFEST, RESULT, check_begun
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import Thought, Trajectory

FORMAT = 1
_MOST_BYTES = 50_000_000
_T = TypeVar("_T")


@dataclass(frozen=True, slots=True)
class EpisodeConfig:
    """Everything that decides how an episode goes; the defaults are the paper's baseline."""

    instruction: str
    """What the agent is told."""
    task: str | None = None
    """Id of the benchmark task that the instruction comes from; decides the checker."""
    scene: str = "s1"
    """Built-in scene or path of a scene file."""
    figure: str = "mara"
    """Who the virtual human is; seen in frames where the body is in view."""
    labeling: Labeling = Labeling.SEM
    model: str = "baseline"
    """Model URI."""
    tool_calls: str = "auto"
    """How a remote model is asked for its calls: "auto", "native", "schema" or "react"."""
    profile: Profile = PAPER
    seed: int = 0
    k: int = 50
    """Steps in the short-term memory."""
    grid: int = 6
    """Reference points along each side of the frame."""
    resolution: tuple[int, int] = (1920, 1080)
    """Width and height of the frames in pixels."""
    text_form: TextForm = TextForm.FULL
    sampling: Sampling = field(default=Sampling())
    limits: Limits = field(default=Limits())
    budget: Budget = field(default=Budget())

    def __post_init__(self) -> None:
        if not self.instruction.strip():
            raise ConfigError("The instruction is empty; say what to do, or name a --task.")
        width, height = self.resolution
        if not (64 <= width <= 7680 and 64 <= height <= 4320):
            raise ConfigError(f"resolution {width}x{height}: use 64x64 up to 7680x4320.")
        if not 0 <= self.grid <= 20:
            raise ConfigError(f"grid is {self.grid}: use 0 to 20 reference points a side.")
        if self.k < 1:
            raise ConfigError(f"k is {self.k}: the memory keeps at least 1 step.")


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
    format: int = FORMAT


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
    completion: float | None
    """Fraction of satisfied conditions; None without a task, or if the episode broke."""
    strict: float | None
    """1 or 0; None like `completion`."""
    conditions: tuple[ConditionResult, ...]
    violations: tuple[str, ...]
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
    manifest: Manifest, trajectory: Trajectory, final: WorldState, run: Path | None
) -> EpisodeResult:
    """Score and count an episode that has ended: a pure function over its records.

    Raises:
        RecordError: The trajectory has no end.
    """
    ended = trajectory.ended
    if ended is None:
        raise RecordError("The episode has not ended; it cannot be scored.")
    config = manifest.config
    scored = None
    if config.task is not None and ended.reason.is_scored:
        scored = score(manifest.initial, final, task(config.task))
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
        completion=scored.completion if scored else None,
        strict=scored.strict if scored else None,
        conditions=scored.conditions if scored else (),
        violations=scored.violations if scored else (),
        termination=ended.reason,
        why=ended.why,
        answer=ended.answer,
        steps=ended.steps,
        model_calls=len(trajectory.thoughts),
        calls=dict(sorted(kinds.items())),
        missing_notes=sum(bool(t.calls) and not t.reasoning.strip() for t in trajectory.thoughts),
        unreadable=sum(t.reply.ending.is_failure for t in trajectory.thoughts),
        requests=sum(t.requests for t in trajectory.thoughts),
        usage=sum((t.usage for t in trajectory.thoughts), Usage()),
        cost_usd=total_cost(trajectory.thoughts),
        rungs=tuple(sorted({str(t.rung) for t in trajectory.thoughts if t.rung is not None})),
        model_s=sum(t.model_s for t in trajectory.thoughts),
        world_s=sum(act.world_s for act in trajectory.acts),
        walked_m=sum(act.feedback.walked_m for act in trajectory.acts),
        direct_m=sum(a.horizontal_distance(b) for a, b in pairwise(stops)),
        run=None if run is None else str(run),
        state_hash=ended.state_hash,
        final=final,
    )


def total_cost(thoughts: Sequence[Thought]) -> float | None:
    """What all answers cost; None if any price is unknown, because that is not 0."""
    known = [thought.cost_usd for thought in thoughts if thought.cost_usd is not None]
    return sum(known) if known and len(known) == len(thoughts) else None


def to_json(record: Manifest | EpisodeResult) -> Any:
    """A record as plain JSON data."""
    return TypeAdapter(type(record)).dump_python(record, mode="json")


def write_record(folder: Path, name: str, record: Manifest | EpisodeResult) -> None:
    """Write a record into a run folder, whole or not at all."""
    data = TypeAdapter(type(record)).dump_json(record, indent=1)
    write_whole(folder / name, data, durable=True)


def read_manifest(folder: Path) -> Manifest:
    """Read how an episode was set up.

    Raises:
        RecordError: The folder holds no run, or one of another version.
    """
    check_begun(folder)
    manifest = _read(folder / MANIFEST, Manifest)
    if manifest.format != FORMAT:
        raise RecordError(
            f"{folder / MANIFEST}: the record has format {manifest.format}, and this version of "
            f"ADAMO reads format {FORMAT}; use the version that wrote it "
            f"({manifest.versions.get('adamo-vh', 'unknown')})."
        )
    return manifest


def read_result(folder: Path) -> EpisodeResult | None:
    """Read what came of an episode; None if it has not ended.

    Raises:
        RecordError: The file is damaged.
    """
    path = folder / RESULT
    return _read(path, EpisodeResult) if path.exists() else None


def _read(path: Path, record_type: type[_T]) -> _T:
    try:
        return TypeAdapter(record_type).validate_json(read_text(path, max_bytes=_MOST_BYTES))
    except FileError as error:
        raise RecordError(str(error)) from None
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise RecordError(
            f"{path}: {where or 'file'}: {first['msg']}; written by another version?"
        ) from None
