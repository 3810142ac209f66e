"""One finished episode as a flat row: all that tables, intervals and comparisons need of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from pydantic import TypeAdapter, ValidationError

from adamo_vh import action
from adamo_vh.analysis.claims import claims_success, names_a_gap
from adamo_vh.benchmark.tasks import Task
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import EpisodeResult, Manifest
from adamo_vh.errors import ConfigError, RecordError
from adamo_vh.inference.model import UNSAFE, Isolation, ModelKind, Reply, Spent, Usage
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Ended, Trajectory
from adamo_vh.record.turn import Wish

_UNSURE = 0.5
"""A Finish with less confidence than this claims nothing."""


_MARK = {"none": "not isolated", "unknown": "isolation unknown"}


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one episode."""

    key: str
    """Names the episode within its study; readable, and the same on every machine."""
    scene: str
    variation: int
    """Of the scene's layout; 0 is the scene as it is."""
    labeling: str
    model: str
    model_kind: ModelKind
    profile: str
    """Name of the profile, and the switches that differ from it."""
    task: str
    """Id of the task; the instruction itself if there was no task."""
    repetition: int
    """From 1, within the cell and variation."""
    seed: int
    completion: float | None
    """Fraction of satisfied conditions; None if the episode is unscored."""
    strict: float | None
    """1 or 0; None if the episode is unscored."""
    termination: TerminationReason
    conditions: int
    """Atomic conditions of the task; 0 if the episode is unscored."""
    conditions_open: int
    """Those that do not hold at the end."""
    claims_success: bool | None
    """Whether the final message says that all is done; False if it says that something is not,
    None if neither can be told or the agent did not end the episode."""
    steps: int
    """Tool calls that were executed or refused."""
    calls: Mapping[str, int]
    """The same by kind."""
    model_calls: int
    requests: int
    """Requests to the provider, repairs and failed tries included."""
    protocol_failures: int
    """Replies that were neither a valid call nor an answer."""
    missing_notes: int
    refused: int
    """Tool calls that changed nothing."""
    corrected: int
    """Tool calls that were carried out, but not as asked."""
    usage: Usage
    """Tokens of all model calls."""
    cost_usd: float | None
    """None if the price of any call is unknown."""
    model_s: float
    """Seconds that the model took, waits left out."""
    world_s: float
    """Seconds that tools took."""
    waited_s: float
    """Seconds lost to failed tries, retries and rate limits."""
    walked_m: float
    direct_m: float
    """The same from place to place in straight lines."""
    shortest_m: float | None
    """Metres that the oracle walks for the task from the same start; None if unknown."""
    family: str = ""
    """Of the task; empty if it has none."""
    printed_level: int | None = None
    """C-D level as the paper prints it; None if the task is none of the paper's."""
    computed_level: int | None = None
    """C-D level by the taxonomy's own rules; None if the units are unknown."""
    axes: Mapping[str, str] = field(default_factory=dict)
    """Further settings that the study varies, by name."""
    run: str = ""
    """The run folder, relative to the study's."""
    answer: str = ""
    """What the agent said at the end; the fault, if the episode broke."""
    why: str = ""
    """Why it was stopped, in words, where there is more to say than the reason."""
    diagnosis: str = ""
    """Class of the failure; empty if there is none, or none was made."""
    diagnosis_code: str = ""
    """The finer code of the failure."""
    state_hash: str = ""
    """Of the world at the end."""
    assisted: bool = False
    """Whether a person took part other than by what was said; see `EpisodeResult`."""
    cut_prompts: int | None = None
    """Model calls whose prompt no longer held every reply before; None if the record tells not."""
    isolation: Isolation = ""
    """How far a program that decided was kept from all but its body; see `EpisodeResult`."""

    @property
    def is_scored(self) -> bool:
        """Whether it counts; a fault that is not the agent's never does."""
        return self.completion is not None

    @property
    def is_ranked(self) -> bool:
        """Whether it may be compared with others; see `EpisodeResult.is_ranked`."""
        return self.isolation not in UNSAFE and not self.assisted

    @property
    def is_complete(self) -> bool:
        """Whether every condition holds."""
        return self.completion is not None and self.conditions_open == 0

    @property
    def ended_by_agent(self) -> bool:
        """Whether the agent itself ended it, by an answer: not by silence, nor by a limit."""
        return self.termination is TerminationReason.ANSWERED

    @property
    def is_early_stop(self) -> bool:
        """Whether the agent ended it with conditions open, whatever it said."""
        return self.is_scored and self.ended_by_agent and self.conditions_open > 0

    @property
    def is_false_claim(self) -> bool:
        """Whether it is an early stop, and the final message says that all is done."""
        return self.is_early_stop and self.claims_success is True


