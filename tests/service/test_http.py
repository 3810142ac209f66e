"""The body over HTTP: real requests on a loopback socket."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from tests.service.conftest import JUDGE, Serve

from adamo_vh.action_server.wire import Done, Seen, Welcome, read
from adamo_vh.service.hosting import Host
from adamo_vh.session.verifying import verify_run

LOOK = {"name": "Look", "arguments": {"x": 0.5, "y": -1.0, "z": 0.8}}
KEY = {"authorization": f"Bearer {JUDGE}"}


@pytest.fixture
def server(serve: Serve) -> Iterator[tuple[httpx.Client, Host]]:
    url, host = serve()
    with httpx.Client(base_url=url, timeout=60) as client:
        yield client, host


@pytest.fixture
def standing_server(standing: str, standing_host: Host) -> Iterator[tuple[httpx.Client, Host]]:
    with httpx.Client(base_url=standing, timeout=60) as client:
        yield client, standing_host


def begun(client: httpx.Client, **asked: Any) -> tuple[str, Welcome]:
    answer = client.post("/v1/sessions", json={"task": "T1", **asked})
    assert answer.status_code == 201, answer.text
    welcome: Welcome = read(Welcome, answer.content)
    return f"/v1/sessions/{welcome.session}", welcome


def test_an_episode_from_beginning_to_end(server: tuple[httpx.Client, Host]) -> None:
    client, host = server
    here, welcome = begun(client, player="curl")
    assert welcome.instruction == "Pick the object tagged as 34"
    assert [tool.name for tool in welcome.tools] == ["Look", "Walk", "Pick", "Drop"]
    assert welcome.seen is not None
    picture = client.get(welcome.seen.view.picture.href)
    assert picture.headers["content-type"] == "image/jpeg" and picture.content[:2] == b"\xff\xd8"
    seen: Seen = read(Seen, client.get(f"{here}/view").content)
    assert seen == welcome.seen

    looked: Done = read(Done, client.post(f"{here}/act", json=LOOK).content)
    assert looked.view is not None and looked.feedback.outcome == "done" and not looked.ended
    assert looked.view.objects[0].tag in client.get(f"{here}/state-text").text
    assert client.post(f"{here}/think", json={"note": "No key here."}).json()["ended"] is False
    refused = client.post(f"{here}/act", json={"name": "Fly", "arguments": None})
    assert refused.json()["feedback"]["code"] == "unknown_tool"
    assert client.post(f"{here}/say", json={"text": "I give up."}).status_code == 200
    assert client.post(f"{here}/finish", json={"answer": "I give up."}).json()["ended"] is True
    over = client.post(f"{here}/act", json=LOOK)
    assert (over.status_code, over.json()["error"]["type"]) == (409, "episode_over")
    assert read(Welcome, client.get(here).content).ended
    folder = host.find(welcome.session).folder
    assert client.delete(here).status_code == 204 and client.get(here).status_code == 404
    assert verify_run(folder, replayed=False).problems == ()
    assert client.get(f"{here}/result", headers=KEY).json()["model"] == "curl"


def test_a_judge_alone_is_told_how_it_stands(server: tuple[httpx.Client, Host]) -> None:
    client, _ = server
    here, welcome = begun(client)
    for path in (f"{here}/state", f"{here}/score", f"{here}/result", "/v1/sessions"):
        refused = client.get(path)
        assert (refused.status_code, refused.json()["error"]["type"]) == (403, "judge_only")
    assert client.get(f"{here}/score", headers=KEY).json() == {"completion": 0.0}
    assert client.get(f"{here}/state", headers=KEY).json()["scene"]["name"] == "s1"
    assert client.get(f"{here}/result", headers=KEY).status_code == 409
    (listed,) = client.get("/v1/sessions", headers=KEY).json()
    assert (listed["session"], listed["ended"]) == (welcome.session, False)
    client.post(f"{here}/finish", json={})
    result = client.get(f"{here}/result", headers=KEY).json()
    assert (result["score"]["completion"], result["termination"]) == (0.0, "empty_reply")


def test_a_player_is_told_nothing_but_the_end(server: tuple[httpx.Client, Host]) -> None:
    client, _ = server
    here, _ = begun(client)
    told = [client.post(f"{here}/act", json=LOOK).text for _ in range(4)]
    assert json.loads(told[-1])["ended"] is True  # The same look again and again is a loop.
    told += [client.get(path).text for path in (here, f"{here}/happenings?wait_s=1")]
    for word in ("loop", "completion", "strict", "violation", "score", "termination", '"engine"'):
        assert not any(word in text for text in told), word


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"task": "T99"}, "There is no task 'T99'"),
        ({"task": "/etc/passwd.toml"}, "There is no task"),
        ({"task": None}, "Say what to do"),
        ({"instruction": "x"}, "not both"),
        ({"task": None, "instruction": "   "}, "instruction is empty"),
        ({"scene": "../../x.toml"}, "There is no scene"),
        ({"scene": "s3"}, "Scenes: s1, s2"),
        ({"labeling": "none"}, "labeling: Input should be 'sem' or 'opaq'"),
        ({"profile": "fast"}, "profile: Input should be 'paper'"),
        ({"switches": {"wings": True}}, "There is no switch"),
        ({"resolution": "big"}, "resolution: String should match"),
        ({"resolution": "9999x9999"}, "use 64x64 up to"),
    ],
)
def test_a_wrong_setting_is_told_in_a_line(
    standing_server: tuple[httpx.Client, Host], asked: dict[str, Any], said: str
) -> None:
    client, host = standing_server
    answer = client.post("/v1/sessions", json={"task": "T1", **asked})
    assert answer.status_code in (400, 422) and said in answer.json()["error"]["message"]
    assert host.sessions() == ()


@pytest.mark.parametrize(
    "body",
    [b"", b"[]", b"{", b'{"seed": -1}', b'{"seed": 1e999}', b'{"x": 1}', b"[" * 10_000, b"\xff"],
)
def test_what_is_no_message_is_told_in_a_line(
    standing_server: tuple[httpx.Client, Host], body: bytes
) -> None:
    client, _ = standing_server
    headers = {"content-type": "application/json"}
    answer = client.post("/v1/sessions", content=body, headers=headers)
    assert answer.status_code in (400, 422) and answer.json()["error"]["message"]


def test_what_is_not_there_is_not_found(server: tuple[httpx.Client, Host]) -> None:
    client, _ = server
    here, _ = begun(client)
    for path in ("/v2", "/v1/sessions/none", "/v1/sessions/none/view", f"{here}/frames/x.jpg"):
        answer = client.get(path)
        assert answer.status_code == 404 and answer.json()["error"]["type"] == "not_found", path
    for name in ("..%2F..%2Fmanifest.json", "manifest.json", "0" * 24 + ".jpg"):
        assert client.get(f"{here}/frames/{name}").status_code == 404


def test_a_request_that_is_sent_again_is_done_once(server: tuple[httpx.Client, Host]) -> None:
    client, host = server
    here, welcome = begun(client)
    answers = [client.post(f"{here}/act", json={**LOOK, "request": "one"}).json() for _ in range(2)]
    assert answers[0] == answers[1]
    assert host.find(welcome.session).body.steps == 1


def test_a_model_reply_is_put_on_record(server: tuple[httpx.Client, Host]) -> None:
    client, _ = server
    here, _ = begun(client)
    call = {"id": "c", **LOOK}
    usage = {"input_tokens": 900, "output_tokens": 50}
    reply = {"message": {"text": "I look.", "calls": [call]}, "usage": usage, "cost_usd": 0.5}
    assert client.post(f"{here}/think", json={"reply": reply}).status_code == 200
    client.post(f"{here}/act", json=LOOK)
    client.post(f"{here}/finish", json={"answer": "Nothing."})
    result = client.get(f"{here}/result", headers=KEY).json()
    assert (result["usage"]["input_tokens"], result["cost_usd"]) == (900, 0.5)
    for wrong in ({}, {"message": 1}, {**reply, "cost_usd": -1}, {**reply, "seconds": 1e300}):
        answer = client.post(f"{here}/think", json={"reply": wrong})
        assert answer.status_code in (400, 409)


def test_a_watcher_hears_what_happens(server: tuple[httpx.Client, Host]) -> None:
    client, _ = server
    here, _ = begun(client)
    client.post(f"{here}/act", json={**LOOK, "note": "I look."})
    first = client.get(f"{here}/happenings").json()
    kinds = [one["kind"] for one in first["happenings"]]
    assert kinds == ["began", "saw", "thought", "did", "saw"]
    known = first["next"]
    assert client.get(f"{here}/happenings?after={known}&wait_s=0.1").json()["happenings"] == []
    client.post(f"{here}/finish", json={"answer": "Nothing."})
    with client.stream("GET", f"{here}/stream", headers={"last-event-id": str(known)}) as stream:
        lines = [line for line in stream.iter_lines() if line.startswith("event:")]
    assert lines == ["event: ended"]


def test_the_interface_describes_itself(server: tuple[httpx.Client, Host]) -> None:
    client, _ = server
    assert client.get("/v1").json()["tasks"][0] == "T1"
    told = client.get("/openapi.json").json()
    assert "/v1/sessions/{session}/act" in told["paths"]
    assert client.get("/docs").status_code == 404
