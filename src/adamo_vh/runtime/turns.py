"""One call at a time into an engine, from whichever thread it comes."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import wraps
from typing import Any, Concatenate, ParamSpec, Protocol, TypeVar, cast

Turns = threading.RLock
"""Is held during a call; a watcher that is asked within a call may call again."""

_P = ParamSpec("_P")
_T = TypeVar("_T")


class _TakesTurns(Protocol):
    turns: Any


_S = TypeVar("_S", bound=_TakesTurns)


def in_turn(method: Callable[Concatenate[_S, _P], _T]) -> Callable[Concatenate[_S, _P], _T]:
    """Let a method wait until no other thread is in the same engine."""

    @wraps(method)
    def call(self: _S, *args: _P.args, **kwargs: _P.kwargs) -> _T:
        with self.turns:
            return method(self, *args, **kwargs)

    return cast("Callable[Concatenate[_S, _P], _T]", call)
