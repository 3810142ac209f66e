"""What happened, as it happens: typed events, observers of them, and how they are read back."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, Any, Literal, Protocol

from pydantic import Field, TypeAdapter, ValidationError

from adamo_vh.action import Code, Feedback
from adamo_vh.engine import ObjectState, WorldEvent
from adamo_vh.errors import RecordError
from adamo_vh.inference.model import Reply, Spent
from adamo_vh.observation import (
    AgentState,
    BodyState,
    Frame,
    Observation,
    ObservedObject,
    ReferencePoint,
)
from adamo_vh.record.old_format import OLD_FORMAT, upgraded_event
from adamo_vh.record.run_folder import EVENTS, read_head
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.turn import Turn


@dataclass(frozen=True, slots=True)
class Started:
    """The instruction was given."""

    instruction: str
    system_prompt: str
    state_hash: str
    saved: str
    """The saved state with the first view: a replay can start here."""
    type: Literal["started"] = "started"


@dataclass(frozen=True, slots=True)
class Observed:
    """A new view reached the agent."""

    step: int
    frame: str
    """File name in `frames/`, which is the hash of the content."""
    width_px: int
    height_px: int
    objects: tuple[ObservedObject, ...]
    points: tuple[ReferencePoint, ...]
    agent: AgentState
    type: Literal["observed"] = "observed"


@dataclass(frozen=True, slots=True)
class Thought:
    """The model answered."""

    step: int
    state_text: str
    """The symbolic state that the model read."""
    messages: int
    """How many messages the prompt had."""
    turn: Turn
    """The reply, and what each of its calls wishes."""
    forgotten: int | None = None
    """How many replies before it the prompt no longer held; None in records that do not tell."""
    type: Literal["thought"] = "thought"

    @property
    def reply(self) -> Reply:
        """What the model replied, as it came."""
        return self.turn.reply


@dataclass(frozen=True, slots=True)
class Acted:
    """A tool call was carried out, or refused."""

    step: int
    call_id: str
    """Of the call in the turn that it was done for; a doubted Pick shows its object instead."""
    name: str
    arguments: Mapping[str, Any] | None
    feedback: Feedback
    agent: AgentState
    state_hash: str
    saved: str
    """The saved state afterwards: a replay can start here."""
    world_s: float
    type: Literal["acted"] = "acted"

    @property
    def is_cut(self) -> bool:
        """Whether a person cut it short, at a moment that no execution brings about again."""
        return self.feedback.code == Code.CANCELLED


@dataclass(frozen=True, slots=True)
class Ended:
    """The episode is over."""

    steps: int
    reason: TerminationReason
    answer: str
    """What the agent said at the end; the fault, if the episode broke."""
    state_hash: str
    seconds: float
    why: str = ""
    """Why it was stopped, in words, where there is more to say than the reason."""
    spent: Spent | None = None
    """What was spent on an answer that never came, if one did not."""
    type: Literal["ended"] = "ended"


@dataclass(frozen=True, slots=True)
class Shown:
    """A tool showed a picture that is not the view of the eyes, e.g. a close-up."""

    step: int
    frame: str
    """File name in `frames/`."""
    width_px: int
    height_px: int
    type: Literal["shown"] = "shown"


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A tool call was not executed; the calls of a turn that are left out are its last ones."""

    step: int
    call_id: str
    name: str
    why: str
    type: Literal["left_out"] = "left_out"


@dataclass(frozen=True, slots=True)
class Happened:
    """Something happened in the world that no body in it did."""

    step: int
    event: Annotated[WorldEvent, Field(discriminator="type")]
    state_hash: str
    by_user: bool = False
    """Whether a person who watched brought it about."""
    type: Literal["happened"] = "happened"


@dataclass(frozen=True, slots=True)
class Vetoed:
    """A person did not let the turn be carried out."""

    step: int
    why: str
    """What the model was told of the reason."""
    type: Literal["vetoed"] = "vetoed"


@dataclass(frozen=True, slots=True)
class Restored:
    """A person put the world back as it was when an earlier instruction began."""

    step: int
    saved: str
    """The saved state that it went back to."""
    state_hash: str
    type: Literal["restored"] = "restored"


@dataclass(frozen=True, slots=True)
class Lost:
    """The episode broke here on an answer that never came, was paid for, and went on later."""

    step: int
    spent: Spent
    type: Literal["lost"] = "lost"


@dataclass(frozen=True, slots=True)
class Stood:
    """How the world stood after a step; kept where a task asks what came first. Privileged."""

    step: int
    changed: tuple[ObjectState, ...]
    """Objects that are otherwise than before the step, or were not there."""
    gone: tuple[int, ...]
    """Ids of the objects that are not there any more."""
    body: BodyState
    state_hash: str
    type: Literal["stood"] = "stood"


