"""Another world: four blocks on a floor, seen by casting one ray a pixel with NumPy.

What an engine must offer stands in `adamo_vh.engine`: a `World` (the truth, and the way back to any
state) and a `Body` (what it senses and does). Everything above (tags, text, feedback, model,
record, replay) works on it unchanged. A real engine would ask Unity, Godot or Isaac instead.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

import adamo_vh
from adamo_vh.action import Code, Outcome
from adamo_vh.engine import (
    FLOOR,
    Body,
    BodyInfo,
    BodyReport,
    ObjectState,
    SceneInfo,
    WorldEvent,
    WorldState,
)
from adamo_vh.errors import EngineError
from adamo_vh.geometry import Array, Box, Camera, Vec3
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.observation import NOTHING, BodyState, Percept, SeenObject

SCENE = SceneInfo("blocks", -3.0, -3.0, 3.0, 3.0, 2.5, areas=(), source="examples/07_own_engine.py")
BODY = BodyInfo("nobody", 0.2, 1.5, math.radians(60), 0.8, 2.0, 0.5)


@dataclass(frozen=True)
class Block:
    """A cube on the floor."""

    name: str
    color: tuple[int, int, int]
    center: Vec3
    edge_m: float = 0.3

    @property
    def box(self) -> Box:
        """Where it is."""
        return Box(self.center, Vec3(self.edge_m, self.edge_m, self.edge_m))


START = {
    1: Block("RedBlock", (200, 40, 40), Vec3(0.0, -1.0, 0.15)),
    2: Block("GreenBlock", (40, 170, 60), Vec3(0.0, 0.0, 0.15)),
    3: Block("BlueBlock", (50, 80, 220), Vec3(0.0, 1.0, 0.15)),
    4: Block("YellowBlock", (230, 200, 40), Vec3(1.5, 0.5, 0.15)),
}


class BlockWorld:
    """The truth: where the blocks are. It has one body, `Walker`."""

    scene = SCENE
    object_names: Mapping[int, str] = {number: block.name for number, block in START.items()}

    def __init__(self) -> None:
        self.blocks = dict(START)
        self.walker = Walker(self)
        self.bodies: Mapping[str, Body] = {"walker": self.walker}

    def reset(self, seed: int) -> None:
        """Everything back to its start; nothing here is drawn by chance."""
        self.blocks = dict(START)
        self.walker.start()

    def state(self) -> WorldState:
        """The whole truth, for checkers and records."""
        held = self.walker.held
        objects = [
            ObjectState(
                number, block.name, block.box, None if number == held else FLOOR, number == held
            )
            for number, block in self.blocks.items()
        ]
        return WorldState(SCENE, tuple(objects), self.walker.state())

    def snapshot(self) -> bytes:
        """All that decides what happens next."""
        walker = self.walker
        places = {number: _numbers(block.center) for number, block in self.blocks.items()}
        body = [_numbers(walker.position), _numbers(walker.gaze), walker.heading_rad, walker.held]
        return json.dumps([places, body]).encode()

    def restore(self, snapshot: bytes) -> None:
        """Go back to a snapshot."""
        try:
            places, (position, gaze, heading, held) = json.loads(snapshot)
            self.blocks = {
                number: replace(block, center=Vec3(*places[str(number)]))
                for number, block in START.items()
            }
        except (ValueError, LookupError, TypeError):
            raise EngineError("This is no snapshot of the world of blocks.") from None
        walker = self.walker
        walker.position, walker.gaze = Vec3(*position), Vec3(*gaze)
        walker.heading_rad, walker.held = heading, held

    def apply(self, event: WorldEvent) -> None:
        """What nobody in this world does; an engine says what it cannot."""
        raise EngineError(f"The world of blocks knows no {event.type}.")

    def close(self) -> None:
        """Nothing to free."""

    def cast(
        self, origin: Vec3, directions: Array, without: int | None
    ) -> tuple[Array, NDArray[np.int16]]:
        """Distance and id of the first hit of each ray; floor and walls have the id `NOTHING`."""
        start = origin.array()
        low, high = np.array([-3.0, -3.0, 0.0]), np.array([3.0, 3.0, 2.5])
        with np.errstate(divide="ignore", invalid="ignore"):
            best = np.nanmax(np.stack([(low - start) / directions, (high - start) / directions]), 0)
            best, ids = best.min(axis=1), np.full(len(directions), NOTHING, np.int16)
            for number, block in self.blocks.items():
                if number == without:
                    continue
                half = block.edge_m / 2
                a = (block.center.array() - half - start) / directions
                b = (block.center.array() + half - start) / directions
                near, far = np.minimum(a, b).max(axis=1), np.maximum(a, b).min(axis=1)
                hit = (near > 0) & (near < far) & (near < best)
                best, ids = np.where(hit, near, best), np.where(hit, number, ids)
        return best, ids.astype(np.int16)


class Walker:
    """The one body: two eyes on a pole, with an arm."""

    info = BODY

    def __init__(self, world: BlockWorld) -> None:
        self._world = world
        self.start()

    def start(self) -> None:
        """Where an episode begins."""
        self.position, self.gaze = Vec3(-2.0, 0.0, 0.0), Vec3(0.5, 0.0, 0.0)
        self.heading_rad = 0.0
        self.held: int | None = None

    def state(self) -> BodyState:
        """Where it stands, where it looks, and what it feels in its hand."""
        eyes = Vec3(self.position.x, self.position.y, BODY.eye_height_m)
        box = self._world.blocks[self.held].box if self.held is not None else None
        return BodyState(self.position, self.heading_rad, self.gaze, eyes, self.held, box)

    def see(self, width_px: int, height_px: int) -> Percept:
        """What its eyes see."""
        return self.closeup(self.gaze, BODY.fov_y_rad, width_px, height_px)

    def closeup(
        self, point: Vec3, vertical_fov_rad: float, width_px: int, height_px: int
    ) -> Percept:
        """The same eyes, turned to a point and through another angle."""
        state, size = self.state(), (width_px, height_px)
        camera = Camera.towards(state.eyes, point, vertical_fov_rad, size, self.heading_rad)
        u, v = np.meshgrid(np.arange(width_px) + 0.5, np.arange(height_px) + 0.5)
        directions = camera.rays(np.stack([u.ravel(), v.ravel()], axis=1))
        distances, ids = self._world.cast(state.eyes, directions, self.held)
        rgb = self._paint(state.eyes, directions, distances, ids)
        seen = {
            number: SeenObject(number, block.name, block.box)
            for number, block in self._world.blocks.items()
            if (ids == number).any()
        }
        shape = (height_px, width_px)
        return Percept(rgb.reshape(*shape, 3), (ids.reshape(shape),), seen, state, camera)

    def _paint(
        self, eyes: Vec3, directions: Array, distances: Array, ids: NDArray[np.int16]
    ) -> NDArray[np.uint8]:
        """Flat colours; tiles on the floor and darker sides make depth visible."""
        points = eyes.array() + directions * distances[:, None]
        tiles = (np.floor(points[:, 0] * 2) + np.floor(points[:, 1] * 2)) % 2
        floor = points[:, 2] < 0.01
        rgb = np.where(floor, 165 + 25 * tiles, 215)[:, None] * np.ones(3)
        for number, block in self._world.blocks.items():
            on_top = points[:, 2] > block.center.z + block.edge_m / 2 - 0.01
            shade = np.where(on_top, 1.0, 0.8)[:, None]
            rgb = np.where((ids == number)[:, None], shade * np.array(block.color), rgb)
        return rgb.astype(np.uint8)

    def rays(self, origin: Vec3, directions: Array) -> Sequence[Vec3 | None]:
        """First hits."""
        distances, _ = self._world.cast(origin, directions, self.held)
        hits = origin.array() + directions * distances[:, None]
        return [Vec3(*map(float, hit)) for hit in hits]

    def look(self, point: Vec3) -> BodyReport:
        """Turn to a point."""
        self.gaze = point
        if point.horizontal_distance(self.position) > 1e-6:
            self.heading_rad = math.atan2(point.y - self.position.y, point.x - self.position.x)
        return BodyReport(Outcome.DONE, Code.OK, point)

    def walk(self, point: Vec3) -> BodyReport:
        """Walk straight to a place; blocks are low enough to step over."""
        before, edge = self.position, 3.0 - BODY.radius_m
        there = Vec3(max(-edge, min(edge, point.x)), max(-edge, min(edge, point.y)), 0.0)
        self.position = there
        exact = there.horizontal_distance(point) < 0.01
        outcome, code = (
            (Outcome.DONE, Code.OK) if exact else (Outcome.CORRECTED, Code.STOPPED_SHORT)
        )
        return BodyReport(outcome, code, there, walked_m=before.horizontal_distance(there))

    def pick(self, object_id: int) -> BodyReport:
        """Go near and take a block."""
        walked = self._approach(self._world.blocks[object_id].center)
        self.held = object_id
        self._place(object_id, Vec3(self.position.x, self.position.y, 1.0))
        return BodyReport(Outcome.DONE, Code.OK, self.position, walked_m=walked)

    def drop(self, point: Vec3) -> BodyReport:
        """Put the held block on the floor, below the point."""
        held = self.held
        if held is None:
            return BodyReport(Outcome.REFUSED, Code.HAND_EMPTY)
        rest = Vec3(point.x, point.y, self._world.blocks[held].edge_m / 2)
        for number, block in self._world.blocks.items():
            near = max(abs(block.center.x - rest.x), abs(block.center.y - rest.y))
            if number != held and near < block.edge_m:
                return BodyReport(Outcome.REFUSED, Code.NO_FREE_SPOT)
        walked = self._approach(rest)
        self._place(held, rest)
        self.held = None
        return BodyReport(Outcome.DONE, Code.OK, rest, FLOOR, walked)

    def say(self, text: str) -> None:
        """Deliver the final answer."""
        print("the body says:", text)

    def _approach(self, point: Vec3) -> float:
        gap = self.position.horizontal_distance(point)
        if gap <= BODY.reach_m:
            return 0.0
        share = (gap - BODY.reach_m) / gap
        x, y = self.position.x, self.position.y
        self.position = Vec3(x + (point.x - x) * share, y + (point.y - y) * share, 0.0)
        return gap - BODY.reach_m

    def _place(self, object_id: int, center: Vec3) -> None:
        blocks = self._world.blocks
        blocks[object_id] = replace(blocks[object_id], center=center)


def _numbers(point: Vec3) -> list[float]:
    return [point.x, point.y, point.z]


def main() -> None:
    """Let a script play in it; any model would do."""
    red = "RedBlock_1"
    place = {"object": red, "x": 1.5, "y": 0.0, "z": 0.0}
    steps = [
        AIMessage(f"I see {red} before me and take it.", (ToolCall("1", "Pick", {"object": red}),)),
        AIMessage("I put it beside the yellow one.", (ToolCall("2", "Drop", place),)),
        AIMessage("The red block lies beside the yellow one."),
    ]
    result = adamo_vh.run_episode(
        "Put the red block next to the yellow one",
        engine=BlockWorld(),
        model=ScriptedModel("script", steps),
        resolution=(640, 360),
    )
    print(result.termination, "-", result.answer)


if __name__ == "__main__":
    main()
