"""From an endpoint to the client that talks to it, and what its wire can carry."""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from adamo_vh.errors import ModelConfigError
from adamo_vh.inference.redaction import redacted
from adamo_vh.inference.remote.compatible import compatible_client
from adamo_vh.inference.remote.endpoint import (
    NO_REMOTE,
    Endpoint,
    check_remote_allowed,
    remote_forbidden,
)
from adamo_vh.inference.remote.routes import check_way

if TYPE_CHECKING:
    import httpx2
    from pydantic_ai.models import Model as Client
    from pydantic_ai.providers import Provider

_NO_KEY = "no-key"
"""Sent to a server of one's own that needs no key; the client libraries insist on one."""

_ENCRYPTED = "openai_supports_encrypted_reasoning_content"
_OWN_EXTRAS = ("anthropic", "google")


@dataclass(frozen=True, slots=True)
class Connection:
    """A client, and what its wire can carry."""

    client: Client
    wire: str
    """The shape of its requests, or the provider's name if it is none of the four."""
    pictures_in_results: bool
    """Whether a tool's result may hold pictures."""
    late_system: bool
    """Whether system messages keep their place behind other messages."""
    takes_thinking: bool
    """Whether thinking can go back in a place of its own."""


def connect(endpoint: Endpoint, http: httpx2.AsyncClient) -> Connection:
    """Make the client of an endpoint. Nothing is sent yet.

    Args:
        endpoint: Where the model lives.
        http: What sends the requests, where the provider's library lets itself be given one.

    Raises:
        ModelConfigError: The provider is unknown, its extra is not installed, its key is missing,
            or remote models are forbidden.
    """
    check_remote_allowed(endpoint)
    check_way(endpoint)
    if endpoint.prefix == "openai":
        return _described(_openai(endpoint, http), "openai-chat")
    return _described(_inferred(endpoint, http), endpoint.prefix)


def _described(client: Client, wire: str) -> Connection:
    names = {kind.__name__ for kind in type(client).__mro__}
    profile: dict[str, Any] = {**client.profile}
    types = profile.get("google_supported_mime_types_in_tool_returns", ())
    responses, anthropic = "OpenAIResponsesModel" in names, "AnthropicModel" in names
    return Connection(
        client,
        wire,
        pictures_in_results=responses or anthropic or {"image/png", "image/jpeg"} <= {*types},
        late_system=responses or "OpenAIChatModel" in names,
        takes_thinking=not responses or bool(profile.get(_ENCRYPTED)),
    )


def _openai(endpoint: Endpoint, http: httpx2.AsyncClient) -> Client:
    from pydantic_ai.models.openai import OpenAIChatModel
    from pydantic_ai.providers.openai import OpenAIProvider

    if endpoint.base_url is not None:
        return compatible_client(endpoint.model, endpoint.base_url, endpoint.key or _NO_KEY, http)
    _check_key(endpoint)
    return OpenAIChatModel(endpoint.model, provider=OpenAIProvider(http_client=http))


def _check_key(endpoint: Endpoint) -> None:
    if endpoint.has_known_key and endpoint.key is None:
        name = f"{endpoint.prefix}:{endpoint.model}"
        raise ModelConfigError(
            f"{name} needs a key: set the environment variable {endpoint.key_variable}. "
            f"A server of your own needs none: {name}@http://127.0.0.1:8000/v1."
        )


def _inferred(endpoint: Endpoint, http: httpx2.AsyncClient) -> Client:
    from pydantic_ai.exceptions import UserError
    from pydantic_ai.models import infer_model

    try:
        return infer_model(
            f"{endpoint.prefix}:{endpoint.model}", lambda _: _provider(endpoint, http)
        )
    except ImportError as error:
        reason = f"needs an extra package: pip install '{_extra(endpoint, error)}'."
    except (UserError, TypeError, ValueError) as error:
        reason = f"cannot be used: {redacted(str(error))}"
    # Raised here, not in the handler: the library's own exception may hold a key.
    raise ModelConfigError(f"{endpoint.prefix}:{endpoint.model} {reason}")


def _extra(endpoint: Endpoint, error: ImportError) -> str:
    found = re.search(r"pydantic-ai-slim\[([\w-]+)\]", str(error))
    extra = found.group(1) if found else endpoint.prefix
    return f"adamo-vh[{extra}]" if extra in _OWN_EXTRAS else f"pydantic-ai-slim[{extra}]"


def _provider(endpoint: Endpoint, http: httpx2.AsyncClient) -> Provider[Any]:
    from pydantic_ai.exceptions import UserError
    from pydantic_ai.providers import infer_provider, infer_provider_class

    if endpoint.prefix.startswith("gateway/"):
        return infer_provider(endpoint.prefix)
    make = infer_provider_class(endpoint.prefix)
    takes = inspect.signature(make).parameters
    options: dict[str, Any] = {"http_client": http} if _takes_httpx2(takes) else {}
    if not options and remote_forbidden():
        raise ModelConfigError(
            f"{endpoint.prefix}: its library sends on ways of its own, and {NO_REMOTE} forbids all "
            f"but this machine. Write openai:{endpoint.model}@{endpoint.base_url}."
        )
    if endpoint.base_url is None:
        _check_key(endpoint)
        return make(**options)
    address = next((name for name in ("base_url", "api_base") if name in takes), None)
    if address is None:
        raise ModelConfigError(
            f"{endpoint.prefix}: takes no address. Write openai:{endpoint.model}@"
            f"{endpoint.base_url} for an OpenAI-compatible server."
        )
    options[address] = _root(endpoint)
    keyless = {**options, "api_key": _NO_KEY}
    if endpoint.has_known_key and endpoint.key is None:
        return make(**keyless)
    try:
        return make(**options)
    except UserError:
        return make(**keyless)


def _takes_httpx2(takes: Any) -> bool:
    """Whether a provider's library sends through the client that it is given, of our kind."""
    if "http_client" not in takes:
        return False
    kind = str(takes["http_client"].annotation)
    return "httpx2" in kind or "OpenAIHTTPClient" in kind or "AsyncHTTPClient" in kind


def _root(endpoint: Endpoint) -> str:
    """The address as the provider's library wants it: some add the version of the API alone."""
    address = (endpoint.base_url or "").rstrip("/")
    if endpoint.prefix in _OWN_EXTRAS:
        return re.sub(r"/v1(beta)?$", "", address)
    return address
