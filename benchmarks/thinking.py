"""How long a player thinks about a step, by the processor's time and by the clock.

    python benchmarks/thinking.py [--model baseline] [--scene s1] [--labeling opaq]
        [--profile lean] [--task T4] [--seed 0] [--json]

Options may be repeated. Each episode is played once and its prompts are kept; then the player is
asked again with the same prompts alone, so that neither physics nor drawing is in the figures. Its
pictures are marked anew for each episode: nothing is known from an earlier look at them. One prompt
is asked beforehand, which loads libraries.
"""

from __future__ import annotations

import argparse
import itertools
import json
import statistics
import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import adamo_vh
from adamo_vh.action import ToolSchema
from adamo_vh.benchmark.tasks import TASKS
from adamo_vh.inference.messages import HumanMessage, ImagePart, Message, ToolMessage
from adamo_vh.inference.model import Model, ModelInfo, Reply, Sampling
from adamo_vh.session.minds import model_of

Asked = tuple[tuple[Message, ...], tuple[ToolSchema, ...], Sampling]


@dataclass(slots=True)
class Listening:
    """A player whose prompts are kept."""

    player: Model
    asked: list[Asked] = field(default_factory=list)

    @property
    def info(self) -> ModelInfo:
        """That of the player."""
        return self.player.info

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Keep the prompt and let the player answer."""
        self.asked.append((tuple(messages), tuple(tools), sampling))
        return self.player.complete(messages, tools, sampling)


@dataclass(slots=True)
class Times:
    """Milliseconds of each step of a cell."""

    cpu: list[float] = field(default_factory=list)
    wall: list[float] = field(default_factory=list)


def main() -> None:
    """Play, ask again, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--model", default="baseline")
    for option in ("scene", "labeling", "profile", "task"):
        parser.add_argument(f"--{option}", action="append")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    player = model_of(arguments.model)
    cells: dict[tuple[str, str, str], Times] = {}
    marks = itertools.count(1)
    for scene in arguments.scene or ["s1", "s2"]:
        engine = adamo_vh.create_engine(scene)
        for labeling, profile, task in itertools.product(
            arguments.labeling or ["sem", "opaq"],
            arguments.profile or ["paper", "lean"],
            arguments.task or [item.id for item in TASKS],
        ):
            listening = Listening(player)
            adamo_vh.run_episode(
                task=task,
                scene=scene,
                labeling=labeling,
                profile=profile,
                model=listening,
                seed=arguments.seed,
                engine=engine,
            )
            times = cells.setdefault((scene, labeling, profile), Times())
            _ask_again(player, listening.asked, next(marks), times)
        engine.close()
    _report(cells, arguments.json)


def _ask_again(player: Model, asked: Sequence[Asked], mark: int, times: Times) -> None:
    if mark == 1:
        _answer(player, asked[0], 0)
    for prompt in asked:
        cpu_ms, wall_ms = _answer(player, prompt, mark)
        times.cpu.append(cpu_ms)
        times.wall.append(wall_ms)


def _answer(player: Model, asked: Asked, mark: int) -> tuple[float, float]:
    """Milliseconds of processor and clock for one answer."""
    messages = [_marked(message, mark) for message in asked[0]]
    cpu, wall = time.process_time(), time.perf_counter()
    player.complete(messages, asked[1], asked[2])
    return (time.process_time() - cpu) * 1e3, (time.perf_counter() - wall) * 1e3


def _marked(message: Message, mark: int) -> Message:
    """The same message with pictures of other bytes; what follows a picture's end is not shown."""

    def other(image: ImagePart) -> ImagePart:
        return replace(image, data=image.data + b"%d" % mark)

    if isinstance(message, ToolMessage):
        return replace(message, images=tuple(other(image) for image in message.images))
    if isinstance(message, HumanMessage):
        parts = (other(part) if isinstance(part, ImagePart) else part for part in message.parts)
        return replace(message, parts=tuple(parts))
    return message


def _report(cells: dict[tuple[str, str, str], Times], as_json: bool) -> None:
    rows = [
        {
            "scene": scene,
            "labeling": labeling,
            "profile": profile,
            "steps": len(times.cpu),
            "mean_cpu_ms": round(statistics.mean(times.cpu), 1),
            "worst_cpu_ms": round(max(times.cpu), 1),
            "mean_wall_ms": round(statistics.mean(times.wall), 1),
            "worst_wall_ms": round(max(times.wall), 1),
        }
        for (scene, labeling, profile), times in cells.items()
    ]
    if as_json:
        print(json.dumps(rows))
        return
    print("scene  labeling  profile  steps  CPU ms mean  worst  clock ms mean  worst")
    for row in rows:
        print(
            f"{row['scene']:<6} {row['labeling']:<9} {row['profile']:<7} {row['steps']:6d} "
            f"{row['mean_cpu_ms']:12.1f} {row['worst_cpu_ms']:6.1f} "
            f"{row['mean_wall_ms']:14.1f} {row['worst_wall_ms']:6.1f}"
        )


if __name__ == "__main__":
    main()
