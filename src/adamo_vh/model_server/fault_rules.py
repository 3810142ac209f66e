"""Which requests of a served model go wrong, and how: a TOML file of rules, validated."""

from __future__ import annotations

import random
from collections.abc import Collection
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from pydantic import ConfigDict, Field, TypeAdapter, ValidationError

from adamo_vh.errors import ConfigError, FileError
from adamo_vh.files import read_toml

_STRICT = ConfigDict(extra="forbid")

Seconds = Annotated[float, Field(ge=0, le=3600, allow_inf_nan=False)]
Number = Annotated[int, Field(ge=1)]


class What(StrEnum):
    """What goes wrong."""

    ERROR = "error"
    """An error status instead of an answer."""
    ERROR_IN_200 = "error_in_200"
    """An error body under status 200."""
    REFUSED_PARAMETER = "refused_parameter"
    """Status 400 for each request that has a parameter, naming it."""
    HANG = "hang"
    """No answer for some seconds, then a reset."""
    SLOW = "slow"
    """The answer, some seconds late."""
    RESET = "reset"
    """The connection is reset instead of an answer."""
    HALF_BODY = "half_body"
    """The connection ends in the middle of the answer."""
    BAD_JSON = "bad_json"
    """Status 200 with a body that is no JSON."""
    EMPTY_REPLY = "empty_reply"
    """A completion without text and calls."""
    UNKNOWN_TOOL = "unknown_tool"
    """The call names a tool that does not exist."""
    WRONG_ARGUMENTS = "wrong_arguments"
    """The arguments of the call are JSON, but no tool takes them."""
    BROKEN_ARGUMENTS = "broken_arguments"
    """The arguments of the call are no JSON."""
    TWO_CALLS = "two_calls"
    """The call comes twice in one answer."""
    LEAKED_CALL = "leaked_call"
    """The call is written into the text instead of being made."""


class Style(StrEnum):
    """How a leaked call is written."""

    FENCE = "fence"
    """In a Markdown code fence."""
    TAGS = "tags"
    """In tool_call tags."""
    BARE = "bare"
    """As it is, on a line of its own."""


_OPTIONS: dict[What, tuple[str, ...]] = {
    What.ERROR: ("status", "message", "retry_after_s"),
    What.ERROR_IN_200: ("message",),
    What.REFUSED_PARAMETER: ("parameter", "message"),
    What.HANG: ("seconds",),
    What.SLOW: ("seconds",),
    What.LEAKED_CALL: ("style",),
}
_NEEDED = ("status", "parameter", "seconds")
_WHEN = ("every", "requests", "probability")


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """One kind of fault and the requests that it meets."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    what: What
    every: Number | None = None
    """Every so many requests: 3 meets the third, the sixth, ..."""
    requests: tuple[Number, ...] | None = None
    """These requests; the first has number 1."""
    probability: Annotated[float, Field(ge=0, le=1)] | None = None
    """Each request with this probability, drawn from the seed and the request's number."""
    status: Annotated[int, Field(ge=400, le=599)] | None = None
    message: str | None = None
    """Text of the error; a usual one if left out."""
    retry_after_s: Annotated[int, Field(ge=0, le=3600)] | None = None
    """Value of the header Retry-After, which is in whole seconds."""
    parameter: str | None = None
    """Name of a parameter of the request, e.g. "top_p"; "image_url" means pictures."""
    seconds: Seconds | None = None
    style: Style | None = None
    """A code fence by default."""


@dataclass(frozen=True, slots=True)
class WithoutTools:
    """How a model that is served without tool calling treats what it does not know."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    tools: Literal["refuse", "prose"] = "refuse"
    """Requests with tools get status 400, or an answer in prose that ignores them."""
    schema: Literal["obey", "ignore"] = "obey"
    """Whether the reply is held to a JSON schema that the request brings."""


@dataclass(frozen=True, slots=True)
class Faults:
    """All rules of a served model."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    seed: int = 0
    """Seed of the rules with a probability."""
    fault: tuple[Rule, ...] = ()
    """The rules; the first that meets a request holds."""
    without_tools: WithoutTools = field(default_factory=WithoutTools)

    def __post_init__(self) -> None:
        """Refuse rules whose settings do not belong together."""
        for number, rule in enumerate(self.fault, start=1):
            if problem := _problem(rule):
                raise ConfigError(f"fault {number} ({rule.what}): {problem}")

    def meeting(self, number: int, parameters: Collection[str]) -> Rule | None:
        """The fault of a request; None if it is answered well.

        Args:
            number: The request's number, counted from 1 in the order of arrival.
            parameters: What the request has.
        """
        for at, rule in enumerate(self.fault):
            if rule.parameter is not None and rule.parameter not in parameters:
                continue
            if self._is_due(rule, at, number):
                return rule
        return None

    def _is_due(self, rule: Rule, at: int, number: int) -> bool:
        if rule.every is not None:
            return number % rule.every == 0
        if rule.requests is not None:
            return number in rule.requests
        # Drawn for each number afresh, so that it does not matter which rules were asked before.
        drawn = random.Random(f"{self.seed} {at} {number}").random()
        return rule.probability is not None and drawn < rule.probability


def load_faults(path: str | Path) -> Faults:
    """Read a file of fault rules.

    Args:
        path: The TOML file.

    Raises:
        ConfigError: The file is missing or wrong: names the file, the rule and the fix.
    """
    try:
        data = read_toml(path)
    except FileError as error:
        raise ConfigError(f"Faults {error}") from error
    try:
        return TypeAdapter(Faults).validate_python(data)
    except ValidationError as error:
        raise ConfigError(f"Faults {path}, {_first(error)}") from None
    except ConfigError as error:
        raise ConfigError(f"Faults {path}, {error}") from None


def _problem(rule: Rule) -> str:
    """What is wrong with the settings of a rule; empty if nothing is."""
    if sum(getattr(rule, name) is not None for name in _WHEN) != 1:
        return "give one of every, requests and probability."
    taken = _OPTIONS.get(rule.what, ())
    for name in (*_NEEDED, "message", "retry_after_s", "style"):
        given = getattr(rule, name) is not None
        if given and name not in taken:
            offer = ", ".join(taken) or "no setting of its own"
            return f"{name} does not belong to it; it takes {offer}."
        if not given and name in taken and name in _NEEDED:
            return f"{name} is missing."
    return ""


def _first(error: ValidationError) -> str:
    """The first problem that pydantic found, in the words of the file."""
    first = error.errors()[0]
    words = [f"{p + 1}" if isinstance(p, int) else p for p in first["loc"]]
    place = " ".join(words).replace("fault ", "fault ", 1) or "the file"
    if first["type"] == "unexpected_keyword_argument":
        return f"{place}: there is no such setting."
    return f"{place}: {first['msg']}."