Event = (
    Started
    | Observed
    | Thought
    | Acted
    | LeftOut
    | Shown
    | Happened
    | Vetoed
    | Restored
    | Stood
    | Lost
    | Ended
)


class Observer(Protocol):
    """Is told of every event as it happens: records, shows, counts."""

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Take note of an event; `frame` comes with `Observed` and `Shown`."""
        ...


def observed(step: int, view: Observation) -> Observed:
    """The event of a new view."""
    frame = view.frame
    return Observed(
        step,
        frame_name(frame),
        frame.width_px,
        frame.height_px,
        view.objects,
        view.points,
        view.agent,
    )


def shown(step: int, frame: Frame) -> Shown:
    """The event of a picture that a tool showed."""
    return Shown(step, frame_name(frame), frame.width_px, frame.height_px)


_SUFFIXES = {"image/jpeg": "jpg", "image/png": "png"}
_FRAME_NAME = re.compile(r"[0-9a-f]{8,64}\.(jpg|png)")


def frame_name(frame: Frame) -> str:
    """File name of a picture: the hash of its content."""
    return f"{hashlib.sha256(frame.data).hexdigest()[:24]}.{_SUFFIXES[frame.media_type]}"


def frame_type(name: str) -> str:
    """Media type of a picture by its file name; empty for what is no such name.

    Ask before a name from a record or a client is opened: it must not lead out of the folder.
    """
    match = _FRAME_NAME.fullmatch(name)
    return next((kind for kind, end in _SUFFIXES.items() if match and end == match[1]), "")


@cache
def codec() -> TypeAdapter[Event]:
    """Writes an event as a line of the record, and reads it."""
    return TypeAdapter(Annotated[Event, Field(discriminator="type")])


def _is_by_hand(event: Event) -> bool:
    match event:
        case Vetoed() | Restored():
            return True
        case Happened():
            return event.by_user
        case Acted():
            return event.is_cut
        case Ended():
            return event.reason is TerminationReason.STOPPED
    return False


class Trajectory:
    """Keeps events in memory, in order."""

    def __init__(self, events: tuple[Event, ...] = ()) -> None:
        """Start with events that are already known."""
        self.events: list[Event] = list(events)

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Keep an event."""
        self.events.append(event)

    @property
    def thoughts(self) -> list[Thought]:
        """Every model turn."""
        return [e for e in self.events if isinstance(e, Thought)]

    @property
    def acts(self) -> list[Acted]:
        """Every tool call that was executed or refused."""
        return [e for e in self.events if isinstance(e, Acted)]

    @property
    def lost(self) -> list[Spent]:
        """What was spent on answers that never came, whether it went on behind them or not."""
        ends = [e.spent for e in self.events if isinstance(e, Lost | Ended)]
        return [spent for spent in ends if spent is not None]

    @property
    def assisted(self) -> bool:
        """Whether a person took part other than by what was said: moved, stopped, forbade, undid.

        What a person stops ends as such, or leaves an action cut short.
        """
        return any(_is_by_hand(event) for event in self.events)

    @property
    def instructions(self) -> list[str]:
        """Everything the user said, in order; one, unless it was a conversation."""
        return [e.instruction for e in self.events if isinstance(e, Started)]

    @property
    def ended(self) -> Ended | None:
        """How it ended; None if the last instruction did not get that far."""
        for event in reversed(self.events):
            if not isinstance(event, Happened | Restored | Stood):
                return event if isinstance(event, Ended) else None
        return None

    @property
    def state_hash(self) -> str:
        """Digest of the world after all of it; empty before the first view."""
        leads = Started | Acted | Happened | Restored | Ended
        return next((e.state_hash for e in reversed(self.events) if isinstance(e, leads)), "")


def read_trajectory(folder: Path, damaged: list[str] | None = None) -> Trajectory:
    """Read a run folder; a last line that a kill cut off is left out.

    Args:
        folder: The run folder.
        damaged: Takes what is wrong with each line that cannot be read, and these are left out:
            for those who show a record, never for those who execute it.

    Raises:
        RecordError: There is no episode, or a line in the middle is damaged.
    """
    path = folder / EVENTS
    if not path.is_file():
        raise RecordError(f"{folder} holds no episode: {EVENTS} is missing.")
    head = read_head(folder)
    is_old = head.get("format") == OLD_FORMAT
    lines = path.read_bytes().split(b"\n")
    events: list[Event] = []
    for number, line in enumerate(lines[:-1], start=1):
        try:
            told = json.dumps(upgraded_event(line, head, events)) if is_old else line
            events.append(codec().validate_json(told))
        except (ValueError, TypeError, LookupError) as error:
            problem = error.errors()[0]["msg"] if isinstance(error, ValidationError) else str(error)
            text = f"{path}, line {number} is damaged: {problem}; written by another version?"
            if damaged is None:
                raise RecordError(text) from None
            damaged.append(text)
    return Trajectory(tuple(events))
