"""What the mind needs from a body: tools, views, and truthful feedback.

Every call is answered whole, so that an action takes one round trip wherever the body is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from adamo_vh.action import Action, Feedback, parse
from adamo_vh.errors import InvalidActionError
from adamo_vh.observation import AgentState, Frame, Observation


@dataclass(frozen=True, slots=True)
class Sighting:
    """What a look at the room brought."""

    observation: Observation
    """The view, with the body as it is now."""
    state_hash: str
    """Digest of the world now; reveals nothing, proves replays."""
    saved: str
    """Handle to the saved state, for `ActionServer.load`: the state itself where body and mind are
    in one process, else a name under which the server keeps it."""
    waited_s: float = 0.0
    """Seconds that the server waited for an engine that others use too: none of the agent's."""

    @property
    def agent(self) -> AgentState:
        """The body now."""
        return self.observation.agent


@dataclass(frozen=True, slots=True)
class ActionResult:
    """What an action brought."""

    feedback: Feedback
    agent: AgentState
    """The body after the action."""
    observation: Observation | None
    """A new view, if the refresh rule grants one for this action."""
    state_hash: str
    """Digest of the world after the action; see `Sighting`."""
    saved: str
    """Handle to the saved state after the action; see `Sighting`."""
    pictures: tuple[Frame, ...] = ()
    """What the action itself showed, e.g. a close-up; not the view of the eyes."""
    waited_s: float = 0.0
    """Seconds that the server waited for its engine; see `Sighting`."""


class ActionServer(Protocol):
    """A body that can be asked for views and told to act."""

    @property
    def actions(self) -> tuple[type, ...]:
        """The action types on offer, in the order in which tools are listed."""
        ...

    def observe(self) -> Sighting:
        """The view from where the body stands now.

        Raises:
            EngineError: The world itself failed, or showed what cannot be.
        """
        ...

    def execute(self, action: Action) -> ActionResult:
        """Carry out one action.

        Raises:
            EngineError: The world itself failed; what the agent did wrong is feedback instead.
        """
        ...

    def refuse(self, error: InvalidActionError) -> ActionResult:
        """Answer a call that is no valid action: nothing changes."""
        ...

    def say(self, text: str) -> None:
        """Deliver the final answer through the body."""
        ...

    def load(self, saved: str) -> str:
        """Go back to a saved state.

        Args:
            saved: What an earlier answer gave, or the state itself from a record.

        Returns:
            Digest of the world then.

        Raises:
            EngineError: It is damaged or belongs to another scene.
        """
        ...


def execute_call(
    server: ActionServer, name: str, arguments: Mapping[str, Any] | None
) -> ActionResult:
    """Carry a model's tool call out; one that is no valid action is refused and changes nothing."""
    try:
        action = parse(name, arguments, server.actions)
    except InvalidActionError as error:
        error.call = (name, arguments)  # For a server that has to record or to send it.
        return server.refuse(error)
    return server.execute(action)
