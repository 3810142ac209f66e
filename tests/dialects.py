"""The four wires, as a test server speaks them."""

from __future__ import annotations

from tests.providers.anthropic import Anthropic
from tests.providers.chat import Chat
from tests.providers.dialect import CACHED, INPUT, OUTPUT, REASONING, Dialect, Said, uri
from tests.providers.google import Google
from tests.providers.responses import Responses

__all__ = [
    "CACHED",
    "DIALECTS",
    "INPUT",
    "OUTPUT",
    "REASONING",
    "Anthropic",
    "Chat",
    "Dialect",
    "Google",
    "Responses",
    "Said",
    "uri",
]

DIALECTS: tuple[Dialect, ...] = (Chat(), Responses(), Anthropic(), Google())
