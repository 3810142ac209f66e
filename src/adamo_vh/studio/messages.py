"""What the server tells the page, and what the page may ask: the words of the studio's wire."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, cast

from pydantic import AfterValidator, ConfigDict, Field, TypeAdapter, ValidationError

from adamo_vh.engine import BodyInfo, FurnitureOutline, ObjectState
from adamo_vh.episode.result import Manifest
from adamo_vh.errors import ConfigError
from adamo_vh.inference.model import Spent
from adamo_vh.readable import readable
from adamo_vh.record.trajectory import Event, Observed, Shown, codec, frame_type
from adamo_vh.session.posing import RATE_HZ, Pose, joint_names

Message = dict[str, Any]
"""What the page is told, ready for JSON: `n`, `t` and `type`, and what belongs to the type."""
Doing = Literal["idle", "seeing", "thinking", "acting", "asking", "waiting_for_you", "closed"]
Level = Literal["info", "warning", "error"]
Href = Callable[[str], str]
"""Where a picture can be had, by its name."""

SPEEDS = (0.5, 1.0, 2.0, 4.0)
"""How much faster than real time simulated time may pass."""
MAX_MESSAGE_BYTES = 64_000
"""Of what the page asks."""
_STRICT = ConfigDict(extra="forbid")
_Metres = Annotated[float, Field(ge=-50, le=50, allow_inf_nan=False)]


@dataclass(frozen=True, slots=True)
class Places:
    """Where the page finds what belongs to a track; empty for what is not to be had."""

    scene: str = ""
    figure: str = ""


@dataclass(frozen=True, slots=True)
class Part:
    """Who tells a track, and what the page may do with it."""

    name: str
    """Of the room, or of the run."""
    is_live: bool
    controls: tuple[str, ...] = ()
    """Types of the messages that the page may send."""


def hello(part: Part, manifest: Manifest, body: BodyInfo | None, title: str, at: Places) -> Message:
    """The first message of a track: what there is.

    Args:
        part: Who tells it.
        manifest: How the episode is set up, and how its world began.
        body: Who lives in it; None if the engine is not here to say.
        title: Of the scene.
        at: Where meshes can be had.
    """
    config, initial = manifest.config, manifest.initial
    scene = initial.scene
    told = {
        "n": 0,
        "t": 0.0,
        "type": "hello",
        "room" if part.is_live else "run": part.name,
        "live": part.is_live,
        "settings": {
            "instruction": config.instruction,
            "task": config.task,
            "scene": config.scene,
            "variation": scene.variation,
            "figure": Path(config.figure).name,
            "model": manifest.model_name,
            "model_kind": str(manifest.model_kind),
            "profile": str(config.profile),
            "labeling": manifest.labeling or config.labeling.value,
            "resolution": list(config.resolution),
            "k": config.k,
            "started_at": manifest.started_at,
        },
        "scene": {
            "name": scene.name,
            "title": title,
            "x_min": scene.x_min,
            "x_max": scene.x_max,
            "y_min": scene.y_min,
            "y_max": scene.y_max,
            "height_m": scene.height_m,
            "glb": at.scene,
            "objects": [_object(item, config.labeling.tag) for item in initial.objects],
            "furniture": [_furniture(piece) for piece in initial.furniture],
            "areas": [asdict(area) for area in scene.areas],
        },
        "body": None if body is None else _body(body),
        "figure": {"name": Path(config.figure).name, "glb": at.figure},
        "joints": list(joint_names()),
        "rate": RATE_HZ,
        "controls": list(part.controls),
    }
    return cast(Message, _shown(told))


def _object(item: ObjectState, tag: Callable[[int, str], str]) -> Message:
    size = item.box.size
    return {
        "id": item.id,
        "class_name": item.class_name,
        "tag": tag(item.id, item.class_name),
        "size": [size.x, size.y, size.z],
        "node": f"object/{item.id}",
    }


def _furniture(piece: FurnitureOutline) -> Message:
    xs, ys = [x for x, _ in piece.points], [y for _, y in piece.points]
    spans = ((min(xs), max(xs)), (min(ys), max(ys)), (piece.bottom_m, piece.top_m))
    return {
        "name": piece.name,
        "node": f"furniture/{piece.name}",
        "center": [round((low + high) / 2, 4) for low, high in spans],
        "size": [round(high - low, 4) for low, high in spans],
        "outline": [list(point) for point in piece.points],
    }


def _body(body: BodyInfo) -> Message:
    return {
        "reach_m": body.reach_m,
        "reach_top_m": body.reach_top_m,
        "radius_m": body.radius_m,
        "eye_height_m": body.eye_height_m,
        "fov_y_rad": body.fov_y_rad,
    }


def pose(shown: Pose) -> Message:
    """How figure and things stand; what did not change is left out."""
    told: Message = {
        "type": "pose",
        "body": shown.body,
        "pelvis": shown.pelvis,
        "joints": shown.joints,
        "eyes": shown.eyes,
        "held": shown.held,
    }
    if shown.things:
        told["things"] = shown.things
    if shown.gone is not None:
        told["gone"] = shown.gone
    if shown.lights is not None:
        told["lights"] = shown.lights
    return told


def event(happened: Event, href: Href) -> Message:
    """An event of the record, without the saved states, which are of no use to a page."""
    told = _shown(codec().dump_python(happened, mode="json"))
    told.pop("saved", None)
    frame = ""
    if isinstance(happened, Observed | Shown) and frame_type(happened.frame):
        frame = href(happened.frame)
    return {"type": "event", "event": told, "frame": frame}


def _shown(value: Any) -> Any:
    """Data of a record as people may read it, whoever wrote it."""
    if isinstance(value, str):
        return readable(value, lines=True)
    if isinstance(value, list):
        return [_shown(item) for item in value]
    if isinstance(value, dict):
        return {readable(str(key)): _shown(item) for key, item in value.items()}
    return value


def status(doing: Doing, speed: float, spent: Spent, *, can_undo: bool) -> Message:
    """What is being done."""
    usage = spent.usage
    return {
        "type": "status",
        "doing": doing,
        "speed": speed,
        "spent": {
            "input_tokens": usage.input_tokens,
            "output_tokens": usage.output_tokens,
            "usd": spent.cost_usd,
        },
        "can_undo": can_undo,
    }


def asked(calls: Sequence[Mapping[str, Any]], note: str) -> Message:
    """What she is about to do, if one lets her."""
    return {"type": "asked", "calls": calls, "note": note}


def notice(text: str, level: Level = "info") -> Message:
    """A sentence for who looks on."""
    return {"type": "notice", "text": readable(text, lines=True), "level": level}


# --- from the page ------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Say:
    """Give an instruction; what is being done is stopped first."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    text: Annotated[str, Field(min_length=1, max_length=4000)]
    type: Literal["say"] = "say"


