"""An episode as a reader goes through it: turns of seeing, thinking, acting and being told.

A pure function over the recorded events. A turn begins with the view that the model read, so a
frame that a `Look` brings belongs to the turn after it.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import zip_longest
from typing import Any

from adamo_vh.engine import LightChanged, ObjectAdded, ObjectMoved, ObjectTaken
from adamo_vh.observation import AgentState
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import (
    Acted,
    Ended,
    Happened,
    LeftOut,
    Observed,
    Restored,
    Shown,
    Started,
    Thought,
    Trajectory,
)
from adamo_vh.record.turn import Wish


@dataclass(frozen=True, slots=True)
class CallText:
    """A tool call, ready to be printed like code."""

    name: str
    arguments: tuple[tuple[str, str], ...]
    """Names and values; values are JSON."""
    unreadable: str | None = None
    """What the model wrote in place of arguments, if it was no JSON object."""

    @classmethod
    def of(cls, name: str, arguments: Mapping[str, Any] | None, raw: str = "") -> CallText:
        """Spell a call out as the model made it."""
        if arguments is None:
            return cls(name, (), raw)
        values = {key: json.dumps(value, ensure_ascii=False) for key, value in arguments.items()}
        return cls(name, tuple(values.items()))

    def __str__(self) -> str:
        if self.unreadable is not None:
            return f"{self.name}({self.unreadable})"
        return f"{self.name}({', '.join(f'{key}={value}' for key, value in self.arguments)})"


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture that came in the middle of a turn: a close-up, or a view that did not last."""

    id: str
    """Names it within the page."""
    event: Shown | Observed
    turn: str
    """Anchor of the turn that shows it; this one's if it came here first."""
    source: str
    """What `id` it has there."""

    @property
    def is_first(self) -> bool:
        """Whether it appears here for the first time."""
        return self.id == self.source


@dataclass(frozen=True, slots=True)
class Deed:
    """One call of a turn, and what came of it."""

    call: CallText
    note: str = ""
    """Its own note, where the turn does not begin with it."""
    confidence: float | None = None
    """0 to 1, as the model said; None if it did not."""
    act: Acted | None = None
    """What was executed for it: the call itself or, for a doubted one, a close-up."""
    pictures: tuple[Picture, ...] = ()
    left_out: str = ""
    """Why it was not executed; empty if it was, or if the record stops here."""

    @property
    def is_doubted(self) -> bool:
        """Whether something else was executed: the model was too unsure of the call."""
        return self.act is not None and self.act.name != self.call.name

    @property
    def tone(self) -> str:
        """An outcome, "doubted", "left-out", or "cut" where the record stops."""
        if self.act is None:
            return "left-out" if self.left_out else "cut"
        return "doubted" if self.is_doubted else self.act.feedback.outcome.value


@dataclass(frozen=True, slots=True)
class Closing:
    """What a call of Finish says."""

    answer: str
    asked: str
    verified: str
    unseen: str
    confidence: float | None

    @classmethod
    def of(cls, wish: Wish) -> Closing:
        """Read the call; what is missing is empty."""
        said = wish.arguments or {}
        asked, verified, unseen = (_words(said.get(key)) for key in ("asked", "verified", "unseen"))
        return cls(wish.answer, asked, verified, unseen, wish.confidence)


@dataclass(frozen=True, slots=True)
class ShownTurn:
    """One time around the loop, as the page shows it."""

    anchor: str
    """Names the turn within the page."""
    label: str
    """Numbers of the steps, or nothing for a turn without any."""
    view: Observed | None
    """The latest view when the model was asked."""
    arrived: bool
    """Whether that view is new in this turn."""
    picture: str
    """Anchor of the turn that shows the picture of the view; this one's if it came here first."""
    source: str
    """How that picture is named within the page."""
    thought: Thought | None
    agent: AgentState | None
    """The body after the turn."""
    started: Started | None = None
    """The instruction that begins with this turn."""
    ended: Ended | None = None
    """How the instruction ended, after its last turn."""
    note: str = ""
    """The reasoning note, or what the model answered in plain text."""
    deeds: tuple[Deed, ...] = ()
    closing: Closing | None = None
    """What Finish said, if the model called it and nothing else."""
    by_hand: tuple[str, ...] = ()
    """What happened meanwhile that the body did not do."""
    tone: str = "view"
    """What kind of turn it is: the tone of its last executed deed, "answer", "empty", "returned"
    (the model had to go on), "unreadable", "cut" or "view"."""

    @property
    def acts(self) -> tuple[Acted, ...]:
        """Everything that was executed."""
        return tuple(deed.act for deed in self.deeds if deed.act)

    @property
    def shows_picture(self) -> bool:
        """Whether the picture appears here for the first time."""
        return self.view is not None and self.picture == self.anchor

    @property
    def title(self) -> str:
        """The call, or the names of several."""
        if len(self.deeds) == 1:
            return str(self.deeds[0].call)
        return ", ".join(deed.call.name for deed in self.deeds)


