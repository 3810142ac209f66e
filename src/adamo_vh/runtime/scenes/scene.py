"""Scene files: what they may hold, how they are read, and what is wrong with them.

A scene is data only: a TOML file with a room, an agent start, lights, furniture, objects and floor
areas. Files are untrusted: every field is validated, counts and sizes are limited, assets are names
from the catalog and never paths.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Annotated, Any, ClassVar

from pydantic import ConfigDict, Field, TypeAdapter, ValidationError

from adamo_vh.engine import MOST_VARIATIONS, Area, SceneInfo, named
from adamo_vh.errors import FileError, SceneError
from adamo_vh.files import parse_toml, read_text
from adamo_vh.runtime.scenes.faults import field_faults

_STRICT = ConfigDict(extra="forbid")
_ROOM_M = (1.0, 20.0)
"""Least and largest side of a room: nothing farther than 20 m from the eyes is drawn."""

Metres = Annotated[float, Field(strict=True, ge=-50, le=50, allow_inf_nan=False)]
Name = Annotated[str, Field(min_length=1, max_length=60, pattern=r"^[A-Za-z0-9][A-Za-z0-9 _-]*$")]
Degrees = Annotated[float, Field(strict=True, ge=-360, le=360, allow_inf_nan=False)]
Unit = Annotated[float, Field(strict=True, ge=0, le=1, allow_inf_nan=False)]


@dataclass(frozen=True, slots=True)
class Room:
    """The room's shell."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    asset: Name
    x_min: Metres
    x_max: Metres
    y_min: Metres
    y_max: Metres
    height_m: Annotated[float, Field(strict=True, gt=1.8, le=20)]


@dataclass(frozen=True, slots=True)
class AgentStart:
    """Where the body stands at the start, and the point that it looks at."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    position: tuple[Metres, Metres]
    heading_deg: Degrees
    gaze: tuple[Metres, Metres, Metres]


@dataclass(frozen=True, slots=True)
class Light:
    """A spot light; at most one should cast shadows, since each draws the scene again."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    position: tuple[Metres, Metres, Metres]
    target: tuple[Metres, Metres, Metres]
    diffuse: Unit
    shadow: Annotated[bool, Field(strict=True)] = False


@dataclass(frozen=True, slots=True)
class Furniture:
    """A static piece on the floor."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    name: Name
    asset: Name
    position: tuple[Metres, Metres]
    yaw_deg: Degrees = 0.0


@dataclass(frozen=True, slots=True)
class PlacedObject:
    """An interactable object, lying on a piece of furniture or on the floor."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    id: Annotated[int, Field(strict=True, ge=0, le=9999)]
    asset: Name
    on: Annotated[str, Field(max_length=130)]
    """Furniture name, "furniture/level" where it has several levels, or "floor"."""
    position: tuple[Metres, Metres]
    yaw_deg: Degrees = 0.0


@dataclass(frozen=True, slots=True)
class FloorArea:
    """A named rectangle on the floor that tasks can refer to."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    name: Name
    kind: Name
    min: tuple[Metres, Metres]
    max: tuple[Metres, Metres]


@dataclass(frozen=True, slots=True)
class Scene:
    """A whole scene file."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    name: Name
    title: Annotated[str, Field(max_length=200)]
    room: Room
    agent: AgentStart
    lights: Annotated[tuple[Light, ...], Field(min_length=1, max_length=6)]
    furniture: Annotated[tuple[Furniture, ...], Field(max_length=100)]
    objects: Annotated[tuple[PlacedObject, ...], Field(min_length=1, max_length=200)]
    areas: Annotated[tuple[FloorArea, ...], Field(max_length=50)] = field(default=())
    ambient: Unit = 0.54
    """How bright the light is that comes from everywhere."""
    variation: Annotated[int, Field(strict=True, ge=0, le=MOST_VARIATIONS)] = 0
    """Which variation of a scene this is; 0 for a scene of its own."""

    @property
    def full_name(self) -> str:
        """Its name, with the variation that it is."""
        return named(self.name, self.variation)

    def info(self) -> SceneInfo:
        """The public facts about the scene."""
        room = self.room
        areas = tuple(Area(a.name, a.kind, *a.min, *a.max) for a in self.areas)
        extent = (room.x_min, room.y_min, room.x_max, room.y_max, room.height_m)
        return SceneInfo(self.name, *extent, areas, variation=self.variation)


_BUILT_IN = {"s1": "s1_tabletop.toml", "s2": "s2_living_room.toml"}


def scene_names() -> tuple[str, ...]:
    """Names of the scenes that come with the package."""
    return tuple(_BUILT_IN)


