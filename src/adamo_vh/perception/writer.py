"""The symbolic state as text: whole, or as what changed since it was last told."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from adamo_vh.observation import AgentState, Observation, ObservedObject, ReferencePoint
from adamo_vh.perception.symbolic import NONE, TextForm, agent_lines, object_lines, point_lines
from adamo_vh.render import render_from


@dataclass(frozen=True, slots=True)
class Wording:
    """Which fields the text has, and how many words it makes of them."""

    form: TextForm = TextForm.FULL
    terse: bool = False
    boxes: bool = True
    """Whether there is a frame for the boxes of objects to be in."""

    def objects(self, objects: Iterable[ObservedObject]) -> str:
        """One line for each object, with its box in the frame where the form has it."""
        if not self.terse:
            return object_lines(objects, self.form if self.boxes else TextForm.PAPER)
        return "\n".join(map(self.lasting, objects)) or NONE

    def lasting(self, item: ObservedObject) -> str:
        """Where an object is: true also when it is out of view."""
        if not self.terse:
            return object_lines([item], TextForm.PAPER)
        return f"- {item.tag} {item.position.text(2, ',')}, {item.volume_m3 * 1e6:.0f} cm3"

    def in_view(self, item: ObservedObject) -> str:
        """An object as it is seen now."""
        if self.terse:
            return item.short or item.tag
        if self.form is TextForm.PAPER or not self.boxes:
            return item.tag
        return f"{item.tag} [{', '.join(map(str, item.box_px))}]"

    def points(self, points: Iterable[ReferencePoint]) -> str:
        """One line for each reference point; all on one line where words are few."""
        if not self.terse:
            return point_lines(points)
        return ", ".join(f"{point.tag} {point.position.text(2, ',')}" for point in points) or NONE

    def agent(self, agent: AgentState) -> str:
        """The body now."""
        return agent_lines(agent, self.form)


class SymbolicState:
    """All of it: objects and points of a view, which are written once, and the body at a moment."""

    def __init__(self, view: Observation, wording: Wording) -> None:
        """Write a view down."""
        self._wording = wording
        self._objects = wording.objects(view.objects)
        self._points = wording.points(view.points)

    def text(self, agent: AgentState) -> str:
        """The view, and the body now."""
        return render_from(
            "adamo_vh.perception.prompts",
            "symbolic_state",
            view="frame" if self._wording.boxes else "view",
            objects=self._objects,
            points=self._points,
            agent=self._wording.agent(agent),
        )


@dataclass
class Told:
    """What a reader of the conversation knows so far: each thing is said once, until it changes."""

    wording: Wording
    _objects: dict[str, str] = field(default_factory=dict)
    _agent: str = ""

    def changes(self, view: Observation | None, agent: AgentState) -> str:
        """Say what a view and the body's state add to what was told; empty if nothing."""
        parts = []
        if view is not None:
            # What is in the hand moves with it and needs no word.
            resting = [item for item in view.objects if item.tag != agent.held]
            lines = {item.tag: self.wording.lasting(item) for item in resting}
            new = [line for tag, line in lines.items() if tag not in self._objects]
            moved = [line for tag, line in lines.items() if self._objects.get(tag, line) != line]
            self._objects.update(lines)
            parts += ["\n".join(["New in view:", *new])] if new else []
            parts += ["\n".join(["Moved:", *moved])] if moved else []
        you = ", ".join(_items(self.wording.agent(agent)))
        if you != self._agent:
            self._agent = you
            parts.append(f"You: {you}")
        return "\n".join(parts)


def view_now(view: Observation, wording: Wording) -> str:
    """What belongs to a picture and is dropped with it: what is in view, and reference points."""
    tags = ", ".join(map(wording.in_view, view.objects)) or NONE
    points = wording.points(view.points)
    if not wording.terse:
        points = ", ".join(item.replace(":", "", 1) for item in _items(points)) or NONE
    return f"# The view now\nIn view: {tags}\nReference points: {points}"


def _items(lines: str) -> list[str]:
    return [line.removeprefix("- ") for line in lines.splitlines() if line.startswith("- ")]
