"""Inspect's answers are judged as those of every other provider are."""

from __future__ import annotations

from typing import Any

import pytest
from tests.talk import ASK, TOOLS, calls

from adamo_vh.adapters.inspect.conversation import chat, offered_tools, reply_of, spent_on
from adamo_vh.inference.messages import ToolMessage
from adamo_vh.inference.model import Ending, Usage

pytestmark = pytest.mark.extras


def output(text: Any = "", *tool_calls: Any, stop: str = "stop", usage: Any = None) -> Any:
    from inspect_ai.model import ChatCompletionChoice, ChatMessageAssistant, ModelOutput

    message = ChatMessageAssistant(content=text, tool_calls=list(tool_calls) or None)
    choice = ChatCompletionChoice(message=message, stop_reason=stop)
    return ModelOutput(model="any", choices=[choice], usage=usage)


def call(name: str, arguments: dict[str, Any], call_id: str = "c1", **more: Any) -> Any:
    from inspect_ai.tool import ToolCall

    return ToolCall(id=call_id, function=name, arguments=arguments, **more)


def judged(*said: Any, **more: Any) -> Any:
    return reply_of(output(*said, **more), ASK, TOOLS, 1.5)


def test_a_call_is_a_call() -> None:
    reply = judged("I pick it.", call("Pick", {"object": "Plate_57"}), stop="tool_calls")
    assert reply.ending is Ending.CALL
    (made,) = reply.message.calls
    assert (made.id, made.name, made.arguments) == ("c1", "Pick", {"object": "Plate_57"})
    assert (reply.message.text, reply.seconds) == ("I pick it.", 1.5)


def test_text_alone_is_the_answer_and_nothing_is_empty() -> None:
    assert judged("Done.").ending is Ending.ANSWER
    assert judged("  ").ending is Ending.EMPTY


@pytest.mark.parametrize("stop", ["max_tokens", "model_length"])
def test_what_was_cut_off_is_no_answer(stop: str) -> None:
    reply = judged("The plate is on the", stop=stop)
    assert reply.ending is Ending.CUT_OFF
    assert reply.unreadable == f"was cut off ({stop}). Be shorter."


def test_what_a_filter_stopped_is_no_answer() -> None:
    assert judged("I cannot", stop="content_filter").ending is Ending.FILTERED


def test_a_call_written_into_the_text_is_read() -> None:
    reply = judged('<tool_call>{"name": "Pick", "arguments": {"object": "Plate_57"}}</tool_call>')
    assert reply.ending is Ending.CALL
    assert reply.message.calls[0].arguments == {"object": "Plate_57"}


def test_arguments_that_inspect_could_not_read_are_unreadable() -> None:
    reply = judged("", call("Pick", {"raw": "{"}, parse_error="no JSON"), stop="tool_calls")
    assert reply.message.calls[0].arguments is None


def test_an_id_never_means_two_calls() -> None:
    before = (*ASK, calls("c1"), ToolMessage("c1", "Look", "Done."))
    reply = reply_of(output("", call("Pick", {"object": "x"}), stop="tool_calls"), before, TOOLS, 0)
    assert reply.message.calls[0].id != "c1"


def test_thinking_goes_back_as_it_came() -> None:
    from inspect_ai.model import ContentReasoning, ContentText

    said = [ContentReasoning(reasoning="Hm.", signature="signed"), ContentText(text="I pick it.")]
    reply = judged(said, call("Pick", {"object": "x"}), stop="tool_calls")
    assert reply.message.text == "I pick it."
    (again,) = chat([reply.message])
    assert not isinstance(again.content, str)
    reasoning = again.content[0]
    assert (reasoning.type, reasoning.signature) == ("reasoning", "signed")
    assert [made.id for made in again.tool_calls] == ["c1"]


def test_a_conversation_is_told_in_its_roles() -> None:
    messages = [*ASK, calls("a"), ToolMessage("a", "Look", "Done: you look.", ())]
    told = chat(messages)
    assert [one.role for one in told] == ["system", "system", "user", "assistant", "tool"]
    picture = told[2].content[1]
    assert picture.type == "image" and picture.image.startswith("data:image/jpeg;base64,")
    assert (told[4].tool_call_id, told[4].function, told[4].content) == (
        "a", "Look", "Done: you look.",
    )  # fmt: skip


def test_tools_keep_their_parameters() -> None:
    (look, *_) = offered_tools(TOOLS)
    assert look.name == "Look" and set(look.parameters.properties) == {"x", "y", "z"}
    assert look.parameters.required == ["x", "y", "z"]


def test_cached_tokens_are_counted_once() -> None:
    from inspect_ai.model import ModelUsage

    spent = ModelUsage(
        input_tokens=100,
        output_tokens=20,
        total_tokens=420,
        input_tokens_cache_read=300,
        reasoning_tokens=5,
        total_cost=0.25,
    )
    reply = judged("Done.", usage=spent)
    assert reply.usage == Usage(400, 20, 300, 5)
    assert reply.cost_usd == 0.25
    back = spent_on(reply.usage, reply.cost_usd)
    assert back.model_dump() == spent.model_dump()
