"""Keep keys out of every message that people or files may see."""

from __future__ import annotations

import os
import re

_NAMES = re.compile(r"KEY|TOKEN|SECRET|PASSWORD|CREDENTIAL", re.IGNORECASE)
_SHORTEST = 6
"""Shorter values are no keys, and redacting them would mangle ordinary words."""

_SHAPES = re.compile(
    r"\b[rs]k-[\w*.\-]{4,}|\bAIza[\w*.\-]{4,}|\bya29\.[\w*.\-]{4,}|\bBearer\s+[^\s'\"]+"
)
"""What keys look like, also masked ones: servers quote part of a wrong key in their errors."""


def redacted(text: str) -> str:
    """The text with every key of the environment, and all that looks like one, blacked out."""
    secrets = [
        value
        for name, value in os.environ.items()
        if _NAMES.search(name) and len(value) >= _SHORTEST
    ]
    for secret in sorted(secrets, key=len, reverse=True):
        text = text.replace(secret, "[key]")
    return _SHAPES.sub("[key]", text)
