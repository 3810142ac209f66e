"""A world in an engine that dialled in. What it answers is checked before anybody rests on it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from adamo_vh.abilities import Abilities
from adamo_vh.engine import (
    FLOOR,
    Body,
    BodyInfo,
    BodyReport,
    FurnitureOutline,
    SceneInfo,
    WorldEvent,
    WorldState,
)
from adamo_vh.errors import EngineError
from adamo_vh.geometry import Array, Box, Camera, Vec3
from adamo_vh.observation import BodyState, Percept, SeenObject
from adamo_vh.readable import readable
from adamo_vh.service.engines.line import EngineLine
from adamo_vh.service.engines.messages import (
    BodiesAnswer,
    CaptureAnswer,
    CloseAim,
    RaysAnswer,
    ReportAnswer,
    SceneAnswer,
    SnapshotAnswer,
    StateAnswer,
)
from adamo_vh.service.engines.pictures import ids_in, painted, read_colour, read_ids

_MOST_OBJECTS = 2000
_MOST_ID = int(np.iinfo(np.int16).max)
_FAR_M = 1000.0
_LONGEST_NAME = 60
_START = b"start "
"""The one state that an engine can go back to that keeps none: by a reset."""


class RemoteWorld:
    """A world in an engine that dialled in. Implements `adamo_vh.engine.World`."""

    def __init__(self, line: EngineLine, scene: str, figure: str = "") -> None:
        """Have the engine load a scene.

        Args:
            line: To the engine; is given back by `close`.
            scene: Name of the scene.
            figure: Who the virtual human is; "" if it does not matter.

        Raises:
            EngineError: The engine does not have it, or failed.
        """
        self.line = line
        answer: SceneAnswer = line.ask("scene", scene=scene, figure=figure).result
        bodies: BodiesAnswer = line.ask("bodies").result
        if fault := _scene_fault(answer, bodies, scene):
            raise line.failed("scene", fault)
        self._scene = replace(answer.scene, source=f"dialled in: {line.name}")
        self._names = dict(sorted(answer.object_names.items()))
        self._furniture: tuple[FurnitureOutline, ...] = answer.furniture
        self._fresh: int | None = None
        """The seed of the last reset, if nothing was done since."""
        self._bodies = {n: _RemoteBody(self, n, info) for n, info in bodies.bodies.items()}

    @property
    def abilities(self) -> Abilities:
        """What the engine said that it can do."""
        return self.line.hello.abilities

    @property
    def fault(self) -> str:
        """Why nothing can be asked any more; empty if it can."""
        return self.line.fault

    @property
    def scene(self) -> SceneInfo:
        """Name, origin, extent and areas of the loaded scene."""
        return self._scene

    @property
    def object_names(self) -> Mapping[int, str]:
        """Class of every interactable object, by id."""
        return self._names

    @property
    def bodies(self) -> Mapping[str, Body]:
        """Its bodies by name, the one that acts first."""
        return self._bodies

    def reset(self, seed: int) -> None:
        """Put the world and its bodies back to their start."""
        self.line.ask("reset", seed=seed)
        self._fresh = seed

    def state(self) -> WorldState:
        """The whole truth, as plain data."""
        answer = self.ask_state()
        acting = answer.bodies[next(iter(self._bodies))]
        return WorldState(self._scene, answer.objects, acting, self._furniture)

    def ask_state(self) -> StateAnswer:
        """Where everything is, checked."""
        answer: StateAnswer = self.line.ask("state").result
        if fault := next(self._state_faults(answer), ""):
            raise self.line.failed("state", fault)
        return answer

    def _state_faults(self, answer: StateAnswer) -> Iterator[str]:
        ids = [item.id for item in answer.objects]
        if ids != sorted(set(ids)):
            yield "the objects are not ordered by id, each once."
        if unknown := sorted(set(ids) - set(self._names)):
            yield f"object {unknown[0]} is not among the object_names."
        for item in answer.objects:
            yield from _box_faults(item.box, f"object {item.id}")
            yield from _name_faults(item.support or FLOOR)
        if lacking := sorted(set(self._bodies) - set(answer.bodies)):
            yield f"body {lacking[0]!r} is missing."
        for body in answer.bodies.values():
            yield from self.body_faults(body)

    def body_faults(self, body: BodyState) -> Iterator[str]:
        """What no body can be like."""
        if body.held is not None and body.held not in self._names:
            yield f"the hand holds {body.held}, which is not among the object_names."
        if (body.held is None) != (body.held_box is None):
            yield "held and held_box go together: both or neither."
        points = (body.position, body.gaze, body.eyes)
        if any(_is_far(point) for point in points):
            yield "the body is not anywhere near the room."

    def snapshot(self) -> bytes:
        """Everything that decides what happens next.

        Of an engine that keeps no states only the start can be told, and anything else is empty.
        """
        if not self.abilities.snapshot:
            return b"" if self._fresh is None else _START + str(self._fresh).encode()
        answer: SnapshotAnswer = self.line.ask("snapshot").result
        if not answer.snapshot:
            raise self.line.failed("snapshot", "the snapshot is empty.")
        return answer.snapshot.encode()

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot.

        Raises:
            EngineError: It is damaged or belongs to another scene, or the engine keeps no states.
        """
        if not self.abilities.snapshot:
            seed = snapshot.removeprefix(_START)
            if seed == snapshot or not seed.isdigit():
                raise EngineError(
                    f"{self.line.name} keeps no states: nothing can go on from the middle. Begin "
                    "anew."
                )
            self.reset(int(seed))
            return
        try:
            text = snapshot.decode()
        except UnicodeDecodeError:
            raise EngineError("The snapshot is damaged: it is no text.") from None
        self.line.ask("restore", snapshot=text)
        self._fresh = None

    def apply(self, event: WorldEvent) -> None:
        """Let something happen that no body does.

        Raises:
            EngineError: The engine cannot do it, or not now; nothing changed.
        """
        if not self.abilities.events:
            raise EngineError(f"{self.line.name} lets nothing happen but by its body.")
        self.touched()
        self.line.ask("apply", event=event)

    def touched(self) -> None:
        """Note that it is not as after a reset any more."""
        self._fresh = None

    def close(self) -> None:
        """Give the engine back; it may carry another world."""
        self.line.released()


