"""A model that first repeats what it said before an interruption and then goes on."""

from __future__ import annotations

from collections.abc import Sequence

from adamo_vh.action import ToolSchema
from adamo_vh.inference.messages import Message
from adamo_vh.inference.model import Model, ModelKind, Reply, Sampling, close_model


class Resumed:
    """Recorded answers first, then those of a model."""

    def __init__(self, said: Sequence[Reply], model: Model) -> None:
        """Prepare to go on.

        Args:
            said: What was answered before, in order.
            model: Who answers afterwards.
        """
        self._said = list(said)
        self._model = model

    @property
    def name(self) -> str:
        """The model's name."""
        return self._model.name

    @property
    def kind(self) -> ModelKind:
        """The model's kind."""
        return self._model.kind

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Answer from the record, or ask the model when the record is used up."""
        if self._said:
            return self._said.pop(0)
        return self._model.complete(messages, tools, sampling)

    def close(self) -> None:
        """Close the model's connections, if it has any."""
        close_model(self._model)
