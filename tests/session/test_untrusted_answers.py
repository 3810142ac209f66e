"""Whatever a server sends, an episode can write it down, go on or end, and never waits for ever."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from tests.dialects import DIALECTS, Anthropic, Chat, Dialect, uri
from tests.fake_provider import FakeProvider, completion
from tests.talk import ASK, NAMES, QUICK, TOOLS, tell

from adamo_vh.cognition.profile import PAPER
from adamo_vh.cognition.turns import read_turn
from adamo_vh.errors import ProviderError, RefusedError
from adamo_vh.inference.arguments import read_arguments
from adamo_vh.inference.ladder import Ladder
from adamo_vh.inference.model import Model, Reply, Rung, Sampling
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.retry import RetryPolicy
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Ended, Event, Thought, read_trajectory
from adamo_vh.record.writer import TrajectoryWriter

every_wire = pytest.mark.parametrize("dialect", DIALECTS, ids=NAMES)
SURROGATE = "\ud800"
"""JSON can spell it, UTF-8 cannot."""


def nested(depth: int) -> str:
    return '{"x": ' + "[" * depth + "]" * depth + "}"


def thought(reply: Reply) -> Thought:
    return Thought(0, "", 1, read_turn(reply, PAPER))


def written(folder: Path, event: Event) -> Event:
    """An event, written into a run folder and read again."""
    writer = TrajectoryWriter(folder / "run")
    writer.notify(event)
    writer.close()
    (read,) = read_trajectory(folder / "run").events
    return read


@every_wire
def test_an_id_that_no_file_can_hold_is_recorded(dialect: Dialect, tmp_path: Path) -> None:
    answer = dialect.answer("I look.", [(f"call_{SURROGATE}", "Look", {"x": 1})])
    reply = tell(dialect, [answer] * 3).reply
    assert [call.name for call in reply.message.calls] == ["Look"]
    assert written(tmp_path, thought(reply)) == thought(reply)


@pytest.mark.parametrize("depth", [100, 300, 900, 5000])
def test_arguments_nested_beyond_reason_are_feedback(depth: int, tmp_path: Path) -> None:
    assert read_arguments(nested(depth)) is None
    reply = tell(Chat(), [Chat().answer("", [("a", "Look", nested(depth))])]).reply
    assert reply.message.calls[0].arguments is None
    written(tmp_path, thought(reply))


def test_arguments_nested_within_reason_are_read() -> None:
    assert read_arguments(nested(20)) is not None


@every_wire
def test_an_error_that_no_file_can_hold_is_recorded(dialect: Dialect, tmp_path: Path) -> None:
    with (
        FakeProvider([dialect.error(400, f"bad {SURROGATE} thing")]) as server,
        ProviderModel(uri(dialect, server), QUICK) as model,
        pytest.raises(RefusedError, match="thing") as caught,
    ):
        model.complete(ASK, TOOLS, Sampling())
    text = str(caught.value)
    written(tmp_path, Ended(0, TerminationReason.BROKEN, text, "", 0.0))


def test_a_step_that_no_file_can_hold_is_recorded(tmp_path: Path) -> None:
    """JSON in a text can spell it too."""
    step = r'{"action": "\ud800", "args": 3}'
    with FakeProvider([completion(step)] * 2) as server:
        model: Model = Ladder(ProviderModel(server.uri(), QUICK), Rung.SCHEMA)
        reply = model.complete(ASK, TOOLS, Sampling())
    assert reply.unreadable
    written(tmp_path, thought(reply))


def test_a_setting_that_the_library_insists_on_is_not_dropped_for_ever() -> None:
    words = "max_tokens: must be greater than thinking.budget_tokens"
    with (
        FakeProvider(lambda _: Anthropic().error(400, words)) as server,
        ProviderModel(uri(Anthropic(), server), QUICK) as model,
        pytest.raises(RefusedError, match="must be greater"),
    ):
        model.complete(ASK, TOOLS, Sampling())
    assert len(server.requests) <= 3  # as it is, without the setting, without the picture


class _Trickle(BaseHTTPRequestHandler):
    """Sends an answer without an end, byte by byte."""

    def do_POST(self) -> None:
        self.send_response(200)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", "100000")
        self.end_headers()
        try:
            for _ in range(200):
                self.wfile.write(b" ")
                time.sleep(0.05)
        except OSError:
            pass  # The client has had enough.

    def log_message(self, format: str, *args: object) -> None:
        """Stay silent."""


@pytest.fixture
def trickle() -> Iterator[str]:
    server = ThreadingHTTPServer(("127.0.0.1", 0), _Trickle)
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True)
    thread.start()
    yield f"http://127.0.0.1:{server.server_address[1]}/v1"
    server.shutdown()
    server.server_close()


def test_an_answer_that_trickles_in_is_given_up_in_time(trickle: str) -> None:
    retry = RetryPolicy(max_tries=2, max_wait_s=5.0, base_s=0.001, timeout_s=0.4)
    with ProviderModel(f"openai:slow@{trickle}", retry) as model:
        started = time.monotonic()  # The client is made: importing its library takes a while.
        with pytest.raises(ProviderError, match="No whole answer came in time"):
            model.complete(ASK, TOOLS, Sampling())
        assert time.monotonic() - started < 10.0
