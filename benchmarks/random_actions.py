"""Play many random actions, good, bad and nonsense, and count what breaks the rules of the world.

    python benchmarks/random_actions.py [--actions 2000] [--scene s1 --scene s2] [--json]

After every action the state is checked, and the feedback against the state; now and then a view
too, and that the same call gives the same state again. Each violation is printed with the seed and
the number of the action: the same arguments play the same actions.
"""

from __future__ import annotations

import argparse
import json
import random
import statistics
import sys
import time
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

from adamo_vh.action import parse
from adamo_vh.action_server import LocalActionServer, execute_call
from adamo_vh.action_server.soundness import state_faults, step_faults, view_faults
from adamo_vh.errors import InvalidActionError
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.inspection.soundness import Soundness

EPISODE_ACTIONS = 50
RESOLUTION = (320, 180)
NONSENSE: tuple[tuple[str, dict[str, Any] | None], ...] = (
    ("Fly", {"x": 0, "y": 0, "z": 1}),
    ("look", {"x": 0, "y": 0, "z": 1}),
    ("", {}),
    ("Walk", None),
    ("Walk", {"x": 1.0}),
    ("Walk", {"x": "near the table", "y": 0, "z": 0}),
    ("Look", {"x": float("nan"), "y": 0, "z": 0}),
    ("Look", {"x": 1e30, "y": -1e30, "z": 1}),
    ("Pick", {"object": ""}),
    ("Pick", {"object": "Unicorn_999"}),
    ("Pick", {"object": ["Key_34"]}),
    ("Drop", {"object": "Key_34", "x": 0, "y": 0, "z": 0, "gently": True}),
)


@dataclass(slots=True)
class Tally:
    """What was played in one scene, and what came of it."""

    actions: int = 0
    views: int = 0
    repeats: int = 0
    outcomes: Counter[str] = field(default_factory=Counter)
    milliseconds: dict[str, list[float]] = field(default_factory=dict)
    violations: list[str] = field(default_factory=list)


class RandomPlayer:
    """Plays seeded episodes in one scene."""

    def __init__(self, scene: str, view_every: int, repeat_every: int) -> None:
        self._engine = BuiltinEngine(scene)
        self._world = self._engine._world
        self._rules = Soundness(self._world)
        self._view_every, self._repeat_every = view_every, repeat_every
        self.tally = Tally()

    def episode(self, seed: int, actions: int) -> None:
        """Play one episode from the start of the scene."""
        self._engine.reset(seed)
        server = LocalActionServer(self._engine, resolution=RESOLUTION, refresh_after=frozenset())
        # Everything counts as seen, so that most actions can be tried without a picture.
        server.load(json.dumps(json.loads(server.save()) | {"seen": list(self._ids.values())}))
        choose = random.Random(f"{self._engine.scene.name} {seed}")
        for number in range(actions):
            name, arguments = self._call(choose)
            for fault in self._act(server, name, arguments):
                self.tally.violations.append(
                    f"seed {seed}, action {number}, {name} {arguments}: {fault}"
                )

    @property
    def _ids(self) -> dict[str, int]:
        return {f"{name}_{i}": i for i, name in self._engine.object_names.items()}

    def _act(
        self, server: LocalActionServer, name: str, arguments: dict[str, Any] | None
    ) -> list[str]:
        tally, engine = self.tally, self._engine
        saved, before = server.save(), engine.state()
        started = time.perf_counter()
        result = execute_call(server, name, arguments)
        taken = (time.perf_counter() - started) * 1000
        after = engine.state()
        tally.actions += 1
        tally.outcomes[f"{name[:8]} {result.feedback.code}"] += 1
        tally.milliseconds.setdefault(name[:8], []).append(taken)
        faults = [*state_faults(after), *self._rules.faults(after)]
        try:
            action = parse(name, arguments, server.actions)
        except InvalidActionError:
            if after.hash() != before.hash():
                faults.append("an invalid call changed the world")
        else:
            faults += step_faults(before, after, action, result.feedback)
        if tally.actions % self._repeat_every == 0:
            tally.repeats += 1
            now = server.save()
            server.load(saved)
            if execute_call(server, name, arguments).state_hash != result.state_hash:
                faults.append("the same call from the same snapshot gave another state")
            server.load(now)
            if server.state_hash() != result.state_hash:
                faults.append("a snapshot came back as another state")
        if tally.actions % self._view_every == 0:
            tally.views += 1
            faults += view_faults(
                engine.capture(*RESOLUTION), server.observe().observation, self._ids, after
            )
        return faults

    def _call(self, choose: random.Random) -> tuple[str, dict[str, Any] | None]:
        """A call as a model would write it; about one in twelve is nonsense."""
        if choose.random() < 0.08:
            return choose.choice(NONSENSE)
        held = self._engine.body.state().held
        tags = {i: tag for tag, i in self._ids.items()}
        point = self._point(choose)
        kind = choose.random()
        if kind < 0.15:
            return "Look", point
        if kind < 0.35:
            return "Walk", point
        if held is None or kind < 0.40:
            return "Pick", {"object": choose.choice(list(tags.values()))}
        return "Drop", {"object": tags[held], **point}

    def _point(self, choose: random.Random) -> dict[str, Any]:
        """A point near an object, near something that carries, or anywhere; sometimes outside."""
        room, kind = self._engine.scene, choose.random()
        if kind < 0.35:
            near = choose.choice(self._engine.state().objects).box.center
        elif kind < 0.65:
            surface = choose.choice(self._world.surfaces)
            near, spread = surface.center, max(surface.half_x, surface.half_y)
            x, y = (near.x, near.y)
            return _written(
                x + choose.uniform(-spread, spread), y + choose.uniform(-spread, spread), near.z
            )
        else:
            over = 0.2 if choose.random() < 0.1 else 0.0
            return _written(
                choose.uniform(room.x_min - over, room.x_max + over),
                choose.uniform(room.y_min - over, room.y_max + over),
                choose.choice((0.0, 0.0, choose.uniform(-over, room.height_m + over))),
            )
        return _written(near.x + choose.gauss(0, 0.1), near.y + choose.gauss(0, 0.1), near.z)

    def close(self) -> None:
        """Free the engine."""
        self._engine.close()


