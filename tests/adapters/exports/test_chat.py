"""Prompts in the OpenAI chat format: each kind of message, and the way back."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import pytest
from PIL import Image
from tests.talk import TOOLS, calls

from adamo_vh.adapters.exports.chat import chat_message, chat_messages, chat_tools
from adamo_vh.adapters.exports.pictures import InlinePictures, PictureFiles
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.model_server.openai_messages import read_request


def drawn(colour: str) -> ImagePart:
    data = io.BytesIO()
    Image.new("RGB", (16, 9), colour).save(data, "JPEG")
    return ImagePart(data.getvalue(), "image/jpeg", 16, 9)


RED, BLUE = drawn("red"), drawn("blue")
ASKED: tuple[Message, ...] = (
    SystemMessage("You live in a body."),
    HumanMessage((TextPart("Pick the plate."), RED)),
    calls("a", "b"),
    ToolMessage("a", "Look", "Done: you look at the plate.", (BLUE,)),
    ToolMessage("b", "Look", "Not executed: one action a turn."),
)


def test_pictures_of_results_come_right_behind_the_results() -> None:
    told = chat_messages(ASKED, InlinePictures())
    assert [message["role"] for message in told] == [
        "system", "user", "assistant", "tool", "tool", "user",
    ]  # fmt: skip
    (url,) = [p["image_url"]["url"] for p in told[-1]["content"] if p["type"] == "image_url"]
    assert url == InlinePictures().url(BLUE)


def test_pictures_stand_before_the_next_answer() -> None:
    told = chat_messages([*ASKED, AIMessage("I see it.")], InlinePictures())
    assert [message["role"] for message in told][-3:] == ["tool", "user", "assistant"]


def test_our_own_reader_of_the_format_reads_the_same_again() -> None:
    body = {
        "model": "any",
        "messages": chat_messages(ASKED, InlinePictures()),
        "tools": chat_tools(TOOLS),
    }
    found = read_request(json.loads(json.dumps(body)))
    assert found.tools == tuple(TOOLS)
    roles = [message.role for message in found.messages]
    assert roles[:5] == ["system", "human", "ai", "tool", "tool"]
    answer = found.messages[2]
    assert isinstance(answer, AIMessage)
    assert [(call.id, call.name, call.arguments) for call in answer.calls] == [
        ("a", "Look", {"x": 0.5, "y": 0, "z": 1}),
        ("b", "Look", {"x": 0.5, "y": 1, "z": 1}),
    ]
    asked = found.messages[1]
    assert isinstance(asked, HumanMessage)
    assert [part.data for part in asked.parts if isinstance(part, ImagePart)] == [RED.data]


@pytest.mark.parametrize(
    ("message", "told"),
    [
        (
            AIMessage("The end."),
            {"role": "assistant", "content": [{"type": "text", "text": "The end."}]},
        ),
        (AIMessage(""), {"role": "assistant", "content": [{"type": "text", "text": ""}]}),
        (
            AIMessage("", (ToolCall("c", "Pick", {"object": "Teller_57 · ä"}),)),
            {
                "role": "assistant",
                "tool_calls": [
                    {
                        "id": "c",
                        "type": "function",
                        "function": {"name": "Pick", "arguments": '{"object": "Teller_57 · ä"}'},
                    }
                ],
            },
        ),
        (
            AIMessage("", (ToolCall("c", "Pick", None, '{"object": '),)),
            {
                "role": "assistant",
                "tool_calls": [
                    {
                        "id": "c",
                        "type": "function",
                        "function": {"name": "Pick", "arguments": '{"object": '},
                    }
                ],
            },
        ),
    ],
    ids=["answer", "nothing", "call", "broken-call"],
)
def test_an_answer_is_told_as_it_was(message: AIMessage, told: dict[str, Any]) -> None:
    assert chat_message(message, InlinePictures()) == told


def test_a_picture_is_written_once(tmp_path: Path) -> None:
    files = PictureFiles(tmp_path)
    first, second = files.url(RED), files.url(RED)
    assert first == second
    assert files.url(BLUE) != first
    assert (tmp_path / first).read_bytes() == RED.data
    assert len(list((tmp_path / "images").iterdir())) == 2
