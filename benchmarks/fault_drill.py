"""Kills workers and supervisors of a study at random moments, and looks for what that cost.

    python benchmarks/fault_drill.py [--kills 50] [--workers 2] [--episodes 24] [--seed 1] [--json]

The same study is played undisturbed, and again and again under fire until so many kills are made.
Each time nothing that was finished may be lost or played twice, and the report without timings must
be the same, byte for byte.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

_LONGEST_S = 6.0
"""Seconds at most between two kills."""


@dataclass
class Drill:
    """One study that is played under fire."""

    folder: Path
    command: list[str]
    lots: random.Random
    kills: Counter[str] = field(default_factory=Counter)
    finished: dict[str, str] = field(default_factory=dict)
    """Digests of the results that were seen, by episode."""
    lost: set[str] = field(default_factory=set)
    doubled: set[str] = field(default_factory=set)

    def play(self, most_kills: int) -> None:
        """Play to the end; kills no more than so often."""
        while True:
            process = subprocess.Popen(
                [*self.command, "--out", str(self.folder)],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            while process.poll() is None and self.kills.total() < most_kills:
                time.sleep(self.lots.uniform(0.1, _LONGEST_S))
                self._strike(process)
                self.look()
            if process.wait() == 0:
                self.look()
                return

    def _strike(self, process: subprocess.Popen[bytes]) -> None:
        """Kill a worker, the supervisor, or all of them."""
        whom = self.lots.choice(("worker", "worker", "supervisor", "all"))
        workers = _children(process.pid)
        victims = [process.pid, *workers]
        if whom == "worker":
            victims = [self.lots.choice(workers)] if workers else []
        elif whom == "supervisor":
            victims = [process.pid]
        if process.poll() is not None or not victims:
            return
        for pid in victims:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                continue
        self.kills[whom] += 1

    def look(self) -> None:
        """See that what was finished is as it was."""
        now = {
            str(path.parent.relative_to(self.folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in self.folder.glob("episodes/**/result.json")
        }
        for episode, digest in self.finished.items():
            if episode not in now:
                self.lost.add(episode)
            elif now[episode] != digest:
                self.doubled.add(episode)
        self.finished |= now


def _children(pid: int) -> list[int]:
    """The workers of a supervisor; not the process that keeps its books of shared memory."""
    found = []
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        try:
            found += [int(child) for child in task.read_text().split()]
        except OSError:
            continue
    return [child for child in found if "spawn_main" in _words(child)]


def _words(pid: int) -> str:
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes().decode("utf-8", "replace")
    except OSError:
        return ""


def study_command(episodes: int, workers: int) -> list[str]:
    """The command that plays so many episodes or a few more, each of a second or less."""
    repetitions = -(-episodes // 4)
    return [
        *(sys.executable, "-m", "adamo_vh", "bench", "--tasks", "T1,T8", "--labeling", "sem,opaq"),
        *("--model", "random", "--repetitions", str(repetitions), "--resolution", "160x90"),
        *("--set", "limits.max_steps=8", "--workers", str(workers), "--json"),
    ]


def report(folder: Path) -> bytes:
    """The report without timings."""
    command = [sys.executable, "-m", "adamo_vh", "report", str(folder), "--json", "--no-timings"]
    return subprocess.run(command, capture_output=True, check=True).stdout


def drill(place: Path, kills: int, workers: int, episodes: int, seed: int) -> dict[str, Any]:
    """Play undisturbed and under fire; what was killed, lost, doubled, and reported otherwise.

    Args:
        place: An empty folder.
        kills: How many at least.
        workers: Processes of each study.
        episodes: Of each study.
        seed: Of the moments and the victims.
    """
    command, lots = study_command(episodes, workers), random.Random(seed)
    subprocess.run([*command, "--out", str(place / "calm")], check=True, stdout=subprocess.DEVNULL)
    calm = report(place / "calm")
    done: Counter[str] = Counter()
    lost, doubled, otherwise, rounds = 0, 0, 0, 0
    while done.total() < kills:
        rounds += 1
        run = Drill(place / f"fire-{rounds}", command, lots)
        run.play(kills - done.total())
        done += run.kills
        lost += len(run.lost)
        doubled += len(run.doubled)
        otherwise += report(run.folder) != calm
        planned = json.loads((run.folder / "study.json").read_text())["episodes"]
        lost += len(planned) - len(run.finished)
    return {
        "kills": dict(sorted(done.items())),
        "studies": rounds,
        "episodes": rounds * len(planned),
        "lost": lost,
        "doubled": doubled,
        "reports_that_differ": otherwise,
    }


def main() -> int:
    """Drill and print what came of it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--episodes", type=int, default=24)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        found = drill(Path(place), given.kills, given.workers, given.episodes, given.seed)
    if given.json:
        print(json.dumps(found))
    else:
        for name, value in found.items():
            print(f"{name:<20} {value}")
    return int(bool(found["lost"] or found["doubled"] or found["reports_that_differ"]))


if __name__ == "__main__":
    sys.exit(main())
