"""What the mind needs from a body: tools, views, and truthful feedback."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from adamo.action import Action, Feedback
from adamo.observation import AgentState, Observation


@dataclass(frozen=True, slots=True)
class ActionResult:
    """What an action brought."""

    feedback: Feedback
    agent: AgentState
    """The body after the action."""
    observation: Observation | None
    """A new view, if the refresh rule grants one for this action."""
    state_hash: str
    """Digest of the world after the action; reveals nothing, proves replays."""


class ActionServer(Protocol):
    """A body that can be asked for views and told to act."""

    @property
    def actions(self) -> tuple[type, ...]:
        """The action types on offer, in the order in which tools are listed."""
        ...

    def observe(self) -> Observation:
        """The view from where the body stands now."""
        ...

    def execute(self, action: Action) -> ActionResult:
        """Carry out one action.

        Raises:
            EngineError: The world itself failed; what the agent did wrong is feedback instead.
        """
        ...

    def agent(self) -> AgentState:
        """The body now."""
        ...

    def say(self, text: str) -> None:
        """Deliver the final answer through the body."""
        ...

    def state_hash(self) -> str:
        """Digest of the world now."""
        ...
