"""An episode as a reader goes through it: turns of seeing, thinking, acting and being told.

A pure function over the recorded events. A turn begins with the view that the model read, so a
frame that a `Look` brings belongs to the turn after it.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from adamo.cognition.trajectory import Acted, Observed, Thought, Trajectory
from adamo.inference.messages import ToolCall
from adamo.observation import AgentState


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
class Turn:
    """One time around the loop."""

    anchor: str
    """Names the turn within the page."""
    label: str
    """Number of the step, or a word for a turn that is none."""
    view: Observed | None
    """The latest view when the model was asked."""
    arrived: bool
    """Whether that view is new in this turn."""
    picture: str
    """Anchor of the turn that shows the picture of the view; this one's if it came here first."""
    thought: Thought | None
    act: Acted | None
    agent: AgentState | None
    """The body after the turn."""

    @property
    def call(self) -> CallText | None:
        """The call that counts in this turn."""
        if self.thought and self.thought.calls:
            return _spelt(self.thought.calls[0])
        return CallText.of(self.act.name, self.act.arguments) if self.act else None

    @property
    def ignored(self) -> tuple[CallText, ...]:
        """Further calls of the same message; only the first one is executed."""
        return tuple(_spelt(call) for call in self.thought.calls[1:]) if self.thought else ()

    @property
    def shows_picture(self) -> bool:
        """Whether the picture appears here for the first time."""
        return self.view is not None and self.picture == self.anchor

    @property
    def tone(self) -> str:
        """What kind of turn it is: an outcome, "answer", "empty", "cut" or "view"."""
        if self.act:
            return self.act.feedback.outcome.value
        if self.thought is None:
            return "view"
        if self.thought.calls:
            return "cut"
        return "answer" if self.thought.note.strip() else "empty"


def turns(trajectory: Trajectory) -> tuple[Turn, ...]:
    """Arrange the events of an episode, also of one that was cut off, into turns."""
    found: list[Turn] = []
    shown: dict[str, str] = {}
    view: Observed | None = None
    agent: AgentState | None = None
    fresh = False

    def begin(label: str, thought: Thought | None) -> None:
        anchor = f"turn-{len(found) + 1}"
        picture = shown.setdefault(view.frame, anchor) if view else anchor
        found.append(Turn(anchor, label, view, fresh, picture, thought, None, agent))

    for event in trajectory.events:
        match event:
            case Observed():
                view, agent, fresh = event, event.agent, True
            case Thought():
                begin(str(event.step + 1) if event.calls else "", event)
                fresh = False
            case Acted():
                agent = event.agent
                if not found or found[-1].act or found[-1].tone != "cut":
                    begin(str(event.step), None)
                    fresh = False
                found[-1] = replace(found[-1], act=event, agent=agent)
    if fresh:
        begin("", None)
    return tuple(found)


def _spelt(call: ToolCall) -> CallText:
    return CallText.of(call.name, call.arguments, call.raw)
