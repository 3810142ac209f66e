"""The one interface behind which any VLM, LLM or rule-based player sits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cache
from typing import TYPE_CHECKING, Any, Literal, Protocol

from adamo_vh.action import ToolSchema
from adamo_vh.inference.messages import AIMessage, Message

if TYPE_CHECKING:
    from pydantic import TypeAdapter

    from adamo_vh.inference.remote.capabilities import Capabilities


Isolation = Literal["", "bwrap", "none", "unknown"]
"""How far a player is kept from all but its body: in a box of bubblewrap, not at all, or nobody
knows."""
UNSAFE: tuple[Isolation, ...] = ("none", "unknown")
"""The player may have seen more than its body, the answers even: never compared with others."""


class ModelKind(StrEnum):
    """What kind of player a model is; reports never mix them."""

    VLM = "vlm"
    RULE_BASED = "rule-based"
    RANDOM = "random"
    SCRIPTED = "scripted"
    REPLAY = "replay"
    HUMAN = "human"
    OUTSIDE = "outside"
    """A program of which nothing is known but its calls."""


@dataclass(frozen=True, slots=True)
class Sampling:
    """Decoding settings; the defaults are the paper's (Sec. 4.2)."""

    temperature: float = 0.0
    top_p: float = 0.0
    max_tokens: int = 4000
    """Output tokens at most a message."""
    exact: bool = False
    """Send temperature and top-p as they are, and fail where one is refused. Otherwise a top-p of
    0 is left out at temperature 0 (decoding is greedy without it), and what a server refuses is
    left out too."""


@dataclass(frozen=True, slots=True)
class Usage:
    """Tokens of one reply, as the provider counts them; all 0 for models without tokens."""

    input_tokens: int = 0
    """All of the input, cached or not."""
    output_tokens: int = 0
    """All of the output, reasoning included."""
    cached_tokens: int = 0
    """Part of the input that a provider cache served."""
    reasoning_tokens: int = 0
    """Part of the output that was hidden reasoning."""
    estimated: bool = False
    """Whether a part of it is an estimate, because the provider did not count it."""

    def __add__(self, other: Usage) -> Usage:
        return Usage(
            self.input_tokens + other.input_tokens,
            self.output_tokens + other.output_tokens,
            self.cached_tokens + other.cached_tokens,
            self.reasoning_tokens + other.reasoning_tokens,
            self.estimated or other.estimated,
        )

    @property
    def total_tokens(self) -> int:
        """Input plus output."""
        return self.input_tokens + self.output_tokens


class Rung(StrEnum):
    """How a model is asked for its calls, from the best way down: the ladder."""

    NATIVE = "native"
    """Tool calls of the provider's API."""
    LEAKED = "leaked"
    """The same, but the model writes the call into its text."""
    SCHEMA = "schema"
    """No tools: the reply is one JSON step, held to a schema by the server."""
    REACT = "react"
    """No tools and no schema: Thought, Action and Action Input as text."""


class Ending(StrEnum):
    """What a reply is; each is exactly one of these."""

    CALL = "call"
    """One call or several, to be executed."""
    ANSWER = "answer"
    """Text alone, which the model ended itself: the final answer."""
    CUT_OFF = "cut_off"
    """Stopped before its end: at a limit of tokens, by a pause, or by an abort."""
    UNPARSED_CALL = "unparsed_call"
    """Meant as a call, or as a step in the agreed form, that cannot be read."""
    EMPTY = "empty"
    """Ended by the model itself, with nothing in it."""
    FILTERED = "filtered"
    """Refused or stopped by a filter of the provider."""

    @property
    def is_failure(self) -> bool:
        """Whether it is neither a call nor an answer: a counted protocol failure."""
        return self not in (Ending.CALL, Ending.ANSWER)


@dataclass(frozen=True, slots=True)
class Reply:
    """One answer of a model."""

    message: AIMessage
    usage: Usage = Usage()
    """Of all requests that this answer took, a repair turn included."""
    seconds: float = 0.0
    """Time of the successful requests alone."""
    waited_s: float = 0.0
    """Time lost to failed tries, retries and rate limits; left out of the episode's time cap."""
    requests: int = 1
    """Requests that were answered or failed for this answer."""
    cost_usd: float | None = None
    """What it cost; None if no price is known."""
    settings: Mapping[str, Any] = field(default_factory=dict)
    """The decoding settings that were in effect: what was sent, not what was wished."""
    rung: Rung | None = None
    """How the answer was asked for; None for models without a wire."""
    unreadable: str = ""
    """What is wrong with the answer, as a sentence without its subject, for the model ("was cut off
    after 50 tokens."); empty if it is a call or a final answer, or if nothing was said at all."""
    ending: Ending = None  # type: ignore[assignment]  # Never None once it is made.
    """What the answer is; follows from the message if it is left out."""
    finish_reason: str = ""
    """Why the answer ended, in the provider's own word; empty if there is none."""
    warning: str = ""
    """What people should know of it, e.g. that the server has cut the prompt; empty if nothing."""

    def __post_init__(self) -> None:
        """Tell what the answer is, where the model did not."""
        if self.ending is None:
            object.__setattr__(self, "ending", _ending(self))


@cache
def reply_codec() -> TypeAdapter[Reply]:
    """Writes a reply as JSON, and reads it."""
    from pydantic import TypeAdapter

    return TypeAdapter(Reply)


@dataclass(frozen=True, slots=True)
class Spent:
    """What was spent on an answer that never came."""

    usage: Usage = Usage()
    requests: int = 0
    cost_usd: float | None = None
    """None if no price is known."""
    seconds: float = 0.0
    waited_s: float = 0.0

    @classmethod
    def on(cls, reply: Reply) -> Spent:
        """What a reply took."""
        return cls(reply.usage, reply.requests, reply.cost_usd, reply.seconds, reply.waited_s)

    def __add__(self, other: Spent) -> Spent:
        """Both together; one unknown price makes it unknown."""
        costs = (self.cost_usd, other.cost_usd)
        return Spent(
            self.usage + other.usage,
            self.requests + other.requests,
            None if costs[0] is None or costs[1] is None else costs[0] + costs[1],
            self.seconds + other.seconds,
            self.waited_s + other.waited_s,
        )


def _ending(reply: Reply) -> Ending:
    if reply.unreadable:
        return Ending.UNPARSED_CALL
    if reply.message.calls:
        return Ending.CALL
    return Ending.ANSWER if reply.message.text.strip() else Ending.EMPTY


def _nothing_to_close() -> None:
    """A model without connections has nothing to close."""


@dataclass(frozen=True, slots=True)
class ModelInfo:
    """What there is to know about a model besides its answers."""

    name: str
    """As in the URI that made it, without any secret."""
    kind: ModelKind
    """What kind of player it is."""
    rung: Rung | None = None
    """How it is asked for its calls; None for models without a wire."""
    capabilities: Capabilities | None = None
    """What a probe found out about it; None if it was not probed or has no wire."""
    isolation: Isolation = ""
    """How far a program outside is kept from all but its body; empty for a model that is asked from
    here, and sees only what it is sent."""
    close: Callable[[], None] = field(default=_nothing_to_close, compare=False)
    """Closes its connections."""


class Model(Protocol):
    """Answers a conversation with a note and tool calls."""

    @property
    def info(self) -> ModelInfo:
        """Its name, its kind, and what else there is to know; the same for as long as it lives."""
        ...

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Answer.

        Args:
            messages: The whole prompt, oldest first.
            tools: The tools on offer.
            sampling: Decoding settings.

        Raises:
            ModelError: No answer could be had.
        """
        ...
