"""The executor of many machines: actors of a Ray cluster, each of which may be lost at any moment.

An actor plays in a folder of its own machine and publishes each episode whole. What all machines
share, the study's budget and its pace with providers, is kept by one actor on the machine that gave
the command. With a machine only the episodes that it played are lost, and played again elsewhere.
"""

from __future__ import annotations

import os
import signal
import socket
import tempfile
import threading
import time
import warnings
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from adamo_vh.errors import AdamoError, ConfigError
from adamo_vh.inference.remote.gate import Ticket
from adamo_vh.inference.remote.retry import Failure
from adamo_vh.study.executor import Failed, Finished, Lost, Noted, Report
from adamo_vh.study.ledger import Amount, StudyLedger
from adamo_vh.study.limiter import LIMITS, Limiter
from adamo_vh.study.plan import Planned
from adamo_vh.study.publishing import check_place, collect, forget, publish
from adamo_vh.study.store import episode_folder
from adamo_vh.study.worker import BEAT_S, Player, Setup

_AT_ONCE = 1024
"""Requests to the office that may wait at the same time."""
_NO_SEAT_S = 60.0
"""Seconds without a single actor after which people are told."""


@dataclass(frozen=True, slots=True)
class Cluster:
    """Which machines play, and where they put what they have played."""

    address: str = ""
    """Of the cluster; by default the one that Ray finds, or a new one on this machine."""
    shared: str = ""
    """Folder that all machines see, or a URL; the study's folder by default."""


class Office:
    """Keeps budget and pace for all machines; one actor beside the study's folder."""

    def __init__(self, setup: Setup) -> None:
        """Open the files."""
        self._parts = {
            "purse": StudyLedger(setup.folder, setup.budget),
            "gate": Limiter(setup.folder / LIMITS, setup.rates),
        }

    def ask(
        self, part: str, what: str, arguments: tuple[Any, ...]
    ) -> tuple[Any, AdamoError | None]:
        """Do something for another machine: the answer, or the error.

        An error that is raised here would come out there as one of Ray's, with a whole traceback.
        """
        try:
            return getattr(self._parts[part], what)(*arguments), None
        except AdamoError as error:
            return None, error


class _Line:
    """A line to the office: purse and gate for those who play elsewhere."""

    def __init__(self, office: Any, part: str) -> None:
        self._office, self._part = office, part

    def _ask(self, what: str, *arguments: Any) -> Any:
        import ray

        answer, error = ray.get(self._office.ask.remote(self._part, what, arguments))
        if error is not None:
            raise error
        return answer


class _FarPurse(_Line):
    def reserve(self, episode: str, most: Amount) -> int:
        return int(self._ask("reserve", episode, most))

    def settle(self, number: int, took: Amount) -> None:
        self._ask("settle", number, took)


class _FarGate(_Line):
    def acquire(self, provider: str, tokens: int) -> Ticket:
        ticket: Ticket = self._ask("acquire", provider, tokens)
        return ticket

    def settle(self, ticket: Ticket, tokens: int, failure: Failure | None = None) -> None:
        self._ask("settle", ticket, tokens, failure)


class Seat:
    """Plays on some machine of the cluster, in a folder of that machine."""

    def __init__(self, setup: Setup, office: Any, place: str) -> None:
        """Take a seat.

        Args:
            setup: The study, with the folder of the machine that gave the command.
            office: Keeps budget and pace.
            place: Where episodes are published.
        """
        self._folder = Path(tempfile.mkdtemp(prefix="adamo-vh-"))
        self._place = place
        self._notes: list[Noted] = []
        warnings.showwarning = lambda message, *_, **__: self._notes.append(Noted(str(message)))
        self._player = Player(
            replace(setup, folder=self._folder),
            purse=_FarPurse(office, "purse"),
            gate=_FarGate(office, "gate"),
        )
        threading.Thread(target=self._watch, daemon=True).start()

    def _watch(self) -> None:
        """End this process when an episode in it hangs, as a kill would."""
        while not self._player.hangs:
            time.sleep(BEAT_S)
        os._exit(1)

    def ready(self) -> None:
        """Answer, which says that there is a machine for it."""

    def play(self, planned: Planned) -> list[Report]:
        """Play an episode and publish it; go on with one that was published before."""
        run = episode_folder(self._folder, planned.key)
        report: Report
        try:
            if not run.is_dir():
                collect(self._place, planned.key, run)
            report = self._player.play(planned)
            if isinstance(report, Finished):
                publish(run, self._place, planned.key)
                forget(run)
        except AdamoError as error:
            report = Failed(planned.key, str(error), fatal=True)
        notes, self._notes = self._notes, []
        return [*notes, report]


@dataclass(slots=True, eq=False)
class _Taken:
    """A seat as it is seen from the machine that gives the orders."""

    actor: Any
    ready: Any
    """Is there as soon as it has a machine; None from then on."""
    playing: dict[Any, Planned] = field(default_factory=dict)
    """What it plays, by the promise of its report."""
    alone: bool = False


