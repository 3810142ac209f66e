"""The messages between ADAMO and an engine that dialled in, as dataclasses and JSON Schema.

The engine opens a WebSocket to `/engine` and says hello. From then on ADAMO asks, one request at a
time, and the engine answers, as in JSON-RPC 2.0::

    engine  {"jsonrpc": "2.0", "method": "hello", "params": {"wire": 1, "engine": "Mine", ...}}
    ADAMO   {"jsonrpc": "2.0", "id": 1, "method": "walk", "params": {"body": "agent", ...}}
    engine  {"jsonrpc": "2.0", "id": 1, "result": {...}}
    engine  {"jsonrpc": "2.0", "id": 1, "error": {"code": 1, "message": "why not"}}

Pictures do not fit into JSON: an answer that has some says ``"attachments": N`` beside its result,
and exactly N binary messages follow it, in the order in which the result names them.

All points are in ADAMO's frame: right-handed, Z up, metres (see docs/conventions.md).
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal, cast

from pydantic import TypeAdapter

from adamo_vh.abilities import Abilities
from adamo_vh.action import Code, Outcome
from adamo_vh.engine import BodyInfo, FurnitureOutline, ObjectState, SceneInfo, WorldEvent
from adamo_vh.geometry import Box, Vec3
from adamo_vh.observation import BodyState

WIRE = 1
"""Version of these messages."""
FRAME = "right-handed, z up, metres"
"""The one coordinate frame of the wire."""
NO_OBJECT = 65535
"""Value of a pixel in a picture of ids that shows no object."""

ColourCode = Literal["png", "jpeg", "rgb8"]
IdsCode = Literal["png16", "rgb555", "int16"]


@dataclass(frozen=True, slots=True)
class Hello:
    """The first message: who dials in and what it can do."""

    wire: int
    """Version of the messages that it speaks."""
    engine: str
    """Its name, with its version: "Godot 3.2.3"."""
    frame: str
    """Must be "right-handed, z up, metres": says that the engine translates from its own."""
    abilities: Abilities
    """What it can do beyond what every engine must."""


@dataclass(frozen=True, slots=True)
class Nothing:
    """No parameters, or no result."""


@dataclass(frozen=True, slots=True)
class SceneWish:
    """Load a scene; the engine may answer that it does not have it."""

    scene: str
    figure: str
    """Who the virtual human is: mara, jonas, amina or ken; "" if it does not matter."""


@dataclass(frozen=True, slots=True)
class SceneAnswer:
    """What is always true of the loaded scene."""

    scene: SceneInfo
    object_names: Mapping[int, str]
    """Class of every interactable object, by id."""
    furniture: tuple[FurnitureOutline, ...] = ()
    """May be empty: for drawings and oracles."""


@dataclass(frozen=True, slots=True)
class BodiesAnswer:
    """The bodies by name, the one that acts first."""

    bodies: Mapping[str, BodyInfo]


@dataclass(frozen=True, slots=True)
class ResetWish:
    """Put the world back to its start. Same seed, same world."""

    seed: int


@dataclass(frozen=True, slots=True)
class StateAnswer:
    """Where everything is."""

    objects: tuple[ObjectState, ...]
    """Those in the room or in a hand, by ascending id."""
    bodies: Mapping[str, BodyState]


@dataclass(frozen=True, slots=True)
class CloseAim:
    """Where a close-up looks, from the same eyes."""

    point: Vec3
    fov_y_rad: float


@dataclass(frozen=True, slots=True)
class CaptureWish:
    """Draw what a body sees."""

    body: str
    width_px: int
    height_px: int
    aim: CloseAim | None = None
    """For a close-up; the gaze and the body stay as they are."""


@dataclass(frozen=True, slots=True)
class View:
    """The camera that drew a picture."""

    position: Vec3
    yaw_rad: float
    """Heading of the optical axis; 0 is along +X, counter-clockwise from above."""
    pitch_rad: float
    """Elevation of the optical axis; positive looks up."""
    fov_y_rad: float


@dataclass(frozen=True, slots=True)
class SeenBox:
    """An object with pixels in a picture."""

    id: int
    box: Box
    box_px: tuple[int, int, int, int] | None = None
    """Left, top, right, bottom; right and bottom are exclusive. Only if no ids are sent."""
    pixels: int | None = None
    """How many pixels show it. Only if no ids are sent."""


@dataclass(frozen=True, slots=True)
class CaptureAnswer:
    """A picture; its attachments are the colours and then each layer of ids."""

    camera: View
    body: BodyState
    objects: tuple[SeenBox, ...]
    """Those with a pixel; others may be among them, if ids are sent."""
    colour: ColourCode
    """"png", "jpeg", or "rgb8": rows from the top, three bytes a pixel."""
    ids: IdsCode | None = None
    """"png16": grey PNG of 16 bits; "rgb555": RGB PNG, five bits of the id in each colour,
    red first, each in the middle of a step of 8 (8 bits + 4), since renderers round; "int16": rows
    from the top, two bytes a pixel, low byte first. No object is 65535, or white in RGB."""
    layers: int = 0
    """How many pictures of ids follow: one, or two where the second leaves out transparent things;
    none if boxes are told."""


@dataclass(frozen=True, slots=True)
class RaysWish:
    """First hits of rays; the body and what it holds are passed through."""

    body: str
    origin: Vec3
    directions: tuple[Vec3, ...]
    """Unit vectors."""


@dataclass(frozen=True, slots=True)
class RaysAnswer:
    """One hit, or null, for each direction."""

    hits: tuple[Vec3 | None, ...]


@dataclass(frozen=True, slots=True)
class PointWish:
    """Look at, walk to, or drop at a point."""

    body: str
    point: Vec3


@dataclass(frozen=True, slots=True)
class PickWish:
    """Take an object into the hand."""

    body: str
    object_id: int


@dataclass(frozen=True, slots=True)
class ReportAnswer:
    """How an action went; see `adamo_vh.engine.BodyReport`."""

    outcome: Outcome
    code: Code
    point: Vec3 | None = None
    support: str | None = None
    walked_m: float = 0.0
    stopped_s: float | None = None


@dataclass(frozen=True, slots=True)
class SayWish:
    """Deliver the agent's final answer."""

    body: str
    text: str


