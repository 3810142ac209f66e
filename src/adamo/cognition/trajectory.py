"""What happened, as it happens: typed events, observers of them, and the run folder.

A run folder holds `manifest.json` (how the episode was set up), `events.jsonl` (one event a line,
flushed at once, so that a kill loses at most the step in flight) and `frames/` (pictures named by
their content). Everything else, the score too, can be computed from these.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import IO, Annotated, Any, Literal, Protocol

from pydantic import Field, TypeAdapter, ValidationError

from adamo.action import Feedback
from adamo.cognition.termination import TerminationReason
from adamo.errors import RecordError
from adamo.inference.messages import ToolCall
from adamo.inference.model import Usage
from adamo.observation import AgentState, Frame, Observation, ObservedObject, ReferencePoint

EVENTS = "events.jsonl"
FRAMES = "frames"


@dataclass(frozen=True, slots=True)
class Started:
    """The instruction was given."""

    instruction: str
    system_prompt: str
    state_hash: str
    saved: str
    """What `ActionServer.save` gave before the first view."""
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
    note: str
    calls: tuple[ToolCall, ...]
    usage: Usage
    model_s: float
    waited_s: float
    type: Literal["thought"] = "thought"


@dataclass(frozen=True, slots=True)
class Acted:
    """A tool call was carried out, or refused."""

    step: int
    name: str
    arguments: Mapping[str, Any] | None
    feedback: Feedback
    agent: AgentState
    state_hash: str
    saved: str
    """What `ActionServer.save` gave afterwards: a replay can start here."""
    world_s: float
    type: Literal["acted"] = "acted"


@dataclass(frozen=True, slots=True)
class Ended:
    """The episode is over."""

    steps: int
    reason: TerminationReason
    answer: str
    """What the agent said at the end; the fault, if the episode broke."""
    state_hash: str
    seconds: float
    type: Literal["ended"] = "ended"


Event = Started | Observed | Thought | Acted | Ended


class Observer(Protocol):
    """Is told of every event as it happens: records, shows, counts."""

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Take note of an event; `frame` comes with `Observed`."""
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


def frame_name(frame: Frame) -> str:
    """File name of a picture: the hash of its content."""
    suffix = {"image/jpeg": "jpg", "image/png": "png"}[frame.media_type]
    return f"{hashlib.sha256(frame.data).hexdigest()[:24]}.{suffix}"


@cache
def _codec() -> TypeAdapter[Event]:
    return TypeAdapter(Annotated[Event, Field(discriminator="type")])


class TrajectoryWriter:
    """Writes events and frames into a run folder, each at once."""

    def __init__(self, folder: Path, *, known: int = 0) -> None:
        """Open a run folder.

        Args:
            folder: Is made if it is missing.
            known: Go on with an interrupted episode: this many events are in the file already and
                will come again; they are not written twice.

        Raises:
            RecordError: It already holds an episode.
        """
        self._known = known
        if known:
            _cut_off_half_line(folder / EVENTS)
        elif (folder / EVENTS).exists():
            raise RecordError(f"{folder} already holds an episode; choose another --out folder.")
        (folder / FRAMES).mkdir(parents=True, exist_ok=True)
        self._folder = folder
        self._file: IO[bytes] = (folder / EVENTS).open("ab")

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Write an event; its frame first, so that no event names a missing picture."""
        if self._known:
            self._known -= 1
            return
        if frame is not None:
            path = self._folder / FRAMES / frame_name(frame)
            if not path.exists():
                half = path.with_suffix(".part")
                half.write_bytes(frame.data)
                os.replace(half, path)
        self._file.write(_codec().dump_json(event) + b"\n")
        self._file.flush()

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _cut_off_half_line(path: Path) -> None:
    """Remove what a kill left of a line that was being written."""
    content = path.read_bytes()
    whole = content.rfind(b"\n") + 1
    if whole < len(content):
        with path.open("r+b") as file:
            file.truncate(whole)


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
    def views(self) -> list[Observed]:
        """Every view."""
        return [e for e in self.events if isinstance(e, Observed)]

    @property
    def ended(self) -> Ended | None:
        """The last event of a finished episode."""
        return next((e for e in reversed(self.events) if isinstance(e, Ended)), None)


def read_trajectory(folder: Path) -> Trajectory:
    """Read a run folder; a last line that a kill cut off is left out.

    Raises:
        RecordError: There is no episode, or a line in the middle is damaged.
    """
    path = folder / EVENTS
    if not path.is_file():
        raise RecordError(f"{folder} holds no episode: {EVENTS} is missing.")
    lines = path.read_bytes().split(b"\n")
    events: list[Event] = []
    for number, line in enumerate(lines[:-1], start=1):
        try:
            events.append(_codec().validate_json(line))
        except ValidationError as error:
            problem = error.errors()[0]["msg"]
            raise RecordError(f"{path}, line {number} is damaged: {problem}") from None
    return Trajectory(tuple(events))
