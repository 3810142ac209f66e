"""A program of its own that plays over MCP with the official client: what it hears, it prints.

Reads what to do as JSON from its first argument, and writes one JSON message a line.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Mapping
from typing import Any

import anyio
import mcp_types as types
from mcp import Client, StdioServerParameters
from mcp.client.streamable_http import streamable_http_client
from mcp.shared._httpx_utils import create_mcp_http_client


def _heard(message: Any) -> Any:
    print(message.model_dump_json(by_alias=True), flush=True)
    return message


def _client(plan: Mapping[str, Any]) -> Client:
    info = types.Implementation(name=plan.get("name", "player"), version="1")
    if "url" in plan:
        headers = {"Authorization": f"Bearer {plan['token']}"}
        http = create_mcp_http_client(headers=headers)
        return Client(streamable_http_client(plan["url"], http_client=http), client_info=info)
    command, *arguments = plan["command"]
    server = StdioServerParameters(command=command, args=arguments, env=plan["environment"])
    return Client(server, client_info=info)


async def play(plan: Mapping[str, Any]) -> None:
    """Play as planned: begin or go on, make the calls, fetch all that can be fetched."""
    async with _client(plan) as client:
        print(json.dumps({"instructions": client.instructions}), flush=True)
        _heard(await client.list_tools())
        episode = plan.get("episode", "")
        if not episode:
            begun = _heard(await client.call_tool("new_episode", plan["wishes"]))
            episode = re.findall(r"id of your episode is (\S+)\.", begun.content[0].text)[0]
        _heard(await client.call_tool("instructions", {"episode": episode}))
        for name, arguments in plan["calls"]:
            result = _heard(await client.call_tool(name, {"episode": episode, **arguments}))
            for block in result.content:
                if block.type == "resource_link":
                    _heard(await client.read_resource(block.uri))
        for heard in (
            await client.list_prompts(),
            await client.get_prompt("instructions", {"episode": episode}),
            await client.list_resources(),
            await client.list_resource_templates(),
            await client.read_resource(f"adamo://episode/{episode}/instructions"),
            await client.call_tool("observe", {"episode": episode}),
        ):
            _heard(heard)
        print(json.dumps({"episode": episode}), flush=True)
        if plan.get("hangs"):
            await anyio.sleep_forever()


if __name__ == "__main__":
    anyio.run(play, json.loads(sys.argv[1]))
