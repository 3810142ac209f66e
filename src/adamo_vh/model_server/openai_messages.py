"""Read a chat-completions request of OpenAI's API into the neutral messages.

What is wrong with a request is said as OpenAI's servers do: with the field, and here with the fix.
"""

from __future__ import annotations

import base64
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from adamo_vh.action import ToolSchema
from adamo_vh.inference.arguments import read_arguments
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    Part,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
    pictures_of,
)
from adamo_vh.inference.model import Sampling
from adamo_vh.model_server.json_fields import (
    BadRequest,
    child,
    choice_of,
    flag,
    items,
    mapping,
    number,
    text,
)
from adamo_vh.model_server.result_pictures import with_result_pictures
from adamo_vh.readable import encodable

_ROLES = ("system", "developer", "user", "assistant", "tool")
_FORMATS = ("JPEG", "PNG", "WEBP", "GIF")


@dataclass(frozen=True, slots=True)
class ChatRequest:
    """What a client asks for."""

    model: str
    """The model's name as the client wrote it; echoed, not checked."""
    messages: tuple[Message, ...]
    tools: tuple[ToolSchema, ...]
    """The tools on offer, after tool_choice."""
    sampling: Sampling
    schema: Mapping[str, Any] | None
    """JSON schema that the reply must follow."""
    most_tokens: int | None
    """Limit on the tokens of the reply; None if the request sets none."""
    stream: bool
    stream_usage: bool
    """Whether the stream ends with the token counts."""
    parameters: frozenset[str]
    """Names of what the request has; "image_url" if there is a picture in it."""


def read_request(body: Any) -> ChatRequest:
    """Read the decoded body of a request.

    Raises:
        BadRequest: A field is missing or wrong.
    """
    body = mapping(body, "body")
    if (count := number(body, "n")) is not None and count != 1:
        raise BadRequest("n", "only 1 choice is given; leave n out or set it to 1.")
    messages = with_result_pictures(_messages(items(body, "messages")))
    schema, streams = _schema(body), mapping(body.get("stream_options") or {}, "stream_options")
    names = {name for name, value in body.items() if value is not None}
    if any(map(pictures_of, messages)):
        names.add("image_url")
    return ChatRequest(
        text(body, "model"),
        messages,
        _tools(body),
        _sampling(body),
        schema,
        _limit(body),
        flag(body, "stream"),
        flag(streams, "include_usage", "stream_options"),
        frozenset(names),
    )


def _messages(entries: Sequence[Any]) -> tuple[Message, ...]:
    """Read the conversation, in which every call must be answered before it goes on."""
    if not entries:
        raise BadRequest("messages", "the list is empty; send at least one message.")
    found: list[Message] = []
    names: dict[str, str] = {}
    open_calls: set[str] = set()
    for at, entry in enumerate(entries):
        where = f"messages[{at}]"
        message = _message(mapping(entry, where), where, names)
        if isinstance(message, ToolMessage):
            open_calls.discard(message.call_id)
        elif open_calls:
            missing = ", ".join(sorted(open_calls))
            raise BadRequest(
                where,
                "an assistant message with tool_calls must be followed by one tool message for "
                f"each tool_call_id; still without an answer: {missing}.",
            )
        if isinstance(message, AIMessage):
            names |= {call.id: call.name for call in message.calls}
            open_calls = {call.id for call in message.calls}
        found.append(message)
    if open_calls:
        missing = ", ".join(sorted(open_calls))
        raise BadRequest("messages", f"the conversation ends with unanswered calls: {missing}.")
    return tuple(found)


def _message(entry: Mapping[str, Any], where: str, names: Mapping[str, str]) -> Message:
    role = choice_of(entry, "role", _ROLES, where)
    at = f"{where}.content"
    if role == "assistant":
        parts = _content(entry.get("content"), at, pictures=False)
        return AIMessage(_joined(parts), _calls(entry, where))
    if entry.get("content") is None:
        raise BadRequest(at, "it is missing; give a text or a list of parts.")
    parts = _content(entry["content"], at, pictures=role in ("user", "tool"))
    if role == "user":
        return HumanMessage(parts)
    if role == "tool":
        call_id = text(entry, "tool_call_id", where)
        if call_id not in names:
            raise BadRequest(
                f"{where}.tool_call_id",
                f"no assistant message before it has a call with the id {call_id!r}.",
            )
        images = tuple(part for part in parts if isinstance(part, ImagePart))
        return ToolMessage(call_id, names[call_id], _joined(parts), images)
    return SystemMessage(_joined(parts))


def _joined(parts: Sequence[Part]) -> str:
    return "\n".join(part.text for part in parts if isinstance(part, TextPart))


