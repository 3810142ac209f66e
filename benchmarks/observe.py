"""How long one full observation takes, stage by stage, beside the bare colour picture.

    python benchmarks/observe.py [--scene s1] [--repeats 15] [--json]

All figures are medians in milliseconds from one process, `ratio` is the median of observations and
bare pictures drawn in turn; `import_s` and `help_s` are medians of fresh processes. Stages:
`render_ms` bare colour picture with read-back, `ids_ms` what ids add, `visibility_ms` counts and
boxes, `points_ms` 36 rays, `overlay_ms` boxes, tags and JPEG, `observe_ms` all of it through the
public path.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import time
from collections.abc import Callable

from adamo_vh.perception import PerceptionConfig, perceive
from adamo_vh.perception.reference_points import reference_points
from adamo_vh.perception.visibility import visible_objects
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.rendering import SceneRenderer

WIDTH, HEIGHT = 1920, 1080


def median_ms(work: Callable[[], object], repeats: int) -> float:
    """Median duration after one warm-up."""
    work()
    samples = []
    for _ in range(repeats):
        started = time.perf_counter()
        work()
        samples.append((time.perf_counter() - started) * 1000)
    return statistics.median(samples)


def paired_ratio(work: Callable[[], object], base: Callable[[], object], repeats: int) -> float:
    """Median of the ratios of runs in turn, which drift and noise of the machine leave alone."""
    ratios = []
    for _ in range(repeats):
        started = time.perf_counter()
        base()
        between = time.perf_counter()
        work()
        ratios.append((time.perf_counter() - between) / (between - started))
    return statistics.median(ratios)


def process_s(code: list[str], repeats: int = 5) -> float:
    """Median wall seconds of a fresh process."""
    samples = []
    for _ in range(repeats):
        started = time.perf_counter()
        subprocess.run([sys.executable, *code], check=True, capture_output=True)
        samples.append(time.perf_counter() - started)
    return statistics.median(samples)


def measure(scene: str, repeats: int) -> dict[str, float]:
    """All figures for one scene."""
    engine = BuiltinEngine(scene)
    engine.reset(0)
    config = PerceptionConfig()
    percept = engine.capture(WIDTH, HEIGHT)
    renderer: SceneRenderer = engine.stage.renderer
    data, camera = engine.data, percept.camera

    def observe() -> object:
        engine.stage.forget()
        seen = engine.capture(WIDTH, HEIGHT)
        return perceive(seen, engine.body.rays, config, engine.object_names)

    def overlay() -> object:
        return perceive(percept, engine.body.rays, config, engine.object_names)

    figures = {
        "observe_ms": median_ms(observe, repeats),
        "render_ms": median_ms(lambda: renderer.color(data, camera), repeats),
        "draw_ms": median_ms(lambda: renderer.draw(data, camera), repeats),
        "visibility_ms": median_ms(lambda: visible_objects(percept, config.min_pixels), repeats),
        "points_ms": median_ms(lambda: reference_points(camera, engine.body.rays, 6), repeats),
        "perceive_ms": median_ms(overlay, repeats),
    }
    figures["ids_ms"] = figures["draw_ms"] - figures["render_ms"]
    figures["overlay_ms"] = figures["perceive_ms"] - figures["visibility_ms"] - figures["points_ms"]
    figures["ratio"] = paired_ratio(observe, lambda: renderer.color(data, camera), repeats)
    engine.close()
    bare = process_s(["-c", "pass"])
    figures["python_s"] = bare
    figures["import_s"] = process_s(["-c", "import adamo_vh"]) - bare
    figures["help_s"] = process_s(["-m", "adamo_vh", "--help"])
    return figures


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--scene", default="s1")
    parser.add_argument("--repeats", type=int, default=15)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    figures = measure(arguments.scene, arguments.repeats)
    if arguments.json:
        print(
            json.dumps({"scene": arguments.scene, **{k: round(v, 3) for k, v in figures.items()}})
        )
        return
    for name, value in figures.items():
        print(f"{name:<14} {value:10.3f}")


if __name__ == "__main__":
    main()
