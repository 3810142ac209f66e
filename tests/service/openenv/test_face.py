"""OpenEnv's wire: its messages over a WebSocket and HTTP, from a real client's side."""

from __future__ import annotations

import base64
import io
import json
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Any

import httpx
import pytest
from hypothesis import given
from PIL import Image
from tests.service.conftest import Serve
from tests.service.test_published import FEW
from websockets.sync.client import ClientConnection, connect

from adamo_vh.episode.result import read_result
from adamo_vh.serving.admission import Rules
from adamo_vh.serving.rate import Rate

PLAN: list[tuple[str, dict[str, Any], float]] = [
    ("Pick", {"object": "Glass_37"}, 0.0),
    ("Drop", {"object": "Glass_37", "x": 1.27, "y": -1.88, "z": 0.0}, 0.5),
    ("Pick", {"object": "Plate_57"}, 0.0),
    ("Drop", {"object": "Plate_57", "x": 1.32, "y": -1.33, "z": 0.0}, 0.5),
]
LOOK = {"x": 0.0, "y": -1.0, "z": 0.8}


class Client:
    """Speaks as OpenEnv's own client does."""

    def __init__(self, wire: ClientConnection) -> None:
        self._wire = wire

    def ask(self, kind: str, data: Any = None) -> Any:
        message = {"type": kind} if data is None else {"type": kind, "data": data}
        return self.send(json.dumps(message))

    def send(self, text: str) -> Any:
        self._wire.send(text)
        return json.loads(self._wire.recv(timeout=60))

    def reset(self, **data: Any) -> Any:
        return self.ask("reset", data)["data"]

    def call(self, name: str, **arguments: Any) -> Any:
        action = {"type": "call_tool", "tool_name": name, "arguments": arguments}
        return self.ask("step", action)["data"]


@pytest.fixture
def url(serve: Serve) -> str:
    return serve()[0] + "/openenv"


@pytest.fixture
def asked_only(standing: str) -> str:
    return standing + "/openenv"


@pytest.fixture
def join() -> Iterator[Callable[[str], Client]]:
    with ExitStack() as stack:

        def joined(url: str) -> Client:
            address = url.replace("http://", "ws://") + "/ws"
            return Client(stack.enter_context(connect(address, max_size=None)))

        yield joined


def test_an_episode_is_played_and_recorded(serve: Serve, join: Callable[[str], Client]) -> None:
    address, host = serve()
    client = join(f"{address}/openenv")
    first = client.reset(split="S1", index=7)
    assert (first["reward"], first["done"]) == (None, False)
    told = first["observation"]["result"]
    assert told["instruction"] == "Pick the glass and the plate then put them on the floor"
    picture = Image.open(io.BytesIO(base64.b64decode(told["image"]["data"])))
    assert picture.size == (told["image"]["width"], told["image"]["height"])
    assert "Glass_37" in told["objects"] and "Glass_37" in told["text"]
    for name, arguments, reward in PLAN:
        step = client.call(name, **arguments)
        assert (step["reward"], step["done"]) == (reward, False)
        assert step["observation"]["result"]["outcome"] == "done"
        assert step["observation"]["error"] is None
    (hosted,) = host.sessions()
    last = client.call("Finish", answer="Both are on the floor.")
    assert (last["reward"], last["done"]) == (0.0, True)
    result = read_result(hosted.folder)
    assert result is not None and (result.completion, result.strict) == (1.0, 1.0)
    assert (result.answer, result.model) == ("Both are on the floor.", "openenv")
    over = client.ask("step", {"tool_name": "Look", "arguments": LOOK})
    assert over["data"]["code"] == "EXECUTION_ERROR" and "reset" in over["data"]["message"]


def test_only_the_reward_tells_of_the_score(url: str, join: Callable[[str], Client]) -> None:
    client = join(url)
    client.reset(task="T8")
    answers = [client.call(name, **arguments) for name, arguments, _ in PLAN]
    answers += [client.call("Finish"), client.ask("state")]
    text = json.dumps(answers)
    assert [word for word in ("completion", "strict", "state_hash", "saved") if word in text] == []


