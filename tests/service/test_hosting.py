"""The sessions of a server: how many, how long, and how they end."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from adamo_vh.action_server.wire import Act, Create, Finish, Observe, Say, Think
from adamo_vh.episode.result import read_manifest, read_result
from adamo_vh.errors import ConfigError, EpisodeOverError, RecordError
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.report.page import PAGE
from adamo_vh.service.hosting import Host, NoSessionError
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.pooling import BusyError, Engines

MakeHost = Callable[..., Host]
LOOK = Act("Look", {"x": 0.5, "y": -1.0, "z": 0.8})


def waited_for(fact: Callable[[], Any]) -> bool:
    until = time.monotonic() + 20
    while not fact() and time.monotonic() < until:
        time.sleep(0.05)
    return bool(fact())


def test_each_session_has_a_run_folder_and_a_name_of_its_own(make_host: MakeHost) -> None:
    host = make_host()
    one, other = host.create(Create("T1", player="a\x1b[1m bot")), host.create(Create("T1"))
    assert one.id != other.id and len(one.id) >= 16 and one.folder != other.folder
    assert read_manifest(one.folder).model_name == "a[1m bot"
    assert host.find(one.id) is one
    with pytest.raises(NoSessionError, match="no such session"):
        host.find(one.id[:-1])


def test_no_more_sessions_are_played_than_there_is_room_for(make_host: MakeHost) -> None:
    host = make_host(most_sessions=2)
    first = host.create(Create("T1"))
    host.create(Create("T1"))
    with pytest.raises(BusyError, match="2 sessions are played"):
        host.create(Create("T1"))
    first.perform(Finish("Enough."))
    host.create(Create("T1"))  # One that has ended takes no room.
    with pytest.raises(ConfigError):
        host.create(Create("T99"))
    assert len(host.sessions()) == 3


def test_many_begin_at_once_and_not_one_too_many(make_host: MakeHost) -> None:
    host = make_host(most_sessions=3)

    def begin(_: int) -> bool:
        try:
            return bool(host.create(Create("T1")))
        except BusyError:
            return False

    with ThreadPoolExecutor(8) as pool:
        assert sum(pool.map(begin, range(8))) == 3


def test_a_session_that_nobody_uses_is_closed_with_its_record(make_host: MakeHost) -> None:
    host = make_host(idle_s=0.4)
    hosted = host.create(Create("T1"))
    hosted.perform(LOOK)
    assert waited_for(lambda: not host.sessions())
    assert len(read_trajectory(hosted.folder).acts) == 1
    assert waited_for((hosted.folder / PAGE).is_file)
    assert host.folder_of(hosted.id) == hosted.folder
    assert read_result(hosted.folder) is None  # It was left, and is no zero.


def test_time_that_is_over_ends_an_episode_that_nobody_goes_on_with(make_host: MakeHost) -> None:
    host = make_host(idle_s=2.0, limits=Limits(max_seconds=0.8))
    hosted = host.create(Create("T1"))
    assert waited_for(lambda: read_result(hosted.folder))
    result = read_result(hosted.folder)
    assert result is not None and result.termination is TerminationReason.TIME_LIMIT
    with pytest.raises(EpisodeOverError):
        hosted.perform(LOOK)


def test_the_end_of_the_server_loses_nothing(make_host: MakeHost) -> None:
    host = make_host()
    playing, done = host.create(Create("T1")), host.create(Create(instruction="Look."))
    playing.perform(LOOK)
    done.perform(Finish("I looked."))
    host.close_all()
    for hosted, result in ((playing, False), (done, True)):
        assert (hosted.folder / PAGE).is_file()
        assert (read_result(hosted.folder) is not None) is result
    with pytest.raises(BusyError, match="ending"):
        host.create(Create("T1"))


def test_calls_of_one_session_come_one_after_the_other(make_host: MakeHost) -> None:
    host = make_host(limits=Limits(max_repeats=0))
    hosted = host.create(Create(instruction="Look around."))
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(lambda n: hosted.perform(Act("Look", {"x": n, "y": 0, "z": 1})), range(8)))
    acts = read_trajectory(hosted.folder).acts
    assert [act.step for act in acts] == list(range(1, 9))


def test_a_request_is_done_once_however_often_it_comes(make_host: MakeHost) -> None:
    hosted = make_host().create(Create("T1"))
    once = [hosted.perform(Act("Look", LOOK.arguments, request="r")) for _ in range(3)]
    assert once[0] is once[1] is once[2] and hosted.body.steps == 1
    hosted.perform(Act("Look", LOOK.arguments))
    hosted.perform(Act("Look", LOOK.arguments))
    assert hosted.body.steps == 3  # Without an id each one is new.
    said = Say("hello", request="s")
    assert hosted.perform(said) is hosted.perform(said)


def test_odd_texts_reach_the_record_as_text(make_host: MakeHost) -> None:
    hosted = make_host().create(Create(instruction="Look \x1b[31mup\ud800.", player="\ud800"))
    assert hosted.body.instruction == "Look [31mup."
    hosted.perform(Think("I \ud800 think."))
    hosted.perform(Act("L\ud800k", {"x": "\ud800"}))
    hosted.perform(Finish("Do\ud800ne"))
    assert read_trajectory(hosted.folder).thoughts[0].turn.note == "I ? think."
    result = read_result(hosted.folder)
    assert result is not None and result.answer == "Do?ne"


def test_no_picture_of_elsewhere_is_given_out(make_host: MakeHost, tmp_path: Path) -> None:
    hosted = make_host().create(Create("T1"))
    (name,) = hosted.perform(Observe()).frames
    assert hosted.frame(name) == hosted.perform(Observe()).frames[name].data
    for other in ("../manifest.json", "manifest.json", "", "\0", "f" * 24 + ".jpg", f"../{name}"):
        assert hosted.frame(other) is None


def test_a_result_is_there_when_it_has_ended(make_host: MakeHost) -> None:
    hosted = make_host().create(Create("T1"))
    with pytest.raises(RecordError, match="not ended"):
        hosted.result()
    assert hosted.completion() == 0.0
    hosted.perform(Finish("No."))
    assert hosted.result().completion == 0.0


def test_engines_are_shared_and_make_room(monkeypatch: pytest.MonkeyPatch, lent: LentWorld) -> None:
    made, closed = [], []

    class Stub:
        def __init__(self, place: Any) -> None:
            self.place = place
            made.append(place)

        def snapshot(self) -> bytes:
            return b""

        def close(self) -> None:
            closed.append(self.place)

    monkeypatch.setattr("adamo_vh.session.pooling.create_engine", lambda *place: Stub(place))
    config = read_config
    engines = Engines(most=2, ready={("s2", "mara", 0): lent.lender})
    assert engines.take(config(scene="s2")) is lent.lender
    one = engines.take(config())
    assert engines.take(config()) is one and made == [("s1", "mara", 0)]
    other = engines.take(config(figure="ken"))
    with pytest.raises(BusyError, match="2 scenes"):
        engines.take(config(figure="amina"))
    engines.give_back(other)
    engines.take(config(figure="amina"))
    assert closed == [("s1", "ken", 0)]
    engines.close()
    assert len(closed) == 3 and ("s1", "mara", 0) in closed


def read_config(**more: Any) -> Any:
    from adamo_vh.episode.config import EpisodeConfig

    return EpisodeConfig.of("Look.", **more)


def test_a_watcher_is_woken_from_any_thread(make_host: MakeHost) -> None:
    import asyncio

    hosted = make_host().create(Create("T1"))
    known = hosted.watch.after(0)
    assert [one.kind for one in known.happenings] == ["began", "saw"]

    async def watched() -> list[str]:
        threading.Timer(0.2, lambda: hosted.perform(LOOK)).start()
        found = await hosted.watch.wait(known.next, 10.0)
        return [one.kind for one in found.happenings]

    assert asyncio.run(watched())[0] == "thought"
    assert asyncio.run(hosted.watch.wait(10_000, 0.05)).happenings == ()
    hosted.perform(Finish("Enough."))
    assert hosted.watch.after(0).ended
