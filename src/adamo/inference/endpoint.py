"""Where a remote model lives: its URI, its host, its key, and the client that talks to it."""

from __future__ import annotations

import ipaddress
import os
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from adamo.errors import ModelConfigError
from adamo.inference.compatible import compatible_client
from adamo.inference.redaction import redacted

if TYPE_CHECKING:
    from pydantic_ai.models import Model as Client

NO_REMOTE = "ADAMO_NO_REMOTE"
"""Environment variable; set to 1, it forbids every model that is not on a loopback address."""

_NO_KEY = "no-key"
"""Sent to a server of one's own that needs no key; the client library insists on one."""


@dataclass(frozen=True, slots=True)
class Endpoint:
    """A parsed model URI."""

    prefix: str
    """The provider, e.g. "openai"."""
    model: str
    """The model's name at the provider."""
    base_url: str | None = None
    """Address of an OpenAI-compatible server, if one was given."""


def parse_endpoint(uri: str) -> Endpoint:
    """Read ``openai:NAME``, ``openai:NAME@http://HOST:PORT/v1`` or ``PROVIDER:NAME``.

    Raises:
        ModelConfigError: The URI is malformed, or its address carries a secret.
    """
    prefix, _, rest = uri.partition(":")
    at = re.search(r"@(?=https?://)", rest)
    model, base_url = (rest[: at.start()], rest[at.end() :]) if at else (rest, None)
    if not prefix or not model:
        raise ModelConfigError("A remote model is written PROVIDER:NAME, e.g. openai:gpt-4o.")
    if base_url is not None:
        _check_url(prefix, base_url)
    return Endpoint(prefix, model, base_url)


def _check_url(prefix: str, base_url: str) -> None:
    if prefix != "openai":
        raise ModelConfigError(
            f"Only openai: takes an address, not {prefix}:. Write "
            "openai:NAME@http://127.0.0.1:8000/v1 for any OpenAI-compatible server."
        )
    try:
        url = urlsplit(base_url)
        valid = bool(url.hostname) and (url.port is None or url.port > 0)
    except ValueError:
        valid = False
    if not valid:
        raise ModelConfigError(
            "The model's address is malformed; write it like http://127.0.0.1:8000/v1."
        )
    if url.username is not None or url.query or url.fragment:
        # The URI is the model's public name: it is shown, logged and recorded.
        raise ModelConfigError(
            "The model's address must not carry a user, a password or a query; put the key into "
            "the environment variable OPENAI_API_KEY."
        )


def check_remote_allowed(endpoint: Endpoint) -> None:
    """Obey the switch that keeps tests and offline runs off the network.

    Raises:
        ModelConfigError: The switch is on and the model is not on a loopback address.
    """
    if os.environ.get(NO_REMOTE, "0") in ("", "0"):
        return
    host = urlsplit(endpoint.base_url).hostname if endpoint.base_url else None
    if host is None or not _is_loopback(host):
        raise ModelConfigError(
            f"{endpoint.prefix}:{endpoint.model} is a remote model and {NO_REMOTE} forbids those. "
            f"Unset {NO_REMOTE}, or use baseline, a script or a server on 127.0.0.1."
        )


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def open_client(endpoint: Endpoint) -> Client:
    """Make the client of an endpoint. Nothing is sent yet.

    Raises:
        ModelConfigError: The provider is unknown, its extra is not installed, its key is missing,
            or remote models are forbidden.
    """
    check_remote_allowed(endpoint)
    if endpoint.prefix == "openai":
        return _openai_client(endpoint)
    return _other_client(endpoint)


def _openai_client(endpoint: Endpoint) -> Client:
    from pydantic_ai.models.openai import OpenAIChatModel
    from pydantic_ai.providers.openai import OpenAIProvider

    if endpoint.base_url is None:
        if not os.environ.get("OPENAI_API_KEY"):
            raise ModelConfigError(
                f"openai:{endpoint.model} needs a key: set the environment variable "
                "OPENAI_API_KEY. A server of your own needs none: "
                f"openai:{endpoint.model}@http://127.0.0.1:8000/v1."
            )
        return OpenAIChatModel(endpoint.model, provider=OpenAIProvider())
    key = os.environ.get("OPENAI_API_KEY") or _NO_KEY
    return compatible_client(endpoint.model, endpoint.base_url, key)


def _other_client(endpoint: Endpoint) -> Client:
    from pydantic_ai.exceptions import UserError
    from pydantic_ai.models import infer_model

    reason = ""
    try:
        return infer_model(f"{endpoint.prefix}:{endpoint.model}")
    except ImportError as error:
        found = re.search(r"pydantic-ai-slim\[([\w-]+)\]", str(error))
        extra = found.group(1) if found else endpoint.prefix
        reason = f"needs an extra package: pip install 'pydantic-ai-slim[{extra}]'."
    except (UserError, ValueError) as error:
        reason = f"cannot be used: {redacted(str(error))}"
    # Raised here, not in the handler: the library's own exception may hold a key.
    raise ModelConfigError(f"{endpoint.prefix}:{endpoint.model} {reason}")


def is_known_provider(prefix: str) -> bool:
    """Whether pydantic-ai knows a provider of this name, installed or not."""
    from pydantic_ai.providers import infer_provider_class

    name = prefix.removeprefix("gateway/")
    try:
        infer_provider_class(name)
    except ImportError:
        return True
    except ValueError:
        return False
    return True
