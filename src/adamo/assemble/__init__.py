"""The one place where a concrete engine, a model, a profile and a task meet."""

from adamo.assemble.chat import ChatSession
from adamo.assemble.engines import create_engine, open_server
from adamo.assemble.episode import resume_episode, run_episode
from adamo.assemble.forecasting import forecast_episodes
from adamo.assemble.players import create_player, recorded_model
from adamo.assemble.replaying import replay_episode

__all__ = [
    "ChatSession",
    "create_engine",
    "create_player",
    "forecast_episodes",
    "open_server",
    "recorded_model",
    "replay_episode",
    "resume_episode",
    "run_episode",
]
