"""Whatever a client sends, the server answers with a message, and lives."""

from __future__ import annotations

import json
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.service.conftest import Serve
from websockets.sync.client import ClientConnection, connect

PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner),
    max_leaves=8,
)
TYPES = st.sampled_from(["act", "think", "say", "load", "observe", "describe", "attach", "x"])
ARGUMENTS = st.dictionaries(st.sampled_from(["x", "y", "z", "object"]), PLAIN)
CALLS = st.fixed_dictionaries(
    {
        "type": st.just("act"),
        "name": st.sampled_from(["Look", "Walk", "Pick", "Drop", "Finish"]) | st.text(max_size=9),
        "arguments": ARGUMENTS,
    }
)
MESSAGES = st.builds(
    lambda kind, more: {**more, "type": kind},
    TYPES,
    st.dictionaries(
        st.sampled_from(["name", "arguments", "text", "saved", "reply", "note", "session"]), PLAIN
    ),
)


def answered(wire: ClientConnection, message: str) -> dict[str, Any]:
    wire.send(message)
    answer = wire.recv(timeout=60)
    while isinstance(answer, bytes):
        answer = wire.recv(timeout=60)
    told: dict[str, Any] = json.loads(answer)
    return told


def test_odd_messages_get_an_answer(serve: Serve) -> None:
    url, host = serve(resolution="64x64", most_sessions=10_000)
    with connect(url.replace("http", "ws") + "/v1/session", max_size=None) as wire:

        def begun() -> None:
            answered(wire, json.dumps({"type": "create", "instruction": "Look."}))

        begun()

        @settings(max_examples=40, suppress_health_check=list(HealthCheck), database=None)
        @given(message=CALLS | MESSAGES)
        def check(message: dict[str, Any]) -> None:
            told = answered(wire, json.dumps(message))
            if told["type"] == "failed":
                error = told["error"]
                assert error["type"] not in ("server_error", "engine_error"), error
                if error["type"] == "episode_over":
                    begun()

        check()
    assert host.sessions()
