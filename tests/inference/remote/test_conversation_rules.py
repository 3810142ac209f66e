"""Whatever a model wrote, what goes back satisfies the rules of each API."""

from __future__ import annotations

import re
from itertools import pairwise

import pytest
from tests.dialects import DIALECTS, Chat, Dialect
from tests.fake_provider import Canned, Json, fault
from tests.talk import ASK, NAMES, SECOND, tell

from adamo_vh.errors import ProviderError
from adamo_vh.inference.messages import AIMessage, HumanMessage, Message, TextPart, ToolCall
from adamo_vh.inference.messages import ToolMessage as Result
from adamo_vh.inference.tool_names import meant_tool, wire_name

every_wire = pytest.mark.parametrize("dialect", DIALECTS, ids=NAMES)
ODD_NAMES = (
    "functions.Pick",
    "",
    "Pick it up",
    "x" * 200,
    "Zu\u00fcck",
    "1Pick",
    "\ud800",
    "--",
    "a b",
)
ODD_IDS = ("call 1", "", "x" * 200, "functions.Pick:0", "\u00e9", "\ud800", "a\nb")


@every_wire
def test_odd_names_and_ids_never_reach_a_server(dialect: Dialect) -> None:
    messages: list[Message] = [*ASK]
    for number, name in enumerate(ODD_NAMES):
        call_id = ODD_IDS[number % len(ODD_IDS)] + str(number)
        call = ToolCall(call_id, name, {}, "{}")
        messages += [AIMessage("n", (call,)), Result(call_id, name, "Refused: no such tool.")]
    told = tell(dialect, [dialect.answer("ok")], messages)
    sent, results = told.said("call"), told.said("result")
    assert len(sent) == len(results) == len(ODD_NAMES)
    assert [piece.id for piece in sent] == [piece.id for piece in results]
    assert len({piece.id for piece in sent}) == len(sent)
    allowed = r"[A-Za-z0-9_-]{1,64}" if dialect.name == "anthropic" else r"[\w.:-]{1,64}"
    for piece in sent:
        assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]{0,63}", piece.text)
        assert re.fullmatch(allowed, piece.id, re.ASCII)


@every_wire
def test_blank_texts_are_left_out_or_filled(dialect: Dialect) -> None:
    first = tell(dialect, [dialect.answer("\n\n", [("c1", "Pick", {"object": "57"})], "sig")])
    said = first.reply.message
    messages = (*ASK, said, Result("c1", "Pick", " "), HumanMessage((TextPart(""), SECOND)))
    told = tell(dialect, [dialect.answer("ok")], messages)
    assert all(piece.text.strip() for piece in told.said("text", "result"))
    assert [piece.text for piece in told.said("call")] == ["Pick"]


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("Pick", "Pick"),
        ("pick", "Pick"),
        ("functions.Pick", "Pick"),
        ("functions.pick:0", "Pick"),
        ("default_api.Pick", "Pick"),
        ("Pick<|channel|>commentary", "Pick"),
        (" Pick ", "Pick"),
        ("Pick()", "Pick"),
        ("switch_lamp", "SwitchLamp"),
        ("Pickup", None),
        ("Pick it", None),
        ("a.Pick", None),
        ("functions.", None),
        ("", None),
        ("drop", None),
    ],
)
def test_a_name_that_means_one_tool_alone_is_that_tool(written: str, meant: str | None) -> None:
    assert meant_tool(written, ("Pick", "SwitchLamp", "Drop", "DROP")) == meant


def test_a_good_name_goes_back_as_it_is() -> None:
    assert wire_name("Pick") == "Pick"
    assert wire_name("my_tool-2") == "my_tool-2"


def _strict(request: Json) -> Canned:
    roles = [message["role"] for message in request["messages"]]
    if ("tool", "user") in pairwise(roles):
        return fault(400, "Unexpected role 'user' after role 'tool'")
    if ("user", "user") in pairwise(roles):
        return fault(500, "Conversation roles must alternate user/assistant")
    return Chat().answer("Done.")


@pytest.mark.parametrize("refused", [(), ("user_after_tool",)])
def test_a_server_that_wants_an_answer_behind_results_gets_one(refused: tuple[str, ...]) -> None:
    call = ToolCall("c1", "Look", {"x": 1, "y": 1, "z": 1})
    view = HumanMessage((TextPart("New view."), SECOND))
    word = HumanMessage((TextPart("Go on."),))
    messages = (*ASK, AIMessage("n", (call,)), Result("c1", "Look", "Done."), view, word)
    told = tell(Chat(), _strict, messages, refused=refused)
    assert told.reply.message.text == "Done."
    assert len(told.requests) == (1 if refused else 2)
    roles = [message["role"] for message in told.requests[-1]["messages"]]
    assert roles[-3:] == ["tool", "assistant", "user"]
    assert told.reply.settings["reshaped"] == ["user_after_tool"]
    assert [piece.data for piece in told.said("image")][-1] == SECOND.data


@pytest.mark.parametrize(
    "refusal",
    [
        Canned({"object": "error", "message": "No.", "type": "x", "code": "3230"}, 400),
        Canned({"message": "No.", "type": "invalid_request_message_order", "code": 1}, 400),
        fault(400, "Not the same number of function calls and responses"),
        fault(500, "jinja2: roles must alternate"),
    ],
)
def test_a_wrong_order_is_known_by_its_code_too(refusal: Canned) -> None:
    def strict(request: Json) -> Canned:
        roles = [message["role"] for message in request["messages"]]
        return refusal if ("tool", "user") in pairwise(roles) else Chat().answer("Done.")

    call = ToolCall("c1", "Look", {"x": 1, "y": 1, "z": 1})
    view = HumanMessage((TextPart("New view."), SECOND))
    messages = (*ASK, AIMessage("n", (call,)), Result("c1", "Look", "Done."), view)
    told = tell(Chat(), strict, messages)
    assert told.reply.settings["reshaped"] == ["user_after_tool"]


@pytest.mark.parametrize(
    "words",
    [
        "The decoder prompt (length 9000) is longer than the maximum model length of 8192.",
        "`inputs` tokens + `max_new_tokens` must be <= 4096. Given: 5000 `inputs` tokens",
        "Input is too long for requested model.",
        "Please reduce the length of the messages or completion.",
        "Your request exceeded model token limit: 8192 (requested: 9000)",
        "litellm.ContextWindowExceededError: too much",
        "Range of input length should be [1, 30720]",
        "request (60000 tokens) exceeds the available context size (50000 tokens)",
    ],
)
def test_a_prompt_beyond_the_context_is_said_to_be_one(words: str) -> None:
    with pytest.raises(ProviderError, match="longer than the model's context"):
        tell(Chat(), [fault(400, words)])


@pytest.mark.parametrize(
    ("complaint", "fix"),
    [
        ("At most 1 image(s) may be provided in one prompt.", "--switch pictures=1"),
        ("At most 4 image(s) may be provided in one request.", "--switch pictures=4"),
        ("Multiple images are not supported", "--switch pictures=1"),
        ("You passed 3 images but the model only supports up to 2 images", "--switch pictures=2"),
        ("The number of images (5) exceeds the maximum allowed: 4", "--switch pictures=4"),
        ("This model only supports single image input", "--switch pictures=1"),
        ("image input is not supported", "--switch pictures=none"),
        ("At most 0 image(s) may be provided in one prompt.", "--switch pictures=none"),
    ],
)
def test_too_many_pictures_are_answered_with_the_switch(complaint: str, fix: str) -> None:
    with pytest.raises(ProviderError, match=fix):
        tell(Chat(), [fault(400, complaint)])