@dataclass
class _Draft:
    """A turn that is not over yet."""

    turn: ShownTurn
    acts: list[Acted] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    """Why the calls after these were not executed."""
    pictures: dict[int, list[Shown | Observed]] = field(default_factory=dict)
    """By the step of the act that brought them."""


class _Timeline:
    """Gathers events into turns."""

    def __init__(self) -> None:
        self.turns: list[ShownTurn] = []
        self._shown: dict[str, tuple[str, str]] = {}
        """By frame: the turn that shows it, and its name there."""
        self._draft: _Draft | None = None
        self._view: Observed | None = None
        self._agent: AgentState | None = None
        self._fresh = False
        self._started: Started | None = None
        self._by_hand: list[str] = []
        """What happened since the last turn that is closed."""

    def take(self, event: object) -> None:
        match event:
            case Started():
                self._close()
                self._started = event
            case Observed():
                self._observed(event)
            case Thought():
                self._close(went_on=True)
                self._open(event)
            case Acted():
                self._acted(event)
            case LeftOut():
                if self._draft:
                    self._draft.left_out.append(event.why)
            case Happened() | Restored():
                self._by_hand.append(_told(event))
            case Shown():
                if self._draft:
                    self._draft.pictures.setdefault(event.step, []).append(event)
            case Ended():
                self.finish(event)

    def finish(self, ended: Ended | None = None) -> None:
        """Close what is open, at the end of an instruction or of the record."""
        self._close(ended)
        if self._fresh:
            self._open(None)
            self._close(ended)
        if self._by_hand and self.turns:
            last = self.turns[-1]
            self.turns[-1] = replace(last, by_hand=(*last.by_hand, *self._by_hand))
            self._by_hand.clear()

    def _acted(self, event: Acted) -> None:
        draft = self._draft
        if draft is None or draft.turn.thought is None:
            self._close()
            draft = self._open(None)
        draft.acts.append(event)
        self._agent = event.agent

    def _observed(self, event: Observed) -> None:
        before = self._view
        if self._fresh and self._draft and before and before.frame != event.frame:
            # A later call of the same turn brought another view: this one did not last.
            self._draft.pictures.setdefault(before.step, []).append(before)
        self._view, self._agent, self._fresh = event, event.agent, True

    def _open(self, thought: Thought | None) -> _Draft:
        anchor = f"turn-{len(self.turns) + 1}"
        place = (anchor, f"{anchor}-view")
        if self._view:
            place = self._shown.setdefault(self._view.frame, place)
        turn = ShownTurn(anchor, "", self._view, self._fresh, *place, thought, self._agent)
        self._draft = draft = _Draft(replace(turn, started=self._started))
        self._fresh, self._started = False, None
        return draft

    def _close(self, ended: Ended | None = None, *, went_on: bool = False) -> None:
        draft, self._draft = self._draft, None
        if draft is None:
            if ended and self.turns and not self._fresh:
                self.turns[-1] = replace(self.turns[-1], ended=ended)
            return
        turn, thought = draft.turn, draft.turn.thought
        wishes = thought.turn.wishes if thought else ()
        closing = wishes[0] if len(wishes) == 1 and wishes[0].is_finish else None
        deeds = () if closing and not draft.acts else self._deeds(draft, wishes)
        note = next((text for text in _notes(thought, wishes) if text), "")
        turn = replace(
            turn,
            agent=draft.acts[-1].agent if draft.acts else turn.agent,
            ended=None if self._fresh else ended,
            note=note,
            deeds=tuple(_own_notes(note, deeds)),
            by_hand=tuple(self._by_hand),
            closing=Closing.of(closing) if closing else None,
        )
        self._by_hand.clear()
        tone = _tone(turn, ended, went_on=went_on)
        self.turns.append(replace(turn, tone=tone, label=_label(turn, tone)))

    def _deeds(self, draft: _Draft, wishes: Sequence[Wish]) -> tuple[Deed, ...]:
        deeds: list[Deed] = []
        unreadable = draft.turn.thought and draft.turn.thought.reply.unreadable
        unknown = "the answer could not be read" if unreadable else ""
        left_out = iter(draft.left_out)
        # Calls are executed from the first on, so what was executed stands for the first ones.
        for wish, act in zip_longest(wishes, draft.acts):
            deed = _deed(wish, act)
            if act is not None:
                found = draft.pictures.get(act.step, ())
                pictures = tuple(self._picture(draft.turn.anchor, event) for event in found)
                deed = replace(deed, pictures=pictures)
            else:
                deed = replace(deed, left_out=next(left_out, unknown))
            deeds.append(deed)
        return tuple(deeds)

    def _picture(self, anchor: str, event: Shown | Observed) -> Picture:
        name = f"{anchor}-picture-{event.step}-{event.frame[:8]}"
        turn, source = self._shown.setdefault(event.frame, (anchor, name))
        return Picture(name, event, turn, source)


