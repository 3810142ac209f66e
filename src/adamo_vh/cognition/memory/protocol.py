"""What the agent needs from a memory: it is told what happened, and makes the prompt of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from adamo_vh.action import Outcome
from adamo_vh.cognition.profile import Profile
from adamo_vh.inference.messages import AIMessage, Message
from adamo_vh.observation import AgentState, Frame, Observation
from adamo_vh.perception import TextForm


@dataclass(frozen=True, slots=True)
class Result:
    """What came back for one call."""

    call_id: str
    name: str
    text: str
    agent: AgentState
    outcome: Outcome | None = None
    """How the action ended; None if it was not executed."""
    view: Observation | None = None
    pictures: tuple[Frame, ...] = ()
    left_out: str = ""
    """Why the call was not even looked at, e.g. because an earlier one ended the turn."""

    @property
    def went_as_planned(self) -> bool:
        """Whether a plan may go on after it."""
        return self.outcome is Outcome.DONE


class Memory(Protocol):
    """Remembers an episode for its model.

    It is given only what the agent has perceived, said and been told; what is not in the prompt
    that it makes, the model does not know.
    """

    @property
    def state_text(self) -> str:
        """The whole symbolic state now; for the record."""
        ...

    def instruct(self, text: str, view: Observation) -> None:
        """Remember an instruction and the view at that moment."""
        ...

    def remark(self, text: str) -> None:
        """Remember a word to the model that is no instruction."""
        ...

    def add_step(self, message: AIMessage, *results: Result) -> None:
        """Remember what the model said and what came back for each of its calls, in order."""
        ...

    def messages(self) -> Sequence[Message]:
        """The whole prompt, oldest first; the same until something is added."""
        ...


NewMemory = Callable[[str, int, Profile, TextForm], Memory]
"""Makes an empty memory from the fixed instructions, the steps to keep (k), the profile, and the
fields that the symbolic state has; `ShortTermMemory` is one."""
