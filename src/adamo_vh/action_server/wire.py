"""The body over a network: what is asked of it and what it answers, as messages in JSON.

Each message is a dataclass; its JSON Schema is published under `docs/wire/`. HTTP and WebSocket
carry the same ones. Pictures are no part of them: a message names its pictures, and they follow as
bytes, or are had by a link.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar, Literal, get_args

from pydantic import ConfigDict, Field, TypeAdapter, ValidationError

from adamo_vh.action import Feedback, ToolSchema
from adamo_vh.action_server.protocol import ActionResult, Sighting
from adamo_vh.engine import MOST_VARIATIONS
from adamo_vh.errors import ConfigError
from adamo_vh.geometry import Camera
from adamo_vh.observation import AgentState, Frame, Observation, ObservedObject, ReferencePoint
from adamo_vh.readable import readable

VERSION = 1
"""Of the messages: the 1 in ``/v1``. It changes when a client of before would be misled."""

_STRICT = ConfigDict(extra="forbid")
_Id = Annotated[str, Field(max_length=100)]
_Name = Annotated[str, Field(max_length=200)]
_Text = Annotated[str, Field(max_length=20_000)]
_RequestId = Annotated[
    str,
    Field(
        max_length=100,
        description="Made up by the client, new for each request. One that is sent again, after a "
        "connection was cut, is answered again and not done twice.",
    ),
]


@dataclass(frozen=True, slots=True)
class Create:
    """Begin an episode; what is left out is as the server has it."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    task: Annotated[_Name | None, Field(description="T1 to T15: a scored episode.")] = None
    instruction: Annotated[_Text | None, Field(description="What to do, in free play.")] = None
    scene: Annotated[_Name | None, Field(description="Built-in scene.")] = None
    labeling: Annotated[
        Literal["sem", "opaq"] | None, Field(description="How objects are tagged.")
    ] = None
    profile: Annotated[
        Literal["paper", "paper-exact", "lean", "single"] | None,
        Field(description="How the player is spoken to, and with which tools."),
    ] = None
    switches: Annotated[
        dict[str, Any] | None,
        Field(description="Single switches of the profile, set otherwise.", max_length=40),
    ] = None
    seed: Annotated[int, Field(ge=0, le=2**31 - 1)] = 0
    variation: Annotated[int, Field(ge=0, le=MOST_VARIATIONS)] = 0
    resolution: Annotated[
        str | None,
        Field(
            description="WIDTHxHEIGHT, 64x64 up to 7680x4320.", pattern="^[0-9]{2,4}x[0-9]{2,4}$"
        ),
    ] = None
    player: Annotated[_Name, Field(description="Who plays, as the record calls him.")] = "outside"
    request: _RequestId = ""
    type: Literal["create"] = "create"


@dataclass(frozen=True, slots=True)
class Attach:
    """Go on in a session, e.g. after a connection was cut."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    session: _Id
    request: _RequestId = ""
    type: Literal["attach"] = "attach"


@dataclass(frozen=True, slots=True)
class Observe:
    """The view from where the body stands; the same one, if nothing was done since."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    request: _RequestId = ""
    type: Literal["observe"] = "observe"


@dataclass(frozen=True, slots=True)
class Act:
    """Carry out a tool call; one that is no valid action is refused with a sentence."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    name: Annotated[str, Field(max_length=1_000, description="Name of the tool.")]
    arguments: Annotated[
        dict[str, Any] | None,
        Field(description="Its arguments; null if they could not be read."),
    ] = None
    note: Annotated[_Text, Field(description="What was thought before it.")] = ""
    request: _RequestId = ""
    type: Literal["act"] = "act"


@dataclass(frozen=True, slots=True)
class Think:
    """Put on record what was thought; with the reply of a model, what it took as well."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    note: _Text = ""
    reply: Annotated[
        dict[str, Any] | None,
        Field(description="A whole reply of a model, as the record keeps it, in place of a note."),
    ] = None
    request: _RequestId = ""
    type: Literal["think"] = "think"


@dataclass(frozen=True, slots=True)
class Say:
    """Say something through the body; the episode goes on."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    text: _Text
    request: _RequestId = ""
    type: Literal["say"] = "say"


@dataclass(frozen=True, slots=True)
class Finish:
    """End the episode with an answer."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    answer: _Text = ""
    reason: Annotated[
        Literal["answered", "empty_reply", "protocol", "loop", "budget", "step_limit", "time_limit"]
        | None,
        Field(description="Why, if a limit of the player's own ended it."),
    ] = None
    why: Annotated[_Text, Field(description="In words, where there is more to say.")] = ""
    request: _RequestId = ""
    type: Literal["finish"] = "finish"


@dataclass(frozen=True, slots=True)
class Load:
    """Go back to a saved state; in a scored episode, only to where it stands."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    saved: Annotated[_Id, Field(description="The handle that an earlier answer gave.")]
    request: _RequestId = ""
    type: Literal["load"] = "load"


@dataclass(frozen=True, slots=True)
class DescribeState:
    """The symbolic state in words."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    request: _RequestId = ""
    type: Literal["describe"] = "describe"


