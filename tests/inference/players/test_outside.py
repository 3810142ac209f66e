"""A model whose replies come from outside: asked in one thread, answered in another."""

from __future__ import annotations

import threading
from concurrent.futures import Future, ThreadPoolExecutor

import pytest

from adamo_vh.action import Look, tool_schema
from adamo_vh.errors import ModelConfigError, ModelError
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    Message,
    SystemMessage,
    TextPart,
    ToolMessage,
)
from adamo_vh.inference.model import Ending, ModelKind, Reply, Sampling
from adamo_vh.inference.players.outside import OutsideModel, outside_name
from adamo_vh.session.minds import model_of

TOOLS = [tool_schema(Look)]


def _said(text: str) -> HumanMessage:
    return HumanMessage((TextPart(text),))


START: list[Message] = [SystemMessage("You are."), SystemMessage("State."), _said("Do it.")]


def _ask(model: OutsideModel, messages: list[Message]) -> Future[Reply]:
    reply: Future[Reply] = Future()

    def run() -> None:
        try:
            reply.set_result(model.complete(messages, TOOLS, Sampling()))
        except ModelError as error:
            reply.set_exception(error)

    threading.Thread(target=run).start()
    return reply


def test_a_call_goes_from_one_thread_to_the_other() -> None:
    model = OutsideModel("outside:me", 60)
    reply = _ask(model, START)
    asked = model.asked()
    assert asked is not None and asked.new == (START[2],) and asked.tools == tuple(TOOLS)
    model.call("Look", {"x": 1}, "I look.")
    message = reply.result(5).message
    assert message.text == "I look."
    assert [(c.id, c.name, c.arguments) for c in message.calls] == [("call_1", "Look", {"x": 1})]
    assert model.info.kind is ModelKind.OUTSIDE


def test_only_what_is_new_is_told() -> None:
    model = OutsideModel("outside:me", 60)
    first = _ask(model, START)
    model.asked()
    model.call("Look", {})
    said = first.result(5).message
    back: list[Message] = [ToolMessage("call_1", "Look", "Done."), _said("New view.")]
    second = _ask(model, [*START, said, *back])
    asked = model.asked(after=1)
    assert asked is not None and list(asked.new) == back
    # What was not shown again, an empty answer, leaves the rest where it was.
    model.answer("")
    assert second.result(5).ending is Ending.EMPTY
    third = _ask(model, [*START, said, *back, _said("Your last message was empty.")])
    asked = model.asked(after=2)
    assert asked is not None and [m.text for m in asked.new] == ["Your last message was empty."]
    model.answer("I am done.")
    assert third.result(5).message == AIMessage("I am done.")


def test_who_goes_on_for_another_is_told_everything() -> None:
    model = OutsideModel("outside:me", 60, answered=1)
    said = AIMessage("I look.")
    reply = _ask(model, [*START, said, _said("New view.")])
    asked = model.asked()
    assert asked is not None and [m.text for m in asked.new] == ["Do it.", "I look.", "New view."]
    model.call("Look", {}, client="someone else")
    assert reply.result(5).message.calls[0].id == "call_2"
    assert reply.result().warning == "outside:someone-else went on with what outside:me had begun."


def test_the_wait_counts_and_ends() -> None:
    model = OutsideModel("outside:me", 0.2)
    reply = model.complete(START, TOOLS, Sampling())
    assert reply.ending is Ending.EMPTY and reply.seconds >= 0.2 and "time" in reply.warning
    # Nothing is left for a second one.
    assert model.complete(START, TOOLS, Sampling()).seconds < 0.1
    with pytest.raises(ModelError, match="Nothing is asked"):
        model.answer("Too late.")


def test_who_hangs_up_says_nothing_any_more() -> None:
    model = OutsideModel("outside:me", 60)
    reply = _ask(model, START)
    model.asked()
    model.hang_up("It went away.")
    assert reply.result(5).ending is Ending.EMPTY
    assert model.complete(START, TOOLS, Sampling()).warning == "It went away."


def test_who_is_cut_off_is_not_to_blame() -> None:
    model = OutsideModel("outside:me", 60)
    reply = _ask(model, START)
    model.asked()
    model.cut_off("The server was closed.")
    with pytest.raises(ModelError, match=r"The server was closed\.") as broken:
        reply.result(5)
    assert broken.value.spent.seconds > 0


def test_nobody_waits_for_what_is_over() -> None:
    model = OutsideModel("outside:me", 60)
    with ThreadPoolExecutor(1) as pool:
        waiting = pool.submit(model.asked)
        model.end()
        assert waiting.result(5) is None and model.is_over


def test_two_replies_to_one_question_are_one_too_many() -> None:
    model = OutsideModel("outside:me", 60)
    with pytest.raises(ModelError, match="Nothing is asked"):
        model.call("Look", {})


@pytest.mark.parametrize(
    ("client", "name"),
    [
        ("claude-code", "outside:claude-code"),
        ("My Client\x1b[31m 2", "outside:My-Client[31m-2"),
        ("\u202e \n", "outside:unknown"),
        ("x" * 500, "outside:" + "x" * 60),
    ],
)
def test_a_name_is_safe_to_show(client: str, name: str) -> None:
    assert outside_name(client) == name


@pytest.mark.parametrize("arguments", [{"x": float("nan")}, {"x": {"y": 10**400}}, None])
def test_arguments_that_are_no_json_are_told_as_such(arguments: dict[str, object] | None) -> None:
    model = OutsideModel("outside:me", 60)
    reply = _ask(model, START)
    model.asked()
    model.call("Look", arguments)
    found = reply.result(5).message.calls[0].arguments
    assert found is None or found == {"x": {"y": 10**400}}


def test_it_is_not_made_from_a_name() -> None:
    with pytest.raises(ModelConfigError, match="adamo-vh mcp"):
        model_of("outside:me")
