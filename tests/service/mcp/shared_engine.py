"""The engine of the tests, for the episodes of a server."""

from __future__ import annotations

from adamo_vh.session.lending import LentWorld
from adamo_vh.session.pooling import Engines


def engines_of(lent: LentWorld) -> Engines:
    """Engines of a server that are open already: that of a test, for scene S1."""
    return Engines(ready={("s1", "mara", 0): lent.lender})