class _RemoteBody:
    """A body in an engine that dialled in. Implements `adamo_vh.engine.Body`."""

    def __init__(self, world: RemoteWorld, name: str, info: BodyInfo) -> None:
        """Be a body of a world."""
        self._world = world
        self._name = name
        self._info = info

    @property
    def info(self) -> BodyInfo:
        """What is always true of it."""
        return self._info

    def state(self) -> BodyState:
        """Where it stands and looks now, and what it feels in its hand."""
        return self._world.ask_state().bodies[self._name]

    def see(self, width_px: int, height_px: int) -> Percept:
        """See the room through its eyes."""
        return self._captured(width_px, height_px, None)

    def closeup(
        self, point: Vec3, vertical_fov_rad: float, width_px: int, height_px: int
    ) -> Percept:
        """See a part of the room larger.

        Raises:
            EngineError: The engine draws no close-ups.
        """
        if not self._world.abilities.closeup:
            raise EngineError(f"{self._world.line.name} draws no close-ups.")
        return self._captured(width_px, height_px, CloseAim(point, vertical_fov_rad))

    def _captured(self, width_px: int, height_px: int, aim: CloseAim | None) -> Percept:
        line = self._world.line
        answer = line.ask(
            "capture", body=self._name, width_px=width_px, height_px=height_px, aim=aim
        )
        try:
            return self._percept(answer.result, answer.attachments, (width_px, height_px))
        except EngineError as fault:
            raise line.failed("capture", str(fault)) from None

    def _percept(
        self, answer: CaptureAnswer, attachments: Sequence[bytes], size: tuple[int, int]
    ) -> Percept:
        names, has_ids = self._world.object_names, self._world.abilities.ids
        layers_sent = answer.layers if answer.ids is not None else 0
        if has_ids != (layers_sent > 0):
            raise EngineError(
                "its hello promises the object at each pixel, and no layer of ids came."
                if has_ids
                else 'its hello says "ids": false, and layers of ids came.'
            )
        if len(attachments) != 1 + layers_sent:
            raise EngineError(
                f"{len(attachments)} attachments came; one of colours and {layers_sent} of ids "
                "were announced."
            )
        if fault := self._answer_fault(answer):
            raise EngineError(fault)
        rgb = read_colour(attachments[0], answer.colour, *size)
        if answer.ids is not None:
            layers = tuple(read_ids(data, answer.ids, *size) for data in attachments[1:])
        else:
            layers = painted(answer.objects, *size)
        seen = {item.id: SeenObject(item.id, names[item.id], item.box) for item in answer.objects}
        shown = ids_in(layers)
        if unknown := sorted(shown - set(seen)):
            raise EngineError(f"pixels show object {unknown[0]}, which is not among its objects.")
        view = answer.camera
        camera = Camera(view.position, view.yaw_rad, view.pitch_rad, view.fov_y_rad, *size)
        objects = {number: item for number, item in sorted(seen.items()) if number in shown}
        return Percept(rgb, layers, objects, answer.body, camera, from_boxes=answer.ids is None)

    def _answer_fault(self, answer: CaptureAnswer) -> str:
        view, ids = answer.camera, [item.id for item in answer.objects]
        if unknown := sorted(set(ids) - set(self._world.object_names)):
            return f"object {unknown[0]} is not among the object_names."
        if len(set(ids)) != len(ids):
            return "an object is named twice."
        faults = [f for item in answer.objects for f in _box_faults(item.box, f"object {item.id}")]
        faults += self._world.body_faults(answer.body)
        if not 0 < view.fov_y_rad < math.pi or _is_far(view.position):
            faults.append(f"no camera sees {view.fov_y_rad:g} rad from {view.position}.")
        return faults[0] if faults else ""

    def rays(self, origin: Vec3, directions: Array) -> Sequence[Vec3 | None]:
        """First hits of rays from a point."""
        if not len(directions):
            return []
        ways = tuple(Vec3.of(direction) for direction in directions)
        line = self._world.line
        asked = line.ask("rays", body=self._name, origin=origin, directions=ways)
        answer: RaysAnswer = asked.result
        if len(answer.hits) != len(ways):
            raise line.failed("rays", f"{len(answer.hits)} hits came for {len(ways)} rays.")
        return answer.hits

    def look(self, point: Vec3) -> BodyReport:
        """Turn body and gaze to a point."""
        return self._acted("look", point=point)

    def walk(self, point: Vec3) -> BodyReport:
        """Walk to the reachable place that is nearest to a point."""
        return self._acted("walk", point=point)

    def pick(self, object_id: int) -> BodyReport:
        """Take an object into the hand, walking closer if needed."""
        return self._acted("pick", object_id=object_id)

    def drop(self, point: Vec3) -> BodyReport:
        """Put the held object down at a point, walking closer if needed."""
        return self._acted("drop", point=point)

    def _acted(self, method: str, **params: Any) -> BodyReport:
        self._world.touched()
        answer: ReportAnswer = self._world.line.ask(method, body=self._name, **params).result
        point, support = answer.point, answer.support
        faults = [*_name_faults(support or FLOOR)]
        if answer.walked_m < 0 or (point is not None and _is_far(point)):
            faults.append(f"it walked {answer.walked_m:g} m and ended at {point}.")
        if answer.stopped_s is not None and answer.stopped_s < 0:
            faults.append(f"it was stopped after {answer.stopped_s:g} s.")
        if faults:
            raise self._world.line.failed(method, faults[0])
        return BodyReport(
            answer.outcome, answer.code, point, support, answer.walked_m, answer.stopped_s
        )

    def say(self, text: str) -> None:
        """Deliver the agent's final answer."""
        self._world.line.ask("say", body=self._name, text=text)