def turns(trajectory: Trajectory) -> tuple[ShownTurn, ...]:
    """Arrange the events of an episode, also of one that was cut off, into turns."""
    timeline = _Timeline()
    for event in trajectory.events:
        timeline.take(event)
    timeline.finish()
    return tuple(timeline.turns)


def _told(event: Happened | Restored) -> str:
    """What happened to the world, in words."""
    if isinstance(event, Restored):
        return "The user put everything back as it was before the instruction."
    who = "by the user" if event.by_user else "from outside"
    match event.event:
        case ObjectMoved(object_id=number):
            return f"Object {number} was moved {who}."
        case ObjectTaken(object_id=number):
            return f"Object {number} was taken away {who}."
        case ObjectAdded(object_id=number):
            return f"Object {number} was brought {who}."
        case LightChanged():
            return f"The light was changed {who}."


def _deed(wish: Wish | None, act: Acted | None) -> Deed:
    if wish is not None:
        call = CallText.of(wish.call.name, wish.arguments, wish.call.raw)
        return Deed(call, wish.note.strip(), wish.confidence, act)
    assert act is not None
    return Deed(CallText.of(act.name, act.arguments), act=act)


def _notes(thought: Thought | None, wishes: Sequence[Wish]) -> Iterator[str]:
    """The text of a reply, and the notes of its calls."""
    if thought:
        yield thought.reply.message.text.strip()
        yield from (wish.note.strip() for wish in wishes)


def _own_notes(note: str, deeds: Sequence[Deed]) -> Iterator[Deed]:
    """The deeds without the notes that stand in the turn already."""
    said = {note}
    for deed in deeds:
        yield replace(deed, note="" if deed.note in said else deed.note)
        said.add(deed.note)


def _tone(turn: ShownTurn, ended: Ended | None, *, went_on: bool) -> str:
    if turn.thought is None and not turn.acts:
        return "view"
    if turn.thought and turn.thought.reply.unreadable:
        return "unreadable"
    if turn.acts:
        return next(deed.tone for deed in reversed(turn.deeds) if deed.act)
    broke = ended is not None and ended.reason is TerminationReason.BROKEN
    if turn.deeds:
        return "returned" if went_on or (ended and not broke) else "cut"
    if not (turn.note or turn.closing):
        return "empty"
    ends = (TerminationReason.ANSWERED, TerminationReason.EMPTY_REPLY)
    stopped = ended is not None and not broke and ended.reason not in ends
    return "returned" if went_on or stopped else "answer"


def _label(turn: ShownTurn, tone: str) -> str:
    if not turn.acts:
        return str(turn.thought.step + 1) if turn.thought and tone == "cut" else ""
    first, last = turn.acts[0].step, turn.acts[-1].step
    return str(first) if first == last else f"{first}–{last}"


def _words(value: object) -> str:
    if value is None:
        return ""
    return value.strip() if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