class RayExecutor:
    """Plays episodes on the machines of a Ray cluster."""

    def __init__(
        self,
        setup: Setup,
        cluster: Cluster,
        workers: int | None = None,
        in_flight: int = 1,
        most: int = 256,
    ) -> None:
        """Join a cluster and ask it for processes.

        Args:
            setup: The study.
            cluster: Where to play.
            workers: Processes in the whole cluster, each of which takes one core; as many as it has
                cores by default.
            in_flight: Episodes at once in each.
            most: Processes that have something to do.

        Raises:
            ConfigError: The extra `cluster` is missing, or the cluster cannot be reached.
            FileError: The place to publish cannot be reached.
        """
        self._setup, self._in_flight = setup, in_flight
        self._place = cluster.shared or str(setup.folder)
        check_place(self._place)
        self._is_own = _join(cluster.address)
        self._office = _office(setup)
        self._begun, self._told = time.monotonic(), False
        count = _cores() if workers is None else workers
        self._seats = [self._born() for _ in range(min(count, most))]

    def can_take(self, *, alone: bool = False) -> bool:
        """Whether another episode can be started now."""
        return self._free(alone=alone) is not None

    def start(self, planned: Planned, *, alone: bool = False) -> None:
        """Send an episode to the process that has least to do."""
        seat = self._free(alone=alone)
        assert seat is not None
        seat.playing[seat.actor.play.remote(planned)] = planned
        seat.alone = alone

    def _free(self, *, alone: bool) -> _Taken | None:
        most = 1 if alone else self._in_flight
        free = [s for s in self._seats if not s.ready and len(s.playing) < most and not s.alone]
        return min(free, key=lambda seat: len(seat.playing), default=None)

    def wait(self, seconds: float) -> Sequence[Report]:
        """What has come; processes that are gone are replaced, wherever there is room."""
        import ray

        waiting = [p for seat in self._seats for p in (seat.ready, *seat.playing) if p]
        if not waiting:
            time.sleep(seconds)
            return []
        ray.wait(waiting, num_returns=1, timeout=seconds, fetch_local=False)
        done, _ = ray.wait(waiting, num_returns=len(waiting), timeout=0, fetch_local=False)
        reports: list[Report] = []
        for promise in done:
            seat = next((s for s in self._seats if promise in (s.ready, *s.playing)), None)
            if seat is not None:  # Else it is gone with another promise of this round.
                reports.extend(self._heard(seat, promise))
        return [*reports, *self._complaint()]

    def _heard(self, seat: _Taken, promise: Any) -> list[Report]:
        import ray
        from ray.exceptions import RayError

        try:
            reports = ray.get(promise)
        except RayError as error:
            return [self._died(seat, error)]
        if promise is seat.ready:
            seat.ready = None
            return []
        planned = seat.playing.pop(promise)
        seat.alone = False
        return [self._taken(planned, report) for report in reports]

    def _taken(self, planned: Planned, report: Report) -> Report:
        """A report whose episode is in the study's folder now."""
        if isinstance(report, Finished):
            try:
                collect(self._place, planned.key, episode_folder(self._setup.folder, planned.key))
            except AdamoError as error:
                return Failed(planned.key, str(error), fatal=True)
        return report

    def _died(self, seat: _Taken, error: Exception) -> Lost:
        import ray

        with suppress(Exception):
            ray.kill(seat.actor)
        self._seats[self._seats.index(seat)] = self._born()
        said = [line for line in str(error).splitlines() if line.strip()]
        why = said[0].strip() if said else type(error).__name__
        keys = tuple(planned.key for planned in seat.playing.values())
        return Lost(keys, f"its machine or process in the cluster is gone ({why})")

    def _complaint(self) -> list[Report]:
        """Say, once, that the cluster has no room at all."""
        if any(not seat.ready for seat in self._seats):
            self._begun = time.monotonic()
        if self._told or time.monotonic() - self._begun < _NO_SEAT_S:
            return []
        self._told = True
        return [Noted("the cluster has no free core for a worker; it is waited for")]

    def _born(self) -> _Taken:
        import ray

        # Several processes draw faster with one thread each.
        environment = {"env_vars": {"LP_NUM_THREADS": "1"}}
        made = ray.remote(Seat).options(
            num_cpus=1, max_concurrency=self._in_flight + 1, runtime_env=environment
        )
        actor = made.remote(self._setup, self._office, self._place)
        return _Taken(actor, actor.ready.remote())

    def close(self) -> None:
        """End all processes at once, and leave the cluster."""
        import ray

        for seat in self._seats:
            with suppress(Exception):
                ray.kill(seat.actor)
        with suppress(Exception):
            ray.kill(self._office)
        if self._is_own:
            ray.shutdown()


def _join(address: str) -> bool:
    """Connect to a cluster; whether that was done here, and is to be undone."""
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    try:
        import ray
    except ImportError:
        raise ConfigError(
            'Playing on a cluster needs the extra "cluster": pip install "adamo-vh[cluster]"'
        ) from None
    if ray.is_initialized():
        return False
    # A signal that ends the command is heeded as without a cluster.
    before = signal.getsignal(signal.SIGTERM)
    try:
        _check_there(address)
        ray.init(address=address or None, log_to_driver=False, logging_level="ERROR")
    except Exception as error:
        # Ray's own errors have no common kind here.
        said = str(error).splitlines() or [type(error).__name__]
        raise ConfigError(
            f"The cluster {address or 'of this machine'} cannot be reached: {said[0]}. Start one "
            "(ray start --head), or name its address: --cluster HOST:PORT"
        ) from error
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, before)
    return True


def _check_there(address: str) -> None:
    """Make sure that somebody listens at an address, which Ray would wait for for minutes."""
    host, colon, port = address.rpartition("://")[2].rpartition(":")
    if colon and port.isdecimal():
        socket.create_connection((host, int(port)), timeout=10.0).close()


def _cores() -> int:
    import ray

    return max(1, int(ray.cluster_resources().get("CPU", 1)))


def _office(setup: Setup) -> Any:
    """The office, on this machine."""
    import ray
    from ray.util.scheduling_strategies import NodeAffinitySchedulingStrategy

    here = NodeAffinitySchedulingStrategy(ray.get_runtime_context().get_node_id(), soft=False)
    made = ray.remote(Office).options(
        num_cpus=0, max_concurrency=_AT_ONCE, scheduling_strategy=here
    )
    return made.remote(setup)
