"""An engine's side of the wire: a request in, the answer of a `World` and its pictures out."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from adamo_vh.abilities import Abilities, abilities
from adamo_vh.action import Code
from adamo_vh.engine import Body, BodyReport, World
from adamo_vh.errors import AdamoError, EngineError
from adamo_vh.observation import Percept
from adamo_vh.perception.visibility import visible_objects
from adamo_vh.service.engines.messages import (
    FRAME,
    METHODS,
    WIRE,
    BodiesAnswer,
    CaptureAnswer,
    CaptureWish,
    EventWish,
    Hello,
    Nothing,
    PickWish,
    PointWish,
    RaysAnswer,
    RaysWish,
    ReportAnswer,
    ResetWish,
    SayWish,
    SceneAnswer,
    SceneWish,
    SeenBox,
    SnapshotAnswer,
    StateAnswer,
    View,
    codec,
)
from adamo_vh.service.engines.pictures import raw_ids
from adamo_vh.service.engines.reading import read_as

Open = Callable[[str, str], World]
"""Makes the world of a scene and a figure."""
Pictures = tuple[bytes, ...]


def hello_of(name: str, able: Abilities) -> dict[str, Any]:
    """The first message of an engine."""
    hello = codec(Hello).dump_python(Hello(WIRE, name, FRAME, able), mode="json")
    return {"jsonrpc": "2.0", "method": "hello", "params": hello}


class Answerer:
    """Answers requests with a world."""

    def __init__(self, opened: Open, able: Abilities | None = None) -> None:
        """Answer for an engine.

        Args:
            opened: Makes a world when a scene is asked for.
            able: What the engine says that it can do; what its world says by default.
        """
        self._open = opened
        self._able = able
        self._world: World | None = None

    def answer(self, request: dict[str, Any]) -> tuple[dict[str, Any], Pictures]:
        """The answer to a request, and the binary messages that follow it."""
        head = {"jsonrpc": "2.0", "id": request.get("id")}
        method = str(request.get("method"))
        try:
            if method not in METHODS:
                raise EngineError(f"there is no method {method[:60]!r}.")
            wish, kind = METHODS[method]
            asked: Any = read_as(wish, request.get("params", {}), f"request for {method}")
            result, pictures = self._carried_out(method, asked)
        except Exception as error:
            # A mistake of the engine's own must not end its program.
            whose = "" if isinstance(error, AdamoError) else f"{type(error).__name__}: "
            return {**head, "error": {"code": 1, "message": f"{whose}{error}"}}, ()
        told = codec(kind).dump_python(result, mode="json")
        return {**head, "result": told, "attachments": len(pictures)}, pictures

    def _carried_out(self, method: str, asked: Any) -> tuple[Any, Pictures]:
        if isinstance(asked, SceneWish):
            return self._scene(asked), ()
        if self._world is None:
            raise EngineError("ask for a scene first.")
        if isinstance(asked, CaptureWish):
            return self._capture(self._body(asked.body), asked)
        return self._told(self._world, method, asked), ()

    def _told(self, world: World, method: str, asked: Any) -> Any:
        match asked:
            case ResetWish(seed=seed):
                world.reset(seed)
            case RaysWish():
                ways = np.array([way.array() for way in asked.directions])
                return RaysAnswer(tuple(self._body(asked.body).rays(asked.origin, ways)))
            case PointWish(body=name, point=point):
                body = self._body(name)
                acts = {"look": body.look, "walk": body.walk, "drop": body.drop}
                return _report(acts[method](point))
            case PickWish(body=name, object_id=object_id):
                if object_id not in world.object_names:
                    raise EngineError(f"there is no object {object_id}.")
                return _report(self._body(name).pick(object_id))
            case SayWish(body=name, text=text):
                self._body(name).say(text)
            case SnapshotAnswer(snapshot=text):
                world.restore(_bytes(text))
            case EventWish(event=event):
                world.apply(event)
            case _:
                return self._asked_plainly(world, method)
        return Nothing()

    def _asked_plainly(self, world: World, method: str) -> Any:
        if method == "snapshot":
            return SnapshotAnswer(base64.b64encode(world.snapshot()).decode())
        if method == "bodies":
            return BodiesAnswer({name: body.info for name, body in world.bodies.items()})
        states = {name: body.state() for name, body in world.bodies.items()}
        return StateAnswer(world.state().objects, states)

    def _scene(self, asked: SceneWish) -> SceneAnswer:
        if self._world is not None:
            self._world.close()
            self._world = None
        self._world = world = self._open(asked.scene, asked.figure)
        world.reset(0)
        return SceneAnswer(world.scene, world.object_names, world.state().furniture)

    def _body(self, name: str) -> Body:
        body = self._world.bodies.get(name) if self._world else None
        if body is None:
            raise EngineError(f"there is no body {name[:60]!r}.")
        return body

    def _capture(self, body: Body, asked: CaptureWish) -> tuple[CaptureAnswer, Pictures]:
        size = asked.width_px, asked.height_px
        if asked.aim is None:
            percept = body.see(*size)
        else:
            percept = body.closeup(asked.aim.point, asked.aim.fov_y_rad, *size)
        able = self._able or (abilities(self._world) if self._world else Abilities())
        layers = tuple(raw_ids(layer) for layer in percept.id_layers) if able.ids else ()
        seen = [SeenBox(item.id, item.box) for item in percept.objects.values()]
        answer = CaptureAnswer(
            View(*(getattr(percept.camera, name) for name in View.__slots__)),
            percept.body,
            tuple(seen if able.ids else _boxes(percept)),
            "rgb8",
            "int16" if able.ids else None,
            len(layers),
        )
        return answer, (percept.rgb.tobytes(), *layers)

    def close(self) -> None:
        """Close the world."""
        if self._world is not None:
            self._world.close()
            self._world = None


def _report(report: BodyReport) -> ReportAnswer:
    where = report.point, report.support
    return ReportAnswer(
        report.outcome, Code(report.code), *where, report.walked_m, report.stopped_s
    )


def _boxes(percept: Percept) -> Sequence[SeenBox]:
    """What is seen, as an engine tells it that knows no ids of pixels."""
    return [
        SeenBox(item.id, percept.objects[item.id].box, item.box_px, item.pixels)
        for item in visible_objects(percept, min_pixels=1)
    ]


def _bytes(text: str) -> bytes:
    try:
        return base64.b64decode(text, validate=True)
    except ValueError:
        raise EngineError("the snapshot is damaged: it is no base64.") from None
