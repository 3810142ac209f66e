"""Run the endpoint of a model beside the rest of a program: in a thread, on a loopback socket."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from adamo_vh.errors import ConfigError
from adamo_vh.extras import extra
from adamo_vh.inference.model import Model
from adamo_vh.inference.registry import create_local_model
from adamo_vh.model_server.fault_rules import Faults, load_faults
from adamo_vh.serving.loopback import listen
from adamo_vh.serving.running import running

if TYPE_CHECKING:
    from adamo_vh.model_server.openai_endpoint import Served


@dataclass(frozen=True, slots=True)
class ServedModel:
    """Where a model is served."""

    name: str
    """As in the URI that made it."""
    base_url: str
    """Address of the API, with its ``/v1``."""

    @property
    def uri(self) -> str:
        """Model URI under which `adamo-vh` reaches it over the network."""
        return f"openai:{self.name.partition(':')[0]}@{self.base_url}"


@contextmanager
def serve_model(
    model: str | Model = "baseline",
    port: int = 0,
    *,
    host: str = "127.0.0.1",
    tools: bool = True,
    faults: str | Path | Faults | None = None,
    max_body_bytes: int | None = None,
    watch: Callable[[Served], None] | None = None,
) -> Iterator[ServedModel]:
    """Serve a local model as an OpenAI-compatible endpoint while the block runs.

    Args:
        model: URI of a local model ("baseline", "random", "scripted:FILE.json", "cassette:DIR"),
            or an own `Model`.
        port: The port; 0 for a free one.
        host: A loopback address: nobody else may ask.
        tools: Whether the model can call tools; otherwise it writes its calls as text.
        faults: What goes wrong on purpose: a TOML file of rules, or the rules.
        max_body_bytes: A larger request is refused; 64 MB by default.
        watch: Is told of every request, in the thread of the server.

    Yields:
        Where it is served.

    Raises:
        ConfigError: A setting is wrong, the port is taken, or the extra `serve` is missing.
        ModelConfigError: The model is unknown.
    """
    with extra("serve", "Serving a model"):
        from adamo_vh.model_server.broken_connections import CuttableProtocol
        from adamo_vh.model_server.openai_endpoint import MAX_BODY_BYTES, Service, create_app
    rules = faults if isinstance(faults, Faults) else load_faults(faults) if faults else Faults()
    limit = MAX_BODY_BYTES if max_body_bytes is None else max_body_bytes
    with listen(host, port) as opened:
        player = _local_model(model) if isinstance(model, str) else model
        app = create_app(Service(player, tools, rules, limit, watch))
        with running(app, opened, "adamo-vh-serve-model", CuttableProtocol):
            shown = f"[{host}]" if ":" in host else host
            bound = opened.getsockname()[1]
            yield ServedModel(player.info.name, f"http://{shown}:{bound}/v1")


def _local_model(uri: str) -> Model:
    model = create_local_model(uri)
    if model is None:
        raise ConfigError(
            f"{uri!r} is no local model; use baseline, random, scripted:FILE.json or cassette:DIR."
        )
    return model
