"""Any remote VLM or LLM, through pydantic-ai's direct model requests."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from adamo.action import ToolSchema
from adamo.inference.background import run_in_background
from adamo.inference.endpoint import open_client, parse_endpoint
from adamo.inference.faults import read_failure
from adamo.inference.messages import Message
from adamo.inference.model import ModelKind, Reply, Sampling
from adamo.inference.retry import Failure, RetryPolicy, run_with_retries
from adamo.inference.wire import from_usage, from_wire, to_parameters, to_wire

if TYPE_CHECKING:
    from pydantic_ai.messages import ModelMessage, ModelResponse
    from pydantic_ai.models import ModelRequestParameters
    from pydantic_ai.settings import ModelSettings

_CLIENT_ERRORS = (
    ArithmeticError,
    AssertionError,
    AttributeError,
    LookupError,
    OSError,
    RuntimeError,
    TypeError,
    ValueError,
)
"""What a client library raises over a server's answer: its own errors are RuntimeErrors, and an
answer that is JSON but no completion ends in any of the others, deep in its reading code."""


class ProviderModel:
    """A model behind a provider's API, or on any OpenAI-compatible server.

    Its key comes from the environment and is kept by the client library alone.
    """

    def __init__(self, uri: str, retry: RetryPolicy | None = None) -> None:
        """Make the client; nothing is sent yet.

        Args:
            uri: ``openai:NAME``, ``openai:NAME@http://HOST:PORT/v1``, or ``PROVIDER:NAME`` with a
                provider that pydantic-ai knows.
            retry: Limits on trying again.

        Raises:
            ModelConfigError: The URI, the provider's package or its key is wrong or missing.
        """
        self._name = uri
        self._retry = retry or RetryPolicy()
        self._client = open_client(parse_endpoint(uri))
        self._entered = False

    def __repr__(self) -> str:
        """The name alone."""
        return f"ProviderModel({self._name!r})"

    @property
    def name(self) -> str:
        """As in the URI that made it."""
        return self._name

    @property
    def kind(self) -> ModelKind:
        """Always a VLM."""
        return ModelKind.VLM

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Ask the provider, trying again while its limits and faults may pass.

        Raises:
            ProviderError: The request was refused, or failed after all retries.
        """
        prompt, parameters = to_wire(messages), to_parameters(tools)
        settings = self._settings(sampling)
        answer = run_with_retries(
            self._retry, self._name, lambda: self._try(prompt, settings, parameters)
        )
        message = from_wire(answer.value, messages, {tool.name for tool in tools})
        usage = from_usage(answer.value.usage)
        return Reply(message, usage, answer.seconds, answer.waited_s)

    def close(self) -> None:
        """Close the connections; a further call opens new ones."""
        if self._entered:
            self._entered = False
            run_in_background(self._client.__aexit__(None, None, None))

    def _try(
        self,
        prompt: list[ModelMessage],
        settings: ModelSettings,
        parameters: ModelRequestParameters,
    ) -> ModelResponse | Failure:
        try:
            return run_in_background(self._request(prompt, settings, parameters))
        except _CLIENT_ERRORS as error:
            # Handed on as text: the exception itself holds the request, and with it the key.
            return read_failure(error)

    async def _request(
        self,
        prompt: list[ModelMessage],
        settings: ModelSettings,
        parameters: ModelRequestParameters,
    ) -> ModelResponse:
        from pydantic_ai.direct import model_request

        if not self._entered:
            self._entered = True
            await self._client.__aenter__()
        return await model_request(
            self._client, prompt, model_settings=settings, model_request_parameters=parameters
        )

    def _settings(self, sampling: Sampling) -> ModelSettings:
        """The settings of a request.

        At temperature 0 a top-p of 0 is left out: decoding is greedy without it, and several
        servers refuse the value.
        """
        settings: dict[str, Any] = {
            "temperature": sampling.temperature,
            "top_p": sampling.top_p,
            "max_tokens": sampling.max_tokens,
            "parallel_tool_calls": False,
            # The library's own retries would hide lost time in the time of the call.
            "max_retries": 0,
            "timeout": self._retry.timeout_s,
            "request_timeout": self._retry.timeout_s,
        }
        if sampling.temperature == 0.0 and sampling.top_p == 0.0:
            del settings["top_p"]
        # A provider without such a setting would warn at every call.
        for name in self._client.unsupported_settings & settings.keys():
            del settings[name]
        return settings  # type: ignore[return-value]