def test_views_come_as_the_profile_grants_them(url: str, join: Callable[[str], Client]) -> None:
    client = join(url)
    first = client.reset(task="T3")["observation"]["result"]
    walked = client.call("Walk", x=1.0, y=1.0, z=0.0)["observation"]["result"]
    assert walked["image"] is None
    # Asking again costs no step, and shows no more than was seen.
    again = client.call("observe")
    assert again["observation"]["result"]["image"] == first["image"]
    assert client.ask("state")["data"]["step_count"] == 1
    assert client.call("Look", **LOOK)["observation"]["result"]["image"] is not None
    client.reset(task="T3", profile="lean")
    assert client.call("Walk", x=1.0, y=1.0, z=0.0)["observation"]["result"]["image"] is not None
    closeup = client.call("Inspect", object="Tape_4")["observation"]["result"]["closeups"]
    assert len(closeup) <= 1


def test_a_session_has_one_episode_at_a_time(serve: Serve, join: Callable[[str], Client]) -> None:
    address, _ = serve(most_sessions=1)
    client = join(f"{address}/openenv")
    client.reset(task="T3")
    assert client.reset(task="T3")["done"] is False  # In place of its own one.
    full = join(f"{address}/openenv").ask("reset", {})
    assert full["data"]["code"] == "CAPACITY_REACHED"
    client.call("Finish")
    assert client.reset(task="T4", episode_id="mine")["done"] is False
    state = client.ask("state")["data"]
    assert state == {
        "episode_id": "mine", "step_count": 0, "task": "T4", "scene": "s1", "done": False,
    }  # fmt: skip


@pytest.mark.parametrize(
    ("message", "code"),
    [
        ("{", "INVALID_JSON"),
        ("[]", "UNKNOWN_TYPE"),
        ('{"type": "jump"}', "UNKNOWN_TYPE"),
        ('{"type": "step", "data": {"tool_name": "Look"}}', "VALIDATION_ERROR"),
        ('{"type": "reset", "data": {"colour": "red"}}', "VALIDATION_ERROR"),
        ('{"type": "reset", "data": {"seed": -1}}', "VALIDATION_ERROR"),
        ('{"type": "reset", "data": {"task": "T99"}}', "VALIDATION_ERROR"),
        ('{"type": "reset", "data": {"scene": "/etc/passwd"}}', "VALIDATION_ERROR"),
        ('{"type": "reset", "data": {"split": "S1", "index": 99}}', "VALIDATION_ERROR"),
        ('{"type": "reset", "data": [1]}', "VALIDATION_ERROR"),
        ('{"type": "step", "data": {"tool": "Look"}}', "VALIDATION_ERROR"),
    ],
)
def test_what_makes_no_sense_is_said_and_ends_nothing(
    asked_only: str, join: Callable[[str], Client], message: str, code: str
) -> None:
    client = join(asked_only)
    told = client.send(message)
    assert (told["type"], told["data"]["code"]) == ("error", code)
    assert told["data"]["message"]
    assert client.ask("state")["data"]["step_count"] == 0


def test_tools_are_listed_before_any_episode(
    asked_only: str, join: Callable[[str], Client]
) -> None:
    found = join(asked_only).ask("step", {"type": "list_tools"})["data"]["observation"]["tools"]
    names = [tool["name"] for tool in found]
    assert names == ["Look", "Walk", "Pick", "Drop", "Finish", "observe"]
    assert all(set(tool) == {"name", "description", "input_schema"} for tool in found)


def test_over_http_a_session_is_named_by_its_id(url: str) -> None:
    with httpx.Client(base_url=url, timeout=60) as http:
        first = http.post("/reset", json={"task": "T3"}).json()
        name = first["observation"]["session_id"]
        action = {"tool_name": "Pick", "arguments": {"object": "Tape_4"}}
        step = http.post("/step", json={"session_id": name, "action": action}).json()
        assert (step["reward"], step["done"]) == (1.0, False)
        assert http.get("/state", params={"session_id": name}).json()["step_count"] == 1
        assert http.get("/state").json()["episode_id"] is None
        missing = http.post("/step", json={"action": action})
        assert (missing.status_code, "session_id" in missing.json()["detail"]) == (422, True)
        unknown = http.post("/step", json={"session_id": "nobody", "action": action})
        assert unknown.status_code == 404


