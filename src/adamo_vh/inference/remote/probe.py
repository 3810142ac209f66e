"""Find out what a model and its server can do: a few small requests, each with a plain answer."""

from __future__ import annotations

import hashlib
import io
import json
import time
from collections.abc import Sequence
from dataclasses import replace
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
from adamo_vh.inference.model import Ending, Reply, Rung, Sampling, Usage
from adamo_vh.inference.prompts import render
from adamo_vh.inference.remote.capabilities import Capabilities, Support, ToolSupport
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.refusals import Feature, refuses
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


def probe(
    uri: str, retry: RetryPolicy | None = None, known: Capabilities | None = None
) -> Capabilities:
    """Find out what a model can do; nothing is stored.

    Only an answer is a verdict. A question that was not answered is asked once more at the end,
    and then stays unknown.

    Args:
        uri: URI of a remote model.
        retry: Limits on trying again; by default short ones.
        known: What an earlier probe found: only what is unknown in it is asked.

    Raises:
        ModelConfigError: The URI, the provider's package or its key is wrong or missing.
        ModelError: The model cannot be reached; names the fix.
    """
    model = ProviderModel(uri, retry or PROBE_RETRY, known.refused if known else (), seed=0)
    try:
        return _Probe(model, known).run(model)
    finally:
        model.close()


