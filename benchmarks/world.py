"""How long the world's own work takes, without pictures, and how much memory an engine holds.

    python benchmarks/world.py [--scene s1 --scene s2] [--repeats 9] [--episodes 500] [--json]

Medians of one process. `look_ms`, `walk_ms`, `pick_ms` and `drop_ms` are the simulated part of an
action, over a round of several objects and places; `create_s` is an engine with a warm cache;
`first_frame_s` is a fresh process from the import to the first annotated full-size frame.
`resident_mb` is the process with one engine and its renderer, `growth_mb` what it gains over many
short episodes of a reset, four actions and one small observation.
"""

from __future__ import annotations

import argparse
import gc
import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

from adamo_vh.action_server import LocalActionServer
from adamo_vh.geometry import Vec3
from adamo_vh.runtime.builtin import BuiltinEngine

FIRST_FRAME = """
import time
started = time.perf_counter()
import adamo_vh
from adamo_vh.action_server import LocalActionServer
engine = adamo_vh.create_engine({scene!r})
engine.reset(0)
LocalActionServer(engine).observe()
print(time.perf_counter() - started)
"""
SMALL = (320, 180)
WARM_UP_EPISODES = 20
"""Caches fill and allocators settle in the first ones."""
TARGETS = {
    "look_ms": 60, "walk_ms": 60, "pick_ms": 60, "drop_ms": 60, "reset_ms": 400,
    "snapshot_restore_ms": 20, "first_frame_s": 3, "resident_mb": 600,
}  # fmt: skip
PLACES = (
    Vec3(-1.8, -2.5, 0.0), Vec3(2.0, -2.0, 0.0), Vec3(-1.0, 2.2, 0.0), Vec3(0.2, -1.0, 0.0),
)  # fmt: skip


def median_ms(work: Callable[[], object], repeats: int) -> float:
    """Median duration after one warm-up."""
    work()
    return statistics.median(timed_ms(work) for _ in range(repeats))


def timed_ms(work: Callable[[], object]) -> float:
    """Duration of one call."""
    started = time.perf_counter()
    work()
    return (time.perf_counter() - started) * 1000


def actions_ms(engine: BuiltinEngine, things: int) -> dict[str, float]:
    """Median duration of each kind of action: objects are carried from where they are."""
    samples: dict[str, list[float]] = {"look_ms": [], "walk_ms": [], "pick_ms": [], "drop_ms": []}
    engine.reset(0)
    for count, item in enumerate(engine.state().objects[:things]):
        home, place = item.box.center, PLACES[count % len(PLACES)]
        samples["look_ms"].append(timed_ms(partial(engine.body.look, home)))
        samples["pick_ms"].append(timed_ms(partial(engine.body.pick, item.id)))
        samples["walk_ms"].append(timed_ms(partial(engine.body.walk, place)))
        samples["drop_ms"].append(timed_ms(partial(engine.body.drop, home)))
    return {name: statistics.median(values) for name, values in samples.items()}


def first_frame_s(scene: str, repeats: int) -> float:
    """Median seconds from the import to the first annotated frame, in fresh processes."""
    program = [sys.executable, "-c", FIRST_FRAME.format(scene=scene)]
    runs = (
        subprocess.run(program, check=True, capture_output=True, text=True) for _ in range(repeats)
    )
    return statistics.median(float(run.stdout) for run in runs)


def resident_mb() -> float:
    """Memory of this process that is in RAM; Linux only."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def growth_mb(engine: BuiltinEngine, episodes: int) -> float:
    """What the process gains over many short episodes, after some that do not count."""
    ids = sorted(engine.object_names)
    before = 0.0
    for episode in range(WARM_UP_EPISODES + episodes):
        if episode == WARM_UP_EPISODES:
            gc.collect()
            before = resident_mb()
        engine.reset(episode)
        engine.body.pick(ids[episode % len(ids)])
        engine.body.walk(PLACES[episode % len(PLACES)])
        engine.body.drop(PLACES[(episode + 1) % len(PLACES)])
        engine.body.look(Vec3(0.0, -1.0, 0.8))
        LocalActionServer(engine, resolution=SMALL).observe()
    gc.collect()
    return resident_mb() - before


def measure(scene: str, repeats: int, episodes: int) -> dict[str, float]:
    """All figures for one scene."""
    engine = BuiltinEngine(scene)
    figures = actions_ms(engine, 12)
    figures["reset_ms"] = median_ms(lambda: engine.reset(0), repeats)
    kept = engine.snapshot()
    figures["snapshot_ms"] = median_ms(engine.snapshot, repeats)
    figures["restore_ms"] = median_ms(lambda: engine.restore(kept), repeats)
    figures["snapshot_restore_ms"] = figures["snapshot_ms"] + figures["restore_ms"]
    figures["state_ms"] = median_ms(engine.state, repeats)
    figures["first_frame_s"] = first_frame_s(scene, 3)
    LocalActionServer(engine).observe()
    gc.collect()
    figures["resident_mb"] = resident_mb()
    figures["growth_mb"] = growth_mb(engine, episodes)
    engine.close()
    # Last, because its engines would count as memory of the one above.
    figures["create_s"] = median_ms(lambda: BuiltinEngine(scene).close(), 3) / 1000
    return figures


def fresh(scene: str, arguments: argparse.Namespace) -> dict[str, float]:
    """The figures from a process of its own, so that scenes do not share memory."""
    command = [sys.executable, __file__, "--scene", scene, "--in-process", "--json"]
    command += ["--repeats", str(arguments.repeats), "--episodes", str(arguments.episodes)]
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    figures: dict[str, float] = json.loads(done.stdout)[scene]
    return figures


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--scene", action="append")
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--episodes", type=int, default=500)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--in-process", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    results: dict[str, dict[str, float]] = {}
    for scene in arguments.scene or ["s1", "s2"]:
        if arguments.in_process:
            results[scene] = measure(scene, arguments.repeats, arguments.episodes)
        else:
            results[scene] = fresh(scene, arguments)
    if arguments.json:
        rounded = {s: {k: round(v, 3) for k, v in f.items()} for s, f in results.items()}
        print(json.dumps(rounded))
        return
    print(f"{'':<20}" + "".join(f"{scene:>10}" for scene in results) + f"{'target':>10}")
    for name in next(iter(results.values())):
        row = "".join(f"{figures[name]:10.2f}" for figures in results.values())
        print(f"{name:<20}{row}{TARGETS.get(name, ''):>10}")


if __name__ == "__main__":
    main()
