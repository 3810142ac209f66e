"""A program that plays over MCP, as somebody else would write it, without the package.

Does what its argument, a JSON object, says: calls, writes, misbehaves, and tells what it sees.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any


def _seen(paths: list[str]) -> dict[str, Any]:
    """What of some paths is there, and what else a box should tell."""
    try:
        import adamo_vh  # noqa: F401

        package = True
    except ImportError:
        package = False
    return {
        "paths": {
            path: Path(path).exists() and (Path(path).is_file() or bool(os.listdir(path)))
            for path in paths
        },
        "package": package,
        "here": os.listdir("."),
        "environment": dict(os.environ),
        "processes": sum(name.isdecimal() for name in os.listdir("/proc")),
        "network": _reached("1.1.1.1", 53),
    }


def _reached(host: str, port: int) -> bool:
    import socket

    with socket.socket() as probe:
        probe.settimeout(2)
        return probe.connect_ex((host, port)) == 0


async def _play(plan: dict[str, Any]) -> None:
    from mcp import Client
    from mcp.client.streamable_http import streamable_http_client
    from mcp.shared._httpx_utils import create_mcp_http_client

    headers = {"Authorization": f"Bearer {os.environ['ADAMO_VH_MCP_TOKEN']}"}
    http = create_mcp_http_client(headers=headers)
    async with Client(
        streamable_http_client(os.environ["ADAMO_VH_MCP_URL"], http_client=http)
    ) as c:
        for name, arguments in plan["calls"]:
            given = {"episode": os.environ["ADAMO_VH_EPISODE"], **arguments}
            result = await c.call_tool(name, given)
            print(name, result.model_dump()["content"][0]["text"], flush=True)


def main() -> None:
    plan = json.loads(sys.argv[1])
    if "paths" in plan:
        Path("seen.json").write_text("{}")
        print(json.dumps(_seen(plan["paths"])), flush=True)
    if plan.get("calls"):
        import anyio

        anyio.run(_play, plan)
    if "children" in plan:
        subprocess.Popen(["sleep", str(plan["children"])])
    print("x" * plan.get("noise", 0) + plan.get("words", ""), file=sys.stderr, flush=True)
    time.sleep(plan.get("sleeps", 0))
    sys.exit(plan.get("code", 0))


if __name__ == "__main__":
    main()
