"""How many episodes an hour a study plays, where the time goes, and how much memory it takes.

    python benchmarks/throughput.py [--workers 1 --workers 2] [--repeats 3] [--json]
        [--only rate|shares|memory|waiting]

`rate`: the built-in baseline over all tasks, both scenes and both labelings at 1080p, with full
records and nothing drawn ahead (`--no-frame-cache`), in studies of their own with so many worker
processes, in turn. From the first episode that begins to the last that ends; starting processes
and building engines is in it, pages are not: they are made when somebody looks at them.
`shares`: the same in one process, with a clock on the functions that do the work; what none of
them explains is `rest`, and `overhead` is `store` and `rest`; `building` makes a scene, once.
`memory`: what one process gains over 500 further episodes.
`waiting`: a model behind a loopback server that takes 6 s for each answer, 2 workers with 16
episodes in flight each, three after the other in each place; `kept` is the rate of its calls
against that of 32 such calls at once with nothing between them: no picture, no diagnosis of the
failure. Memory is that of all processes together, shared pages counted once.
"""

from __future__ import annotations

import argparse
import functools
import gc
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

MATRIX = ("--scene", "s1,s2", "--labeling", "sem,opaq")
THINKING_S = 6.0
CALLS = 12
"""Calls of an episode of the model that takes its time."""
WAVES = 3
"""Episodes of that model in turn, for each that is in flight."""
WARM_UP, MORE = 60, 500
TARGETS = {
    "episodes/h, 2 workers": ">= 8000",
    "overhead": "<= 5 %",
    "waiting: kept": ">= 90 %",
    "waiting: memory": "<= 2500 MB",
}


# --- whole studies --------------------------------------------------------------------------


def study(folder: Path, *flags: str) -> subprocess.Popen[str]:
    """A study that plays, and prints what happens."""
    command = [sys.executable, "-m", "adamo_vh", "bench", "--out", str(folder), "--json", *flags]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)


def rate(workers: int) -> float:
    """Episodes an hour of the baseline's study."""
    with tempfile.TemporaryDirectory() as place:
        flags = ("--model", "baseline", "--no-frame-cache", "--workers", str(workers))
        process = study(Path(place) / "study", *MATRIX, *flags)
        assert process.stdout is not None
        begun, ended, done = 0.0, 0.0, 0
        for line in process.stdout:
            event = json.loads(line)["event"]
            begun = begun or (time.perf_counter() if event == "began" else 0.0)
            if event == "ended":
                ended, done = time.perf_counter(), done + 1
        if process.wait() != 0:
            raise SystemExit("The study failed; run it by hand to see why.")
    return done / (ended - begun) * 3600


# --- where the time goes --------------------------------------------------------------------


class Clock:
    """Adds up the time of functions by what they are for; a call within a call counts once."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = defaultdict(float)
        self._open: list[float] = []

    def watch(self, what: str, owner: Any, *names: str) -> None:
        """Put a clock on functions of a class or module."""
        for name in names:
            setattr(owner, name, self._timed(what, getattr(owner, name)))

    def _timed(self, what: str, work: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(work)
        def timed(*args: Any, **kwargs: Any) -> Any:
            begun = time.perf_counter()
            self._open.append(0.0)
            try:
                return work(*args, **kwargs)
            finally:
                passed = time.perf_counter() - begun
                self.seconds[what] += passed - self._open.pop()
                if self._open:
                    self._open[-1] += passed

        return timed


def matrix() -> Sequence[Any]:
    """The baseline's study as a plan."""
    from adamo_vh.benchmark.tasks import TASKS
    from adamo_vh.study.plan import Study, plan

    tasks = tuple(task.id for task in TASKS)
    return plan(Study(tasks, ("s1", "s2"), ("sem", "opaq"), ("baseline",)))


def play_all(folder: Path, episodes: Sequence[Any]) -> Iterator[None]:
    """Play episodes one after the other, as a worker does with one in flight."""
    from adamo_vh.study.executor import Finished
    from adamo_vh.study.worker import Player, Setup

    player = Player(Setup(folder, frame_cache=False))
    for planned in episodes:
        report = player.play(planned)
        assert isinstance(report, Finished), report
        yield


