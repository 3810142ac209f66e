"""Programs of their own play a scored episode with the official client, and are told no verdict."""

from __future__ import annotations

import base64
import json
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import anyio
import mcp_types as types
import pytest
from mcp import Client
from tests.service.mcp.shared_engine import engines_of
from tests.session.test_outside_episodes import CALLS
from tests.session.test_player_side import assert_blind, texts_in

from adamo_vh.benchmark.tasks import builtin_tasks
from adamo_vh.episode.result import EpisodeResult, read_result
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.service.mcp.episodes import Episodes
from adamo_vh.service.mcp.offer import Offer
from adamo_vh.service.mcp.server import create_server
from adamo_vh.service.mcp.transports import serve_http
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.outside import ENDED
from adamo_vh.session.runs import replay_episode, run_episode

PLAYER = [sys.executable, "-m", "tests.service.mcp.player"]
FINISH = ("finish", {"answer": "They are on the floor."})
SMALL = {"resolution": "160x90", "grid": 3}
TOKEN = "a-token-of-its-own"


def _start(plan: dict[str, Any]) -> subprocess.Popen[str]:
    here = Path(__file__).resolve().parents[3]
    command = [*PLAYER, json.dumps(plan)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=here)


def _heard(lines: Sequence[str]) -> tuple[str, list[str]]:
    """The id of the episode, and all that was heard as texts."""
    messages = [json.loads(line) for line in lines]
    return messages[-1]["episode"], ["\n".join(_texts(message)) for message in messages]


def _texts(value: Any) -> Iterator[str]:
    """Every text, and what pictures say beside pixels."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key in ("data", "blob"):
                yield from texts_in(base64.b64decode(inner))
            else:
                yield from (key, *_texts(inner))
    elif isinstance(value, list):
        for inner in value:
            yield from _texts(inner)
    else:
        yield str(value)


@pytest.fixture
def expected(engine: BuiltinEngine, tmp_path: Path) -> tuple[EpisodeResult, Path]:
    """The same calls in this process."""
    said = [
        AIMessage("", (ToolCall(f"call_{n}", name, arguments),))
        for n, (name, arguments) in enumerate(CALLS, start=1)
    ]
    model = ScriptedModel("scripted", [*said, AIMessage(FINISH[1]["answer"])])
    folder = tmp_path / "inside"
    result = run_episode(task="T8", model=model, engine=engine, out=folder, **SMALL)  # type: ignore[arg-type]
    return result, folder


def _check(run: Path, expected: tuple[EpisodeResult, Path], heard: Sequence[str]) -> None:
    result = read_result(run)
    assert result is not None and result.strict == expected[0].strict == 1.0
    assert result.state_hash == expected[0].state_hash and result.answer == expected[0].answer
    acts = [read_trajectory(folder).acts for folder in (run, expected[1])]
    assert [(a.call_id, a.name, a.arguments, a.state_hash, a.feedback) for a in acts[0]] == [
        (a.call_id, a.name, a.arguments, a.state_hash, a.feedback) for a in acts[1]
    ]
    assert_blind(heard, run, result)


@pytest.mark.slow
def test_over_the_standard_streams(
    engine: BuiltinEngine, tmp_path: Path, expected: tuple[EpisodeResult, Path]
) -> None:
    runs = tmp_path / "the-runs"
    command = [sys.executable, "-m", "adamo_vh", "mcp", "--resolution", "160x90"]
    plan = {
        "command": [*command, "--out", str(runs)],
        "environment": dict(os.environ),
        "name": "the player",
        "wishes": {"task": "T8"},
        "calls": [*CALLS, FINISH],
    }
    player = _start(plan)
    out, _ = player.communicate(timeout=120)
    assert player.returncode == 0
    episode, heard = _heard(out.splitlines())
    assert episode.startswith("t8-")
    _check(runs / episode, expected, heard)
    result = read_result(runs / episode)
    assert result is not None and result.model == "outside:the-player"
    assert not replay_episode(runs / episode, engine=engine).mismatches


def test_over_http_and_after_the_first_client_was_killed(
    tmp_path: Path, expected: tuple[EpisodeResult, Path]
) -> None:
    told: list[str] = []
    offer = Offer(SMALL, tmp_path / "the-runs")
    with (
        Episodes(offer, told.append) as episodes,
        serve_http(create_server(episodes, told.append), token=TOKEN) as url,
    ):
        plan = {"url": url, "token": TOKEN, "wishes": {"task": "T8"}, "calls": CALLS[:2]}
        first = _start({**plan, "name": "first", "hangs": True})
        assert first.stdout is not None
        lines: list[str] = []
        while not (lines and lines[-1].startswith('{"episode"')):
            lines.append(first.stdout.readline())
        first.kill()
        first.wait()
        episode, heard = _heard(lines)
        second = _start(
            {**plan, "episode": episode, "name": "second", "calls": [*CALLS[2:], FINISH]}
        )
        out, _ = second.communicate(timeout=60)
        assert second.returncode == 0
        heard += _heard(out.splitlines())[1]
    run = tmp_path / "the-runs" / episode
    _check(run, expected, heard)
    result = read_result(run)
    assert result is not None
    assert result.warnings == ("outside:second went on with what outside:first had begun.",)
    # Who runs the server is told.
    assert told[-1].startswith(f"{episode}: ended (answered), completion 1.00")


@pytest.mark.slow
@pytest.mark.parametrize("task", [task.id for task in builtin_tasks()])
def test_every_task_is_the_same_over_mcp(
    lent: LentWorld, engine: BuiltinEngine, tmp_path: Path, task: str
) -> None:
    """The baseline's calls, made again by a client: equal calls, states and score."""
    settings: Any = {"resolution": "640x360", "grid": 4}
    expected = run_episode(
        task=task, model="baseline", engine=engine, out=tmp_path / "in", **settings
    )
    recorded = read_trajectory(tmp_path / "in")
    offer = Offer({**settings, "task": task}, fixed=tmp_path / "out")

    async def play(episodes: Episodes) -> None:
        async with Client(create_server(episodes)) as client:
            for act in recorded.acts:
                given = {**(act.arguments or {}), "episode": "out"}
                result = await client.call_tool(act.name, given)
                assert isinstance(result, types.CallToolResult)
                heard = result.content[0]
                assert isinstance(heard, types.TextContent)
                assert heard.text.startswith(act.feedback.text) or heard.text == ENDED
            await client.call_tool("finish", {"episode": "out", "answer": expected.answer})

    with Episodes(offer, engines=engines_of(lent)) as episodes:
        anyio.run(play, episodes)
    result = read_result(tmp_path / "out")
    assert result is not None and result.score == expected.score
    assert result.state_hash == expected.state_hash
    assert [
        (a.name, a.arguments, a.state_hash) for a in read_trajectory(tmp_path / "out").acts
    ] == [(a.name, a.arguments, a.state_hash) for a in recorded.acts]
