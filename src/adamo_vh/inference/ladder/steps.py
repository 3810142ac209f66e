"""One step of a model that has no tool calls, and the forms in which it is written and read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from adamo_vh.action import ToolSchema
from adamo_vh.inference.model import Rung
from adamo_vh.inference.tool_names import meant_tool

FINISH = "finish"
"""The action that ends an episode with an answer, unless a tool of this name does."""
NOTE = "note"
"""Argument of a tool that says what the thought of a step says; it is taken from there."""


@dataclass(frozen=True, slots=True)
class Step:
    """A thought, and an action or a final answer."""

    thought: str
    action: str | None = None
    """Name of a tool; None for a final answer."""
    args: Mapping[str, Any] = field(default_factory=dict)
    answer: str = ""
    """The final answer."""
    is_whole: bool = field(default=False, compare=False)
    """Whether its end can be seen: the closing bracket of its arguments."""


@dataclass(frozen=True, slots=True)
class Unreadable:
    """A text that is no step."""

    problem: str
    """What could not be read, as a sentence for the model."""


class Form(Protocol):
    """A way to write steps."""

    @property
    def rung(self) -> Rung:
        """Which rung of the ladder it is."""
        ...

    @property
    def name(self) -> str:
        """Name of its prompt file."""
        ...

    @property
    def result_label(self) -> str:
        """What the results of actions begin with."""
        ...

    def schema(self, tools: Sequence[ToolSchema]) -> ToolSchema | None:
        """The schema that a server is to hold the answer to, if any."""
        ...

    def write(self, step: Step) -> str:
        """A step as the model should have written it."""
        ...

    def read(self, text: str, tools: Sequence[ToolSchema]) -> Step | Unreadable:
        """Read what a model wrote."""
        ...


def ends_by_answer(tools: Sequence[ToolSchema]) -> bool:
    """Whether a plain answer ends the episode: no tool on offer does."""
    return all(tool.name.casefold() != FINISH for tool in tools)


def takes_note(tool: ToolSchema) -> bool:
    """Whether a tool wants a note among its arguments."""
    return NOTE in tool.parameters.get("properties", {})


def own_parameters(tool: ToolSchema) -> dict[str, Any]:
    """The schema of a tool's arguments without the note, which the thought stands for."""
    given = tool.parameters
    properties = {k: v for k, v in given.get("properties", {}).items() if k != NOTE}
    required = [name for name in given.get("required", ()) if name != NOTE]
    return {**given, "type": "object", "properties": properties, "required": required}


def known_tool(name: str, tools: Sequence[ToolSchema]) -> ToolSchema | None:
    """The tool that a name means."""
    meant = meant_tool(name, (tool.name for tool in tools))
    return next((tool for tool in tools if tool.name == meant), None)


def action_step(
    thought: str,
    name: str,
    args: Mapping[str, Any],
    tools: Sequence[ToolSchema],
    *,
    is_whole: bool = True,
) -> Step:
    """The step that an action comes to; `FINISH` is an answer if no tool is called so."""
    tool = known_tool(name, tools)
    if tool is None and name.casefold() == FINISH:
        return Step(thought, answer=str(args.get("answer") or "").strip() or thought)
    return Step(thought, name if tool is None else tool.name, args, is_whole=is_whole)
