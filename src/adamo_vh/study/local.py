"""The executor of one machine: worker processes, each of which may be killed at any moment.

Plain processes with a pipe each. A pool that shares one queue among its processes loses the others'
tasks, or itself, when one of them is killed at the wrong moment; here nothing is shared.
"""

from __future__ import annotations

import multiprocessing
import signal
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess

from adamo_vh.study.executor import Failed, Finished, Lost, Report
from adamo_vh.study.plan import Planned
from adamo_vh.study.worker import Alive, Played, Setup, work

_SILENT_S = 120.0
"""Seconds without a sign of life after which a worker is killed."""


@dataclass(slots=True, eq=False)
class _Worker:
    process: SpawnProcess
    pipe: Connection
    playing: dict[str, Planned] = field(default_factory=dict)
    explaining: set[str] = field(default_factory=set)
    """What of that has ended, and asks no model any more."""
    alone: bool = False
    """Whether nothing may be played beside what is."""
    heard: float = field(default_factory=time.monotonic)

    def places_taken(self, most: int) -> int:
        """How many of its places are; of several, what is only explained leaves its own."""
        left = min(len(self.explaining), most) if most > 1 else 0
        return len(self.playing) - left


class LocalExecutor:
    """Plays episodes in processes of this machine."""

    def __init__(
        self, setup: Setup, workers: int = 1, in_flight: int = 1, *, silent_s: float = _SILENT_S
    ) -> None:
        """Start the workers.

        Args:
            setup: The study.
            workers: Processes.
            in_flight: Episodes at once in each.
            silent_s: Seconds without a sign of life after which a worker is killed.
        """
        self._setup = setup
        self._in_flight = in_flight
        self._silent_s = silent_s
        self._workers = [self._born() for _ in range(workers)]

    @property
    def pids(self) -> tuple[int, ...]:
        """The processes."""
        return tuple(worker.process.pid or 0 for worker in self._workers)

    def can_take(self, *, alone: bool = False) -> bool:
        """Whether another episode can be started now."""
        return self._free(alone=alone) is not None

    def start(self, planned: Planned, *, alone: bool = False) -> None:
        """Send an episode to the worker that has least to do."""
        worker = self._free(alone=alone)
        assert worker is not None
        worker.playing[planned.key] = planned
        worker.alone = alone
        with suppress(OSError):  # If it has died, `wait` finds out and reports what is lost.
            worker.pipe.send(planned)

    def _free(self, *, alone: bool) -> _Worker | None:
        most = 1 if alone else self._in_flight
        free = [w for w in self._workers if w.places_taken(most) < most and not w.alone]
        return min(free, key=lambda worker: len(worker.playing), default=None)

    def wait(self, seconds: float) -> Sequence[Report]:
        """What has come; workers that died or fell silent are replaced."""
        ready = wait([worker.pipe for worker in self._workers], seconds)
        reports: list[Report] = []
        for worker in list(self._workers):
            if worker.pipe in ready:
                reports.extend(self._heard(worker))
            elif time.monotonic() - worker.heard > self._silent_s:
                worker.process.kill()
        return reports

    def _heard(self, worker: _Worker) -> list[Report]:
        reports: list[Report] = []
        try:
            while worker.pipe.poll():
                message = worker.pipe.recv()
                worker.heard = time.monotonic()
                if isinstance(message, Alive):
                    continue
                if isinstance(message, Played):
                    worker.explaining.add(message.key)
                    continue
                if isinstance(message, Finished | Failed):
                    del worker.playing[message.key]
                    worker.explaining.discard(message.key)
                    worker.alone = False
                reports.append(message)
        except (EOFError, OSError):
            # A killed process may have left half a message; nothing of it counts.
            reports.append(self._died(worker))
        return reports

    def _died(self, worker: _Worker) -> Lost:
        worker.process.kill()
        worker.process.join()
        worker.pipe.close()
        how = f"its process ended (exit code {worker.process.exitcode})"
        self._workers[self._workers.index(worker)] = self._born()
        return Lost(tuple(worker.playing), how)

    def _born(self) -> _Worker:
        spawn = multiprocessing.get_context("spawn")
        here, there = spawn.Pipe()
        process = spawn.Process(target=work, args=(there, self._setup), daemon=True)
        # Ctrl+C goes to every process of a terminal; only the one that gives orders heeds it.
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            process.start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        there.close()
        return _Worker(process, here)

    def close(self) -> None:
        """End all workers at once; idle ones have nothing to lose."""
        for worker in self._workers:
            worker.process.kill()
        for worker in self._workers:
            worker.process.join()
            worker.pipe.close()
