"""A model with something done around each of its calls."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from adamo_vh.action import ToolSchema
from adamo_vh.inference.messages import Message
from adamo_vh.inference.model import Model, ModelInfo, Reply, Sampling

Ask = Callable[[Sequence[Message], Sequence[ToolSchema], Sampling], Reply]
"""`Model.complete`, bound to its model."""
Around = Callable[[Ask, Sequence[Message], Sequence[ToolSchema], Sampling], Reply]
"""Gives the reply to a request; it asks the model itself, or not."""


class Wrapped:
    """A model whose requests go through a function; in all else it is the model itself."""

    def __init__(self, model: Model, around: Around) -> None:
        """Wrap a model.

        Args:
            model: Who answers.
            around: Is called in its place, with the means to ask it.
        """
        self._model = model
        self._around = around

    @property
    def info(self) -> ModelInfo:
        """The model's."""
        return self._model.info

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Answer through the function."""
        return self._around(self._model.complete, messages, tools, sampling)