def outcome_of(
    key: str,
    manifest: Manifest,
    trajectory: Trajectory,
    result: EpisodeResult,
    *,
    repetition: int = 1,
    axes: Mapping[str, str] | None = None,
    run: str = "",
    task: Task | None = None,
    shortest_m: float | None = None,
    diagnosis: tuple[str, str] = ("", ""),
) -> Outcome:
    """The row of one episode that has ended: a pure function over its records.

    Args:
        key: Names the episode within its study.
        manifest: How it was set up.
        trajectory: What happened.
        result: What came of it, see `summarise`.
        repetition: From 1, within the cell and variation.
        axes: Further settings that the study varies, by name.
        run: The run folder, relative to the study's.
        task: What was asked for, if the task is no built-in one.
        shortest_m: Metres that the oracle walks for the task from the same start; None if unknown.
        diagnosis: Class and code of the failure, if it was diagnosed.
    """
    config = manifest.config
    asked = task or _recorded(config)
    done = Counter(act.feedback.outcome for act in trajectory.acts)
    lost = [e.spent for e in trajectory.events if isinstance(e, Ended) and e.spent is not None]
    took: list[Reply | Spent] = [*(thought.reply for thought in trajectory.thoughts), *lost]
    return Outcome(
        key=key,
        scene=config.scene,
        variation=config.variation,
        labeling=manifest.labeling or str(config.labeling),
        # The mark goes where the name goes, and what is marked is never pooled with others.
        model=_marked(result),
        model_kind=result.model_kind,
        profile=result.profile,
        task=config.task or config.instruction,
        repetition=repetition,
        seed=config.seed,
        completion=result.completion,
        strict=result.strict,
        termination=result.termination,
        conditions=len(result.conditions),
        conditions_open=sum(not condition.satisfied for condition in result.conditions),
        claims_success=_claim(config.instruction, trajectory, result),
        steps=result.steps,
        calls=dict(result.calls),
        model_calls=result.model_calls,
        requests=result.requests,
        protocol_failures=result.unreadable,
        missing_notes=result.missing_notes,
        cut_prompts=_cut_prompts(trajectory),
        refused=done[action.Outcome.REFUSED],
        corrected=done[action.Outcome.CORRECTED],
        usage=result.usage,
        cost_usd=result.cost_usd,
        model_s=result.model_s,
        world_s=result.world_s,
        waited_s=sum(reply.waited_s for reply in took),
        walked_m=result.walked_m,
        direct_m=result.direct_m,
        shortest_m=shortest_m,
        family="" if asked is None else str(asked.family),
        printed_level=None if asked is None else asked.printed.total,
        computed_level=None if asked is None else asked.computed.total,
        axes=dict(axes or {}),
        run=run,
        answer=result.answer,
        why=result.why,
        diagnosis=diagnosis[0],
        diagnosis_code=diagnosis[1],
        state_hash=result.state_hash,
        assisted=result.assisted,
        isolation=result.isolation,
    )


def _marked(result: EpisodeResult) -> str:
    """The model's name; with a mark, if it may not be compared with others."""
    marks = [_MARK[result.isolation]] if result.isolation in UNSAFE else []
    marks += ["assisted"] if result.assisted else []
    return f"{result.model} ({', '.join(marks)})" if marks else result.model


def outcome_json(outcome: Outcome) -> str:
    """A row as one line of JSON."""
    return _codec().dump_json(outcome).decode()


def read_outcome(text: str | bytes) -> Outcome:
    """The row that `outcome_json` wrote.

    Raises:
        RecordError: The text is none.
    """
    try:
        return _codec().validate_json(text)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"])
        raise RecordError(
            f"An outcome cannot be read: {where or 'text'}: {first['msg']}; written by another "
            "version? It can be made again from the run folder."
        ) from None


@cache
def _codec() -> TypeAdapter[Outcome]:
    return TypeAdapter(Outcome)


def _recorded(config: EpisodeConfig) -> Task | None:
    try:
        return config.scored_task
    except ConfigError:
        return None


def _cut_prompts(trajectory: Trajectory) -> int | None:
    told = [thought.forgotten for thought in trajectory.thoughts]
    return None if None in told else sum(map(bool, told))


def _claim(instruction: str, trajectory: Trajectory, result: EpisodeResult) -> bool | None:
    """What the agent said of the whole, if it was the agent who ended the episode."""
    if result.termination is not TerminationReason.ANSWERED:
        return None
    said = claims_success(instruction, result.answer)
    finish = trajectory.thoughts[-1].turn.finish if trajectory.thoughts else None
    return None if said and finish is not None and _leaves_open(finish) else said


def _leaves_open(finish: Wish) -> bool:
    """Whether the fields of a Finish take back what its answer claims."""
    fields: Mapping[str, Any] = finish.arguments or {}
    if finish.confidence is not None and finish.confidence < _UNSURE:
        return True
    return any(names_a_gap(str(fields.get(name, ""))) for name in ("verified", "unseen"))
