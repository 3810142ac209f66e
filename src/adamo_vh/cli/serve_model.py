"""`adamo-vh serve-model`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from adamo_vh.cli.listening import told_to_stop
from adamo_vh.cli.terminal import say
from adamo_vh.model_server.model_serving import serve_model

if TYPE_CHECKING:
    from adamo_vh.model_server.openai_endpoint import Served


def serve(model: str, host: str, port: int, faults: Path | None, *, tools: bool) -> None:
    """Serve a model until it is stopped, with a line for each request.

    Raises:
        ConfigError: A setting is wrong or the port is taken.
    """
    stop = told_to_stop()
    with serve_model(model, port, host=host, tools=tools, faults=faults, watch=_tell) as served:
        say(f"{served.name} at {served.base_url}")
        say(f"try    adamo-vh run --task T1 --model {served.uri}")
        say("stop   Ctrl+C")
        stop.wait()
    say("stopped")


def _tell(served: Served) -> None:
    status = str(served.status) if served.status else "cut"
    # A client's words stay on the line of their request.
    say(f"{served.number:5d}  {status:>3}  {' '.join(served.text.split())}")
