"""MCP on the one port of a server: beside the other faces, behind the same edge."""

from __future__ import annotations

import urllib.error
import urllib.request
from collections.abc import Callable
from pathlib import Path

import anyio
import pytest
from mcp import Client

from adamo_vh.action_server.wire import Create
from adamo_vh.episode.result import read_result
from adamo_vh.record.run_folder import RESULT
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.service.app import serving
from adamo_vh.service.hosting import Host
from adamo_vh.session.outside import ENDED
from adamo_vh.session.pooling import BusyError

Serve = Callable[..., tuple[str, Host]]


def test_a_client_plays_on_the_one_port(serve: Serve) -> None:
    url, host = serve(labeling="opaq", limits=Limits(max_steps=3))
    found: list[Path] = []

    async def play() -> None:
        async with Client(f"{url}/mcp") as client:
            begun = (await client.call_tool("new_episode", {"task": "T8"})).content[0]
            assert begun.type == "text" and "after 3 steps" in begun.text
            assert "A tag is" in begun.text and "Class_number" not in begun.text
            episode = begun.text.partition("id of your episode is ")[2].partition(". ")[0]
            for x in (-1, 0, 1):
                look = await client.call_tool("Look", {"episode": episode, "x": x, "y": 1, "z": 0})
            assert look.content[0].type == "text" and look.content[0].text == ENDED
            found.append(host.out / episode)
            with anyio.fail_after(20):
                while not (found[0] / RESULT).exists():
                    await anyio.sleep(0.1)

    anyio.run(play)
    result = read_result(found[0])
    assert result is not None and result.termination is TerminationReason.STEP_LIMIT
    assert result.steps == 3 and result.labeling == "opaq"


def test_the_faces_share_the_room_of_the_server(serve: Serve) -> None:
    url, host = serve(most_sessions=1)

    async def begin(expected: str) -> str:
        async with Client(f"{url}/mcp") as client:
            begun = (await client.call_tool("new_episode", {"task": "T8"})).content[0]
            assert begun.type == "text" and expected in begun.text
            return begun.text.partition("id of your episode is ")[2].partition(". ")[0]

    async def finish(episode: str) -> None:
        async with Client(f"{url}/mcp") as client:
            await client.call_tool("finish", {"episode": episode, "answer": "Enough."})

    first = host.create(Create("T8"))
    anyio.run(begin, "1 session is played already")
    host.close(first.id)
    episode = anyio.run(begin, "id of your episode is ")
    with pytest.raises(BusyError, match="1 session is played already"):
        host.create(Create("T8"))
    anyio.run(finish, episode)
    host.create(Create("T8"))


def test_what_is_unfinished_is_written_down_when_the_server_ends(
    make_host: Callable[..., Host],
) -> None:
    host = make_host()

    async def play(url: str) -> None:
        async with Client(f"{url}/mcp") as client:
            await client.call_tool("new_episode", {"task": "T8"})

    with serving(host) as url:
        anyio.run(play, url)
    [folder] = host.out.iterdir()
    result = read_result(folder)
    assert result is not None and result.termination is TerminationReason.BROKEN


def test_it_is_behind_the_same_edge(serve: Serve) -> None:
    url, _ = serve()
    wrong = urllib.request.Request(f"{url}/mcp", b"{}", {"Origin": "http://evil.example"})
    with pytest.raises(urllib.error.HTTPError) as refused:
        urllib.request.urlopen(wrong, timeout=10)
    assert refused.value.code == 403
