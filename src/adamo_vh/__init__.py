"""ADAMO: a body in a 3D room for vision-language models, and the benchmark around it.

One call runs an episode: `adamo_vh.run_episode("Put the plate on the floor", model="baseline")`.
A `Session` is what it is made of; a conversation is a session with several instructions. Everything
that stands behind an interface can be handed in from outside: `World` and `Body`, `Model`, `Tool`,
`Memory`, `Task`, `Tagger` (as `Labeling`), `Guard`, `Observer`.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from adamo_vh.action import Feedback as Feedback
    from adamo_vh.action_server import PAPER_TOOLS as PAPER_TOOLS
    from adamo_vh.action_server import Tool as Tool
    from adamo_vh.action_server import ToolContext as ToolContext
    from adamo_vh.action_server.frame_cache import FrameCache as FrameCache
    from adamo_vh.action_server.remote import RemoteBody as RemoteBody
    from adamo_vh.action_server.remote import connect as connect
    from adamo_vh.benchmark.tasks import Task as Task
    from adamo_vh.cognition.budget import Budget as Budget
    from adamo_vh.cognition.guards import Guard as Guard
    from adamo_vh.cognition.memory.protocol import Memory as Memory
    from adamo_vh.cognition.profile import Profile as Profile
    from adamo_vh.engine import Body as Body
    from adamo_vh.engine import World as World
    from adamo_vh.episode.config import EpisodeConfig as EpisodeConfig
    from adamo_vh.episode.result import EpisodeResult as EpisodeResult
    from adamo_vh.errors import AdamoError as AdamoError
    from adamo_vh.inference.model import Model as Model
    from adamo_vh.inference.model import ModelInfo as ModelInfo
    from adamo_vh.inference.model import Reply as Reply
    from adamo_vh.perception import Labeling as Labeling
    from adamo_vh.perception import Tagger as Tagger
    from adamo_vh.record.termination import Limits as Limits
    from adamo_vh.record.termination import Stop as Stop
    from adamo_vh.record.trajectory import Observer as Observer
    from adamo_vh.session.bodies import create_engine as create_engine
    from adamo_vh.session.driven import DrivenBody as DrivenBody
    from adamo_vh.session.lending import Lender as Lender
    from adamo_vh.session.runs import replay_episode as replay_episode
    from adamo_vh.session.runs import resume_episode as resume_episode
    from adamo_vh.session.runs import run_episode as run_episode
    from adamo_vh.session.session import Session as Session

_HOMES = {
    "action": "Feedback",
    "action_server": "PAPER_TOOLS Tool ToolContext",
    "action_server.frame_cache": "FrameCache",
    "action_server.remote": "RemoteBody connect",
    "benchmark.tasks": "Task",
    "cognition.budget": "Budget",
    "cognition.guards": "Guard",
    "cognition.memory.protocol": "Memory",
    "cognition.profile": "Profile",
    "engine": "Body World",
    "episode.config": "EpisodeConfig",
    "episode.result": "EpisodeResult",
    "errors": "AdamoError",
    "inference.model": "Model ModelInfo Reply",
    "perception": "Labeling Tagger",
    "record.termination": "Limits Stop",
    "record.trajectory": "Observer",
    "session.bodies": "create_engine",
    "session.driven": "DrivenBody",
    "session.lending": "Lender",
    "session.runs": "replay_episode resume_episode run_episode",
    "session.session": "Session",
}
"""Where the public names are at home; type checkers read the imports above."""
_HOME = {name: home for home, names in _HOMES.items() for name in names.split()}

__all__ = sorted([*_HOME, "__version__"])  # noqa: PLE0605


def __getattr__(name: str) -> Any:
    """Import the public names when they are first used, so that `import adamo_vh` stays fast."""
    if name == "__version__":
        from importlib.metadata import version

        return version("adamo-vh")
    if name not in _HOME:
        raise AttributeError(f"module 'adamo_vh' has no attribute {name!r}")
    return getattr(import_module(f"adamo_vh.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    """The public names, and what every module has."""
    return sorted({*__all__, *globals()})
