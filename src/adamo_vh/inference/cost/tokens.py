"""Estimate the tokens of a whole request and of a reply, without a provider.

For forecasts, for comparing profiles offline, and for players that have no tokens of their own.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from adamo_vh.action import ToolSchema
from adamo_vh.inference.arguments import dump_arguments
from adamo_vh.inference.cost.pictures import (
    ANTHROPIC,
    ANTHROPIC_HIGH,
    GEMINI,
    GEMINI_3,
    OPENAI_PATCHES,
    OPENAI_TILES,
    QWEN,
    QWEN_3,
    ImageRule,
    Patches,
    Tiles,
    estimate_image,
    rule_for,
)
from adamo_vh.inference.cost.text import estimate_text
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    Message,
    TextPart,
    pictures_of,
)
from adamo_vh.inference.model import Model, Reply, Sampling, Usage
from adamo_vh.inference.players.wrapper import Ask, Wrapped

__all__ = [
    "ANTHROPIC",
    "ANTHROPIC_HIGH",
    "GEMINI",
    "GEMINI_3",
    "OPENAI_PATCHES",
    "OPENAI_TILES",
    "QWEN",
    "QWEN_3",
    "ImageRule",
    "cut_prompt",
    "estimate_image",
    "estimate_message",
    "estimate_reply",
    "estimate_request",
    "estimate_text",
    "estimate_tools",
    "filled_usage",
    "metered",
    "rule_for",
]

PER_MESSAGE = 4
"""Signs around a message, and its role."""
REPLY_START = 3
"""Signs that open the reply, paid with the request."""
FUNCTION_START, PROPERTIES_START, PER_PROPERTY, FUNCTIONS_END = 7, 3, 3, 12
"""Signs around tools, as OpenAI's Cookbook counts them for GPT-4o ("How to count tokens with
tiktoken", section 7)."""
PER_CALL = 4
"""Signs around a tool call: that it is one, its name's end, its arguments' start and end."""


def estimate_request(
    messages: Iterable[Message],
    tools: Iterable[ToolSchema] = (),
    rule: ImageRule = OPENAI_TILES,
) -> int:
    """Input tokens of a request.

    Args:
        messages: The whole prompt.
        tools: The tools on offer, counted as the JSON that is sent.
        rule: How pictures are counted.
    """
    told = sum(estimate_message(message, rule) for message in messages)
    return told + estimate_tools(tools, rule) + REPLY_START


def estimate_message(message: Message, rule: ImageRule = OPENAI_TILES) -> int:
    """Input tokens of one message of a prompt."""
    texts = sum(estimate_text(text) for text in _texts(message))
    pictures = sum(estimate_image(p.width_px, p.height_px, rule) for p in pictures_of(message))
    calls = len(message.calls) * PER_CALL if isinstance(message, AIMessage) else 0
    return PER_MESSAGE + texts + pictures + calls


def estimate_tools(tools: Iterable[ToolSchema], rule: ImageRule = OPENAI_TILES) -> int:
    """Input tokens of the tools on offer.

    OpenAI's models read them in a form of their own, whose size its Cookbook gives; others are
    taken to read the JSON.
    """
    if isinstance(rule, Tiles | Patches):
        counts = [_function_tokens(tool) for tool in tools]
        return sum(counts) + FUNCTIONS_END if counts else 0
    return sum(
        estimate_text(
            json.dumps(
                {"name": t.name, "description": t.description, "parameters": t.parameters},
                ensure_ascii=False,
            )
        )
        for t in tools
    )


def _function_tokens(tool: ToolSchema) -> int:
    fields = tool.parameters.get("properties", {})
    lines = [f"{tool.name}:{tool.description.rstrip('.')}"]
    for name, field in fields.items():
        lines.append(f"{name}:{field.get('type', '')}:{field.get('description', '').rstrip('.')}")
    signs = FUNCTION_START + (PROPERTIES_START if fields else 0) + PER_PROPERTY * len(fields)
    return signs + sum(map(estimate_text, lines))


def estimate_reply(message: AIMessage) -> int:
    """Output tokens of a reply; hidden reasoning cannot be known and is left out."""
    return sum(map(estimate_text, _texts(message))) + len(message.calls) * PER_CALL


def metered(model: Model, rule: ImageRule = OPENAI_TILES) -> Model:
    """A model whose tokens are estimated where it counts none of its own.

    Oracles, scripts and the baseline have no tokenizer; with this their prompts can be compared
    with those of a VLM.

    Args:
        model: Who answers.
        rule: How its pictures are counted.
    """

    def counted(
        ask: Ask, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        reply = ask(messages, tools, sampling)
        usage = filled_usage(reply.usage, messages, tools, reply.message, rule)
        return replace(reply, usage=usage)

    return Wrapped(model, counted)


def filled_usage(
    usage: Usage,
    messages: Iterable[Message],
    tools: Iterable[ToolSchema],
    reply: AIMessage,
    rule: ImageRule,
) -> Usage:
    """A usage with estimates in place of what was not counted: no prompt has 0 tokens.

    Args:
        usage: As counted.
        messages: The prompt.
        tools: The tools on offer.
        reply: The answer.
        rule: How pictures are counted.
    """
    read = usage.input_tokens or estimate_request(messages, tools, rule)
    said = usage.output_tokens or estimate_reply(reply)
    if (read, said) == (usage.input_tokens, usage.output_tokens):
        return usage
    return replace(usage, input_tokens=read, output_tokens=said, estimated=True)


_CUT = 0.6
"""No tokenizer makes so much fewer tokens of our texts than are estimated."""
_SHORT = 500
"""Tokens; so little no server cuts."""


def cut_prompt(usage: Usage, messages: Iterable[Message], tools: Iterable[ToolSchema]) -> str:
    """What to say if a server has counted far fewer tokens than the prompt has; empty if not.

    Some servers cut what is longer than their context without a word, Ollama's default above all:
    then the model has not read its instructions. Pictures are left out: they differ too much.

    Args:
        usage: As the server counted.
        messages: The prompt.
        tools: What was on offer.
    """
    expected = sum(estimate_text(text) for message in messages for text in _texts(message))
    expected += estimate_tools(tools)
    if usage.estimated or expected < _SHORT or usage.input_tokens >= _CUT * expected:
        return ""
    return (
        f"The server counted {usage.input_tokens:,} tokens of a prompt of about {expected:,}: it "
        "may have cut the prompt to its context. Give the server a longer one (Ollama: "
        "OLLAMA_CONTEXT_LENGTH, llama-server: --ctx-size)."
    )


def _texts(message: Message) -> Iterator[str]:
    """Every text of a message that a model reads or writes."""
    if isinstance(message, HumanMessage):
        yield from (part.text for part in message.parts if isinstance(part, TextPart))
        return
    yield message.text
    if isinstance(message, AIMessage):
        for call in message.calls:
            yield call.name
            yield call.raw or dump_arguments(call.arguments or {})
