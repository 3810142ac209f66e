"""From a model's URI to the model."""

from __future__ import annotations

from adamo.errors import ModelConfigError
from adamo.inference.model import Model
from adamo.inference.retry import RetryPolicy

KNOWN = (
    "baseline, scripted:FILE.json, replay:RUN_DIR, openai:NAME, openai:NAME@http://HOST:PORT/v1 "
    "(any OpenAI-compatible server), or PROVIDER:NAME with another provider of pydantic-ai, "
    "e.g. anthropic:NAME, google:NAME, mistral:NAME"
)


def create_model(uri: str, retry: RetryPolicy | None = None) -> Model:
    """Make the model of a URI.

    ``replay:`` needs a run folder, which inference knows nothing of; `adamo.assemble` makes it.

    Args:
        uri: ``baseline``, ``scripted:FILE.json``, ``openai:NAME``, ``openai:NAME@URL`` or
            ``PROVIDER:NAME``.
        retry: Limits on trying a remote model again.

    Raises:
        ModelConfigError: The URI is unknown, or the provider's package or key is missing.
        ConfigError: The script is missing or wrong.
    """
    prefix, colon, rest = uri.partition(":")
    if uri == "baseline":
        from adamo.inference.baseline import BaselineModel

        return BaselineModel()
    if prefix == "scripted" and rest:
        from adamo.inference.scripted import ScriptedModel, load_script

        return ScriptedModel(uri, load_script(rest))
    if colon and rest and _is_remote(prefix):
        from adamo.inference.provider import ProviderModel

        return ProviderModel(uri, retry)
    raise ModelConfigError(f"Unknown model {uri!r}. Known: {KNOWN}.")


def _is_remote(prefix: str) -> bool:
    from adamo.inference.endpoint import is_known_provider

    return prefix == "openai" or is_known_provider(prefix)