def load_scene(name_or_path: str) -> Scene:
    """Load a built-in scene by name, or a scene file.

    Raises:
        SceneError: No such scene, or the file is wrong; names the field and the fix.
    """
    if name_or_path.lower() in _BUILT_IN:
        file_name = _BUILT_IN[name_or_path.lower()]
        text = (resources.files(__package__) / file_name).read_text(encoding="utf-8")
        return parse_scene(text, file_name)
    path = Path(name_or_path)
    if path.suffix != ".toml" or not path.is_file():
        offer = ", ".join(_BUILT_IN)
        raise SceneError(f"There is no scene {name_or_path!r}. Use {offer} or a .toml file.")
    try:
        text = read_text(path)
    except FileError as error:
        raise SceneError(str(error)) from None
    return parse_scene(text, str(path))


def parse_scene(text: str, source: str) -> Scene:
    """Parse and validate the text of a scene file.

    Args:
        text: TOML.
        source: File name for error messages.

    Raises:
        SceneError: Names the source, the field and the fix; its `faults` are all that is wrong.
    """
    try:
        return scene_from(parse_toml(text, source), source)
    except FileError as error:
        raise SceneError(str(error)) from None


@cache
def _codec() -> TypeAdapter[Scene]:
    return TypeAdapter(Scene)


def scene_from(data: Mapping[str, Any], source: str) -> Scene:
    """Validate the data of a scene file.

    Args:
        data: As its text says.
        source: File name for error messages.

    Raises:
        SceneError: Names the source, the field and the fix; its `faults` are all that is wrong.
    """
    try:
        scene = _codec().validate_python(data)
    except ValidationError as error:
        faults = field_faults(error)
    else:
        faults = (*_unroomy(scene.room), *_misnamed(scene))
        if not faults:
            faults = tuple(_misplaced(scene))
        if not faults:
            return scene
    (where, problem), more = faults[0], len(faults) - 1
    others = f" ({more} more: see adamo-vh scenes check)" if more else ""
    raise SceneError(f"{source}: {where}: {problem}{others}", faults)


def _unroomy(room: Room) -> Iterator[tuple[str, str]]:
    """A room with sides that no room has."""
    sides = room.x_max - room.x_min, room.y_max - room.y_min
    if min(sides) < _ROOM_M[0]:
        yield "room", "smaller than 1 x 1 m; check x_min < x_max, y_min < y_max"
    elif max(sides) > _ROOM_M[1]:
        size, most = f"{sides[0]:g} x {sides[1]:g} m", f"{_ROOM_M[1]:g} m"
        yield "room", f"{size} is too large; make no side longer than {most}"


def _misplaced(scene: Scene) -> Iterator[tuple[str, str]]:
    """Fields with a place outside the room."""
    room = scene.room
    placed = [("agent.position", scene.agent.position)]
    placed += [(f"furniture[{i}].position", f.position) for i, f in enumerate(scene.furniture)]
    placed += [(f"objects[{i}].position", o.position) for i, o in enumerate(scene.objects)]
    for where, (x, y) in placed:
        if not (room.x_min <= x <= room.x_max and room.y_min <= y <= room.y_max):
            yield where, f"({x}, {y}) is outside the room; move it inside"
    for i, area in enumerate(scene.areas):
        if not (area.min[0] < area.max[0] and area.min[1] < area.max[1]):
            yield f"areas[{i}]", "min must be below max in both axes"


def _misnamed(scene: Scene) -> Iterator[tuple[str, str]]:
    """Fields with a name or id that is taken or unknown."""
    # Imported here: the catalog is above the plain data of a scene.
    from adamo_vh.runtime.assets.catalog import FURNITURE, OBJECTS

    names = {"floor"}
    for i, piece in enumerate(scene.furniture):
        if piece.name in names:
            yield f"furniture[{i}].name", f"{piece.name!r} is taken; choose another"
        if piece.asset not in FURNITURE:
            yield f"furniture[{i}].asset", f"unknown; one of {', '.join(sorted(FURNITURE))}"
        names.add(piece.name)
    ids: set[int] = set()
    for i, item in enumerate(scene.objects):
        if item.id in ids:
            yield f"objects[{i}].id", f"{item.id} is taken; ids are unique"
        if item.asset not in OBJECTS:
            yield f"objects[{i}].asset", f"unknown; one of {', '.join(sorted(OBJECTS))}"
        if item.on.split("/")[0] not in names:
            yield (
                f"objects[{i}].on",
                f"{item.on!r} is no furniture; one of {', '.join(sorted(names))}",
            )
        ids.add(item.id)
