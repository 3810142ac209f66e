"""One event loop in a thread of its own, for the asynchronous client libraries.

A caller may or may not have a running loop (a notebook, a web server), and connections are bound to
the loop they were opened on. A loop that outlives the single call keeps them open between calls.
"""

from __future__ import annotations

import asyncio
import os
import threading
from collections.abc import Coroutine
from functools import cache
from typing import Any, TypeVar

T = TypeVar("T")
_starting = threading.Lock()
"""Threads that ask for the first time at once must get the same loop."""


def run_in_background(work: Coroutine[Any, Any, T]) -> T:
    """Run a coroutine on the background loop and wait for it.

    An interrupt of the waiting thread cancels the work.
    """
    with _starting:
        loop = _loop(os.getpid())
    future = asyncio.run_coroutine_threadsafe(work, loop)
    try:
        return future.result()
    except BaseException:
        future.cancel()
        raise


@cache
def _loop(pid: int) -> asyncio.AbstractEventLoop:
    """The loop of this process: a forked child has no threads of its parent and starts its own."""
    loop = asyncio.new_event_loop()
    threading.Thread(target=loop.run_forever, name=f"adamo-vh-inference-{pid}", daemon=True).start()
    return loop
