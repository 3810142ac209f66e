"""Where a remote model lives: its URI, its host, and whether it may be reached."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from urllib.parse import urlsplit

from adamo_vh.errors import ModelConfigError
from adamo_vh.inference.redaction import public
from adamo_vh.serving.loopback import is_loopback

NO_REMOTE = "ADAMO_VH_NO_REMOTE"
"""Environment variable; set to 1, it forbids every model that is not on a loopback address."""

_KEYS = {
    "openai": ("OPENAI_API_KEY",),
    "openai-responses": ("OPENAI_API_KEY",),
    "anthropic": ("ANTHROPIC_API_KEY",),
    "google": ("GOOGLE_API_KEY", "GEMINI_API_KEY"),
}
"""Environment variables of keys, the first that is set counts."""

_IN_HEADERS = ("OPENAI_ORG_ID", "OPENAI_PROJECT_ID", "ANTHROPIC_AUTH_TOKEN", "OPENROUTER_API_KEY")
"""What client libraries take out of the environment and put into headers as well."""

_ADDRESS = re.compile(r"@(?=(?://)?(?:localhost\b|[^@/\s]+:\d|\[))(?://)?(.+)$")
"""An address without its scheme at the end of a model's name."""


@dataclass(frozen=True, slots=True)
class Endpoint:
    """A parsed model URI."""

    prefix: str
    """The provider, e.g. "openai"."""
    model: str
    """The model's name at the provider."""
    base_url: str | None = None
    """Address of the server, if one was given."""

    @property
    def key_variables(self) -> tuple[str, ...]:
        """Environment variables of its key; a guess for all but the providers with wires of ours.

        The first that is set counts.
        """
        guess = re.sub(r"\W", "_", f"{self.prefix.upper()}_API_KEY")
        return _KEYS.get(self.prefix, (guess,))

    @property
    def key_variable(self) -> str:
        """The first of `key_variables`."""
        return self.key_variables[0]

    @property
    def key(self) -> str | None:
        """The key; None if the environment has none under a name that we know."""
        return next((os.environ[n] for n in self.key_variables if os.environ.get(n)), None)

    @property
    def has_known_key(self) -> bool:
        """Whether we know where its key is kept, rather than the client library alone."""
        return self.prefix in _KEYS


def parse_endpoint(uri: str) -> Endpoint:
    """Read ``PROVIDER:NAME`` or ``PROVIDER:NAME@http://HOST:PORT/v1``.

    Raises:
        ModelConfigError: The URI is malformed, or its address has no scheme or carries a secret.
    """
    prefix, _, rest = uri.partition(":")
    at = re.search(r"@(?=https?://)", rest)
    model, base_url = (rest[: at.start()], rest[at.end() :]) if at else (rest, None)
    if not prefix or not model:
        raise ModelConfigError("A remote model is written PROVIDER:NAME, e.g. openai:gpt-4o.")
    if base_url is None and (lost := _ADDRESS.search(model)):
        # Else the request would go to the provider, with the key.
        written = public(f"{prefix}:{model[: lost.start()]}@{lost[1]}")
        name, _, address = written.rpartition("@")
        raise ModelConfigError(
            f"{written}: write the address with its scheme, {name}@http://{address}."
        )
    endpoint = Endpoint(prefix, model, base_url)
    if base_url is not None:
        _check_url(endpoint, base_url)
    return endpoint


def _check_url(endpoint: Endpoint, base_url: str) -> None:
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
            f"the environment variable {endpoint.key_variable}."
        )


def check_remote_allowed(endpoint: Endpoint) -> None:
    """Obey the switch that keeps tests and offline runs off the network.

    Raises:
        ModelConfigError: The switch is on and the model is not on a loopback address.
    """
    if not remote_forbidden():
        return
    host = urlsplit(endpoint.base_url).hostname if endpoint.base_url else None
    if host is None or not is_loopback(host):
        raise ModelConfigError(
            f"{endpoint.prefix}:{endpoint.model} is a remote model and {NO_REMOTE} forbids those. "
            f"Unset {NO_REMOTE}, or use baseline, a script or a server on 127.0.0.1."
        )


def remote_forbidden() -> bool:
    """Whether the switch is on."""
    return os.environ.get(NO_REMOTE, "0") not in ("", "0")


def key_problems(names: Iterable[str] | None = None) -> Iterator[str]:
    """What is wrong with the keys in the environment, a sentence with the fix each.

    Args:
        names: Environment variables; all that are known by default.
    """
    wanted = [*(names if names is not None else (n for some in _KEYS.values() for n in some))]
    for name in dict.fromkeys((*wanted, *_IN_HEADERS)):
        value = os.environ.get(name, "")
        odd = next((letter for letter in value if not "!" <= letter <= "~"), "")
        if odd:
            what = "a line break" if odd in "\r\n" else "a blank" if odd == " " else "a letter"
            what = f"{what} that is not ASCII" if odd > "~" else what
            yield f"{name} holds {what}, which no key has; set it again without."


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
