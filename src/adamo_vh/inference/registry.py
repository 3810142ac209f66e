"""From a model's URI to the model."""

from __future__ import annotations

from typing import TYPE_CHECKING

from adamo_vh.errors import AdamoError, ModelConfigError, ModelError
from adamo_vh.inference.model import Model, Rung
from adamo_vh.inference.redaction import public
from adamo_vh.inference.remote.retry import RetryPolicy
from adamo_vh.inference.uris import known_forms

if TYPE_CHECKING:
    from adamo_vh.inference.remote.capabilities import Capabilities

AUTO = "auto"
_RUNGS = {"native": Rung.NATIVE, "schema": Rung.SCHEMA, "react": Rung.REACT}
TOOLS = (AUTO, *_RUNGS)
"""How a remote model may be asked for its calls."""


def create_model(
    uri: str,
    retry: RetryPolicy | None = None,
    *,
    tools: str = AUTO,
    several_calls: bool = False,
    cache: bool = False,
    seed: int = 0,
) -> Model:
    """Make the model of a URI.

    ``replay:`` needs a run folder, which inference knows nothing of; `adamo_vh.session` makes it.

    Args:
        uri: ``baseline``, ``baseline:ocr``, ``random``, ``random:SEED``,
            ``scripted:FILE.json``, ``cassette:DIR``, ``openai:NAME``, ``openai:NAME@URL`` or
            ``PROVIDER:NAME``.
        retry: Limits on trying a remote model again.
        tools: How a remote model is asked for its calls. "auto" takes the best way that works: it
            probes the model unless that was done before. "native", "schema" and "react" probe
            nothing.
        several_calls: Whether a remote model may call several tools in one turn, where it is asked
            through native tools.
        cache: Ask providers that want to be asked (Anthropic) to cache the prompt's beginning;
            worth it only where the prompt grows at its end.
        seed: Seed of the episode: of `random` where its URI names none, and sent to providers that
            take one.

    Returns:
        The model. The `info` of a remote one says what a probe found out about it.

    Raises:
        ModelConfigError: The URI or `tools` is unknown, or the provider's package or key is
            missing.
        ModelError: The model had to be probed and cannot be reached.
        ConfigError: The script is missing or wrong.
    """
    if tools not in TOOLS:
        raise ModelConfigError(f"There is no way {tools!r} to ask. Use one of {', '.join(TOOLS)}.")
    local = create_local_model(uri, seed=seed)
    if local is not None:
        return local
    check_remote_uri(uri)
    return _remote_model(uri, retry, tools, several_calls=several_calls, cache=cache, seed=seed)


def check_remote_uri(uri: str) -> None:
    """Make sure that a URI is written like that of a remote model.

    Raises:
        ModelConfigError: It is not; lists what is known.
    """
    if not is_remote(uri):
        raise ModelConfigError(f"Unknown model {public(uri)!r}. Known: {known_forms()}.")


def is_remote(uri: str) -> bool:
    """Whether a URI is written like that of a model behind a server."""
    prefix, _, rest = uri.partition(":")
    return bool(rest) and (prefix == "openai" or _is_known_provider(prefix))


def create_local_model(uri: str, *, seed: int = 0) -> Model | None:
    """Make a model that needs no server; None if the URI is not that of one.

    Args:
        uri: As for `create_model`.
        seed: Of a model that draws lots, where its URI names none.
    """
    prefix, _, rest = uri.partition(":")
    if uri in ("baseline", "baseline:ocr"):
        from adamo_vh.inference.baseline import BaselineModel

        return BaselineModel(ocr=uri == "baseline:ocr")
    if prefix == "random":
        from adamo_vh.inference.players.random import RandomModel

        return RandomModel(_seed(uri, rest) if rest else seed)
    if prefix == "scripted" and rest:
        from adamo_vh.inference.players.scripted import ScriptedModel, load_script

        return ScriptedModel(uri, load_script(rest))
    if prefix == "cassette" and rest:
        from adamo_vh.inference.players.cassette import Cassette

        return Cassette(rest)
    return _plugin_model(prefix, rest, seed)


def _plugin_model(name: str, rest: str, seed: int) -> Model | None:
    """The model of another installed package; None if none has this name."""
    from adamo_vh.inference.players.checked import checked
    from adamo_vh.plugins import MODELS, load_plugin

    make = load_plugin(MODELS, name) if name else None
    if make is None:
        return None
    try:
        model = make(rest, seed)
    except AdamoError:
        raise
    except Exception as error:
        raise ModelConfigError(
            f"The model {name} of an installed package cannot be made: {type(error).__name__}: "
            f"{error}. It is called with the text behind the colon and the seed."
        ) from error
    return checked(model)


def _seed(uri: str, text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise ModelConfigError(f"{uri}: the seed is a whole number, e.g. random:7.") from None


def _remote_model(
    uri: str,
    retry: RetryPolicy | None,
    tools: str,
    *,
    several_calls: bool,
    cache: bool,
    seed: int,
) -> Model:
    from adamo_vh.inference.ladder import Ladder
    from adamo_vh.inference.remote.capabilities import load_capabilities
    from adamo_vh.inference.remote.endpoint import check_remote_allowed, parse_endpoint
    from adamo_vh.inference.remote.provider import ProviderModel

    check_remote_allowed(parse_endpoint(uri))
    known = load_capabilities(uri)
    if tools == AUTO and (known is None or not known.is_complete):
        known = probe_and_save(uri, retry, known)
    refused = known.refused if known else ()
    model = ProviderModel(uri, retry, refused, several_calls=several_calls, cache=cache, seed=seed)
    rung = known.rung if known and tools == AUTO else _RUNGS.get(tools)
    if rung is None:
        why = " ".join(known.unanswered) if known else ""
        raise ModelError(
            f"{uri}: how to ask it is not known, because a question about it was not answered "
            f"({why.rstrip('.')}). Try again later, or choose with --tool-calls native, schema or "
            "react."
        )
    return Ladder(model, rung, known)


def probe_and_save(
    uri: str, retry: RetryPolicy | None = None, known: Capabilities | None = None
) -> Capabilities:
    """Probe a remote model and save what was found out for the next time.

    Args:
        uri: URI of a remote model.
        retry: Limits on trying again.
        known: What an earlier probe found; only what it left unknown is asked.

    Raises:
        ModelConfigError: The URI, the provider's package or its key is wrong or missing.
        ModelError: The model cannot be reached; nothing is saved.
    """
    from adamo_vh.inference.remote.capabilities import save_capabilities
    from adamo_vh.inference.remote.probe import probe

    check_remote_uri(uri)
    found = probe(uri, retry, known)
    save_capabilities(found)
    return found


def _is_known_provider(prefix: str) -> bool:
    from adamo_vh.inference.remote.endpoint import is_known_provider

    return is_known_provider(prefix)
