"""The log of a room: all of it for whoever comes later, and within bounds."""

from __future__ import annotations

import threading
import time
from typing import Any

from adamo_vh.studio.log import Log
from adamo_vh.studio.pace import Pace


def pose(number: int, **things: Any) -> dict[str, Any]:
    return {"type": "pose", "body": [number, 0, 0], "things": things}


def test_messages_are_numbered_and_told_from_any_of_them_on():
    log = Log()
    for number in range(5):
        log.append({"type": "notice", "text": str(number)}, number / 2)
    assert [kept.message["n"] for kept in log.since(3)] == [3, 4, 5]
    assert log.since(6) == [] and len(log.since(0, most=2)) == 2
    assert '"t":1.0' in log.since(3)[0].text


def test_who_waits_is_woken_until_he_leaves():
    log, woken = Log(), []
    key = log.watch(lambda: woken.append(1))
    log.append({"type": "status"}, 0.0)
    assert log.watchers == 1 and woken == [1]
    log.leave(key)
    log.close()
    assert log.watchers == 0 and woken == [1] and log.closed


def test_a_long_log_keeps_every_event_and_loses_no_change_of_a_thing():
    log = Log(most=100)
    for number in range(600):
        if number % 50 == 0:
            log.append({"type": "event", "event": number}, number)
        log.append(pose(number, **{str(number % 7): [number]}), number)
    kept = log.since(0, most=10_000)
    assert len(kept) <= 101
    serials = [one.number for one in kept]
    assert serials == sorted(serials)
    poses = [one.message for one in kept if one.message["type"] == "pose"]
    assert poses[-1]["body"][0] == 599
    things: dict[str, Any] = {}
    for one in poses:
        things |= one["things"]
    assert things == {str(n % 7): [n] for n in range(593, 600)}


def test_when_there_are_too_many_events_the_oldest_go():
    log = Log(most=50)
    for number in range(200):
        log.append({"type": "event", "event": number}, 0.0)
    kept = log.since(0, most=1000)
    assert len(kept) <= 51 and kept[-1].message["event"] == 199


def test_simulated_time_keeps_pace_with_real_time():
    pace = Pace(threading.Event(), lambda: True)
    pace.speed = 4.0
    began = time.monotonic()
    for moment in range(9):
        pace.wait(moment * 0.1)
    assert 0.18 < time.monotonic() - began < 1.0


def test_nothing_is_waited_for_if_nobody_looks_or_it_is_cut():
    began = time.monotonic()
    unwatched = Pace(threading.Event(), lambda: False)
    for moment in range(100):
        unwatched.wait(float(moment))
    cut = threading.Event()
    cut.set()
    stopped = Pace(cut, lambda: True)
    stopped.wait(0.0)
    stopped.wait(100.0)
    assert time.monotonic() - began < 1.0


def test_what_was_late_is_not_made_up_in_a_rush():
    pace = Pace(threading.Event(), lambda: True)
    pace.wait(0.0)
    time.sleep(0.4)
    pace.wait(0.05)  # Late: from here on it goes at its speed again.
    began = time.monotonic()
    pace.wait(0.25)
    assert time.monotonic() - began > 0.12
