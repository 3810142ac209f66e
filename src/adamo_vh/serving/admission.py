"""Who may come in, and with how much: what a request must keep to, judged before anybody reads it.

A server on a loopback address is not safe from the web: a page in the user's own browser can send
requests to it, and a name of the page's own can be pointed at it. So a request must name this
machine as its host, come from no other page, say what it carries, and keep to sizes and a rate.
"""

from __future__ import annotations

import hmac
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs, urlsplit

from adamo_vh.serving.loopback import is_loopback
from adamo_vh.serving.rate import Rate

TOKEN_VARIABLE = "ADAMO_VH_TOKEN"
"""Environment variable with what players, agents and engines bring, or must bring."""
JUDGE_VARIABLE = "ADAMO_VH_JUDGE_TOKEN"
"""The same for a judge."""
COOKIE = "adamo_token"
"""Name of the cookie in which a browser brings the token."""
WITH_BODY = ("POST", "PUT", "PATCH")
_MAX_TARGET_BYTES = 8_000
_MAX_HEADERS = 100
_MAX_HEADER_BYTES = 32_000


class Role(StrEnum):
    """What somebody who was let in may ask for."""

    PLAYER = "player"
    """Views, text and feedback."""
    JUDGE = "judge"
    """The state of the world, scores and results as well."""


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why a request is not let in."""

    status: int
    text: str
    after_s: int = 0
    """When to ask again; 0 for no promise."""


@dataclass(frozen=True, slots=True)
class Rules:
    """What a request must keep to."""

    max_body_bytes: int
    content_types: tuple[str, ...] = ("application/json",)
    """What a request with a body may carry."""
    token: str = ""
    """What each request must bring as its bearer token; empty for none."""
    too_large: str = "send less at once."
    """What helps against a body that is too large."""
    judge_token: str = ""
    """What a judge brings as his bearer token, in place of the other; empty for no judge."""
    hosts: tuple[str, ...] = ()
    """Names and addresses, beside those of the loopback, that a request may call this machine."""
    rate: Rate = field(default=Rate())
    """How many requests and messages one address may send."""
    max_message_bytes: int = 1_000_000
    """Of a WebSocket."""
    roomy: Mapping[str, int] = field(default_factory=dict)
    """Larger bodies and messages, by the path that they are for."""
    browsed: str = ""
    """The path under which a browser, which can send no header of its own, may bring the token: as
    a cookie, or once in the address of the page itself. Empty for none."""

    def most_bytes(self, path: str, *, message: bool) -> int:
        """How large a body, or a message of a WebSocket, may be."""
        return self.roomy.get(path, self.max_message_bytes if message else self.max_body_bytes)


@dataclass(frozen=True, slots=True)
class Asked:
    """A request as it is judged: its scope, read once."""

    method: str
    """Empty for a WebSocket."""
    headers: Mapping[str, str]
    target_bytes: int
    header_count: int
    header_bytes: int
    path: str = ""
    query: str = ""

    @property
    def has_body(self) -> bool:
        """Whether it says that it carries something."""
        return "transfer-encoding" in self.headers or self.headers.get("content-length", "0") != "0"

    @classmethod
    def of(cls, scope: Mapping[str, Any]) -> Asked:
        """Read the scope of ASGI."""
        pairs = [(n.decode("latin-1").lower(), v.decode("latin-1")) for n, v in scope["headers"]]
        target = len(scope.get("raw_path") or b"") + len(scope.get("query_string") or b"")
        size = sum(len(name) + len(value) for name, value in pairs)
        query = (scope.get("query_string") or b"").decode("latin-1")
        path = str(scope.get("path", ""))
        return cls(scope.get("method", ""), dict(pairs), target, len(pairs), size, path, query)


def admitted(asked: Asked, rules: Rules) -> Role | Refusal:
    """As what a request is let in, or why it is not."""
    return (
        _too_long(asked)
        or _foreign(asked, rules)
        or _shapeless(asked, rules)
        or _role(asked, rules)
    )


def _too_long(asked: Asked) -> Refusal | None:
    if asked.target_bytes > _MAX_TARGET_BYTES:
        return Refusal(
            414, f"The address has more than {_MAX_TARGET_BYTES} bytes; send less in it."
        )
    if asked.header_count > _MAX_HEADERS or asked.header_bytes > _MAX_HEADER_BYTES:
        most = f"{_MAX_HEADERS} headers or {_MAX_HEADER_BYTES} bytes"
        return Refusal(431, f"The request has more than {most} of headers; send fewer.")
    return None


def _foreign(asked: Asked, rules: Rules) -> Refusal | None:
    host = asked.headers.get("host", "")
    name = _host_name(host)
    if not (is_loopback(name) or name in {own.lower() for own in rules.hosts}):
        offer = " or ".join(("127.0.0.1", "localhost", *rules.hosts))
        return Refusal(403, f"{host[:200]!r} is not served here; use {offer}.")
    origin, site = asked.headers.get("origin"), asked.headers.get("sec-fetch-site", "none")
    if origin is not None and origin not in (f"http://{host}", f"https://{host}"):
        return Refusal(403, f"Pages of {origin[:200]} may not ask here; ask without a browser.")
    if site not in ("none", "same-origin"):
        return Refusal(403, "Pages of other sites may not ask here; ask without a browser.")
    return None


def _shapeless(asked: Asked, rules: Rules) -> Refusal | None:
    if asked.method in WITH_BODY and asked.has_body:
        kind = asked.headers.get("content-type", "").partition(";")[0].strip().lower()
        if kind not in rules.content_types:
            offer = " or ".join(rules.content_types)
            return Refusal(415, f"The content type is {kind[:80] or 'missing'!r}; send {offer}.")
    return None


def _role(asked: Asked, rules: Rules) -> Role | Refusal:
    brought = _brought(asked, rules).encode("latin-1", "replace")
    is_judge, is_player = (
        bool(token) and hmac.compare_digest(brought, token.encode())
        for token in (rules.judge_token, rules.token)
    )
    if is_judge:
        return Role.JUDGE
    # Where players need no token, one that is brought all the same is a judge's who mistypes his.
    if not is_player and (rules.token or (rules.judge_token and brought)):
        return Refusal(401, "The token is missing or wrong; send it as bearer token.")
    return Role.PLAYER


def _brought(asked: Asked, rules: Rules) -> str:
    """The token that a request brings; empty for none."""
    if header := asked.headers.get("authorization", ""):
        return header.removeprefix("Bearer ")
    root = rules.browsed
    if not root or not (asked.path == root or asked.path.startswith(f"{root}/")):
        return ""
    if asked.path == f"{root}/" and (told := parse_qs(asked.query).get("token")):
        return told[0]
    try:
        kept = SimpleCookie(asked.headers.get("cookie", "")).get(COOKIE)
    except CookieError:
        return ""
    return kept.value if kept else ""


def _host_name(host: str) -> str:
    try:
        return urlsplit(f"//{host}").hostname or ""
    except ValueError:
        return ""
