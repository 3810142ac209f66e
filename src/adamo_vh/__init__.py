"""ADAMO: a body in a 3D room for vision-language models, and the benchmark around it.

One call runs an episode: `adamo_vh.run_episode("Put the plate on the floor", model="baseline")`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from adamo_vh.cognition.budget import Budget
    from adamo_vh.cognition.profile import Profile
    from adamo_vh.episode.result import EpisodeConfig, EpisodeResult
    from adamo_vh.errors import AdamoError
    from adamo_vh.session.chat import ChatSession
    from adamo_vh.session.engines import create_engine
    from adamo_vh.session.episode import resume_episode, run_episode
    from adamo_vh.session.replaying import replay_episode

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
    "AdamoError": "adamo_vh.errors",
    "Budget": "adamo_vh.cognition.budget",
    "ChatSession": "adamo_vh.session.chat",
    "EpisodeConfig": "adamo_vh.episode.result",
    "EpisodeResult": "adamo_vh.episode.result",
    "Profile": "adamo_vh.cognition.profile",
    "create_engine": "adamo_vh.session.engines",
    "replay_episode": "adamo_vh.session.replaying",
    "resume_episode": "adamo_vh.session.episode",
    "run_episode": "adamo_vh.session.episode",
}


def __getattr__(name: str) -> Any:
    """Import the public names when they are first used, so that `import adamo_vh` stays fast."""
    if name not in _HOME:
        raise AttributeError(f"module 'adamo_vh' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_HOME[name]), name)