@dataclass(frozen=True, slots=True)
class SnapshotAnswer:
    """Everything that decides what happens next, as a text that only the engine reads."""

    snapshot: str


@dataclass(frozen=True, slots=True)
class EventWish:
    """Let something happen that no body does."""

    event: WorldEvent


METHODS: dict[str, tuple[type, type]] = {
    "scene": (SceneWish, SceneAnswer),
    "bodies": (Nothing, BodiesAnswer),
    "reset": (ResetWish, Nothing),
    "state": (Nothing, StateAnswer),
    "capture": (CaptureWish, CaptureAnswer),
    "rays": (RaysWish, RaysAnswer),
    "look": (PointWish, ReportAnswer),
    "walk": (PointWish, ReportAnswer),
    "pick": (PickWish, ReportAnswer),
    "drop": (PointWish, ReportAnswer),
    "say": (SayWish, Nothing),
    "snapshot": (Nothing, SnapshotAnswer),
    "restore": (SnapshotAnswer, Nothing),
    "apply": (EventWish, Nothing),
}
"""What ADAMO asks for: the parameters and the result of each method."""


@cache
def _codec(kind: Hashable) -> TypeAdapter[Any]:
    return TypeAdapter(cast(type, kind))


def codec(kind: type) -> TypeAdapter[Any]:
    """Reads and writes one kind of message."""
    return _codec(kind)


def wire_schema() -> dict[str, Any]:
    """The JSON Schema of all messages."""
    kinds = [Hello, *(kind for pair in METHODS.values() for kind in pair)]
    mode: Literal["validation"] = "validation"
    inputs = [(kind, mode, codec(kind)) for kind in dict.fromkeys(kinds)]
    refs, definitions = TypeAdapter.json_schemas(inputs)
    methods = {
        name: {"params": refs[wish, "validation"], "result": refs[answer, "validation"]}
        for name, (wish, answer) in METHODS.items()
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "What an engine that dials in to ADAMO says and is asked",
        "wire": WIRE,
        "hello": refs[Hello, "validation"],
        "methods": methods,
        **definitions,
    }