def _is_far(point: Vec3) -> bool:
    return max(abs(point.x), abs(point.y), abs(point.z)) > _FAR_M


def _box_faults(box: Box, whose: str) -> Iterator[str]:
    if min(box.size.x, box.size.y, box.size.z) <= 0:
        yield f"the box of {whose} has size {box.size}."
    turn = box.orientation
    length = math.sqrt(turn.w**2 + turn.x**2 + turn.y**2 + turn.z**2)
    if abs(length - 1) > 1e-3:
        yield f"the orientation of {whose} is no unit quaternion: its length is {length:.4f}."
    if _is_far(box.center):
        yield f"{whose} is at {box.center}, not anywhere near the room."


def _name_faults(name: str) -> Iterator[str]:
    """Names are read by models and people."""
    if not name or len(name) > _LONGEST_NAME or readable(name) != name:
        yield f"{readable(name)[:_LONGEST_NAME]!r} is no name; use at most {_LONGEST_NAME} letters."


def _scene_fault(answer: SceneAnswer, bodies: BodiesAnswer, asked: str) -> str:
    room, names = answer.scene, answer.object_names
    if room.name.lower() != asked.lower():
        return f"it loaded scene {room.name[:60]!r}, and {asked!r} was asked for."
    if not (room.x_min < room.x_max and room.y_min < room.y_max and room.height_m > 0):
        return "the room has no extent."
    if len(names) > _MOST_OBJECTS:
        return f"the scene has {len(names)} objects; at most {_MOST_OBJECTS} fit."
    if strange := [number for number in names if not 0 <= number <= _MOST_ID]:
        return f"{strange[0]} is no id; use 0 to {_MOST_ID}."
    if unfit := [name for name in names.values() if not name.isidentifier() or len(name) > 40]:
        return f"{unfit[0][:60]!r} is no class of objects; use letters, digits and _."
    carriers = [surface.support for piece in answer.furniture for surface in piece.surfaces]
    told = [*carriers, *(piece.name for piece in answer.furniture)]
    told += [word for area in room.areas for word in (area.name, area.kind)]
    if fault := next((fault for name in told for fault in _name_faults(name)), ""):
        return fault
    if not bodies.bodies:
        return "it has no body; an engine needs at least one."
    return ""
