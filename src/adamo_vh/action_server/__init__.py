"""The Action Server: carries tool calls out in an engine and tells what became of them."""

from adamo_vh.action_server.local import LocalActionServer
from adamo_vh.action_server.protocol import ActionResult, ActionServer, Sighting, execute_call
from adamo_vh.action_server.tools import LEAN_TOOLS, PAPER_TOOLS, Tool, ToolContext

__all__ = [
    "LEAN_TOOLS",
    "PAPER_TOOLS",
    "ActionResult",
    "ActionServer",
    "LocalActionServer",
    "Sighting",
    "Tool",
    "ToolContext",
    "execute_call",
]
