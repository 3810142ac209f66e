"""The one interface behind which any VLM, LLM or rule-based player sits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol

from adamo.action import ToolSchema
from adamo.inference.messages import AIMessage, Message


class ModelKind(StrEnum):
    """What kind of player a model is; reports never mix them."""

    VLM = "vlm"
    RULE_BASED = "rule-based"
    SCRIPTED = "scripted"
    REPLAY = "replay"


@dataclass(frozen=True, slots=True)
class Sampling:
    """Decoding settings; the defaults are the paper's (Sec. 4.2)."""

    temperature: float = 0.0
    top_p: float = 0.0
    max_tokens: int = 4000
    """Output tokens at most a message."""


@dataclass(frozen=True, slots=True)
class Usage:
    """Tokens of one reply, as the provider counts them; 0 for models without tokens."""

    input_tokens: int = 0
    output_tokens: int = 0
    cached_tokens: int = 0
    """Part of the input that a provider cache served."""

    def __add__(self, other: Usage) -> Usage:
        return Usage(
            self.input_tokens + other.input_tokens,
            self.output_tokens + other.output_tokens,
            self.cached_tokens + other.cached_tokens,
        )

    @property
    def total_tokens(self) -> int:
        """Input plus output."""
        return self.input_tokens + self.output_tokens


@dataclass(frozen=True, slots=True)
class Reply:
    """One answer of a model."""

    message: AIMessage
    usage: Usage = Usage()
    seconds: float = 0.0
    """Time of the successful request alone."""
    waited_s: float = 0.0
    """Time lost to failed tries, retries and rate limits; left out of the episode's time cap."""


class Model(Protocol):
    """Answers a conversation with a note and tool calls."""

    @property
    def name(self) -> str:
        """As in the URI that made it, without any secret."""
        ...

    @property
    def kind(self) -> ModelKind:
        """What kind of player it is."""
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