@dataclass(frozen=True, slots=True)
class Stop:
    """Stop what is being done, at the moment that is shown."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    type: Literal["stop"] = "stop"


@dataclass(frozen=True, slots=True)
class Undo:
    """Put everything back as it was before the last instruction."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    type: Literal["undo"] = "undo"


@dataclass(frozen=True, slots=True)
class Move:
    """Put an object elsewhere."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    object_id: Annotated[int, Field(strict=True, ge=0, le=9999)]
    point: tuple[_Metres, _Metres, _Metres]
    type: Literal["move"] = "move"


@dataclass(frozen=True, slots=True)
class Act:
    """Make a call, where a person is the mind."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    name: Annotated[str, Field(min_length=1, max_length=60)]
    arguments: dict[str, Any]
    type: Literal["act"] = "act"


@dataclass(frozen=True, slots=True)
class Finish:
    """Give the final answer, where a person is the mind."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    answer: Annotated[str, Field(max_length=4000)]
    type: Literal["finish"] = "finish"


@dataclass(frozen=True, slots=True)
class Approve:
    """Let her do what she is about to do."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    type: Literal["approve"] = "approve"


@dataclass(frozen=True, slots=True)
class Veto:
    """Do not let her do it, and say why."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    why: Annotated[str, Field(max_length=1000)] = ""
    type: Literal["veto"] = "veto"


@dataclass(frozen=True, slots=True)
class Approval:
    """Be asked before each step, or not any more."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    on: Annotated[bool, Field(strict=True)]
    type: Literal["approval"] = "approval"


def _offered(factor: float) -> float:
    if factor not in SPEEDS:
        raise ValueError(f"use one of {', '.join(f'{speed:g}' for speed in SPEEDS)}")
    return factor


@dataclass(frozen=True, slots=True)
class Speed:
    """Let simulated time pass so many times faster than real time."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    factor: Annotated[float, AfterValidator(_offered)]
    type: Literal["speed"] = "speed"


@dataclass(frozen=True, slots=True)
class Ping:
    """Show that somebody is there."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    type: Literal["ping"] = "ping"


Wish = Say | Stop | Undo | Move | Act | Finish | Approve | Veto | Approval | Speed | Ping
"""What the page may ask of a room."""


@cache
def _wishes() -> TypeAdapter[Wish]:
    return TypeAdapter(Annotated[Wish, Field(discriminator="type")])


def read_wish(text: str | bytes) -> Wish:
    """Read what the page asks.

    Raises:
        ConfigError: It is none of the messages above; says what is wrong with it.
    """
    try:
        return _wishes().validate_json(text)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "message"
        raise ConfigError(
            f"{readable(where)[:80]}: {readable(str(first['msg']))[:200]}; nothing was done."
        ) from None