Step = Observe | Act | Think | Say | Finish | Load | DescribeState
"""What is asked in a session."""
Request = Create | Attach | Step


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture that belongs to an answer."""

    name: str
    """The hash of its content, so that what was had before need not be had again."""
    media_type: str
    width_px: int
    height_px: int
    href: str
    """Where it can be had over HTTP."""


@dataclass(frozen=True, slots=True)
class View:
    """What is seen: the picture, and the same as data."""

    picture: Picture
    objects: tuple[ObservedObject, ...]
    points: tuple[ReferencePoint, ...]
    agent: AgentState
    camera: Camera


@dataclass(frozen=True, slots=True)
class Seen:
    """The answer to `Observe`."""

    view: View
    state_hash: str
    saved: str
    waited_s: float = 0.0
    ended: bool = False
    type: Literal["seen"] = "seen"


@dataclass(frozen=True, slots=True)
class Done:
    """The answer to `Act`."""

    feedback: Feedback
    agent: AgentState
    state_hash: str
    saved: str
    view: View | None = None
    """A new view, if the action brings one."""
    pictures: tuple[Picture, ...] = ()
    """What the action itself showed, e.g. a close-up."""
    waited_s: float = 0.0
    ended: bool = False
    """Whether the episode is over: all that a player is told of that."""
    type: Literal["done"] = "done"


@dataclass(frozen=True, slots=True)
class Welcome:
    """The answer to `Create` and `Attach`."""

    session: str
    instruction: str
    system_prompt: str
    tools: tuple[ToolSchema, ...]
    settings: dict[str, Any]
    """Scene, labeling, profile and limits, as they hold."""
    ended: bool = False
    seen: Seen | None = None
    """The view; none once the episode is over."""
    version: int = VERSION
    type: Literal["welcome"] = "welcome"


@dataclass(frozen=True, slots=True)
class Noted:
    """The answer to `Think`, `Say`, `Finish` and `Load`."""

    ended: bool = False
    state_hash: str = ""
    """After `Load`: where the world stands now."""
    type: Literal["noted"] = "noted"


@dataclass(frozen=True, slots=True)
class Described:
    """The answer to `DescribeState`."""

    text: str
    type: Literal["described"] = "described"


@dataclass(frozen=True, slots=True)
class Problem:
    """What went wrong, and what helps."""

    message: str
    type: str = "invalid_request_error"
    """For programs: invalid_request_error, not_found, episode_over, judge_only, busy, engine_error
    or server_error."""
    param: str | None = None
    code: str | None = None


@dataclass(frozen=True, slots=True)
class Failed:
    """The answer to what cannot be done."""

    error: Problem
    type: Literal["failed"] = "failed"


Answer = Welcome | Seen | Done | Noted | Described | Failed


@dataclass(frozen=True, slots=True)
class Sent:
    """An answer and its pictures, by their names."""

    answer: Answer
    frames: Mapping[str, Frame] = field(default_factory=dict)


_CODECS: dict[Any, TypeAdapter[Any]] = {}


def codec(kind: Any) -> TypeAdapter[Any]:
    """Writes and reads messages of a kind; of several kinds, by their type."""
    if kind not in _CODECS:
        told: Any = Annotated[kind, Field(discriminator="type")] if get_args(kind) else kind
        _CODECS[kind] = TypeAdapter(told)
    return _CODECS[kind]


def read(kind: Any, text: str | bytes) -> Any:
    """A message as somebody sent it.

    Raises:
        ConfigError: It is none of that kind; says where.
    """
    try:
        return codec(kind).validate_json(text)
    except ValidationError as error:
        raise ConfigError(fault_in(error)) from None


def fault_in(error: ValidationError) -> str:
    """What is wrong with a message, in a line."""
    first = error.errors(include_url=False, include_input=False)[0]
    where = readable(".".join(str(part) for part in first["loc"]))[:100]
    return f"The message is wrong: {where or 'it'}: {readable(first['msg'])[:200]}."


def to_plain(message: Any) -> dict[str, Any]:
    """A message as plain JSON data."""
    plain: dict[str, Any] = codec(type(message)).dump_python(message, mode="json")
    return plain


def to_json(message: Any) -> str:
    """A message as it is sent."""
    return codec(type(message)).dump_json(message).decode()


def observation_of(view: View, frames: Mapping[str, Frame]) -> Observation:
    """A view as it was sent, with its picture."""
    frame = frames[view.picture.name]
    return Observation(frame, view.objects, view.points, view.agent, view.camera)


def sighting_of(seen: Seen, frames: Mapping[str, Frame]) -> Sighting:
    """What a look at the room brought, as it was before it was sent."""
    view = observation_of(seen.view, frames)
    return Sighting(view, seen.state_hash, seen.saved, seen.waited_s)


def result_of(done: Done, frames: Mapping[str, Frame]) -> ActionResult:
    """What an action brought, as it was before it was sent."""
    return ActionResult(
        done.feedback,
        done.agent,
        None if done.view is None else observation_of(done.view, frames),
        done.state_hash,
        done.saved,
        tuple(frames[item.name] for item in done.pictures),
        done.waited_s,
    )


def pictures_of(answer: Answer) -> tuple[Picture, ...]:
    """The pictures that an answer names, each once, in order."""
    match answer:
        case Welcome(seen=Seen() as seen) | (Seen() as seen):
            return (seen.view.picture,)
        case Done():
            views = () if answer.view is None else (answer.view.picture,)
            return tuple(dict.fromkeys((*views, *answer.pictures)))
    return ()