def _content(content: Any, where: str, pictures: bool) -> tuple[Part, ...]:
    if content is None:
        return ()
    if isinstance(content, str):
        return (TextPart(encodable(content)),)
    if not isinstance(content, list):
        raise BadRequest(where, "it must be a text or a list of parts.")
    kinds = ("text", "image_url") if pictures else ("text", "refusal")
    parts: list[Part] = []
    for number_, value in enumerate(content):
        at = f"{where}[{number_}]"
        part = mapping(value, at)
        kind = choice_of(part, "type", kinds, at)
        if kind == "image_url":
            address = mapping(part.get("image_url"), f"{at}.image_url")
            parts.append(_picture(text(address, "url", f"{at}.image_url"), f"{at}.image_url.url"))
        else:
            parts.append(TextPart(text(part, kind, at)))
    return tuple(parts)


def _picture(url: str, where: str) -> ImagePart:
    """Decode a data URI; nothing is ever fetched."""
    from PIL import Image

    head, comma, encoded = url.partition(",")
    if not head.startswith("data:") or not head.endswith(";base64") or not comma:
        raise BadRequest(
            where,
            "pictures are read from data URIs alone and never fetched; send "
            "data:image/jpeg;base64,... instead.",
        )
    try:
        data = base64.b64decode(encoded, validate=True)
        with Image.open(io.BytesIO(data), formats=_FORMATS) as picture:
            width, height = picture.size
            media_type = picture.get_format_mimetype() or "image/jpeg"
    except (EOFError, OSError, SyntaxError, ValueError, Image.DecompressionBombError):
        raise BadRequest(
            where, "this is no picture; send base64 of a JPEG, PNG, WEBP or GIF file."
        ) from None
    return ImagePart(data, media_type, width, height)


def _calls(entry: Mapping[str, Any], where: str) -> tuple[ToolCall, ...]:
    calls = []
    for at, place in child(entry, "tool_calls", where):
        call = mapping(at, place)
        choice_of(call, "type", ("function",), place)
        function = mapping(call.get("function"), f"{place}.function")
        name = text(function, "name", f"{place}.function")
        raw = text(function, "arguments", f"{place}.function")
        calls.append(ToolCall(text(call, "id", place), name, read_arguments(raw), raw))
    return tuple(calls)


def _tools(body: Mapping[str, Any]) -> tuple[ToolSchema, ...]:
    tools = []
    for value, where in child(body, "tools"):
        tool = mapping(value, where)
        choice_of(tool, "type", ("function",), where)
        function = mapping(tool.get("function"), f"{where}.function")
        parameters = mapping(function.get("parameters") or {}, f"{where}.function.parameters")
        name = text(function, "name", f"{where}.function")
        about = function.get("description")
        # A tool without arguments may leave its schema out, or the properties in it.
        filled = {"type": "object", "properties": {}, **parameters}
        tools.append(ToolSchema(name, about if isinstance(about, str) else "", filled))
    return _chosen(tuple(tools), body.get("tool_choice"))


def _chosen(tools: tuple[ToolSchema, ...], choice: Any) -> tuple[ToolSchema, ...]:
    """The tools that tool_choice leaves."""
    if choice is None or choice in ("auto", "required"):
        return tools
    if choice == "none":
        return ()
    if not isinstance(choice, dict):
        raise BadRequest("tool_choice", "use none, auto, required or a function of tools.")
    function = mapping(choice.get("function"), "tool_choice.function")
    name = text(function, "name", "tool_choice.function")
    left = tuple(tool for tool in tools if tool.name == name)
    if not left:
        raise BadRequest("tool_choice.function.name", f"tools has no function {name!r}.")
    return left


def _sampling(body: Mapping[str, Any]) -> Sampling:
    usual = Sampling()
    temperature = number(body, "temperature", 0, 2)
    top_p = number(body, "top_p", 0, 1)
    return Sampling(
        usual.temperature if temperature is None else temperature,
        usual.top_p if top_p is None else top_p,
        _limit(body) or usual.max_tokens,
    )


def _limit(body: Mapping[str, Any]) -> int | None:
    limits = [number(body, name, 1) for name in ("max_completion_tokens", "max_tokens")]
    return next((int(value) for value in limits if value is not None), None)


def _schema(body: Mapping[str, Any]) -> Mapping[str, Any] | None:
    if body.get("response_format") is None:
        return None
    wanted = mapping(body["response_format"], "response_format")
    kinds = ("text", "json_object", "json_schema")
    kind = choice_of(wanted, "type", kinds, "response_format")
    if kind == "text":
        return None
    if kind == "json_object":
        return {}
    where = "response_format.json_schema"
    return mapping(mapping(wanted.get("json_schema"), where).get("schema"), f"{where}.schema")
