"""Which decoding settings a request carries: those wished for, less what the server refuses."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from itertools import pairwise
from threading import Lock
from typing import Any

from adamo_vh.inference.model import Sampling
from adamo_vh.inference.remote.exchange import Exchange, sent_settings
from adamo_vh.inference.remote.faults import SEVERAL_SYSTEM, USER_AFTER_TOOL, refused_setting

EXACT = ("temperature", "top_p")
"""Settings that `Sampling.exact` insists on."""

_SEEDED = ("openai-chat", "google")
"""Wires whose requests have a place for a seed."""

_OLD_LIMIT, _NEW_LIMIT = "max_tokens", "max_completion_tokens"


class Settings:
    """The settings of one model's requests, and what its server has refused so far."""

    def __init__(self, wire: str, refused: Iterable[str] = (), seed: int | None = None) -> None:
        """Take over what is known already.

        Args:
            wire: Shape of the requests; see `Connection.wire`.
            refused: Parameters that the server is known to refuse.
            seed: Seed of the draws; None to send none.
        """
        self._seed = seed if wire in _SEEDED else None
        self._has_new_limit = wire == "openai-chat"
        self._refused = frozenset(refused)
        self._lock = Lock()

    @property
    def refused(self) -> frozenset[str]:
        """What the server refused by name."""
        return self._refused

    def wanted(
        self, sampling: Sampling, *, with_tools: bool, several_calls: bool
    ) -> dict[str, Any]:
        """The settings to ask for.

        Args:
            sampling: What is wished for.
            with_tools: Whether tools are on offer.
            several_calls: Whether the model may call several tools in one turn.
        """
        wanted: dict[str, Any] = {
            "temperature": sampling.temperature,
            "top_p": sampling.top_p,
            _OLD_LIMIT: sampling.max_tokens,
        }
        if self._seed is not None:
            wanted["seed"] = self._seed
        if with_tools:
            wanted["parallel_tool_calls"] = several_calls
        if sampling.temperature == 0.0 == sampling.top_p and not sampling.exact:
            # Decoding is greedy without it, and several servers refuse the value.
            del wanted["top_p"]
        insisted = EXACT if sampling.exact else ()
        for name in self._refused & wanted.keys() - {*insisted}:
            del wanted[name]
        if self._has_new_limit and _OLD_LIMIT in self._refused and _NEW_LIMIT not in self._refused:
            wanted["extra_body"] = {_NEW_LIMIT: sampling.max_tokens}
        return wanted

    @property
    def one_system(self) -> bool:
        """Whether system text may only come once, at the start."""
        return SEVERAL_SYSTEM in self._refused

    @property
    def bridged(self) -> bool:
        """Whether what a user says may not follow the results of calls."""
        return USER_AFTER_TOOL in self._refused

    @property
    def reshaped(self) -> tuple[str, ...]:
        """For what refusals the conversation is told in another shape."""
        return tuple(sorted({SEVERAL_SYSTEM, USER_AFTER_TOOL} & self._refused))

    def take_refusal(self, exchange: Exchange, wanted: Collection[str], sampling: Sampling) -> str:
        """Remember what an answer refuses.

        Args:
            exchange: The answer, and what was sent.
            wanted: Names of the settings that were asked for.
            sampling: What was wished for.

        Returns:
            What it refuses, if the next request will go without it; empty if there is nothing to
            leave out.
        """
        name = refused_setting(exchange, _removable(exchange, wanted, sampling))
        if name is None:
            return ""
        names = {name}
        if name == _OLD_LIMIT and _NEW_LIMIT in exchange.sent:
            names.add(_NEW_LIMIT)
        with self._lock:
            self._refused |= names
        return name


def _removable(exchange: Exchange, wanted: Collection[str], sampling: Sampling) -> set[str]:
    """What is in a request and will not be in the next one, if it is refused."""
    asked = {*wanted} | ({_OLD_LIMIT} if "extra_body" in wanted else set())
    # A library may insist on a setting: without it in what was asked for, it cannot be left out.
    found = asked & {*sent_settings(exchange.sent)}
    if sampling.exact:
        found -= {*EXACT}
    roles = [message.get("role") for message in exchange.sent.get("messages", ())]
    found |= {SEVERAL_SYSTEM} if roles.count("system") > 1 else set()
    said_after_results = any(
        role == "tool" and following not in ("tool", "assistant")
        for role, following in pairwise(roles)
    )
    return found | {USER_AFTER_TOOL} if said_after_results else found