def shares() -> dict[str, float]:
    """What part of the time each kind of work takes, in hundredths."""
    from adamo_vh.action_server import local
    from adamo_vh.inference.baseline.model import BaselineModel
    from adamo_vh.record.writer import TrajectoryWriter
    from adamo_vh.runtime.builtin import BuiltinEngine
    from adamo_vh.runtime.builtin_body import BuiltinBody
    from adamo_vh.runtime.rendering import SceneRenderer
    from adamo_vh.session import pooling, session
    from adamo_vh.study import playing

    episodes, clock = matrix(), Clock()
    with tempfile.TemporaryDirectory() as place:
        for _ in play_all(Path(place) / "warm", episodes[:: len(episodes) // 2]):
            pass
        clock.watch("building", pooling, "create_engine")
        clock.watch("render", SceneRenderer, "draw", "color", "layers")
        clock.watch("perception", local.LocalActionServer, "_view")
        clock.watch("physics", BuiltinBody, "look", "walk", "pick", "drop", "rays", "see")
        clock.watch("physics", BuiltinEngine, "state", "snapshot", "restore", "reset")
        clock.watch("model", BaselineModel, "complete")
        clock.watch("store", TrajectoryWriter, "notify")
        clock.watch("store", session, "write_record")
        clock.watch("store", playing, "finished")
        for number, _ in enumerate(play_all(Path(place) / "study", episodes)):
            if number == 0:
                clock.seconds.clear()
                begun = time.perf_counter()
        whole = time.perf_counter() - begun
    parts = {what: 100 * seconds / whole for what, seconds in clock.seconds.items()}
    parts["rest"] = 100 - sum(parts.values())
    return parts | {"overhead": parts["store"] + parts["rest"]}


# --- memory ---------------------------------------------------------------------------------


def growth_mb() -> float:
    """What a process gains over many episodes, after some that do not count."""
    episodes = matrix()
    before, count = 0.0, 0
    with tempfile.TemporaryDirectory() as place:
        for turn in range(1 + (WARM_UP + MORE) // len(episodes)):
            for _ in play_all(Path(place) / str(turn), episodes):
                count += 1
                if count == WARM_UP:
                    gc.collect()
                    before = memory_mb(os.getpid())
                if count == WARM_UP + MORE:
                    gc.collect()
                    return memory_mb(os.getpid()) - before
    raise AssertionError("fewer episodes than were asked for")


def memory_mb(pid: int) -> float:
    """Memory of a process and its children; what several share counts once. Linux only."""
    try:
        rollup = Path(f"/proc/{pid}/smaps_rollup").read_text()
        children = [
            int(child)
            for task in Path(f"/proc/{pid}/task").glob("*/children")
            for child in task.read_text().split()
        ]
    except OSError:
        return 0.0
    own = next(int(line.split()[1]) for line in rollup.splitlines() if line.startswith("Pss:"))
    return own / 1000 + sum(map(memory_mb, children))


# --- a model that takes its time -----------------------------------------------------------


class SlowMind(BaseHTTPRequestHandler):
    """Answers as an OpenAI-compatible server that thinks for a while."""

    protocol_version = "HTTP/1.1"
    times: list[float] = []  # noqa: RUF012 (one server at a time)

    def do_POST(self) -> None:
        """Let the model look round, and then say that it is done."""
        request = self.rfile.read(int(self.headers["Content-Length"]))
        self.times.append(time.perf_counter())
        time.sleep(THINKING_S)
        # To read all of 5 MB would take the processors that the workers need.
        turns = len(re.findall(rb'"role": ?"assistant"', request))
        self.times.append(time.perf_counter())
        said: dict[str, Any] = {"role": "assistant", "content": "I look round."}
        if turns < CALLS - 1:
            point = {"x": 2.0 - turns % 5, "y": -2.0 + turns % 3, "z": 0.8}
            call = {"name": "Look", "arguments": json.dumps(point)}
            said["tool_calls"] = [{"id": f"call_{turns}", "type": "function", "function": call}]
        reason = "tool_calls" if "tool_calls" in said else "stop"
        body = json.dumps(
            {
                "id": "reply",
                "object": "chat.completion",
                "created": 0,
                "model": "slow",
                "choices": [{"index": 0, "message": said, "finish_reason": reason}],
                "usage": {"prompt_tokens": 5000, "completion_tokens": 50, "total_tokens": 5050},
            }
        ).encode()
        self.send_response(200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *args: Any) -> None:
        """Say nothing."""


class _Server(ThreadingHTTPServer):
    daemon_threads = True
    request_queue_size = 256


@contextmanager
def slow_mind() -> Iterator[str]:
    """A server on loopback; the URI of its model."""
    SlowMind.times.clear()
    server = _Server(("127.0.0.1", 0), SlowMind)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"openai:slow@http://127.0.0.1:{server.server_port}/v1"
    finally:
        server.shutdown()


def waiting(workers: int = 2, in_flight: int = 16) -> dict[str, float]:
    """How well many episodes share few engines while their model thinks."""
    at_once = workers * in_flight
    most_mb = 0.0
    with tempfile.TemporaryDirectory() as place, slow_mind() as model:
        flags = [*MATRIX, "--tasks", "T1,T2,T3,T4,T5,T6,T7,T8", "--model", model]
        flags += ["--set", "tool_calls=native", "--no-frame-cache", "--workers", str(workers)]
        flags += ["--repetitions", str(WAVES)]
        flags += ["--in-flight", str(in_flight)]
        process = study(Path(place) / "study", *flags)
        while process.poll() is None:
            most_mb = max(most_mb, memory_mb(process.pid))
            time.sleep(1)
    times = SlowMind.times
    calls = len(times) / 2
    return {
        "calls": calls,
        "kept": 100 * calls / (max(times) - min(times)) / (at_once / THINKING_S),
        "memory_mb": most_mb,
    }


# --- all of it ------------------------------------------------------------------------------


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--workers", action="append", type=int)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--only", choices=("rate", "shares", "memory", "waiting"), action="append")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    chosen = given.only or ["rate", "shares", "memory", "waiting"]
    found: dict[str, Any] = {}
    if "rate" in chosen:
        workers = given.workers or [1, 2]
        rates: dict[int, list[float]] = {count: [] for count in workers}
        for _ in range(given.repeats):
            for count in workers:
                rates[count].append(rate(count))
        found["episodes_per_h"] = {n: statistics.median(every) for n, every in rates.items()}
    if "shares" in chosen:
        found["shares_percent"] = shares()
    if "memory" in chosen:
        found["growth_mb"] = growth_mb()
    if "waiting" in chosen:
        found["waiting"] = waiting()
    if given.json:
        print(json.dumps(found))
        return
    for what, value in found.items():
        rows = value.items() if isinstance(value, dict) else [("", value)]
        for name, figure in rows:
            print(f"{what:<16} {name!s:<12} {figure:10.1f}")
    print("Targets on 2 cores:", "; ".join(f"{what} {least}" for what, least in TARGETS.items()))


if __name__ == "__main__":
    main()
