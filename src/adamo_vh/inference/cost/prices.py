"""What tokens cost: by the user's own table, else by the list prices that genai-prices carries.

The table is a TOML file, at the path in the environment variable ADAMO_VH_PRICES or else
``prices.toml`` in the user's configuration folder::

    ["openai:my-model@http://127.0.0.1:8000/v1"]   # a model's URI, or a pattern with * and ?
    input = 0.5      # US dollars per million tokens
    cached = 0.05    # of the input that a provider cache served; as input if left out
    output = 2.0     # reasoning included

An exact URI goes before patterns, and patterns in the order of the file. Nothing is looked up in
the network. A price that is not known is None and never 0.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

from adamo_vh.errors import ConfigError, FileError, ModelConfigError
from adamo_vh.files import read_toml
from adamo_vh.inference.model import Usage
from adamo_vh.inference.remote.endpoint import Endpoint, parse_endpoint

if TYPE_CHECKING:
    from genai_prices.types import ModelPrice, PriceCalculation

PRICES = "ADAMO_VH_PRICES"
"""Environment variable: path of the user's price table."""

_NEEDED, _OPTIONAL = ("input", "output"), ("cached",)
_EXAMPLE = "e.g. input = 2.5, the US dollars for a million tokens"
_MILLION = 1_000_000


@dataclass(frozen=True, slots=True)
class Price:
    """US dollars for a million tokens."""

    input_usd: float
    cached_usd: float
    """Of the part of the input that a provider cache served."""
    output_usd: float

    def cost_usd(self, usage: Usage) -> float:
        """What a usage costs at this price."""
        cached = min(usage.cached_tokens, usage.input_tokens)
        dollars = (
            (usage.input_tokens - cached) * self.input_usd
            + cached * self.cached_usd
            + usage.output_tokens * self.output_usd
        )
        return dollars / _MILLION


def cost_usd(uri: str, usage: Usage) -> float | None:
    """What a usage costs in US dollars; None if no price is known, never 0 for want of one.

    Args:
        uri: Model URI.
        usage: Tokens of one request. Where long requests cost more, a sum over several requests
            can be priced too high.

    Raises:
        ConfigError: The user's price table is wrong.
    """
    own = _own_price(uri)
    if own is not None:
        return own.cost_usd(usage)
    listed = _listed(uri, usage)
    return None if listed is None else float(listed.total_price)


def prices_file() -> Path:
    """Where the user's price table is, or would be."""
    given = os.environ.get(PRICES)
    if given:
        return Path(given).expanduser()
    import platformdirs

    return Path(platformdirs.user_config_dir("adamo-vh")) / "prices.toml"


def _own_price(uri: str) -> Price | None:
    """The price in the user's table."""
    path = prices_file()
    try:
        changed = path.stat().st_mtime_ns
    except OSError as error:
        if os.environ.get(PRICES):
            reason = error.strerror or type(error).__name__
            raise ConfigError(
                f"{PRICES} names {path}, which cannot be read: {reason}. Correct or unset it."
            ) from None
        return None
    table = _read_table(path, changed)
    if uri in table:
        return table[uri]
    return next((price for pattern, price in table.items() if fnmatchcase(uri, pattern)), None)


@lru_cache(maxsize=8)
def _read_table(path: Path, changed: int) -> Mapping[str, Price]:
    """The user's table; `changed` makes an edited file a new one."""
    try:
        entries = read_toml(path)
    except FileError as error:
        raise ConfigError(f"Prices: {error}") from None
    return {uri: _read_entry(path, uri, entry) for uri, entry in entries.items()}


def _read_entry(path: Path, uri: str, entry: Any) -> Price:
    where = f'{path}, ["{uri}"]'
    if not isinstance(entry, dict):
        raise ConfigError(
            f"{where}: must be a section with input and output, {_EXAMPLE}. "
            f'Put the URI into quotes: ["{uri}"].'
        )
    if unknown := sorted(entry.keys() - {*_NEEDED, *_OPTIONAL}):
        raise ConfigError(f"{where}: unknown field {unknown[0]}; use input, cached and output.")
    for field in _NEEDED:
        if field not in entry:
            raise ConfigError(f"{where}: {field} is missing; add it, {_EXAMPLE}.")
    numbers = {field: _number(f"{where}: {field}", value) for field, value in entry.items()}
    cached = numbers.get("cached", numbers["input"])
    return Price(numbers["input"], cached, numbers["output"])


def _number(where: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ConfigError(f"{where} must be a number, not {value!r}; {_EXAMPLE}.")
    if not math.isfinite(value) or value < 0:
        raise ConfigError(f"{where} must be 0 or more, not {value}; {_EXAMPLE}.")
    return float(value)


def _listed(uri: str, usage: Usage) -> PriceCalculation | None:
    """The list price of a usage."""
    try:
        endpoint = parse_endpoint(uri)
    except ModelConfigError:
        return None
    if _is_own_server(endpoint):
        return None
    from genai_prices import Usage as Counted
    from genai_prices import calc_price

    counted = Counted(
        input_tokens=usage.input_tokens,
        output_tokens=usage.output_tokens,
        cache_read_tokens=min(usage.cached_tokens, usage.input_tokens),
        output_reasoning_tokens=min(usage.reasoning_tokens, usage.output_tokens),
    )
    try:
        found = calc_price(counted, endpoint.model, provider_id=endpoint.prefix)
    except LookupError:
        return None
    return found if _is_complete(found.model_price, endpoint.model) else None


def _is_own_server(endpoint: Endpoint) -> bool:
    """Whether the requests go to a server of one's own, whose models only share their names."""
    if endpoint.base_url is not None:
        return True
    moved = os.environ.get("OPENAI_BASE_URL") if endpoint.prefix.startswith("openai") else None
    return bool(moved) and urlsplit(moved).hostname != "api.openai.com"


def _is_complete(prices: ModelPrice, model: str) -> bool:
    """Whether tokens alone are priced, both ways: what lacks a price would count as 0."""
    if prices.requests_kcount is not None:
        return False
    priced = prices.input_mtok is not None and prices.output_mtok is not None
    return priced or model.endswith(":free")
