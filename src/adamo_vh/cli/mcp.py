"""`adamo-vh mcp`: any MCP client plays, over the standard streams or over HTTP."""

from __future__ import annotations

import re
import secrets
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from adamo_vh.cli.episode import RUNS
from adamo_vh.cli.listening import told_to_stop
from adamo_vh.extras import extra
from adamo_vh.readable import readable
from adamo_vh.record.run_folder import reserve

if TYPE_CHECKING:
    from adamo_vh.service.mcp.offer import Offer


def serve(
    out: Path | None, http: int | None, token: str, *, most: int, idle_s: float, **settings: Any
) -> None:
    """Serve MCP clients until they hang up, or until the process is told to stop.

    Args:
        out: Run folder of the one episode that the settings name; else where run folders go.
        http: Port for HTTP; the standard streams without.
        token: What HTTP requests must bring.
        most: Episodes at once.
        idle_s: When an episode of which nothing is heard is closed.
        **settings: How episodes are set up.

    Raises:
        ConfigError: A setting is wrong, or the extra `mcp` is missing.
    """
    with extra("mcp", "MCP"):
        from adamo_vh.service.mcp.server import create_server
        from adamo_vh.service.mcp.transports import serve_http, serve_stdio
    from adamo_vh.service.mcp.episodes import Episodes

    offer = _offer(out, settings, most, idle_s)
    with Episodes(offer, _tell) as episodes:
        server = create_server(episodes, _tell)
        if http is None:
            _tell(f"MCP on the standard streams; {_what(offer)}")
            serve_stdio(server, episodes.close)
        else:
            with serve_http(server, http, token=token) as url:
                _tell(f"MCP at {url}; {_what(offer)}")
                _tell("stop   Ctrl+C")
                told_to_stop().wait()


def _offer(out: Path | None, settings: dict[str, Any], most: int, idle_s: float) -> Offer:
    from adamo_vh.service.mcp.offer import Offer

    root = RUNS if out is None else out
    offer = Offer(settings, root, None, most, idle_s)
    if not offer.has_one:
        return offer
    what = re.sub(r"[^a-z0-9]+", "-", (offer.config().task or "free").lower()).strip("-")
    folder = out or reserve(RUNS, f"{what}-{secrets.token_hex(4)}")
    return replace(offer, fixed=folder.absolute())


def _what(offer: Offer) -> str:
    if offer.fixed is None:
        return f"clients begin episodes; the runs lie below {offer.root}"
    return f"one episode, recorded in {offer.fixed}"


def _tell(line: str) -> None:
    """Tell who runs the server: beside the standard output, which may be the wire."""
    print(readable(line, lines=True), file=sys.stderr, flush=True)
