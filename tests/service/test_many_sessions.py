"""Many sessions, one after the other and at once: no memory is kept, and none disturbs another."""

from __future__ import annotations

import gc
import os
import weakref
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from adamo_vh.action_server.wire import Act, Create, Finish, Observe
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.service.hosting import Host

LOOKS = [{"x": x, "y": -1.0, "z": 0.8} for x in (0.0, 0.5, 1.0)]


def memory_mb() -> float:
    """What this process holds."""
    gc.collect()
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def played(host: Host, *, closed: bool, looks: int = len(LOOKS)) -> list[str]:
    """One session from its beginning to its end; the states that it went through."""
    hosted = host.create(Create("T1"))
    states = [hosted.perform(Act("Look", look)).answer for look in LOOKS[:looks]]
    hosted.perform(Observe())
    hosted.perform(Finish("Enough."))
    if closed:
        host.close(hosted.id)
    return [state.state_hash for state in states if state.type == "done"]


def test_sessions_at_once_go_as_alone(make_host: Callable[..., Host]) -> None:
    host = make_host(resolution="64x64")
    alone = played(host, closed=False)
    with ThreadPoolExecutor(6) as pool:
        together = list(pool.map(lambda _: played(host, closed=False), range(6)))
    assert together == [alone] * 6
    for hosted in host.sessions():
        acts = read_trajectory(hosted.folder).acts
        assert [act.state_hash for act in acts] == alone


def test_what_is_closed_is_not_kept(make_host: Callable[..., Host]) -> None:
    host = make_host(resolution="64x64", most_sessions=2)
    began = []
    for _ in range(4):
        hosted = host.create(Create("T1"))
        hosted.perform(Act("Look", LOOKS[0]))
        began.append(weakref.ref(hosted))
        host.close(hosted.id)
    del hosted
    assert host.sessions() == () and len(host._folders) == 4
    gc.collect()
    assert [one() for one in began] == [None] * 4


@pytest.mark.slow
def test_a_hundred_sessions_leave_the_memory_flat(make_host: Callable[..., Host]) -> None:
    host = make_host(resolution="64x64", most_sessions=4)
    for _ in range(10):
        played(host, closed=True, looks=1)
    before = memory_mb()
    for _ in range(100):
        played(host, closed=True, looks=1)
    assert memory_mb() - before < 20
