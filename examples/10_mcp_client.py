"""A mind outside: an MCP client with the official SDK, which knows nothing of ADAMO.

It starts the server by itself and plays one task. Run by `adamo-vh run --agent-cmd`, it finds its
server instead and is scored in a box of its own:

    adamo-vh run --task T1 --agent-cmd "python examples/10_mcp_client.py"
"""

from __future__ import annotations

import json
import os
import re
import sys
import tempfile
from pathlib import Path

import anyio
from mcp import Client, StdioServerParameters
from mcp.client.streamable_http import streamable_http_client
from mcp.shared._httpx_utils import create_mcp_http_client

ROUND = ((0.0, -1.0), (2.0, -4.0), (2.0, 2.0), (-2.5, 2.5), (-2.5, -4.5))
"""Points to look at, one after another."""


async def play(client: Client, episode: str) -> None:
    """Find the object whose number the instruction names, and take it."""

    async def call(tool: str, **arguments: object) -> str:
        result = await client.call_tool(tool, {"episode": episode, **arguments})
        return "\n".join(block.text for block in result.content if block.type == "text")

    told = await call("instructions")
    instruction = told.partition("# The instruction\n")[2].splitlines()[0]
    print("asked:   ", instruction)
    number = re.findall(r"tagged as (\d+)", instruction)[0]
    seen = await call("observe")
    for x, y in ROUND:
        if found := re.search(rf"\b\w+_{number}\b", seen):
            seen = await call("Pick", object=found[0], note=f"I see {found[0]}.")
            print("feedback:", seen.splitlines()[0])
            break
        seen = await call("Look", x=x, y=y, z=0.8, note=f"{number} is not in view; I look on.")
    print("the end: ", await call("finish", answer="I have looked, and taken it if it was there."))


async def main() -> None:
    """Play at the server that is there, or at one that is started here, and read the score."""
    if url := os.environ.get("ADAMO_VH_MCP_URL"):
        token = os.environ["ADAMO_VH_MCP_TOKEN"]
        http = create_mcp_http_client(headers={"Authorization": f"Bearer {token}"})
        async with Client(streamable_http_client(url, http_client=http)) as client:
            await play(client, os.environ["ADAMO_VH_EPISODE"])
        return
    run = Path(tempfile.mkdtemp()) / "my-run"
    arguments = ["-m", "adamo_vh", "mcp", "--task", "T1", "--resolution", "640x360"]
    server = StdioServerParameters(
        command=sys.executable, args=[*arguments, "--out", str(run)], env=dict(os.environ)
    )
    async with Client(server) as client:
        await play(client, run.name)
    # No client is told the score. It stands in the run folder, for whoever may read it.
    print("score:   ", json.loads((run / "result.json").read_text())["score"]["completion"])


if __name__ == "__main__":
    anyio.run(main)
