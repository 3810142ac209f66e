"""The MCP server in this process: its tools, its refusals, several episodes and clients at once."""

from __future__ import annotations

import base64
import time
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import anyio
import mcp_types as types
import pytest
from mcp import Client
from mcp.shared.exceptions import MCPError
from tests.service.mcp.shared_engine import engines_of
from tests.session.test_outside_episodes import CALLS

from adamo_vh.episode.result import read_result
from adamo_vh.record.run_folder import RESULT
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.service.mcp.episodes import Episodes
from adamo_vh.service.mcp.offer import Offer
from adamo_vh.service.mcp.server import create_server
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.outside import ENDED

SMALL = {"resolution": "160x90", "grid": 3}
Play = Callable[[Client], Awaitable[None]]


@contextmanager
def _served(lent: LentWorld, root: Path, **more: Any) -> Iterator[Episodes]:
    settings = {**SMALL, **more.pop("settings", {})}
    offer = Offer(settings, root, **more)
    with Episodes(offer, engines=engines_of(lent)) as episodes:
        yield episodes


def _play(episodes: Episodes, play: Play, name: str = "tester") -> None:
    async def main() -> None:
        info = types.Implementation(name=name, version="1")
        async with Client(create_server(episodes), client_info=info) as client:
            await play(client)

    anyio.run(main)


async def _call(client: Client, tool: str, **arguments: Any) -> types.CallToolResult:
    result = await client.call_tool(tool, arguments)
    assert isinstance(result, types.CallToolResult)
    return result


def _text(result: types.CallToolResult) -> str:
    return "\n".join(b.text for b in result.content if isinstance(b, types.TextContent))


async def _begun(client: Client, **wishes: Any) -> str:
    text = _text(await _call(client, "new_episode", **wishes))
    return text.partition("id of your episode is ")[2].partition(". ")[0]


@pytest.mark.parametrize(
    ("profile", "names"),
    [
        ("paper", ["Look", "Walk", "Pick", "Drop", "finish"]),
        ("lean", ["Look", "Walk", "Pick", "Drop", "Inspect", "Survey", "Finish"]),
    ],
)
def test_the_tools_are_those_of_the_profile(
    lent: LentWorld, tmp_path: Path, profile: str, names: list[str]
) -> None:
    async def play(client: Client) -> None:
        tools = (await client.list_tools()).tools
        assert [t.name for t in tools] == ["new_episode", "observe", "instructions", *names]
        for tool in tools[1:]:
            assert tool.input_schema["required"][0] == "episode"
        noted = tools[3].input_schema
        assert "note" in noted["properties"]
        assert ("note" in noted["required"]) == (profile == "lean")
        assert ("confidence" in noted["properties"]) == (profile == "lean")
        assert (client.instructions or "").count(names[-1]) == 1

    with _served(lent, tmp_path, settings={"profile": profile}) as episodes:
        _play(episodes, play)


def test_a_result_has_feedback_state_picture_and_link(lent: LentWorld, tmp_path: Path) -> None:
    async def play(client: Client) -> None:
        episode = await _begun(client, instruction="Look round.")
        look = await _call(client, "Look", episode=episode, x=-2, y=1, z=0.5, note="I look.")
        kinds = [block.type for block in look.content]
        assert kinds == ["text", "text", "image", "resource_link"]
        assert _text(look).startswith("Done: looking at (-2.00, 1.00, 0.50).")
        assert "## You" in _text(look) and "- hand: empty" in _text(look)
        image, link = look.content[2:]
        assert isinstance(image, types.ImageContent) and isinstance(link, types.ResourceLink)
        frame = (await client.read_resource(link.uri)).contents[0]
        assert isinstance(frame, types.BlobResourceContents)
        assert frame.blob == image.data and len(base64.b64decode(image.data)) == link.size
        again = await _call(client, "observe", episode=episode)
        assert again.content == look.content

    with _served(lent, tmp_path) as episodes:
        _play(episodes, play)


def test_what_is_wrong_is_told_and_changes_nothing(lent: LentWorld, tmp_path: Path) -> None:
    async def play(client: Client) -> None:
        for tool, arguments, words in (
            ("Look", {}, "episode is missing"),
            ("Look", {"episode": 7}, "episode is missing or no text"),
            ("Look", {"episode": "t8-00000000"}, "There is no episode 't8-00000000'"),
            ("Look", {"episode": "../../etc"}, "There is no episode"),
            ("new_episode", {}, "give a task (T1 to T15) or an instruction"),
            ("new_episode", {"task": "T99"}, "There is no task 'T99'"),
            ("new_episode", {"task": "/etc/passwd"}, "There is no task"),
            ("new_episode", {"task": "T1", "scene": "/tmp/own.toml"}, "There is no scene"),
            ("new_episode", {"task": "T1", "seed": "x"}, "seed is 'x'; give a whole number"),
            ("new_episode", {"task": "T1", "seed": -1}, "seed is -1"),
            ("new_episode", {"task": "T1", "profile": "lean"}, "takes no 'profile'"),
            ("new_episode", {"instruction": "x" * 5000}, "at most 4000"),
        ):
            result = await _call(client, tool, **arguments)
            assert result.is_error and words in _text(result), _text(result)
        episode = await _begun(client, task="t8", scene="S1")
        for tool, arguments, words in (
            ("Look", {"x": "there"}, "Refused"),
            ("Fly", {}, "there is no tool named 'Fly'"),
            ("Pick", {"object": "Nothing_1"}, "no object tagged"),
        ):
            result = await _call(client, tool, episode=episode, **arguments)
            assert not result.is_error and words in _text(result)
        late = await _call(client, "finish", episode=episode)
        assert late.is_error and "answer is missing" in _text(late)
        for uri in ("adamo://episode/nope/instructions", f"adamo://episode/{episode}/frame/x"):
            with pytest.raises(MCPError, match="There is no"):
                await client.read_resource(uri)
        with pytest.raises(MCPError, match="no such resource"):
            await client.read_resource("file:///etc/passwd")
        with pytest.raises(MCPError, match="no such prompt"):
            await client.get_prompt("other")

    with _served(lent, tmp_path) as episodes:
        _play(episodes, play)


