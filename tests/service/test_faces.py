"""The same calls through every face are the same episode: states, steps, score and end."""

from __future__ import annotations

import dataclasses
import json
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import anyio
import httpx
import pytest
from mcp import Client
from tests.service.conftest import JUDGE, Serve
from websockets.sync.client import connect

import adamo_vh
from adamo_vh.action import action_name
from adamo_vh.action_server import LocalActionServer
from adamo_vh.benchmark.oracle import Oracle
from adamo_vh.benchmark.tasks import TASKS
from adamo_vh.benchmark.tasks import task as find_task
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import EpisodeResult, read_result
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.perception import Labeling, PerceptionConfig
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.service.hosting import Host
from adamo_vh.session.lending import LentWorld

SMALL = (320, 180)
ANSWER = "It is done."
Calls = Sequence[tuple[str, Mapping[str, Any]]]
Face = Callable[[str, str, str, Calls], str]


def oracle_calls(lent: LentWorld, task: str, labeling: str) -> Calls:
    perception = PerceptionConfig(labeling=Labeling(labeling))
    world = lent.lender.lend()
    world.reset(0)
    server = LocalActionServer(world, resolution=SMALL, perception=perception)
    server.observe()
    oracle = Oracle(find_task(task).conditions, server.tag, server.body.info)
    calls: list[tuple[str, Mapping[str, Any]]] = []
    while (action := oracle.next_action(world.state(), server.seen)) is not None:
        calls.append((action_name(type(action)), dataclasses.asdict(action)))
        server.execute(action)
    return calls


def over_http(url: str, task: str, labeling: str, calls: Calls) -> str:
    with httpx.Client(base_url=url, timeout=60) as client:
        made = client.post("/v1/sessions", json={"task": task, "labeling": labeling}).json()
        here = f"/v1/sessions/{made['session']}"
        for name, arguments in calls:
            done = client.post(f"{here}/act", json={"name": name, "arguments": arguments}).json()
            assert done["type"] == "done"
        assert client.post(f"{here}/finish", json={"answer": ANSWER}).json()["ended"]
    return str(made["session"])


def over_websocket(url: str, task: str, labeling: str, calls: Calls) -> str:
    with connect(url.replace("http", "ws") + "/v1/session", max_size=None) as wire:

        def ask(**message: Any) -> Any:
            wire.send(json.dumps(message))
            answer = wire.recv(timeout=60)
            while isinstance(answer, bytes):  # Pictures of the answer before.
                answer = wire.recv(timeout=60)
            return json.loads(answer)

        made = ask(type="create", task=task, labeling=labeling)
        for name, arguments in calls:
            assert ask(type="act", name=name, arguments=arguments)["type"] == "done"
        assert ask(type="finish", answer=ANSWER)["ended"]
    return str(made["session"])


def by_client(url: str, task: str, labeling: str, calls: Calls) -> str:
    with adamo_vh.connect(url, task=task, labeling=labeling) as body:
        for name, arguments in calls:
            body.call(name, arguments)
        body.finish(ANSWER)
        return body.session


def over_mcp(url: str, task: str, labeling: str, calls: Calls) -> str:
    async def play() -> str:
        async with Client(f"{url}/mcp") as client:
            wishes = {"task": task, "labeling": labeling}
            begun = (await client.call_tool("new_episode", wishes)).content[0]
            assert begun.type == "text"
            episode = begun.text.partition("id of your episode is ")[2].partition(". ")[0]
            for name, arguments in calls:
                done = await client.call_tool(name, {"episode": episode, **arguments})
                assert not done.is_error
            await client.call_tool("finish", {"episode": episode, "answer": ANSWER})
        return episode

    return anyio.run(play)


def told_result(url: str, host: Host, face: str, session: str) -> dict[str, Any]:
    """What a judge is told; of an episode over MCP, what its run folder says when it is over."""
    if face != "mcp":
        headers = {"authorization": f"Bearer {JUDGE}"}
        told: dict[str, Any] = httpx.get(
            f"{url}/v1/sessions/{session}/result", headers=headers
        ).json()
        return told
    until = time.monotonic() + 20.0
    while (result := read_result(host.out / session)) is None:
        assert time.monotonic() < until, "no result was written"
        time.sleep(0.05)
    return plain(result)


def plain(result: EpisodeResult) -> dict[str, Any]:
    """As JSON would carry it."""
    found: dict[str, Any] = json.loads(json.dumps(dataclasses.asdict(result), default=str))
    return found


FACES: dict[str, Face] = {
    "http": over_http,
    "websocket": over_websocket,
    "client": by_client,
    "mcp": over_mcp,
}
QUICK = {"T1", "T8"}
TRIED = [
    pytest.param(task.id, marks=[] if task.id in QUICK else [pytest.mark.slow]) for task in TASKS
]


@pytest.mark.parametrize("task", TRIED)
def test_every_face_plays_the_same_episode(
    serve: Serve, lent: LentWorld, tmp_path: Path, task: str
) -> None:
    labeling = "opaq" if int(task[1:]) % 2 else "sem"
    calls = oracle_calls(lent, task, labeling)
    said = [AIMessage("", (ToolCall("c", name, dict(told)),)) for name, told in calls]
    model = ScriptedModel("oracle", [*said, AIMessage(ANSWER)])
    config = EpisodeConfig.of(task=task, labeling=labeling, resolution=SMALL)
    here = tmp_path / "here"
    world = lent.lender.lend()
    alone = adamo_vh.run_episode(config, model=model, engine=world, out=here)
    assert alone.score is not None and alone.completion == 1.0
    url, host = serve()
    for name, play in FACES.items():
        session = play(url, task, labeling, calls)
        told, expected = told_result(url, host, name, session), plain(alone)
        for part in ("score", "steps", "answer", "termination"):
            assert told[part] == expected[part], (name, part)
        folder = host.out / session if name == "mcp" else host.find(session).folder
        one, other = read_trajectory(here).acts, read_trajectory(folder).acts
        assert [(a.name, a.state_hash) for a in one] == [(a.name, a.state_hash) for a in other]
        assert [a.feedback for a in one] == [a.feedback for a in other]
