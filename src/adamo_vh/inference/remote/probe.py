"""Find out what a model and its server can do: a few small requests, each with a plain answer."""

from __future__ import annotations

import hashlib
import io
import json
import time
from collections.abc import Sequence
from datetime import UTC, datetime

from adamo_vh.action import ToolSchema
from adamo_vh.errors import ModelError, ProviderError, RefusedError
from adamo_vh.inference.ladder import Provider
from adamo_vh.inference.ladder.json_form import JsonForm
from adamo_vh.inference.ladder.steps import Step
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    TextPart,
    ToolMessage,
)
from adamo_vh.inference.model import Reply, Rung, Sampling, Usage
from adamo_vh.inference.prompts import render
from adamo_vh.inference.remote.capabilities import Capabilities, Support, ToolSupport
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.retry import RetryPolicy

PROBE_RETRY = RetryPolicy(max_tries=3, max_wait_s=60.0, timeout_s=120.0)
"""A server that is not there is given up soon; one that loads its model first is waited for."""

_SAMPLING = Sampling(max_tokens=2000)
"""Room enough for a model that thinks first."""

COLOURS = {
    "red": (220, 20, 20),
    "green": (20, 140, 40),
    "blue": (25, 50, 215),
    "yellow": (250, 225, 20),
    "black": (0, 0, 0),
    "white": (255, 255, 255),
}
"""Colours that it asks for, as red, green and blue."""
_SIDE_PX = 256

LAMP = ToolSchema(
    "SwitchLamp",
    "Switch a lamp on and take a picture of the room.",
    {
        "type": "object",
        "properties": {"lamp": {"type": "string", "description": "Name of the lamp."}},
        "required": ["lamp"],
        "additionalProperties": False,
    },
)
"""The tool that the probe offers."""


def probe(uri: str, retry: RetryPolicy | None = None) -> Capabilities:
    """Find out what a model can do; nothing is kept.

    Args:
        uri: URI of a remote model.
        retry: Limits on trying again; by default short ones.

    Raises:
        ModelConfigError: The URI, the provider's package or its key is wrong or missing.
        ModelError: The model cannot be reached; names the fix.
    """
    model = ProviderModel(uri, retry or PROBE_RETRY, seed=0)
    try:
        return _Probe(model).run(model)
    finally:
        model.close()