class _Probe:
    """The requests of one probe, and what they took."""

    def __init__(self, model: Provider, known: Capabilities | None = None) -> None:
        self._model = model
        self._tools = known.tools if known else ToolSupport.UNKNOWN
        self._pictures = known.pictures if known else Support.UNKNOWN
        self._results = known.result_pictures if known else Support.UNKNOWN
        self._schema = known.schema if known else Support.UNKNOWN
        self._several = known.several_pictures if known else Support.UNKNOWN
        self._called: tuple[Message, ...] | None = None
        """The conversation up to a native call."""
        self._why: dict[str, str] = {}
        self._requests = known.requests if known else 0
        self._usage = known.usage if known else Usage()
        self._seconds = known.seconds if known else 0.0
        self._answers = False

    def run(self, model: ProviderModel) -> Capabilities:
        """Ask all that is unknown, the most telling things first."""
        started = time.monotonic()
        colours = _colours(model.info.name)
        self._ask_unknown(*colours)
        if not self._found(model, started).is_complete:
            self._ask_unknown(*colours)
        if self._tools is ToolSupport.REFUSED and self._schema is Support.REFUSED:
            self._must_answer()  # Else it was not these two that were refused.
        return self._found(model, started)

    def _found(self, model: ProviderModel, started: float) -> Capabilities:
        return Capabilities(
            model.info.name,
            _rung(self._tools, self._schema),
            self._tools,
            self._schema,
            self._pictures,
            self._results,
            tuple(sorted(model.refused)),
            self._requests,
            self._usage,
            self._seconds + time.monotonic() - started,
            datetime.now(UTC).isoformat(timespec="seconds"),
            tuple(self._why.values()),
            self._several,
        )

    def _ask_unknown(self, first: tuple[str, str], second: tuple[str, str]) -> None:
        if self._pictures is Support.UNKNOWN:
            self._pictures = self._sees_picture(first)
        if self._several is Support.UNKNOWN and self._pictures is not Support.UNKNOWN:
            seen = self._pictures is Support.YES
            self._several = self._takes_several(first) if seen else Support.UNTESTED
        if self._tools is ToolSupport.UNKNOWN:
            self._tools = self._calls_tool()
        if self._results is Support.UNKNOWN:
            self._results = self._sees_result(second)
        if self._schema is Support.UNKNOWN:
            self._schema = self._obeys_schema()

    def _sees_picture(self, colours: tuple[str, str]) -> Support:
        question = HumanMessage((_text("colours"), two_colours(*colours)))
        reply = self._ask(Feature.PICTURES, [question])
        return reply if isinstance(reply, Support) else _named(reply.message.text, colours)

    def _takes_several(self, colours: tuple[str, str]) -> Support:
        """Whether a prompt may hold two pictures, whatever is made of them."""
        picture = two_colours(*colours)
        question = HumanMessage((_text("word"), picture, picture))
        reply = self._ask(Feature.PICTURES, [question], what="several pictures")
        return reply if isinstance(reply, Support) else Support.YES

    def _calls_tool(self) -> ToolSupport:
        """Whether it calls a tool; the conversation up to a native call is remembered."""
        question = HumanMessage((_text("tool"),))
        reply = self._ask(Feature.TOOLS, [question], [LAMP])
        if isinstance(reply, Support):
            return ToolSupport(reply.value)
        called = [call for call in reply.message.calls if call.name == LAMP.name]
        if not called or called[0].arguments is None:
            return ToolSupport.NONE
        if reply.rung is Rung.LEAKED:
            return ToolSupport.LEAKED
        self._called = (question, replace(reply.message, calls=(called[0],)))
        return ToolSupport.NATIVE

    def _sees_result(self, colours: tuple[str, str]) -> Support:
        if Support.UNKNOWN in (self._pictures, self._tools.value):
            return Support.UNKNOWN
        if self._pictures is not Support.YES or self._tools is not ToolSupport.NATIVE:
            return Support.UNTESTED
        if self._called is None:
            self._calls_tool()
        if self._called is None:
            return Support.UNKNOWN
        *_, said = self._called
        assert isinstance(said, AIMessage)
        picture = two_colours(*colours)
        result = ToolMessage(said.calls[0].id, LAMP.name, _text("result").text, (picture,))
        reply = self._ask(
            Feature.PICTURES, [*self._called, result], [LAMP], what="pictures in results"
        )
        return reply if isinstance(reply, Support) else _named(reply.message.text, colours)

    def _obeys_schema(self) -> Support:
        # The question says nothing of JSON: only a server that holds the model to it gives it.
        question = [HumanMessage((_text("schema"),))]
        reply = self._ask(Feature.SCHEMA, question, schema=JsonForm().schema([LAMP]))
        if isinstance(reply, Support):
            return reply
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
        feature: Feature,
        messages: Sequence[Message],
        tools: Sequence[ToolSchema] = (),
        schema: ToolSchema | None = None,
        *,
        what: str = "",
    ) -> Reply | Support:
        """The reply; `REFUSED` if the server does not take the feature, `UNKNOWN` if none came."""
        what = what or str(feature)
        self._why.pop(what, None)
        try:
            reply = self._model.complete(messages, tools, _SAMPLING, schema=schema)
        except ProviderError as error:
            self._requests += 1
            # A server may report as a fault of its own what it does not know, and may be down.
            if not (self._answers and isinstance(error, RefusedError)):
                self._must_answer()
            shown = feature is Feature.PICTURES and error.most_pictures is not None
            if shown or refuses(feature, error):
                return Support.REFUSED
            self._why[what] = f"{what}: {error}"
            return Support.UNKNOWN
        self._count(reply)
        if reply.ending in _NO_VERDICT:
            self._why[what] = f"{what}: the reply was {_NO_VERDICT[reply.ending]}."
            return Support.UNKNOWN
        return reply

    def _count(self, reply: Reply) -> None:
        self._requests += reply.requests
        self._usage += reply.usage
        self._answers = True


_NO_VERDICT = {
    Ending.CUT_OFF: "cut off before its end",
    Ending.EMPTY: "empty",
    Ending.FILTERED: "stopped by a filter",
}
"""Replies that tell nothing of what a model can do."""


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


def _rung(tools: ToolSupport, schema: Support) -> Rung | None:
    if tools is ToolSupport.NATIVE:
        return Rung.NATIVE
    if tools is ToolSupport.LEAKED:
        return Rung.LEAKED
    if tools is ToolSupport.UNKNOWN or schema is Support.UNKNOWN:
        return None
    return Rung.SCHEMA if schema is Support.YES else Rung.REACT


def _text(name: str) -> TextPart:
    return TextPart(render(f"probe_{name}"))
