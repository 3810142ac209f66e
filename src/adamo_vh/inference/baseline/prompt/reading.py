"""What the prompt says: messages read back into data, as any reader of the text could.

Two layouts are known, and what lies between them: the whole state in one place and always the
latest, or what changed with each result. Which one it is shows in the messages themselves.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.prompt.state_text import Body, Listed, StateReader, first_point
from adamo_vh.inference.baseline.tags import TAG
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    SystemMessage,
    TextPart,
    ToolMessage,
    pictures_of,
)

__all__ = ["Body", "Event", "Listed", "OwnTurn", "Prompt", "Room", "first_point", "read_prompt"]

_NUMBER = r"(-?\d+(?:\.\d+)?)"
_SPAN = re.compile(rf"x from {_NUMBER} to {_NUMBER} and y from {_NUMBER} to {_NUMBER}")
_CORNER = re.compile(rf"{_NUMBER} x {_NUMBER} m squares")
_NEAR = re.compile(rf"within {_NUMBER} m horizontally")
_SUBJECT = re.compile(rf"({TAG}) (?:is|are|rests|looks|has)\b|I hold ({TAG})")
_NEW_VIEW = "New view after"
_CLOSE_UP = "What "
"""How the words before a frame begin that is no view of the eyes."""
_LEFT_OUT = "(An earlier picture"
_HANDLING = ("Pick", "Drop")
CLOSEUPS = ("Inspect", "Survey")


@dataclass(frozen=True, slots=True)
class Room:
    """What the fixed instructions say about the room, metres."""

    x_min: float = -3.0
    x_max: float = 3.0
    y_min: float = -3.0
    y_max: float = 3.0
    corner_m: float = 1.0
    near_m: float = 0.3

    def clamp(self, point: Vec3, margin_m: float) -> Vec3:
        """The nearest point that keeps a distance to the walls."""
        x = min(max(point.x, self.x_min + margin_m), self.x_max - margin_m)
        y = min(max(point.y, self.y_min + margin_m), self.y_max - margin_m)
        return Vec3(x, y, point.z)

    def corners(self) -> tuple[Vec3, ...]:
        """Centres of the four corner areas."""
        half = self.corner_m / 2
        return tuple(
            Vec3(x, y, 0.0)
            for x in (self.x_min + half, self.x_max - half)
            for y in (self.y_min + half, self.y_max - half)
        )


@dataclass(frozen=True, slots=True)
class Event:
    """A tool call and what came back."""

    name: str
    arguments: Mapping[str, Any]
    text: str
    """The feedback alone."""
    pictures: tuple[ImagePart, ...] = ()
    """Close-ups that came with it."""
    origin: Vec3 | None = None
    """Where a thing was that it took, as the own note tells."""

    @property
    def outcome(self) -> str:
        """Its first word: "done", "corrected", "refused", "not"."""
        word = re.match(r"\W*(\w+)", self.text)
        return word.group(1).lower() if word else ""

    @property
    def executed(self) -> bool:
        """Whether it was tried at all."""
        return self.outcome not in ("not", "")

    @property
    def tag(self) -> str:
        """The object that it was about."""
        return str(self.arguments.get("object", ""))

    @property
    def point(self) -> Vec3 | None:
        """The last coordinates in the feedback."""
        return first_point(self.text, last=True)


@dataclass(frozen=True, slots=True)
class OwnTurn:
    """One own message, and what came back for its calls."""

    note: str
    events: tuple[Event, ...]
    answer: str = ""
    """What it told the user, if it ended an instruction."""


@dataclass(frozen=True, slots=True)
class Prompt:
    """The whole prompt, read."""

    instruction: str
    room: Room = field(default_factory=Room)
    things: tuple[Listed, ...] = ()
    """What the latest view shows."""
    points: tuple[Vec3, ...] = ()
    """Reference points, world metres."""
    body: Body = field(default_factory=lambda: Body(Vec3(0.0, 0.0, 0.0)))
    frame: ImagePart | None = None
    """The latest view."""
    turns: tuple[OwnTurn, ...] = ()
    """The own turns since the instruction, as far as they are in the prompt."""
    earlier: tuple[OwnTurn, ...] = ()
    """Those before it: of former instructions."""
    former: str = ""
    """The instruction before this one."""
    began: Body | None = None
    """The body when the instruction was given, where a text still tells it."""
    event: Event | None = None
    """The latest call that was tried; None before the first."""
    fresh: bool = True
    """Whether the view came after the last own turn."""
    told: Mapping[str, Listed] = field(default_factory=dict)
    """The latest word about each object that any text of the prompt lists."""
    told_at: Mapping[str, int] = field(default_factory=dict)
    """After how many of the own turns that was."""
    told_from_m: Mapping[str, float] = field(default_factory=dict)
    """From how far; empty where lists do not last."""
    pinned: frozenset[str] = frozenset()
    """Objects that the instruction's own message lists; it stays in the prompt for good."""
    lasting: bool = False
    """Whether lists stay in the prompt; otherwise the next view's list replaces this one."""

    @property
    def spoken_of(self) -> tuple[str, ...]:
        """What "it" and "them" may mean: tags of the last instruction with any, latest first."""
        # What the hand holds now may have been taken since: the meaning must not change on the way.
        held = self._held_before()
        tags = [held] if held else []
        for turns in reversed(_by_instruction(self.earlier)):
            handled = [e.tag for t in turns for e in t.events if e.name in _HANDLING and e.tag]
            named = ["".join(found) for found in _SUBJECT.findall(turns[-1].answer)]
            if handled or named:
                group = list(dict.fromkeys(handled[::-1] or named))
                return tuple(dict.fromkeys([*tags, *(group if not held or held in group else ())]))
        return tuple(tags)

    def _held_before(self) -> str:
        """The tag in the hand when the instruction was given, as far as texts tell."""
        if self.began and self.began.hand:
            return "" if self.began.hand == "empty" else self.began.hand
        held = ""
        for event in (event for turn in self.earlier for event in turn.events):
            if event.name in ("Pick", "Drop") and event.outcome in ("done", "corrected"):
                held = event.tag if event.name == "Pick" else ""
        return held

    @property
    def points_key(self) -> tuple[tuple[float, float, float], ...]:
        """The reference points as plain tuples."""
        return tuple((p.x, p.y, p.z) for p in self.points)


