"""A room of text for the baseline's tests: objects on one table, told as the prompt tells them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from adamo_vh.action import Drop, Look, Pick, ToolSchema, Walk, tool_schema
from adamo_vh.geometry import Vec3, wrap_angle
from adamo_vh.inference.baseline import BaselineModel
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    Message,
    SystemMessage,
    TextPart,
    ToolMessage,
)
from adamo_vh.inference.model import Sampling

TOOLS: list[ToolSchema] = [tool_schema(action) for action in (Look, Walk, Pick, Drop)]
_NOTE = {"note": {"type": "string"}, "confidence": {"type": "number"}}
INSTRUCTIONS = (
    "- The room spans x from -3 to 3 and y from -5 to 3. Its four corner areas are the 1 x 1 m "
    'squares in the corners of the floor.\n- "Near" and "next to" mean: centres within 0.3 m '
    "horizontally, on the same surface."
)
TABLE_Z_M = 0.78
_HALF_VIEW_RAD = math.radians(48)


@dataclass(frozen=True, slots=True)
class Item:
    """An object of the text room."""

    tag: str
    position: Vec3
    volume_cm3: float
    height_m: float
    support: str = "on the table"


def table_items(opaque: bool = False) -> dict[str, Item]:
    """Nineteen household things on a table, by tag."""
    rows = [
        ("Lock", 0, 0.08, -1.35, 69, 0.077),
        ("Flashlight", 2, -0.36, -0.85, 364, 0.045),
        ("Battery", 3, -0.17, -0.85, 113, 0.077),
        ("Tape", 4, -0.17, -0.60, 795, 0.043),
        ("Screwdriver", 5, -0.36, -1.15, 105, 0.021),
        ("PeanutButter", 8, 0.08, -0.85, 1782, 0.15),
        ("Lock", 18, -0.17, -1.35, 98, 0.062),
        ("TomatoSoup", 19, 0.08, -1.60, 514, 0.105),
        ("Pills", 20, -0.42, -1.35, 257, 0.085),
        ("Binoculars", 21, 0.08, -0.35, 2292, 0.069),
        ("Painkiller", 23, -0.42, -1.60, 237, 0.112),
        ("Lighter", 27, -0.17, -1.10, 139, 0.09),
        ("Battery", 30, 0.08, -1.10, 41, 0.082),
        ("Key", 34, -0.17, -1.60, 2.6, 0.002),
        ("WineBottle", 36, 0.33, -1.60, 972, 0.241),
        ("Glass", 37, 0.33, -1.10, 1430, 0.143),
        ("Cup", 45, -0.42, -0.35, 2050, 0.131),
        ("IndoorPlant", 50, 0.33, -1.35, 21250, 0.34),
        ("Plate", 57, 0.33, -0.60, 1875, 0.03),
    ]
    items = {}
    for name, number, x, y, volume, height in rows:
        tag = str(number) if opaque else f"{name}_{number}"
        items[tag] = Item(tag, Vec3(x, y, TABLE_Z_M + height / 2), float(volume), height)
    return items


@dataclass(slots=True)
class TextRoom:
    """Plays an instruction against the baseline, step by step, and keeps the prompt as told."""

    instruction: str
    items: dict[str, Item] = field(default_factory=table_items)
    full: bool = True
    k: int = 50
    body: Vec3 = Vec3(-2.0, -1.0, 0.0)
    heading_rad: float = 0.0
    held: str | None = None
    steps: list[tuple[Message, ...]] = field(default_factory=list)
    calls: list[tuple[str, Mapping[str, object]]] = field(default_factory=list)
    answer: str = ""
    _shown: str = ""

    def __post_init__(self) -> None:
        self._look()

    def _look(self) -> None:
        lines = []
        for item in self.items.values():
            to = item.position - self.body
            turn = wrap_angle(math.atan2(to.y, to.x) - self.heading_rad)
            if abs(turn) < _HALF_VIEW_RAD or item.tag == self.held:
                p = item.position
                box = ", box [10, 10, 40, 40] px" if self.full else ""
                lines.append(
                    f"- {item.tag}: center ({p.x:.3f}, {p.y:.3f}, {p.z:.3f}), "
                    f"volume {item.volume_cm3:.1f} cm3{box}"
                )
        self._shown = "\n".join(lines) or "none"

    def messages(self) -> list[Message]:
        """The prompt as the memory would build it."""
        p = self.body
        state = f"## Visible objects\n{self._shown}\n\n## Reference points\nnone\n\n## You\n"
        state += f"- position ({p.x:.2f}, {p.y:.2f}, {p.z:.2f})"
        if self.full:
            degrees = round(math.degrees(self.heading_rad)) % 360
            state += f"\n- heading {degrees} deg\n- hand: {self.held or 'empty'}"
        prompt: list[Message] = [
            SystemMessage(INSTRUCTIONS),
            SystemMessage(state),
            HumanMessage((TextPart(self.instruction),)),
        ]
        for step in self.steps[-self.k :]:
            prompt.extend(step)
        return prompt

    def run(self, cap: int = 60) -> TextRoom:
        """Let the baseline play to its final answer."""
        model = BaselineModel()
        for _ in range(cap):
            message = model.complete(self.messages(), TOOLS, Sampling()).message
            if not message.calls:
                self.answer = message.text
                return self
            call = message.calls[0]
            arguments = dict(call.arguments or {})
            self.calls.append((call.name, arguments))
            text = self._act(call.name, arguments)
            told: list[Message] = [message, ToolMessage(call.id, call.name, text)]
            if call.name == "Look":
                told.append(HumanMessage((TextPart("New view after your Look."),)))
            self.steps.append(tuple(told))
        raise AssertionError(f"no answer after {cap} steps: {self.steps[-1]}")

    def _act(self, name: str, arguments: Mapping[str, object]) -> str:
        if name in ("Look", "Walk", "Drop"):
            point = Vec3(*(float(str(arguments[axis])) for axis in "xyz"))
        if name == "Look":
            self.heading_rad = math.atan2(point.y - self.body.y, point.x - self.body.x)
            self._look()
            return f"Done: looking at {point}."
        if name == "Walk":
            self.body = Vec3(point.x, point.y, 0.0)
            return f"Done: walked 1.00 m to {self.body}."
        tag = str(arguments["object"])
        if name == "Pick":
            if self.held:
                return f"Refused: your hand already holds {self.held}; drop it first."
            if tag not in self.items:
                return f"Refused: there is no {tag}."
            self.held = tag
            return f"Done: {tag} is in your hand."
        return self._drop(tag, point)

    def _drop(self, tag: str, point: Vec3) -> str:
        if self.held != tag:
            return f"Refused: {tag} is not in your hand."
        item = self.items[tag]
        on_table = point.z > 0.4
        rest = Vec3(point.x, point.y, (TABLE_Z_M if on_table else 0.0) + item.height_m / 2)
        support = "on the table" if on_table else "on the floor"
        self.items[tag] = replace(item, position=rest, support=support)
        self.held = None
        return f"Done: {tag} rests at {rest} {support}."

    def near(self, one: str, other: str) -> bool:
        """Whether two things stand near each other on one surface."""
        a, b = self.items[one], self.items[other]
        return a.position.horizontal_distance(b.position) <= 0.3 and a.support == b.support

    def on_floor(self) -> set[str]:
        """Ids of what lies on the floor."""
        return {
            tag.rsplit("_", 1)[-1]
            for tag, item in self.items.items()
            if item.support == "on the floor"
        }


def with_notes(tool: ToolSchema) -> ToolSchema:
    """A tool that wants a note and a confidence as its first arguments."""
    own = tool.parameters
    properties = {**_NOTE, **own.get("properties", {})}
    required = [*_NOTE, *own.get("required", [])]
    parameters = {**own, "properties": properties, "required": required}
    return ToolSchema(tool.name, tool.description, parameters)


FINISH = ToolSchema(
    "Finish",
    "End the episode.",
    {
        "type": "object",
        "properties": {n: {"type": "string"} for n in ("asked", "verified", "unseen", "answer")},
        "required": ["asked", "verified", "unseen", "answer"],
    },
)
SEVERAL = "\n- You may make several calls in one turn, up to 8, when each follows."


@dataclass(slots=True)
class LeanRoom(TextRoom):
    """The same room, told as what changed; each of the other habits can be switched off."""

    notes: bool = True
    finish: bool = True
    plan: bool = True
    told: list[Message] = field(default_factory=list)
    known: dict[str, str] = field(default_factory=dict)
    turns: int = 0
    finished: Mapping[str, object] = field(default_factory=dict)

    @property
    def tools(self) -> list[ToolSchema]:
        """The tools on offer."""
        offered = [*TOOLS, FINISH] if self.finish else TOOLS
        return [with_notes(tool) for tool in offered] if self.notes else offered

    def messages(self) -> list[Message]:
        """The prompt so far."""
        if not self.told:
            parts = (TextPart(self.instruction), TextPart(self._view()))
            self.told = [SystemMessage(INSTRUCTIONS + SEVERAL * self.plan), HumanMessage(parts)]
        return list(self.told)

    def run(self, cap: int = 60) -> LeanRoom:
        """Let the baseline play to its end."""
        for _ in range(cap):
            message = BaselineModel().complete(self.messages(), self.tools, Sampling()).message
            self.turns += 1
            if not message.calls or message.calls[0].name == "Finish":
                self.finished = dict(message.calls[0].arguments or {}) if message.calls else {}
                self.answer = str(self.finished.get("answer", message.text))
                return self
            self.told.append(message)
            self._turn(message)
        raise AssertionError(f"no answer after {cap} turns: {self.told[-1]}")

    def _turn(self, message: AIMessage) -> None:
        results: list[tuple[str, str, str]] = []
        for call in message.calls:
            arguments = dict(call.arguments or {})
            assert ("note" in arguments) == ("confidence" in arguments) == self.notes
            assert bool(message.text) != self.notes
            if results and not results[-1][2].startswith("Done"):
                results.append((call.id, call.name, "Not executed: a surprise before."))
                continue
            own = {k: v for k, v in arguments.items() if k not in ("note", "confidence")}
            self.calls.append((call.name, own))
            text = self._act(call.name, own)
            seen = "\n\n" + self._view(now=call is message.calls[-1]) if text[0] == "D" else ""
            results.append((call.id, call.name, text + seen))
        self.told += [ToolMessage(*result) for result in results]

    def _view(self, now: bool = True) -> str:
        """What is new or has moved since it was last told, the body, and what is in view."""
        lines: dict[str, list[str]] = {"New in view": [], "Moved": []}
        in_view = []
        for item in self.items.values():
            to = item.position - self.body
            turn = wrap_angle(math.atan2(to.y, to.x) - self.heading_rad)
            if item.tag == self.held or abs(turn) >= _HALF_VIEW_RAD:
                continue
            in_view.append(f"{item.tag} [10, 10, 40, 40]" if self.full else item.tag)
            p = item.position
            place = f"({p.x:.3f}, {p.y:.3f}, {p.z:.3f})"
            line = f"- {item.tag}: center {place}, volume {item.volume_cm3:.1f} cm3"
            if self.known.get(item.tag) != line:
                lines["Moved" if item.tag in self.known else "New in view"].append(line)
            self.known[item.tag] = line
        text = [f"{title}:\n" + "\n".join(told) for title, told in lines.items() if told]
        p = self.body
        you = f"You: position ({p.x:.2f}, {p.y:.2f}, {p.z:.2f})"
        if self.full:
            degrees = round(math.degrees(self.heading_rad)) % 360
            you += f", heading {degrees} deg, hand: {self.held or 'empty'}"
        if now:
            you += f"\n\n# The view now\nIn view: {', '.join(in_view) or 'none'}"
            you += "\nReference points: none"
        return "\n".join([*text, you])
