"""How often one address may ask."""

from __future__ import annotations

import time
from collections import OrderedDict
from dataclasses import dataclass

_MOST_ADDRESSES = 10_000


@dataclass(frozen=True, slots=True)
class Rate:
    """A rate that may be exceeded for a moment."""

    per_s: float = 500.0
    """Requests and messages a second; 0 for any number."""
    burst: int = 1_000
    """So many may come at once, after some quiet."""


class Meter:
    """Counts what each address asks. For one thread."""

    def __init__(self, rate: Rate) -> None:
        """Start with nothing asked."""
        self._rate = rate
        self._left: OrderedDict[str, tuple[float, float]] = OrderedDict()
        """By address: how many it may ask at once, and when that was so."""

    def wait_s(self, address: str) -> float:
        """Count a request: 0 if it may come in, else the seconds after which another one may."""
        if not self._rate.per_s:
            return 0.0
        now, most = time.monotonic(), float(self._rate.burst)
        left, since = self._left.pop(address, (most, now))
        left = min(most, left + (now - since) * self._rate.per_s)
        is_in = left >= 1.0
        self._left[address] = (left - is_in, now)
        if len(self._left) > _MOST_ADDRESSES:
            self._left.popitem(last=False)
        return 0.0 if is_in else (1.0 - left) / self._rate.per_s
