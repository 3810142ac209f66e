"""Natural failures, played and told so that they can be labelled by hand.

    python benchmarks/natural.py --scene s1 --labeling opaq --task T11 --player blind
        [--variation 1003] [--file benchmarks/labelled.jsonl]
    python benchmarks/natural.py --read s1-opaq-T11-blind [--file benchmarks/labelled.jsonl]

Scene, labeling, variation, task and player may be repeated; everything is combined. An episode that
fails is added to the file without a code, and one that is there already is left alone. With
`--read` (a part of the name is enough) kept episodes are played again and told: what was asked,
each call with what came of it, what was in view, and how it ended. The label comes from this and
from the pictures in the run folders (`--out`); nothing here asks the diagnosis.
"""

from __future__ import annotations

import argparse
import itertools
import random
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import adamo_vh
from adamo_vh.action import ToolSchema
from adamo_vh.engine import World
from adamo_vh.inference.messages import AIMessage, Message
from adamo_vh.inference.model import Model, ModelInfo, ModelKind, Reply, Sampling
from adamo_vh.inference.registry import create_model
from adamo_vh.record.trajectory import read_trajectory

sys.path.append(str(Path(__file__).resolve().parents[1]))  # As a file it stands in no package.
from benchmarks.labelled import (
    LABELLED,
    End,
    Labelled,
    difference,
    end_of,
    played,
    read_labelled,
    write_labelled,
)
from benchmarks.telling import told

PLAYERS: dict[str, dict[str, Any]] = {
    "random": {"resolution": "640x360"},
    "blind": {"resolution": "640x360", "switches": {"pictures": "none"}},
    "dim": {"resolution": "96x64", "k": 3},
    "tiny": {"resolution": "64x64"},
    "forgetful": {"resolution": "160x90", "k": 1},
    "short": {"resolution": "640x360"},
    "shaky": {"resolution": "640x360"},
    "distracted": {"resolution": "640x360"},
}
"""Weakened players and how they are set up. All but `random` are the baseline: without pictures,
with small ones, with little memory; `short:N` may take N steps, `shaky:N` drops things half a metre
beside the place it means, and `distracted:N` makes every fourth call by lot (N is the seed)."""
_NUMBERED = ("random", "short", "shaky", "distracted")
_SHAKE_M = 0.5
_DISTRACTED = 0.25


class Weakened:
    """The baseline, with calls that come out otherwise than it meant them."""

    def __init__(self, kind: str, seed: int) -> None:
        """Sit down.

        Args:
            kind: "shaky" or "distracted".
            seed: Of the lots.
        """
        self._kind, self._seed = kind, seed
        self._lots = random.Random(f"{kind} {seed}")
        self._baseline, self._random = create_model("baseline"), create_model(f"random:{seed}")

    @property
    def info(self) -> ModelInfo:
        """Rules, and lots."""
        return ModelInfo(f"{self._kind}:{self._seed}", ModelKind.SCRIPTED)

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """What the baseline says, or what comes out of it."""
        if self._kind == "distracted" and self._lots.random() < _DISTRACTED:
            return self._random.complete(messages, tools, sampling)
        reply = self._baseline.complete(messages, tools, sampling)
        if self._kind == "shaky" and reply.message.calls:
            calls = tuple(
                replace(call, arguments=self._shaken(dict(call.arguments)))
                if call.name == "Drop" and call.arguments
                else call
                for call in reply.message.calls
            )
            return replace(reply, message=replace(reply.message, calls=calls))
        return reply

    def _shaken(self, arguments: dict[str, Any]) -> dict[str, Any]:
        for axis in ("x", "y"):
            arguments[axis] = round(arguments[axis] + self._lots.gauss(0, _SHAKE_M), 3)
        return arguments


def main() -> None:
    """Play and keep, or read."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    for name in ("scene", "labeling", "task", "player"):
        parser.add_argument(f"--{name}", action="append", default=[])
    parser.add_argument("--variation", action="append", type=int)
    parser.add_argument("--read", metavar="NAME")
    parser.add_argument("--file", type=Path, default=LABELLED)
    parser.add_argument("--out", type=Path, help="keep the run folders here")
    arguments = parser.parse_args()
    kept = list(read_labelled(arguments.file)) if arguments.file.exists() else []
    with tempfile.TemporaryDirectory() as folder:
        out = arguments.out or Path(folder)
        if arguments.read is not None:
            _read(kept, arguments.read, out)
            return
        fresh = [episode for episode in _wanted(arguments) if episode.name not in _names(kept)]
        for episode, engine in _with_engines(fresh):
            done = _kept(episode, engine, out)
            if done is not None:
                kept.append(done)
                write_labelled(kept, arguments.file)
                print(f"kept {done.name}", flush=True)


def _names(episodes: Sequence[Labelled]) -> set[str]:
    return {episode.name for episode in episodes}


def _wanted(arguments: argparse.Namespace) -> Iterator[Labelled]:
    for scene, variation, labeling, task, player in itertools.product(
        arguments.scene,
        arguments.variation or [0],
        arguments.labeling,
        arguments.task,
        arguments.player,
    ):
        kind, _, number = player.partition(":")
        if kind not in PLAYERS or (kind in _NUMBERED) is not number.isdigit():
            names = (f"{name}:N" if name in _NUMBERED else name for name in PLAYERS)
            raise SystemExit(f"There is no player {player!r}. Use one of {', '.join(names)}.")
        settings = dict(PLAYERS[kind])
        if kind == "short":
            settings["max_steps"] = int(number)
        nothing = End("", (), (), ())
        yield Labelled(
            scene, variation, labeling, task, player, settings, "", "", nothing, replies=()
        )


def _with_engines(episodes: Sequence[Labelled]) -> Iterator[tuple[Labelled, World]]:
    def place(episode: Labelled) -> tuple[str, int]:
        return episode.scene, episode.variation

    for (scene, variation), group in itertools.groupby(sorted(episodes, key=place), key=place):
        engine = adamo_vh.create_engine(scene, variation=variation)
        for episode in group:
            yield episode, engine
        engine.close()


def _kept(episode: Labelled, engine: World, out: Path) -> Labelled | None:
    """The episode with its replies, if it failed and is the same when they are given again."""
    kind, _, number = episode.player.partition(":")
    model: Model | str = "baseline"
    if kind == "random":
        model = episode.player
    elif kind in ("shaky", "distracted"):
        model = Weakened(kind, int(number))
    folder = out / f"{episode.name}-first"
    result = played(episode, model, engine, folder)
    if result.completion is None or result.strict == 1:
        return None
    replies = [thought.reply for thought in read_trajectory(folder).thoughts]
    done = replace(
        episode,
        end=end_of(episode, result, folder),
        replies=tuple(_entry(reply.message) for reply in replies),
    )
    again = end_of(done, done.again(engine, out), out / done.name)
    if changed := difference(done.end, again):
        print(f"not kept: {done.name}: {changed}")
        return None
    return done


def _entry(message: AIMessage) -> dict[str, Any]:
    """A reply as a script file holds it."""
    if not message.calls:
        return {"note": message.text}
    (call,) = message.calls
    return {"tool": call.name, "args": dict(call.arguments or {}), "note": message.text}


def _read(kept: Sequence[Labelled], name: str, out: Path) -> None:
    for episode, engine in _with_engines([e for e in kept if name in e.name]):
        result = episode.again(engine, out)
        print("\n".join(told(episode, result, out / episode.name)), flush=True)
        if changed := difference(episode.end, end_of(episode, result, out / episode.name)):
            print(f"  NOT THE EPISODE THAT WAS READ: {changed}")


if __name__ == "__main__":
    main()
