"""Is an error an answer to a question of the probe: does the server refuse what was asked of it?

Only what is about the feature is an answer. A server that is down, busy, out of credit or too slow
says nothing about what its model can do.
"""

from __future__ import annotations

import re
from enum import StrEnum

from adamo_vh.errors import ProviderError

_NO_ANSWER = frozenset({401, 402, 403, 407, 408, 409, 413, 425, 429, 502, 503, 504, 529})
"""Statuses that are about the key, the account or the load, whatever the words."""

_VAGUE = re.compile(
    r"(?:bad request|invalid request|unprocessable (?:entity|content)|not (?:implemented|supported)"
    r"|unsupported|no message|error|invalid|http|status|code|media type|[\W\d_])*",
    re.IGNORECASE,
)
"""Words that say nothing; then the status must do."""


class Feature(StrEnum):
    """What a question of the probe is about."""

    TOOLS = "tool calls"
    PICTURES = "pictures"
    SCHEMA = "JSON schema"


_WORDS = {
    Feature.TOOLS: re.compile(r"tool|function", re.IGNORECASE),
    Feature.PICTURES: re.compile(
        r"image|picture|vision|visual|multi-?modal|modalit|mmproj|content (?:type|part|block)"
        r"|valid string|must be a string|should be a valid string",
        re.IGNORECASE,
    ),
    Feature.SCHEMA: re.compile(
        r"response_?format|response_?schema|json|schema|grammar|structured|guided|output_config",
        re.IGNORECASE,
    ),
}
_FOR_A_WHILE = re.compile(
    r"overload|time[d -]?out|temporar|try again|unavailable|too many|rate limit|out of memory"
    r"|capacity|quota|billing|credit|context|too (?:large|long|big)|polic|safety|loading",
    re.IGNORECASE,
)
"""What passes, or is about this one request."""


def refuses(feature: Feature, error: ProviderError) -> bool:
    """Whether an error says that the server does not take a feature.

    Args:
        feature: What the request had and another one, which was answered, had not.
        error: What came of it.
    """
    status, words = error.status, error.words
    if status is None or status < 400 or status in _NO_ANSWER or _FOR_A_WHILE.search(words):
        return False
    if _WORDS[feature].search(words):
        return True
    return status in (400, 415, 422, 501) and _VAGUE.fullmatch(words) is not None
