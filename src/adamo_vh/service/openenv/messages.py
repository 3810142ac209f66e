"""What OpenEnv's clients send, read strictly, and the schemas that they are told."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Annotated, Any, ClassVar, Literal, TypeVar, cast

from pydantic import ConfigDict, Field, TypeAdapter, ValidationError

from adamo_vh.engine import MOST_VARIATIONS
from adamo_vh.errors import ConfigError
from adamo_vh.readable import readable

_STRICT = ConfigDict(extra="forbid")
_Name = Annotated[str, Field(max_length=200)]
_T = TypeVar("_T")


@dataclass(frozen=True, slots=True)
class Reset:
    """Begin an episode; everything may be left out."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    seed: Annotated[int | None, Field(ge=0, le=2**31 - 1)] = None
    """Of the episode; without a task it also chooses one."""
    episode_id: Annotated[str | None, Field(max_length=255)] = None
    """What the client calls it."""
    split: _Name | None = None
    """A scene, as listed: S1, S2."""
    index: Annotated[int, Field(ge=0, le=10_000)] = 0
    """Which task of the split."""
    task: _Name | None = None
    """T1 to T15."""
    instruction: Annotated[str | None, Field(max_length=20_000)] = None
    """Free play without a reward, in place of a task."""
    scene: _Name | None = None
    labeling: Literal["sem", "opaq"] | None = None
    profile: Literal["paper", "paper-exact", "lean", "single"] | None = None
    resolution: _Name | None = None
    """WIDTHxHEIGHT."""
    variation: Annotated[int, Field(ge=0, le=MOST_VARIATIONS)] = 0


@dataclass(frozen=True, slots=True)
class CallTool:
    """Call one of the tools that `list_tools` names."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    tool_name: Annotated[str, Field(max_length=1_000)]
    arguments: dict[str, Any] = field(default_factory=dict)
    metadata: dict[str, Any] = field(default_factory=dict)
    """Is not read; a `note` in it goes on record as the thought before the call."""
    type: Literal["call_tool"] = "call_tool"


@dataclass(frozen=True, slots=True)
class ListTools:
    """Ask for the tools."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    metadata: dict[str, Any] = field(default_factory=dict)
    type: Literal["list_tools"] = "list_tools"


Action = Annotated[CallTool | ListTools, Field(discriminator="type")]


@dataclass(frozen=True, slots=True)
class StepRequest:
    """A step over HTTP, where no connection says whose it is."""

    action: dict[str, Any]
    """As `/schema` describes it."""
    session_id: Annotated[str, Field(max_length=100)]
    """What `/reset` gave."""
    timeout_s: Annotated[float | None, Field(gt=0)] = None
    """Is not read: an action takes as long as it takes."""
    request_id: Annotated[str | None, Field(max_length=255)] = None
    """Is not read."""


@dataclass(frozen=True, slots=True)
class TasksOf:
    """Which tasks are asked for."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    split: _Name


@dataclass(frozen=True, slots=True)
class TaskAt:
    """Which task is asked for."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    split: _Name
    index: Annotated[int, Field(ge=0, le=10_000)]


@dataclass(frozen=True, slots=True)
class TasksFrom:
    """Which part of the tasks is asked for."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    split: _Name
    start: Annotated[int | None, Field(ge=0)] = None
    stop: Annotated[int | None, Field(ge=0)] = None


@dataclass(frozen=True, slots=True)
class Fault:
    """What cannot be done, in a sentence."""

    detail: str


@dataclass(frozen=True, slots=True)
class Shown:
    """A picture."""

    media_type: str
    data: str
    """Base64."""
    width: int
    height: int


@dataclass(frozen=True, slots=True)
class Told:
    """What came of a call: everything that the player is told."""

    instruction: str
    text: str
    """The symbolic state in words."""
    feedback: str = ""
    outcome: str = ""
    """done, corrected or refused; empty where nothing was done."""
    code: str = ""
    image: Shown | None = None
    """The view, if there is a new one."""
    closeups: tuple[Shown, ...] = ()
    objects: tuple[str, ...] = ()
    """Tags in the last view."""


@dataclass(frozen=True, slots=True)
class Observation:
    """An answer to a reset or a step."""

    tool_name: str
    result: Told
    session_id: str = ""
    """Names the session in further requests over HTTP."""
    error: None = None
    """Is always null: what goes wrong in the room is feedback."""


@dataclass(frozen=True, slots=True)
class State:
    """What there is to know of an episode beside its observations; nothing of the room."""

    episode_id: str | None = None
    step_count: int = 0
    task: str | None = None
    scene: str | None = None
    done: bool = False


@cache
def _codec_of(kind: Hashable) -> TypeAdapter[Any]:
    return TypeAdapter(cast(Any, kind))


def _codec(kind: Any) -> TypeAdapter[Any]:
    return _codec_of(kind)


def read(kind: type[_T] | Any, told: object) -> _T:
    """Read what a client sent.

    Args:
        kind: What it should be.
        told: As it came.

    Raises:
        ConfigError: It is something else; names the field.
    """
    if kind is Action and isinstance(told, Mapping) and "type" not in told:
        told = {**told, "type": "call_tool"}
    try:
        found: _T = _codec(kind).validate_python(told)
    except ValidationError as error:
        first = error.errors(include_input=False, include_url=False)[0]
        where = ".".join(str(part) for part in first["loc"])
        raise ConfigError(f"{readable(where)[:100] or 'message'}: {first['msg']}.") from None
    except RecursionError:
        raise ConfigError("The message is nested too deep.") from None
    return found


def plain(message: Any) -> Any:
    """A message of ours as JSON data."""
    return _codec(type(message)).dump_python(message, mode="json")


def schemas() -> dict[str, Any]:
    """The schemas of actions, observations and state."""
    return {
        "action": _codec(Action).json_schema(),
        "observation": _codec(Observation).json_schema(),
        "state": _codec(State).json_schema(),
        "reset_observation": _codec(Observation).json_schema(),
    }
