"""What a server offers to MCP clients: which episodes, with which tools."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.benchmark.tasks import builtin_tasks
from adamo_vh.cognition.turns import offered
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import ConfigError
from adamo_vh.inference.model import Isolation
from adamo_vh.inference.players.outside import UNKNOWN
from adamo_vh.perception import Labeling
from adamo_vh.record.turn import FINISH, NOTE
from adamo_vh.session.bodies import tools_for
from adamo_vh.session.builtin import scene_names

EPISODE, ANSWER = "episode", "answer"
"""Arguments that the tools have here beside their own."""
NEW, LOOK_AGAIN, INSTRUCTIONS, END = "new_episode", "observe", "instructions", "finish"
"""Tools beside those of the body; the last one only where the profile has none of its own."""
LONGEST = 4000
"""Characters of an instruction or an answer."""
_ANY = "Look round."
"""Stands in for the instruction where only the rest of the settings matters."""


@dataclass(frozen=True, slots=True)
class Offer:
    """What a server plays, and how much of it."""

    settings: Mapping[str, Any] = field(default_factory=dict)
    """How every episode is set up, as for `EpisodeConfig.of`; with a task or an instruction there
    is this one episode alone."""
    root: Path = Path("runs")
    """The run folders lie below it."""
    fixed: Path | None = None
    """Run folder of the one episode; its name is the id of the episode."""
    most: int = 16
    """Episodes at once."""
    idle_s: float = 1800.0
    """An episode of which nothing is heard for so long is closed; it can be gone on with."""
    player: str = ""
    """Who plays, if that is known; else clients say it themselves."""
    isolation: Isolation = UNKNOWN
    """How far the players are kept from all but their bodies; see `ModelInfo`."""

    def __post_init__(self) -> None:
        """Refuse what no episode can be played with."""
        self.config()

    @property
    def has_one(self) -> bool:
        """Whether there is one episode alone, which was set up beforehand."""
        return bool(self.settings.get("task") or self.settings.get("instruction"))

    def config(self, wishes: Mapping[str, Any] | None = None) -> EpisodeConfig:
        """How an episode is set up.

        Args:
            wishes: What a client asks for; nothing, for the one episode that is set up, or for
                what is common to all.

        Raises:
            ConfigError: A wish cannot be met.
        """
        wanted = {**self.settings, **_checked(wishes or {})}
        if not (wanted.get("task") or wanted.get("instruction")):
            if wishes is not None:
                raise ConfigError("Say what to do: give a task (T1 to T15) or an instruction.")
            wanted["instruction"] = _ANY
        instruction = wanted.pop("instruction", None)
        return EpisodeConfig.of(instruction or None, **wanted)

    @property
    def finish(self) -> str:
        """Name of the tool that ends an episode."""
        return FINISH if self.config().profile.finish_check else END

    def tools(self) -> Sequence[ToolSchema]:
        """All tools, with the id of the episode among their arguments."""
        config = self.config()
        profile = config.profile
        acting = offered([tool.action_type for tool in tools_for(config)], profile)
        if not profile.note_argument:
            acting = [_with(schema, NOTE, _NOTE, required=False) for schema in acting]
        if not profile.finish_check:
            acting.append(_FINISH)
        own = [_OBSERVE, _INSTRUCTIONS]
        with_id = [_with(schema, EPISODE, _EPISODE) for schema in (*own, *acting)]
        return with_id if self.has_one else [_new_episode(), *with_id]


def _checked(wishes: Mapping[str, Any]) -> dict[str, Any]:
    """What a client asks for. It may name what comes with the package, and no files.

    Raises:
        ConfigError: A wish is unknown or wrong.
    """
    fields = _new_episode().parameters["properties"]
    if unknown := sorted(wishes.keys() - fields.keys()):
        raise ConfigError(f"new_episode takes no {unknown[0]!r:.50}; use {', '.join(fields)}.")
    found = {name: value for name, value in wishes.items() if value not in (None, "")}
    for name, value in found.items():
        wanted: dict[str, Any] = fields[name]
        kind = int if wanted["type"] == "integer" else str
        if not isinstance(value, kind) or isinstance(value, bool):
            raise ConfigError(f"{name} is {value!r:.50}; give {_KINDS[kind]}.")
        if isinstance(value, str) and len(value) > LONGEST:
            raise ConfigError(f"{name} has {len(value)} characters; use at most {LONGEST}.")
        offer = wanted.get("enum")
        if offer and value not in offer:
            # Only a name that is spelt otherwise is meant.
            same = [name for name in offer if name.lower() == str(value).lower()]
            if not same:
                raise ConfigError(f"There is no {name} {value!r:.50}; use {', '.join(offer)}.")
            found[name] = same[0]
    return found


_KINDS: Mapping[type, str] = {int: "a whole number", str: "a text"}
_EPISODE = {"type": "string", "description": "Id of your episode."}
_NOTE = {
    "type": "string",
    "description": "Your reasoning: what the evidence is, what you conclude, what comes next.",
}


def _with(
    schema: ToolSchema, name: str, field: Mapping[str, Any], *, required: bool = True
) -> ToolSchema:
    """A tool with one more argument, before its own."""
    own = schema.parameters
    parameters = {
        **own,
        "properties": {name: dict(field), **own.get("properties", {})},
        "required": [*([name] if required else []), *own.get("required", [])],
    }
    return ToolSchema(schema.name, schema.description, parameters)


def _tool(name: str, description: str, **properties: Mapping[str, Any]) -> ToolSchema:
    return ToolSchema(
        name, description, {"type": "object", "properties": properties, "required": []}
    )


_OBSERVE = _tool(
    LOOK_AGAIN, "Get again what you were told last, with the latest picture. Costs no step."
)
_INSTRUCTIONS = _tool(
    INSTRUCTIONS,
    "Read what you are asked to do, how the world works and what happened so far. Costs no step.",
)
_FINISH = ToolSchema(
    END,
    "End the episode, when everything is done or cannot be done.",
    {
        "type": "object",
        "properties": {ANSWER: {"type": "string", "description": "A short sentence for the user."}},
        "required": [ANSWER],
    },
)


@cache
def _new_episode() -> ToolSchema:
    tasks = [task.id for task in builtin_tasks()]
    whole = {"type": "integer", "minimum": 0}
    return _tool(
        NEW,
        "Begin an episode: a task of the benchmark, or an instruction in your user's words.",
        task={"type": "string", "enum": tasks, "description": "A task of the benchmark."},
        instruction={"type": "string", "description": "What to do, if it is no task."},
        scene={"type": "string", "enum": list(scene_names()), "description": "The room."},
        labeling={
            "type": "string",
            "enum": [str(labeling) for labeling in Labeling],
            "description": "Whether tags tell what an object is (sem) or not (opaq).",
        },
        seed={**whole, "description": "Of every draw."},
        variation={**whole, "description": "Another layout of the same room; 0 as it stands."},
    )
