"""Find out whether a request was refused because of the pictures in it.

Servers say so in any wording, or not at all. What they do tells it: the same request with fewer
pictures is answered, and the whole one is refused once more.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from adamo_vh.errors import ProviderError
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    Part,
    SystemMessage,
    ToolMessage,
    pictures_of,
)
from adamo_vh.inference.model import Reply, Spent
from adamo_vh.inference.remote.faults import is_too_long, picture_fix

_ABOUT_REQUEST = frozenset({400, 404, 415, 422, 500, 501})
"""Statuses that may be about what is in a request; 500 too, as some servers fail over it."""


def count_pictures(messages: Sequence[Message]) -> int:
    """How many pictures a prompt holds."""
    return sum(len(pictures_of(message)) for message in messages)


def may_be_pictures(error: ProviderError) -> bool:
    """Whether pictures may be why a request with some was refused, without that being known."""
    known = error.most_pictures is not None or is_too_long(error.words)
    return error.status in _ABOUT_REQUEST and not known


def with_fewer_pictures(
    ask: Callable[[Sequence[Message]], Reply], messages: Sequence[Message], error: ProviderError
) -> Reply:
    """Ask the same with the newest picture alone, then with none, until that is answered.

    Args:
        ask: Asks once.
        messages: A prompt with pictures.
        error: What became of it.

    Returns:
        Its reply, if it is answered after all.

    Raises:
        ProviderError: It is refused again; names the fix if fewer pictures were answered.
    """
    spent, status = error.spent or Spent(), error.status
    most = min(1, count_pictures(messages) - 1)
    while most >= 0:
        fewer = _once(ask, _fewer(messages, most))
        spent += _spent(fewer)
        if isinstance(fewer, Reply):
            break
        most -= 1
    if most >= 0:
        again = _once(ask, messages)
        spent += _spent(again)
        if isinstance(again, Reply):
            cost, usage = spent.cost_usd, spent.usage
            return replace(again, usage=usage, requests=spent.requests, cost_usd=cost)
        if again.status == status:
            tells = f"{error} With fewer pictures the same is answered. {picture_fix(most)}"
            error = type(error)(tells, status, error.words, most)
    error.spent = spent
    raise error


def _once(
    ask: Callable[[Sequence[Message]], Reply], messages: Sequence[Message]
) -> Reply | ProviderError:
    try:
        return ask(messages)
    except ProviderError as error:
        return error


def _spent(on: Reply | ProviderError) -> Spent:
    return Spent.on(on) if isinstance(on, Reply) else on.spent or Spent()


def _fewer(messages: Sequence[Message], most: int) -> list[Message]:
    """The same prompt with the newest pictures alone."""
    left = count_pictures(messages) - most
    kept: list[Message] = []
    for message in messages:
        if isinstance(message, SystemMessage | AIMessage):
            kept.append(message)
            continue
        gone = min(left, len(pictures_of(message)))
        left -= gone
        if isinstance(message, ToolMessage):
            kept.append(replace(message, images=message.images[gone:]))
            continue
        parts: list[Part] = []
        for part in message.parts:
            if isinstance(part, ImagePart) and gone:
                gone -= 1
            else:
                parts.append(part)
        kept.append(HumanMessage(tuple(parts)))
    return kept
