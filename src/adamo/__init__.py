"""ADAMO: a body in a 3D room for vision-language models, and the benchmark around it.

One call runs an episode: `adamo.run_episode("Put the plate on the floor", model="baseline")`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from adamo.assemble.chat import ChatSession
    from adamo.assemble.engines import create_engine
    from adamo.assemble.episode import resume_episode, run_episode
    from adamo.assemble.replaying import replay_episode
    from adamo.benchmark.episode import EpisodeConfig, EpisodeResult
    from adamo.cognition.budget import Budget
    from adamo.cognition.profile import Profile
    from adamo.errors import AdamoError

__all__ = [
    "AdamoError",
    "Budget",
    "ChatSession",
    "EpisodeConfig",
    "EpisodeResult",
    "Profile",
    "create_engine",
    "replay_episode",
    "resume_episode",
    "run_episode",
]

_HOME = {
    "AdamoError": "adamo.errors",
    "Budget": "adamo.cognition.budget",
    "ChatSession": "adamo.assemble.chat",
    "EpisodeConfig": "adamo.benchmark.episode",
    "EpisodeResult": "adamo.benchmark.episode",
    "Profile": "adamo.cognition.profile",
    "create_engine": "adamo.assemble.engines",
    "replay_episode": "adamo.assemble.replaying",
    "resume_episode": "adamo.assemble.episode",
    "run_episode": "adamo.assemble.episode",
}


def __getattr__(name: str) -> Any:
    """Import the public names when they are first used, so that `import adamo` stays fast."""
    if name not in _HOME:
        raise AttributeError(f"module 'adamo' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_HOME[name]), name)
