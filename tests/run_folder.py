"""Run folders for tests of what reads them: episodes on the plain-data tabletop, no engine."""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from PIL import Image
from tests.tabletop import carried_out, tabletop

from adamo_vh.action import Code, Drop, Feedback, Look, Outcome, Pick, Walk
from adamo_vh.benchmark.tasks import task
from adamo_vh.cognition.turns import read_turn
from adamo_vh.engine import WorldState
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import Manifest, summarise, write_record
from adamo_vh.episode.sealing import write_result
from adamo_vh.geometry import Camera, Vec3
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import ModelKind, Reply, Usage
from adamo_vh.observation import AgentState, Frame, Observation, ObservedObject, ReferencePoint
from adamo_vh.record.run_folder import MANIFEST
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import (
    Acted,
    Ended,
    LeftOut,
    Started,
    Thought,
    observed,
    read_trajectory,
)
from adamo_vh.record.writer import TrajectoryWriter

Painter = Callable[[WorldState, Camera, Sequence[ObservedObject]], Image.Image]


def flat(world: WorldState, camera: Camera, objects: Sequence[ObservedObject]) -> Image.Image:
    """A small picture whose colour tells where the body stands and looks."""
    seed = abs(hash((world.body.position, world.body.gaze)))
    return Image.new("RGB", (64, 36), (seed % 200, seed // 200 % 200, 90))


@dataclass
class Recorder:
    """Plays an episode on the plain-data tabletop and writes its run folder."""

    folder: Path
    config: EpisodeConfig
    paint: Painter = flat
    size: tuple[int, int] = (64, 36)
    world: WorldState = field(default_factory=tabletop)
    step: int = 0
    calls: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.manifest = Manifest(
            self.config,
            self.config.model,
            ModelKind.RULE_BASED,
            {"adamo-vh": "0.1.0"},
            "2026-01-01T00:00:00+00:00",
            self.world,
        )
        write_record(self.folder, MANIFEST, self.manifest)
        self.writer = TrajectoryWriter(self.folder)
        instruction = self.config.instruction
        self.writer.notify(Started(instruction, "You are the mind.", self.world.hash(), "{}"))
        self.see()

    @property
    def agent(self) -> AgentState:
        body = self.world.body
        held = None if body.held is None else self.tag(body.held)
        return AgentState(body.position, body.heading_rad, body.gaze, body.eyes, held)

    def tag(self, object_id: int) -> str:
        return f"{self.world.object(object_id).class_name}_{object_id}"

    def see(self) -> None:
        body = self.world.body
        gaze = body.gaze - body.eyes
        pitch = math.atan2(gaze.z, body.eyes.horizontal_distance(body.gaze))
        camera = Camera(body.eyes, body.heading_rad, pitch, 1.134, *self.size)
        seen = []
        for item in self.world.objects:
            pixels = camera.project(item.box.corners())
            left, top = (int(v) for v in pixels[:, :2].min(axis=0))
            right, bottom = (int(v) for v in pixels[:, :2].max(axis=0))
            inside = left >= 0 and right < self.size[0] and 0 <= bottom < self.size[1]
            if pixels[:, 2].min() > 0 and inside:
                box = (left, top, right, bottom)
                area = (right - left) * (bottom - top)
                seen.append(
                    ObservedObject(
                        self.tag(item.id), item.box.center, item.box.volume_m3, box, area
                    )
                )
        data = io.BytesIO()
        self.paint(self.world, camera, seen).save(data, "JPEG", quality=88)
        frame = Frame(data.getvalue(), "image/jpeg", *self.size)
        points = (ReferencePoint("P0", Vec3(0.0, 0.0, 0.0), (10.0, 10.0)),)
        view = Observation(frame, tuple(seen), points, self.agent, camera)
        self.writer.notify(observed(self.step, view), frame)

    def think(self, note: str, *calls: ToolCall) -> None:
        state = "# Symbolic state\n\n## You\n- hand: empty"
        usage = Usage(6200 + 300 * self.step, 120, 4000)
        reply = Reply(AIMessage(note, calls), usage, 4.2)
        self.writer.notify(Thought(self.step, state, 3, read_turn(reply, self.config.profile)))
        self.calls = [call.id for call in calls]

    def act(
        self,
        note: str,
        action: Look | Walk | Pick | Drop,
        arguments: Mapping[str, Any],
        feedback: Feedback | None = None,
    ) -> None:
        name = type(action).__name__
        self.think(note, ToolCall(f"c{self.step}", name, arguments))
        self.world = carried_out(self.world, action)
        self.acted(name, arguments, feedback or Feedback(Outcome.DONE, Code.OK, f"Done: {name}."))
        if isinstance(action, Look):
            self.see()

    def acted(self, name: str, arguments: Mapping[str, Any] | None, feedback: Feedback) -> None:
        self.step += 1
        digest = self.world.hash()
        self.writer.notify(
            Acted(self.step, self.call(), name, arguments, feedback, self.agent, digest, "{}", 0.31)
        )

    def left_out(self, name: str, why: str) -> None:
        self.writer.notify(LeftOut(self.step, self.call(), name, why))

    def call(self) -> str:
        """The next call of the turn."""
        return self.calls.pop(0) if self.calls else ""

    def end(self, answer: str, reason: TerminationReason = TerminationReason.ANSWERED) -> None:
        if reason is TerminationReason.ANSWERED:
            self.think(answer)
        self.writer.notify(Ended(self.step, reason, answer, self.world.hash(), 31.4))
        recorded = read_trajectory(self.folder)
        result = summarise(self.manifest, recorded, self.world, self.folder)
        write_result(self.folder, result, recorded)


def config(task_id: str | None = "T5", instruction: str | None = None) -> EpisodeConfig:
    prompt = instruction or task(task_id or "T1").prompt
    return EpisodeConfig(prompt, task=task_id, resolution=(64, 64))


def played(folder: Path, *, paint: Painter = flat, size: tuple[int, int] = (64, 36)) -> Recorder:
    """T5 with a detour: every outcome, a new view, and one that is the same picture again."""
    run = Recorder(folder, config(), paint, size)
    plant = {"x": 0.33, "y": -1.35, "z": 0.95}
    run.act(
        "The frame shows the table.\nThe tape, tag 4, lies at (-0.17, -0.60). I pick it.",
        Pick("4"),
        {"object": "Tape_4"},
        Feedback(Outcome.DONE, Code.REPOSITIONED, "Done: walked 1.02 m; Tape_4 is in your hand."),
    )
    run.act("The plant may be to my right.", Look(**plant), plant)
    run.think("I walk around.", ToolCall("c", "Walk", {"x": 9, "y": 0, "z": 0}))
    refusal = Feedback(Outcome.REFUSED, Code.UNREACHABLE, "Refused: no way leads there.")
    run.acted("Walk", {"x": 9, "y": 0, "z": 0}, refusal)
    run.act("Once more.", Look(**plant), plant)
    run.act(
        "",
        Drop("4", 0.12, -1.25, 0.78),
        {"object": "4", "x": 0.12, "y": -1.25, "z": 0.78},
        Feedback(Outcome.CORRECTED, Code.PLACED_ELSEWHERE, "Corrected: Tape_4 rests 0.06 m off."),
    )
    run.end("The tape is now next to the indoor plant.")
    return run
