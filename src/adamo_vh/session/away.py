"""A mind here and its body on a server: the ordinary agent, and what it tells the server's record.

The server keeps record, limits and score. What the model said, and what it took, is told to it
before each call, so that its record is that of an episode played there.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import asdict, replace
from types import TracebackType
from typing import Any, Self

from adamo_vh.action_server.remote import RemoteBody, connect
from adamo_vh.cognition.agent import Agent, AgentConfig
from adamo_vh.cognition.budget import BudgetGuard
from adamo_vh.cognition.profile import PROFILES, Profile
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.inference.model import Model, reply_codec
from adamo_vh.observation import Frame
from adamo_vh.perception import TextForm
from adamo_vh.record.termination import Limits
from adamo_vh.record.trajectory import Ended, Event, Observer, Thought
from adamo_vh.session.forecasting import check_price
from adamo_vh.session.minds import fitting, opened_model


class AwaySession:
    """One episode in which the mind is here and the body elsewhere."""

    def __init__(
        self,
        config: EpisodeConfig,
        url: str,
        *,
        token: str = "",
        transport: str = "auto",
        retry_s: float = 60.0,
        model: Model | None = None,
        observers: Sequence[Observer] = (),
    ) -> None:
        """Open the model, and begin a session on the server.

        Args:
            config: Model, budget and memory hold here; task, scene and profile are the server's to
                carry out; limits are the server's own.
            url: Of the server.
            token: What it asks of players.
            transport: "auto", "websocket" or "http".
            retry_s: So long a cut connection is tried again, seconds.
            model: In place of the one that the settings name; is not closed.
            observers: Are told of every event.

        Raises:
            ConfigError: A setting is wrong, or the server lets nobody in.
            ModelConfigError: The model is unknown or lacks a key or an extra.
            EngineError: The server cannot be reached, or has no room.
        """
        with ExitStack() as stack:
            mind = opened_model(stack, config, model)
            check_price(config.model, config.budget, mind if model is None else None)
            profile = fitting(config.profile, mind)
            self.body = stack.enter_context(
                connect(
                    url,
                    token=token,
                    transport=transport,
                    retry_s=retry_s,
                    **_asked(config, profile, mind.info.name),
                )
            )
            self._agent = Agent(
                mind,
                self.body,
                self.body.system_prompt,
                AgentConfig(
                    profile,
                    config.k,
                    TextForm(self.body.settings["text_form"]),
                    config.sampling,
                    Limits(**self.body.settings["limits"]),
                ),
                guards=(BudgetGuard(config.budget),),
                records=(_Relay(self.body),),
                observers=observers,
            )
            self._closing = stack.pop_all()

    def play(self) -> Ended:
        """Carry the instruction out.

        Returns:
            How it ended, as it is seen from here; the record is the server's.
        """
        return self._agent.run(self.body.instruction)

    def __enter__(self) -> Self:
        """The session itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Hang up, and close the model."""
        self._closing.close()


class _Relay:
    """Tells the server's record what the model said, and why the episode ended here."""

    def __init__(self, body: RemoteBody) -> None:
        self._body = body

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Pass on what the server cannot know."""
        if isinstance(event, Thought):
            # What a provider keeps for itself is nobody else's.
            reply = replace(event.reply, message=replace(event.reply.message, kept=""))
            self._body.think(reply_codec().dump_python(reply, mode="json"))
        if isinstance(event, Ended) and event.reason.is_scored and not self._body.ended:
            self._body.finish(event.answer, event.reason.value, event.why)


def _asked(config: EpisodeConfig, profile: Profile, player: str) -> dict[str, Any]:
    """What the server is asked for."""
    usual = asdict(PROFILES[profile.name])
    switches = {name: value for name, value in asdict(profile).items() if value != usual[name]}
    width, height = config.resolution
    about = {"task": config.task} if config.task else {"instruction": config.instruction}
    return {
        **about,
        "scene": config.scene,
        "labeling": config.labeling.value,
        "profile": profile.name,
        "switches": switches,
        "seed": config.seed,
        "variation": config.variation,
        "resolution": f"{width}x{height}",
        "player": player,
    }
