"""A wrapper stands in for a model: it answers through a function and is the model in all else."""

from __future__ import annotations

from dataclasses import replace

from adamo_vh.inference.messages import AIMessage, HumanMessage, TextPart
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling
from adamo_vh.inference.players.resumed import resumed
from adamo_vh.inference.players.wrapper import Wrapped

ASK = (HumanMessage((TextPart("Hi"),)),)


class Counting:
    """A model that counts its answers and has a connection."""

    def __init__(self) -> None:
        self.closed = False
        self.asked = 0
        self.info = ModelInfo("counting", ModelKind.VLM, close=self._close)

    def _close(self) -> None:
        self.closed = True

    def complete(self, messages, tools, sampling):
        self.asked += 1
        return Reply(AIMessage(f"answer {self.asked}"))


def test_a_wrapped_model_answers_through_the_function() -> None:
    def louder(ask, messages, tools, sampling):
        reply = ask(messages, tools, sampling)
        return replace(reply, message=AIMessage(reply.message.text.upper()))

    inner = Counting()
    model = Wrapped(inner, louder)
    assert model.complete(ASK, (), Sampling()).message.text == "ANSWER 1"
    assert model.info == inner.info
    model.info.close()
    assert inner.closed


def test_a_resumed_model_is_asked_only_behind_the_record() -> None:
    inner = Counting()
    model = resumed([Reply(AIMessage("before"))], inner)
    said = [model.complete(ASK, (), Sampling()).message.text for _ in range(3)]
    assert said == ["before", "answer 1", "answer 2"]
    assert inner.asked == 2