def _by_instruction(turns: Sequence[OwnTurn]) -> list[list[OwnTurn]]:
    """The turns of each former instruction; an answer ends one."""
    groups: list[list[OwnTurn]] = [[]]
    for turn in turns:
        groups[-1].append(turn)
        if turn.answer:
            groups.append([])
    return [group for group in groups if group]


@dataclass(slots=True)
class _Reader:
    """Goes through the messages once, oldest first."""

    state: StateReader = field(default_factory=StateReader)
    system: list[str] = field(default_factory=list)
    instruction: str = ""
    frame: ImagePart | None = None
    turns: list[OwnTurn] = field(default_factory=list)
    calls: dict[str, tuple[str, Mapping[str, Any]]] = field(default_factory=dict)
    fresh: bool = True
    viewed: int = 0
    earlier: list[OwnTurn] = field(default_factory=list)
    former: str = ""
    began: Body | None = None
    pinned: frozenset[str] = frozenset()

    def read(self, message: Message) -> None:
        match message:
            case SystemMessage(text=text):
                if not self.state.read_whole(text):
                    self.system.append(text)
            case HumanMessage():
                self._human(message)
            case AIMessage():
                self._own(message)
            case ToolMessage():
                self._result(message)

    def _human(self, message: HumanMessage) -> None:
        texts = [part.text for part in message.parts if isinstance(part, TextPart)]
        images = pictures_of(message)
        first = texts[0] if texts else ""
        if self.state.read_whole(first):
            return
        left_out = any(text.startswith(_LEFT_OUT) for text in texts)
        if self.turns and first.startswith(_CLOSE_UP) and first.rstrip(".").endswith("shows"):
            self._add_pictures(images)
        elif self.turns and first.startswith(_NEW_VIEW):
            self._view(images)
        elif not self.instruction or images or left_out or len(texts) > 1:
            self.former, self.instruction = self.instruction, first.strip()
            self.earlier += self.turns
            self.turns.clear()
            self.state.turn = 0
            for text in texts[1:]:
                self.state.read_changes(text)
            self.began = self.state.body if self.state.views else None
            self.pinned = self.pinned | frozenset(self.state.told)
            self._view(images)

    def _own(self, message: AIMessage) -> None:
        arguments = [dict(call.arguments or {}) for call in message.calls]
        notes = [str(a["note"]) for a in arguments if isinstance(a.get("note"), str)]
        told = [str(a["answer"]) for a in arguments if isinstance(a.get("answer"), str)]
        answer = told[0] if told else "" if message.calls else message.text
        self.turns.append(OwnTurn(message.text or "\n".join(notes), (), answer))
        self.state.turn = len(self.turns)
        for call, values in zip(message.calls, arguments, strict=True):
            self.calls[call.id] = (call.name, values)
        self.fresh = False

    def _result(self, message: ToolMessage) -> None:
        seen = self.state.read_changes(message.text)
        name, arguments = self.calls.get(message.call_id, (message.name, {}))
        text = message.text.split("\n\n", 1)[0].split(f"\n{_LEFT_OUT}", 1)[0]
        pictures = message.images
        close = name in CLOSEUPS or text.startswith("Not ")
        if seen or (pictures and not close) or (name in CLOSEUPS and len(pictures) > 1):
            self._view(pictures[-1:])
            pictures = pictures[:-1]
        if self.turns:
            turn = self.turns[-1]
            origin = first_point(turn.note.partition(f"Pick {arguments.get('object')} from ")[2])
            event = Event(name, arguments, text, pictures, origin)
            self.turns[-1] = replace(turn, events=(*turn.events, event))

    def _view(self, images: Sequence[ImagePart]) -> None:
        self.fresh = True
        self.viewed = len(self.turns)
        if images:
            self.frame = images[-1]

    def _add_pictures(self, images: tuple[ImagePart, ...]) -> None:
        turn = self.turns[-1]
        if turn.events:
            last = turn.events[-1]
            event = replace(last, pictures=(*last.pictures, *images))
            self.turns[-1] = replace(turn, events=(*turn.events[:-1], event))