class _Probe:
    """The requests of one probe, and what they took."""

    def __init__(self, model: Provider) -> None:
        self._model = model
        self._requests = 0
        self._usage = Usage()
        self._answers = False

    def run(self, model: ProviderModel) -> Capabilities:
        """Ask everything, the most telling things first."""
        started = time.monotonic()
        first, second = _colours(model.info.name)
        pictures = self._sees_picture(first)
        tools, called = self._calls_tool()
        result_pictures = Support.UNTESTED
        if called is not None and pictures is Support.YES:
            result_pictures = self._sees_result(called, second)
        schema = self._obeys_schema()
        if tools is ToolSupport.REFUSED and schema is Support.REFUSED:
            self._must_answer()  # Else it was not these two that were refused.
        return Capabilities(
            model.info.name,
            _rung(tools, schema),
            tools,
            schema,
            pictures,
            result_pictures,
            tuple(sorted(model.refused)),
            self._requests,
            self._usage,
            time.monotonic() - started,
            datetime.now(UTC).isoformat(timespec="seconds"),
        )

    def _sees_picture(self, colours: tuple[str, str]) -> Support:
        question = HumanMessage((_text("colours"), two_colours(*colours)))
        reply = self._ask([question])
        return Support.REFUSED if reply is None else _named(reply.message.text, colours)

    def _calls_tool(self) -> tuple[ToolSupport, tuple[Message, ...] | None]:
        """Whether it calls a tool, and the conversation up to the call, if it was native."""
        question = HumanMessage((_text("tool"),))
        reply = self._ask([question], [LAMP])
        if reply is None:
            return ToolSupport.REFUSED, None
        called = [call for call in reply.message.calls if call.name == LAMP.name]
        if not called or called[0].arguments is None:
            return ToolSupport.NONE, None
        if reply.rung is Rung.LEAKED:
            return ToolSupport.LEAKED, None
        said = AIMessage(reply.message.text, (called[0],), reply.message.kept)
        return ToolSupport.NATIVE, (question, said)

    def _sees_result(self, called: tuple[Message, ...], colours: tuple[str, str]) -> Support:
        said = called[-1]
        assert isinstance(said, AIMessage)
        result = ToolMessage(
            said.calls[0].id, LAMP.name, _text("result").text, (two_colours(*colours),)
        )
        reply = self._ask([*called, result], [LAMP])
        return Support.REFUSED if reply is None else _named(reply.message.text, colours)

    def _obeys_schema(self) -> Support:
        # The question says nothing of JSON: only a server that holds the model to it gives it.
        reply = self._ask([HumanMessage((_text("schema"),))], schema=JsonForm().schema([LAMP]))
        if reply is None:
            return Support.REFUSED
        try:
            json.loads(reply.message.text)
        except (ValueError, RecursionError):
            return Support.NO
        step = JsonForm().read(reply.message.text, [LAMP])
        obeyed = isinstance(step, Step) and step.action in (None, LAMP.name)
        return Support.YES if obeyed else Support.NO

    def _must_answer(self) -> None:
        """Ask for one word, without anything that a server might refuse."""
        try:
            self._count(self._model.complete([HumanMessage((_text("word"),))], (), _SAMPLING))
        except ProviderError as error:
            raise ModelError(f"The model cannot be used. {error}") from None

    def _ask(
        self,
        messages: Sequence[Message],
        tools: Sequence[ToolSchema] = (),
        schema: ToolSchema | None = None,
    ) -> Reply | None:
        """The reply, or None if the request was refused."""
        try:
            reply = self._model.complete(messages, tools, _SAMPLING, schema=schema)
        except ProviderError as error:
            self._requests += 1
            # A server may report as a fault of its own what it does not know, and may be down.
            if not (self._answers and isinstance(error, RefusedError)):
                self._must_answer()
            return None
        self._count(reply)
        return reply

    def _count(self, reply: Reply) -> None:
        self._requests += reply.requests
        self._usage += reply.usage
        self._answers = True


def two_colours(left: str, right: str) -> ImagePart:
    """A picture of two plain halves."""
    from PIL import Image

    picture = Image.new("RGB", (_SIDE_PX, _SIDE_PX), COLOURS[left])
    half = _SIDE_PX // 2
    picture.paste(COLOURS[right], (half, 0, _SIDE_PX, _SIDE_PX))
    data = io.BytesIO()
    picture.save(data, "PNG")
    return ImagePart(data.getvalue(), "image/png", _SIDE_PX, _SIDE_PX)


def _colours(seed: str) -> tuple[tuple[str, str], tuple[str, str]]:
    """Two pairs of colours for a model, always the same, without one in both."""
    names = sorted(COLOURS, key=lambda name: hashlib.sha256(f"{seed} {name}".encode()).hexdigest())
    return (names[0], names[1]), (names[2], names[3])


def _named(text: str, colours: tuple[str, str]) -> Support:
    """Whether a text names the two colours in their order, before any other."""
    words = "".join(letter if letter.isalpha() else " " for letter in text.lower()).split()
    named = [word for word in words if word in COLOURS]
    return Support.YES if tuple(named[:2]) == colours else Support.NO


def _rung(tools: ToolSupport, schema: Support) -> Rung:
    if tools is ToolSupport.NATIVE:
        return Rung.NATIVE
    if tools is ToolSupport.LEAKED:
        return Rung.LEAKED
    return Rung.SCHEMA if schema is Support.YES else Rung.REACT


def _text(name: str) -> TextPart:
    return TextPart(render(f"probe_{name}"))