def test_tasks_are_listed_by_scene(asked_only: str) -> None:
    with httpx.Client(base_url=asked_only, timeout=60) as http:
        assert http.get("/list_environments").json() == ["adamo_vh"]
        splits = http.get("/adamo_vh/splits").json()
        assert splits == [{"name": "S1", "type": "test"}, {"name": "S2", "type": "test"}]
        of = {"split": "S2"}
        assert http.post("/adamo_vh/num_tasks", json=of).json() == {"num_tasks": 15}
        tasks = http.post("/adamo_vh/tasks", json=of).json()["tasks"]
        assert [task["id"] for task in tasks] == [f"S2-T{number}" for number in range(1, 16)]
        one = http.post("/adamo_vh/task", json={**of, "index": 3}).json()["task"]
        assert one == tasks[3]
        part = http.post("/adamo_vh/task_range", json={**of, "start": 3, "stop": 5}).json()
        assert part["tasks"] == tasks[3:5]
        wrong = http.post("/adamo_vh/tasks", json={"split": "S9"})
        assert (wrong.status_code, "Splits: S1, S2" in wrong.json()["detail"]) == (422, True)
        assert http.post("/adamo_vh/task", json={**of, "index": 15}).status_code == 422


def rpc(http: httpx.Client, method: str, **params: Any) -> Any:
    body = {"jsonrpc": "2.0", "id": 1, "method": method, "params": params}
    return http.post("/mcp", json=body).json()


def test_json_rpc_plays_without_a_reward(url: str) -> None:
    with httpx.Client(base_url=url, timeout=60) as http:
        name = rpc(http, "openenv/session/create")["result"]["session_id"]
        tools = rpc(http, "tools/list", session_id=name)["result"]["tools"]
        assert {"name", "description", "inputSchema"} == set(tools[0])
        done = rpc(http, "tools/call", session_id=name, name="Look", arguments=LOOK)["result"]
        assert [part["type"] for part in done["content"]] == ["text", "image"]
        assert done["structuredContent"]["outcome"] == "done"
        assert "reward" not in json.dumps(done)
        assert rpc(http, "openenv/session/close", session_id=name)["result"]["closed"] is True
        again = rpc(http, "tools/call", session_id=name, name="Look", arguments=LOOK)
        assert "no such session" in again["error"]["message"]


@pytest.mark.parametrize("body", [{}, [], None, 3, {"jsonrpc": "2.0", "method": "jump"}])
def test_json_rpc_answers_whatever_comes(asked_only: str, body: Any) -> None:
    answer = httpx.post(f"{asked_only}/mcp", json=body, timeout=60)
    assert (answer.status_code, answer.json()["jsonrpc"]) == (200, "2.0")
    assert answer.json()["error"]["code"] in (-32600, -32601)


def test_what_it_is_and_takes_is_told(asked_only: str) -> None:
    with httpx.Client(base_url=asked_only, timeout=60) as http:
        assert http.get("/health").json() == {"status": "healthy"}
        about = http.get("/metadata").json()
        assert about["name"] == "adamo_vh" and "3D room" in about["description"]
        schema = http.get("/schema").json()
        assert {"action", "observation", "state"} <= set(schema)
        paths = http.get("/openapi.json").json()["paths"]
        assert {"/reset", "/step", "/state", "/mcp"} <= set(paths)


def test_strangers_are_refused_as_on_every_face(asked_only: str) -> None:
    for headers in ({"host": "evil.example"}, {"origin": "http://evil.example"}):
        assert httpx.post(f"{asked_only}/reset", json={}, headers=headers).status_code == 403
        assert httpx.get(f"{asked_only}/health", headers=headers).status_code == 403


def test_the_server_keeps_to_what_it_publishes(serve: Serve) -> None:
    import schemathesis
    from schemathesis.core.result import Ok

    unhurried = Rules(100_000, rate=Rate(per_s=0))
    url = serve(unhurried, most_sessions=100_000, resolution="64x64")[0] + "/openenv"
    schema = schemathesis.openapi.from_url(f"{url}/openapi.json")
    operations = [found.ok() for found in schema.get_all_operations() if isinstance(found, Ok)]
    assert len(operations) >= 12
    for operation in operations:

        @FEW
        @given(case=operation.as_strategy())
        def check(case: Any) -> None:
            # Which splits, tasks and sessions there are, no schema says.
            left_out = [schemathesis.checks.positive_data_acceptance]
            case.call_and_validate(timeout=30, excluded_checks=left_out)

        check()