def read_prompt(messages: Sequence[Message]) -> Prompt:
    """Read all messages; parts that are missing read as empty.

    Args:
        messages: The prompt, oldest first.
    """
    reader = _Reader()
    for message in messages:
        reader.read(message)
    state = reader.state
    tried = [event for turn in reader.turns for event in turn.events if event.executed]
    return Prompt(
        instruction=reader.instruction,
        room=_room("\n".join(reader.system)),
        things=state.things(),
        points=state.points,
        body=state.body,
        frame=reader.frame,
        turns=tuple(reader.turns),
        earlier=tuple(reader.earlier),
        former=reader.former,
        began=reader.began if not reader.turns or state.views else None,
        event=tried[-1] if tried else None,
        fresh=reader.fresh,
        told=state.told,
        told_at=state.told_at if state.views else dict.fromkeys(state.told, reader.viewed),
        told_from_m=state.told_from_m,
        pinned=reader.pinned if state.views else frozenset(),
        lasting=state.views > 0,
    )


def _room(text: str) -> Room:
    span, corner, near = _SPAN.search(text), _CORNER.search(text), _NEAR.search(text)
    usual = Room()
    x_min, x_max, y_min, y_max = (
        (float(v) for v in span.groups())
        if span
        else (usual.x_min, usual.x_max, usual.y_min, usual.y_max)
    )
    return Room(
        x_min,
        x_max,
        y_min,
        y_max,
        float(corner.group(1)) if corner else usual.corner_m,
        float(near.group(1)) if near else usual.near_m,
    )
