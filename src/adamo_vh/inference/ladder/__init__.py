"""The ladder: the best that a model can do with what its server offers.

Native tool calls, a call leaked into the text, a JSON step held to a schema, Thought and Action as
text: the agent above sees the same notes and calls from each rung.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Protocol

from adamo_vh.action import ToolSchema
from adamo_vh.errors import ModelError
from adamo_vh.inference.arguments import dump_arguments
from adamo_vh.inference.ladder.conversation import UNREADABLE, merged, rewritten
from adamo_vh.inference.ladder.json_form import JsonForm
from adamo_vh.inference.ladder.react_form import ReactForm
from adamo_vh.inference.ladder.steps import (
    NOTE,
    Form,
    Step,
    Unreadable,
    ends_by_answer,
    known_tool,
    takes_note,
)
from adamo_vh.inference.messages import AIMessage, HumanMessage, Message, TextPart, ToolCall
from adamo_vh.inference.model import Ending, ModelInfo, Reply, Rung, Sampling, Spent
from adamo_vh.inference.prompts import render
from adamo_vh.inference.remote.capabilities import Capabilities
from adamo_vh.inference.text_calls import read_calls
from adamo_vh.inference.tool_names import fresh_id

_JSON, _REACT = JsonForm(), ReactForm()
_FORMS: dict[Rung, tuple[Form, ...]] = {
    Rung.SCHEMA: (_JSON, _REACT),
    Rung.REACT: (_REACT, _JSON),
}
"""How a model is asked on a rung; what it writes in the other form instead is read as well."""


class Provider(Protocol):
    """A model on a wire, which can be held to a schema instead of being offered tools."""

    @property
    def info(self) -> ModelInfo:
        """What there is to know about it."""
        ...

    def complete(
        self,
        messages: Sequence[Message],
        tools: Sequence[ToolSchema],
        sampling: Sampling,
        *,
        schema: ToolSchema | None = None,
    ) -> Reply:
        """Answer; with a schema, in JSON that obeys it."""
        ...


class Ladder:
    """A model, asked on one rung."""

    def __init__(
        self, inner: Provider, rung: Rung, capabilities: Capabilities | None = None
    ) -> None:
        """Put a model on a rung.

        Args:
            inner: The model.
            rung: How it is asked. `NATIVE` and `LEAKED` ask alike, through the API's tools.
            capabilities: What a probe found out about it, for the record.
        """
        self._inner = inner
        self._rung = rung
        self._forms = _FORMS.get(rung, ())
        self._capabilities = capabilities

    def __repr__(self) -> str:
        """The name and the rung."""
        return f"Ladder({self.info.name!r}, {self._rung.value!r})"

    @property
    def info(self) -> ModelInfo:
        """The model's, with its rung and what a probe found out."""
        return replace(self._inner.info, rung=self._rung, capabilities=self._capabilities)

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Ask; without tool calls, what cannot be read is asked for once more.

        Raises:
            ProviderError: The provider failed after all retries.
        """
        if not self._forms:
            return self._inner.complete(messages, tools, sampling)
        form = self._forms[0]
        prompt, schema = rewritten(messages, tools, form), form.schema(tools)
        reply = self._inner.complete(prompt, (), sampling, schema=schema)
        outcome = self._read(reply, messages, tools)
        if isinstance(outcome, Unreadable) and reply.ending is not Ending.FILTERED:
            prompt = merged([*prompt, *_repair(reply.message, outcome, form, tools)])
            again = _repaired(
                reply, lambda: self._inner.complete(prompt, (), sampling, schema=schema)
            )
            reply = _together(reply, again)
            outcome = self._read(again, messages, tools)
        if isinstance(outcome, AIMessage):
            ending = Ending.CALL if outcome.calls else Ending.ANSWER
            return replace(reply, message=outcome, rung=self._rung, unreadable="", ending=ending)
        return replace(
            reply,
            message=replace(reply.message, kept=UNREADABLE + reply.message.kept),
            rung=self._rung,
            unreadable=reply.unreadable or f"could not be read: {outcome.problem}",
            ending=reply.ending if reply.ending.is_failure else Ending.UNPARSED_CALL,
        )

    def _read(
        self, reply: Reply, messages: Sequence[Message], tools: Sequence[ToolSchema]
    ) -> AIMessage | Unreadable:
        """What a reply comes to: a note with a call, or a final answer."""
        said = reply.message
        if said.calls and reply.ending is Ending.CALL:
            # Some servers recognise calls although no tool was on offer.
            return replace(said, calls=said.calls[:1])
        taken = {call.id for m in messages if isinstance(m, AIMessage) for call in m.calls}
        step = self._step(said.text, taken, tools)
        if isinstance(step, Step) and _may_count(step, reply.ending):
            return replace(_message(step, said.text, taken, tools), kept=said.kept)
        if reply.unreadable or isinstance(step, Step):
            return Unreadable(f"it {reply.unreadable}")
        return step

    def _step(self, text: str, taken: set[str], tools: Sequence[ToolSchema]) -> Step | Unreadable:
        """The one step that a text holds, in whatever form."""
        outcomes = [form.read(text, tools) for form in self._forms]
        for outcome in outcomes:
            if isinstance(outcome, Step):
                return outcome
        leaked = read_calls(text, tools, taken)
        if isinstance(leaked, AIMessage):
            call = leaked.calls[0]
            return Step(leaked.text, call.name, call.arguments or {})
        return outcomes[0]


def _may_count(step: Step, ending: Ending) -> bool:
    """Whether a step may be taken out of a reply that ended like this.

    A model that does not stop behind its step, as it was told to, is cut off there; the step is
    whole. Nothing else that was cut off is, and what a filter has touched counts for nothing.
    """
    if ending is Ending.CUT_OFF:
        return step.action is not None and step.is_whole
    return ending is not Ending.FILTERED


def _message(step: Step, text: str, taken: set[str], tools: Sequence[ToolSchema]) -> AIMessage:
    if step.action is None:
        return AIMessage(step.answer)
    args, tool = dict(step.args), known_tool(step.action, tools)
    if tool is not None and takes_note(tool) and not args.get(NOTE):
        args = {**args, NOTE: step.thought}
    call = ToolCall(fresh_id(text, taken), step.action, args, dump_arguments(args))
    return AIMessage(step.thought, (call,))


def _repair(
    said: AIMessage, outcome: Unreadable, form: Form, tools: Sequence[ToolSchema]
) -> list[Message]:
    text = render(f"repair_{form.name}", problem=outcome.problem, final=ends_by_answer(tools))
    asked = HumanMessage((TextPart(text),))
    # Servers refuse an empty message in the history.
    return [said, asked] if said.text.strip() else [asked]


def _repaired(first: Reply, ask: Callable[[], Reply]) -> Reply:
    """The reply of a repair turn; if none comes, what the first one took is not forgotten."""
    try:
        return ask()
    except ModelError as error:
        error.spent = Spent.on(first) + (error.spent or Spent())
        raise


def _together(first: Reply, second: Reply) -> Reply:
    """The second reply, with what both took; one unknown price makes the sum unknown."""
    costs = (first.cost_usd, second.cost_usd)
    return replace(
        second,
        usage=first.usage + second.usage,
        seconds=first.seconds + second.seconds,
        waited_s=first.waited_s + second.waited_s,
        requests=first.requests + second.requests,
        cost_usd=None if costs[0] is None or costs[1] is None else costs[0] + costs[1],
    )
