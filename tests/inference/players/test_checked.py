"""What an own model does wrong is said in a sentence that names it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from adamo_vh.errors import ModelConfigError, ModelError, ProviderError
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling
from adamo_vh.inference.players.checked import checked

said: Any = AIMessage
call: Any = ToolCall
reply: Any = Reply


class Mine:
    """A model of somebody's own, that does what it is told to."""

    info = ModelInfo("mine", ModelKind.VLM)

    def __init__(self, do: Callable[[], Any]) -> None:
        self._do = do

    def complete(self, messages: Any, tools: Any, sampling: Any) -> Any:
        return self._do()


def ask(do: Callable[[], Any]) -> Reply:
    return checked(Mine(do)).complete((), (), Sampling())


def fail(error: Exception) -> Callable[[], Any]:
    def do() -> Any:
        raise error

    return do


def test_a_good_answer_passes_as_it_is() -> None:
    good = Reply(AIMessage("Done", (ToolCall("1", "Look", None, "{"),)))
    assert ask(lambda: good) is good


@pytest.mark.parametrize(
    "do",
    [
        lambda: None,
        lambda: "Done",
        lambda: AIMessage("Done"),
        fail(ValueError("no idea")),
        fail(KeyError("x")),
        fail(RecursionError()),
        lambda: reply("Done"),
        lambda: reply(said(None)),
        lambda: reply(said("x", [call("1", "Look", {})])),
        lambda: reply(said("x", ({"name": "Look"},))),
        lambda: reply(said("x", (call("1", "Look", "x=1"),))),
        lambda: reply(said("x", (call(1, "Look", {}),))),
        lambda: reply(said("x"), usage=12),
        lambda: reply(said("x"), seconds=float("nan")),
        lambda: reply(said("x"), seconds=-1.0),
        lambda: reply(said("x"), requests=True),
    ],
)
def test_an_answer_that_is_none_names_the_model(do: Callable[[], Any]) -> None:
    with pytest.raises(ModelError, match="The model Mine ") as caught:
        ask(do)
    assert str(caught.value).endswith(".")


def test_what_a_model_raises_on_purpose_passes_as_it_is() -> None:
    error = ProviderError("the provider is down")
    with pytest.raises(ProviderError) as caught:
        ask(fail(error))
    assert caught.value is error


@pytest.mark.parametrize("odd", [None, 7, "mine", object(), ModelInfo("mine", ModelKind.VLM)])
def test_what_is_no_model_is_said_at_the_door(odd: Any) -> None:
    with pytest.raises(ModelConfigError, match="is no model: it lacks complete"):
        checked(odd)


@pytest.mark.parametrize(
    "info",
    [None, "mine", ModelInfo(None, ModelKind.VLM), ModelInfo("mine", "vlm")],  # type: ignore[arg-type]
)
def test_a_model_says_what_it_is(info: Any) -> None:
    model: Any = Mine(lambda: None)
    model.info = info
    with pytest.raises(ModelConfigError, match=r"Mine.*info"):
        checked(model)
