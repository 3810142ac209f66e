"""Any remote VLM or LLM, through pydantic-ai's direct model requests."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from threading import Lock
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self, cast

from adamo_vh.action import ToolSchema
from adamo_vh.errors import ProviderError
from adamo_vh.inference.cost.prices import cost_usd
from adamo_vh.inference.cost.tokens import cut_prompt, estimate_request, filled_usage, rule_for
from adamo_vh.inference.messages import Message
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Rung, Sampling, Spent, Usage
from adamo_vh.inference.redaction import clean_message, redacted
from adamo_vh.inference.remote.background import run_in_background
from adamo_vh.inference.remote.clients import Connection, connect
from adamo_vh.inference.remote.counts import counted
from adamo_vh.inference.remote.endings import refused_call
from adamo_vh.inference.remote.endpoint import parse_endpoint
from adamo_vh.inference.remote.exchange import Exchange, sent_settings, watch
from adamo_vh.inference.remote.faults import read_error, read_exchange, refused_setting
from adamo_vh.inference.remote.gate import Passage
from adamo_vh.inference.remote.picture_trial import (
    count_pictures,
    may_be_pictures,
    with_fewer_pictures,
)
from adamo_vh.inference.remote.replies import Reading, read_refused_call, read_response
from adamo_vh.inference.remote.retry import Failure, RetryPolicy, Success, run_with_retries
from adamo_vh.inference.remote.settings import EXACT, Settings
from adamo_vh.inference.remote.transport import watching_client
from adamo_vh.inference.remote.wire import from_usage, to_parameters, to_wire

if TYPE_CHECKING:
    import httpx2
    from pydantic_ai.messages import ModelMessage, ModelResponse
    from pydantic_ai.models import Model as Client
    from pydantic_ai.models import ModelRequestParameters


@dataclass(slots=True)
class _Asking:
    """One answer in the making."""

    messages: Sequence[Message]
    tools: Sequence[ToolSchema]
    parameters: ModelRequestParameters
    sampling: Sampling
    requests: int = 0
    """Requests so far, those of failed tries included."""
    settings: Mapping[str, Any] | None = None
    """What the last try carried."""
    seconds: float = 0.0
    """How long the last try was on the wire."""
    lost: Usage = field(default_factory=Usage)
    """Tokens of answers that could not be used."""


@dataclass(frozen=True, slots=True)
class _Answer:
    """An answer, and what it took."""

    reading: Reading
    usage: Usage


class ProviderModel:
    """A model behind a provider's API, or on a server of one's own.

    Its key comes from the environment and is kept by the client library alone.
    """

    def __init__(
        self,
        uri: str,
        retry: RetryPolicy | None = None,
        refused: Iterable[str] = (),
        *,
        several_calls: bool = False,
        cache: bool = False,
        seed: int | None = None,
    ) -> None:
        """Make the client; nothing is sent yet.

        Args:
            uri: ``openai:NAME``, ``openai-responses:NAME``, ``anthropic:NAME``, ``google:NAME``, or
                ``PROVIDER:NAME`` with a provider that pydantic-ai knows; with
                ``@http://HOST:PORT/v1`` behind it for a server of one's own.
            retry: Limits on trying again.
            refused: Parameters that the server is known to refuse; see `refused`.
            several_calls: Whether the model may call several tools in one turn.
            cache: Whether to ask for a prompt cache where it must be asked for and writing it
                costs extra (Anthropic). Worth it if each prompt begins as the one before.
            seed: Seed of the server's draws, sent where its API takes one.

        Raises:
            ModelConfigError: The URI, the provider's package or its key is wrong or missing.
        """
        self._name = uri
        self._endpoint = parse_endpoint(uri)
        self._retry = retry or RetryPolicy()
        self._several_calls = several_calls
        self._cache = cache
        self._lock = Lock()
        self._pictures = 0
        """Pictures of the prompt that held most of them and was answered."""
        self._http: httpx2.AsyncClient | None = None
        self._entered = False
        self._connection = self._connect()
        self._settings = Settings(self._connection.wire, refused, seed)

    def __repr__(self) -> str:
        """The name alone."""
        return f"ProviderModel({self._name!r})"

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    @property
    def info(self) -> ModelInfo:
        """A VLM, as in the URI that made it."""
        return ModelInfo(self._name, ModelKind.VLM, close=self.close)

    @property
    def wire(self) -> str:
        """How it is spoken to.

        "openai-chat", "openai-responses", "anthropic", "google", or the provider's name.
        """
        return self._connection.wire

    @property
    def pictures_in_results(self) -> bool:
        """Whether a tool's result may hold pictures; else they follow it as a human message."""
        return self._connection.pictures_in_results

    @property
    def refused(self) -> frozenset[str]:
        """What the server refused by name, mostly parameters, and is no longer sent."""
        return self._settings.refused

    def complete(
        self,
        messages: Sequence[Message],
        tools: Sequence[ToolSchema],
        sampling: Sampling,
        *,
        schema: ToolSchema | None = None,
    ) -> Reply:
        """Ask the provider, trying again while its limits and faults may pass.

        Args:
            messages: The whole prompt, oldest first.
            tools: The tools on offer.
            sampling: Decoding settings.
            schema: What the text of the answer must be, as JSON, if it must; the server is held to
                it. Usually without tools.

        Raises:
            ProviderError: The request was refused, or failed after all retries.
        """

        def ask_once(prompt: Sequence[Message]) -> Reply:
            once = replace(self._retry, max_tries=1)
            return self._ask(prompt, tools, sampling, schema, once)

        pictures, refused = count_pictures(messages), None
        try:
            reply = self._ask(messages, tools, sampling, schema, self._retry)
        except ProviderError as error:
            if pictures <= self._pictures or not may_be_pictures(error):
                raise
            refused = error
        if refused is not None:
            reply = with_fewer_pictures(ask_once, messages, refused)
        self._pictures = max(self._pictures, pictures)
        return reply

    def _ask(
        self,
        messages: Sequence[Message],
        tools: Sequence[ToolSchema],
        sampling: Sampling,
        schema: ToolSchema | None,
        retry: RetryPolicy,
    ) -> Reply:
        asking = _Asking(messages, tools, to_parameters(tools, schema), sampling)
        started = time.monotonic()
        where = self._endpoint.base_url or self._endpoint.prefix
        passage = Passage(where, lambda: estimate_request(messages, tools, rule_for(self._name)))
        try:
            answer = run_with_retries(
                retry,
                self._name,
                lambda: self._pass(asking, passage),
                adapt=lambda failure: bool(failure.refused),
                enter=passage.enter,
            )
        except ProviderError as error:
            cost, waited = self._cost(asking.lost), time.monotonic() - started
            error.spent = Spent(asking.lost, asking.requests, cost, waited_s=waited)
            raise
        return self._reply(answer, asking, tools if schema is None else (*tools, schema))

    def _reply(
        self, answer: Success[_Answer], asking: _Asking, asked: Sequence[ToolSchema]
    ) -> Reply:
        """The reply that an answer comes to, with all that it took."""
        reading, usage = answer.value.reading, answer.value.usage
        # A server may echo the key that it was sent.
        message = clean_message(reading.message)
        usage = filled_usage(usage, asking.messages, asked, message, rule_for(self._name))
        return Reply(
            message,
            asking.lost + usage,
            # The first use of a library takes seconds to load, which is not the model's time.
            asking.seconds or answer.seconds,
            answer.waited_s,
            requests=asking.requests,
            cost_usd=self._cost(asking.lost, usage),
            settings=asking.settings or {},
            rung=Rung.LEAKED if reading.leaked else Rung.NATIVE,
            unreadable=redacted(reading.problem),
            ending=reading.ending,
            finish_reason=redacted(reading.finish_reason),
            warning=cut_prompt(usage, asking.messages, asked),
        )

    def close(self) -> None:
        """Close the connections; a further call opens new ones."""
        with self._lock:
            http, self._http = self._http, None
            entered, self._entered = self._entered, False
        if http is not None:
            run_in_background(_close(self._connection.client, http, entered=entered))

    @property
    def _source(self) -> str:
        """Who gives the answers: nobody else gets back what was kept of them."""
        return f"{self._connection.wire}:{self._endpoint.model}"

    def _connect(self) -> Connection:
        secure = not (self._endpoint.base_url or "https:").startswith("http:")
        self._http = watching_client(self._retry.timeout_s, secure=secure)
        return connect(self._endpoint, self._http)

    def _pass(self, asking: _Asking, passage: Passage) -> _Answer | Failure:
        """Try once, and tell the gate what came of it."""
        tokens, failure = 0, None
        try:
            outcome = self._try(asking)
            if isinstance(outcome, Failure):
                failure = outcome
            else:
                tokens = outcome.usage.total_tokens
            return outcome
        finally:
            passage.leave(tokens, failure)

    def _try(self, asking: _Asking) -> _Answer | Failure:
        exchange = Exchange(required=EXACT if asking.sampling.exact else ())
        settings = self._settings.wanted(
            asking.sampling,
            with_tools=bool(asking.parameters.function_tools),
            several_calls=self._several_calls,
        )
        prompt = to_wire(
            asking.messages,
            self._connection,
            self._source,
            one_system=self._settings.one_system,
            bridged=self._settings.bridged,
        )
        outcome: _Answer | Failure
        try:
            response = run_in_background(
                self._request(prompt, asking.parameters, settings, exchange)
            )
            outcome = self._read(response, exchange, asking)
        except Exception as error:
            # The libraries' errors have no common base, and an answer that is JSON but no
            # completion ends in any error at all, deep in their reading code. It is handed on as
            # text: the exception itself holds the request, and with it the key.
            outcome = read_error(error)
        asking.requests += exchange.requests or 1
        # Not every provider's library can be watched: then it is believed.
        asking.settings = sent_settings(exchange.sent) or settings
        if reshaped := self._settings.reshaped:
            asking.settings = {**asking.settings, "reshaped": [*reshaped]}
        asking.seconds = exchange.seconds
        if exchange.withheld:
            return _inexact(f"The client library does not send {exchange.withheld[0]}.")
        # What the bytes say goes before what the library made of them.
        failure = read_exchange(exchange)
        usage = counted(exchange.body) or Usage()
        if failure is None:
            if isinstance(outcome, Failure):
                asking.lost += usage
            return outcome
        if refused := refused_call(exchange.body, exchange.text):
            # The server did its work; it was the model that wrote what cannot be read.
            return _Answer(read_refused_call(*refused, asking.messages, asking.tools), usage)
        asking.lost += usage
        if asking.sampling.exact and refused_setting(exchange, EXACT):
            return _inexact(failure.text)
        return replace(
            failure, refused=self._settings.take_refusal(exchange, settings, asking.sampling)
        )

    def _cost(self, *usages: Usage) -> float | None:
        """What requests cost; each by itself, since long ones may cost more."""
        costs = [cost_usd(self._name, usage) for usage in usages]
        known = [cost for cost in costs if cost is not None]
        return sum(known) if len(known) == len(costs) else None

    def _read(self, response: ModelResponse, exchange: Exchange, asking: _Asking) -> _Answer:
        reading = read_response(
            response,
            exchange.body,
            asking.messages,
            asking.tools,
            self._source,
            takes_thinking=self._connection.takes_thinking,
        )
        return _Answer(reading, counted(exchange.body) or from_usage(response.usage))

    async def _request(
        self,
        prompt: list[ModelMessage],
        parameters: ModelRequestParameters,
        settings: Mapping[str, Any],
        exchange: Exchange,
    ) -> ModelResponse:
        from pydantic_ai.direct import model_request
        from pydantic_ai.settings import ModelSettings

        watch(exchange)
        client = await self._open()
        # A provider without such a setting would warn at every call.
        unknown = client.unsupported_settings
        known = {name: value for name, value in settings.items() if name not in unknown}
        timeout_s = self._retry.timeout_s
        # The library's own retries would hide lost time in the time of the call.
        limits = ModelSettings(max_retries=0, timeout=timeout_s, request_timeout=timeout_s)
        if self._cache and self.wire == "anthropic":
            limits["cache"] = True
        # The libraries' own time-outs begin anew with every byte that trickles in.
        async with asyncio.timeout(timeout_s):
            return await model_request(
                client,
                prompt,
                model_settings=cast(ModelSettings, {**limits, **known}),
                model_request_parameters=parameters,
            )

    async def _open(self) -> Client:
        """The client, ready to send; made anew after it was closed."""
        with self._lock:
            if self._http is None:
                self._connection = self._connect()
            client, first = self._connection.client, not self._entered
            self._entered = True
        if first:
            await client.__aenter__()
        return client


async def _close(client: Client, http: httpx2.AsyncClient, *, entered: bool) -> None:
    if entered:
        await client.__aexit__(None, None, None)
    await http.aclose()


def _inexact(text: str) -> Failure:
    fix = "These exact settings cannot be had of this model: use `--profile paper`."
    return Failure(f"{text} {fix}", False)