def test_several_episodes_and_clients_at_once(lent: LentWorld, tmp_path: Path) -> None:
    async def play(client: Client) -> None:
        first, second = await _begun(client, task="T8"), await _begun(client, task="T8")
        full = await _call(client, "new_episode", task="T1")
        assert full.is_error and "2 sessions are played already" in _text(full)

        async def carry_out(episode: str, calls: list[tuple[str, dict[str, Any]]]) -> None:
            for name, arguments in calls:
                await _call(client, name, episode=episode, **arguments)
            assert _text(await _call(client, "finish", episode=episode, answer="So.")) == ENDED

        async with anyio.create_task_group() as group:
            group.start_soon(carry_out, first, CALLS)
            group.start_soon(carry_out, second, CALLS[:2])
        assert _text(await _call(client, "Look", episode=first, x=0, y=0, z=0)) == ENDED
        found.extend([first, second])

    found: list[str] = []
    with _served(lent, tmp_path, most=2) as episodes:
        _play(episodes, play)
    results = [read_result(tmp_path / episode) for episode in found]
    assert [result and result.completion for result in results] == [1.0, 0.5]


def test_a_new_server_goes_on_with_an_episode(lent: LentWorld, tmp_path: Path) -> None:
    found: list[str] = []

    async def begin(client: Client) -> None:
        found.append(await _begun(client, task="T8"))
        for name, arguments in CALLS[:2]:
            await _call(client, name, episode=found[0], **arguments, note="First.")

    async def go_on(client: Client) -> None:
        told = await _call(client, "instructions", episode=found[0])
        assert "# What happened so far\n(Before: First. - Pick" in _text(told)
        for name, arguments in CALLS[2:]:
            await _call(client, name, episode=found[0], **arguments)
        await _call(client, "finish", episode=found[0], answer="Done.")
        assert _text(await _call(client, "instructions", episode=found[0])) == ENDED

    with _served(lent, tmp_path) as episodes:
        _play(episodes, begin)
    result = read_result(tmp_path / found[0])
    assert result is not None and result.termination is TerminationReason.BROKEN
    with _served(lent, tmp_path) as episodes:
        _play(episodes, go_on, "other")
    result = read_result(tmp_path / found[0])
    assert result is not None and result.strict == 1.0 and result.model == "outside:tester"
    assert "outside:other went on" in result.warnings[0]


def test_one_episode_that_is_set_up_beforehand(lent: LentWorld, tmp_path: Path) -> None:
    async def play(client: Client) -> None:
        assert "Your episode is my-run." in (client.instructions or "")
        assert "new_episode" not in [tool.name for tool in (await client.list_tools()).tools]
        assert [str(r.uri) for r in (await client.list_resources()).resources] == [
            "adamo://episode/my-run/instructions"
        ]
        prompt = (await client.get_prompt("instructions")).messages[0].content
        assert isinstance(prompt, types.TextContent)
        assert prompt.text.endswith("Pick the glass and the plate then put them on the floor")
        other = await _call(client, "observe", episode="other")
        assert other.is_error and "Yours is my-run." in _text(other)
        await _call(client, "finish", episode="my-run", answer="No.")

    fixed = tmp_path / "my-run"
    with _served(lent, tmp_path, fixed=fixed, settings={"task": "T8"}) as episodes:
        _play(episodes, play)
    assert (fixed / RESULT).exists()


def test_who_is_idle_is_closed_and_can_come_back(lent: LentWorld, tmp_path: Path) -> None:
    async def play(client: Client) -> None:
        episode = await _begun(client, task="T8")
        began = time.monotonic()
        while not (tmp_path / episode / RESULT).exists():
            assert time.monotonic() - began < 20
            await anyio.sleep(0.1)
        look = await _call(client, "Look", episode=episode, x=-2, y=1, z=0.5)
        assert "Done: looking" in _text(look)

    with _served(lent, tmp_path, idle_s=0.5) as episodes:
        _play(episodes, play)


def test_time_runs_out_for_who_does_not_come_back(lent: LentWorld, tmp_path: Path) -> None:
    async def play(client: Client) -> None:
        episode = await _begun(client, task="T8")
        began = time.monotonic()
        while _text(await _call(client, "observe", episode=episode)) != ENDED:
            assert time.monotonic() - began < 20
            await anyio.sleep(0.2)
        found.append(episode)

    found: list[str] = []
    limits = Limits(max_seconds=1.0)
    with _served(lent, tmp_path, settings={"limits": limits}) as episodes:
        _play(episodes, play)
    result = read_result(tmp_path / found[0])
    assert result is not None and result.termination is TerminationReason.TIME_LIMIT


def test_no_pictures_means_none_at_all(lent: LentWorld, tmp_path: Path) -> None:
    async def play(client: Client) -> None:
        episode = await _begun(client, task="T8")
        look = await _call(client, "Look", episode=episode, x=-2, y=1, z=0.5)
        assert {block.type for block in look.content} == {"text"}
        frame = next((tmp_path / episode / "frames").iterdir()).name
        with pytest.raises(MCPError, match="without pictures"):
            await client.read_resource(f"adamo://episode/{episode}/frame/{frame}")

    with _served(lent, tmp_path, settings={"switches": {"pictures": "none"}}) as episodes:
        _play(episodes, play)
