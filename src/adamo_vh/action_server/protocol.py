"""What the mind needs from a body: tools, views, and truthful feedback."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from adamo_vh.action import Action, Feedback, parse
from adamo_vh.errors import InvalidActionError
from adamo_vh.observation import AgentState, Frame, Observation


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
    saved: str
    """What `ActionServer.save` gives after the action."""
    pictures: tuple[Frame, ...] = ()
    """What the action itself showed, e.g. a close-up; not the view of the eyes."""


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

    def save(self) -> str:
        """World, body and what was seen so far, as text: enough to go on from here elsewhere."""
        ...

    def load(self, saved: str) -> None:
        """Go back to what `save` gave.

        Raises:
            EngineError: The text is damaged or belongs to another scene.
        """
        ...


def execute_call(
    server: ActionServer, name: str, arguments: Mapping[str, Any] | None
) -> ActionResult:
    """Carry a model's tool call out; one that is no valid action is refused and changes nothing."""
    try:
        action = parse(name, arguments, server.actions)
    except InvalidActionError as error:
        feedback = Feedback.of_error(error)
        return ActionResult(feedback, server.agent(), None, server.state_hash(), server.save())
    return server.execute(action)