def _written(x: float, y: float, z: float) -> dict[str, Any]:
    return {"x": round(x, 2), "y": round(y, 2), "z": round(z, 2)}


def play(scene: str, options: argparse.Namespace) -> dict[str, Any]:
    """All episodes of one scene, as one record."""
    player = RandomPlayer(scene, options.view_every, options.repeat_every)
    started, tally = time.perf_counter(), player.tally
    for episode in range(-(-options.actions // EPISODE_ACTIONS)):
        left = options.actions - episode * EPISODE_ACTIONS
        known = len(tally.violations)
        player.episode(options.seed + episode, min(EPISODE_ACTIONS, left))
        for violation in tally.violations[known:]:
            print(f"{scene}: {violation}", file=sys.stderr, flush=True)
    player.close()
    return {
        "actions": tally.actions,
        "views": tally.views,
        "repeats": tally.repeats,
        "violations": len(tally.violations),
        "seconds": round(time.perf_counter() - started, 1),
        "median_ms": {
            name: round(statistics.median(values), 2)
            for name, values in sorted(tally.milliseconds.items())
            if name in ("Look", "Walk", "Pick", "Drop")
        },
        "outcomes": dict(sorted(tally.outcomes.items())),
    }


def main() -> None:
    """Play and print; the exit code tells whether a rule was broken."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--actions", type=int, default=2000, help="in each scene")
    parser.add_argument("--scene", action="append")
    parser.add_argument("--seed", type=int, default=0, help="of the first episode")
    parser.add_argument("--view-every", type=int, default=50, help="actions from view to view")
    parser.add_argument("--repeat-every", type=int, default=10, help="actions between repeats")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    results = {scene: play(scene, options) for scene in options.scene or ["s1", "s2"]}
    if options.json:
        print(json.dumps(results))
    else:
        for scene, result in results.items():
            print(f"{scene}: {result['actions']} actions, {result['violations']} violations")
            for name, value in result.items():
                print(f"  {name:<11} {value}")
    sys.exit(any(result["violations"] for result in results.values()))


if __name__ == "__main__":
    main()
