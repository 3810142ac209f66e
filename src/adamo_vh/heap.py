"""What the C library keeps of memory that is free again: given back, or shared by threads.

It matters where pictures of 25 MB and prompts of 5 MB come and go. Only glibc is told; elsewhere
nothing happens.
"""

from __future__ import annotations

import contextlib
import ctypes

_M_ARENA_MAX = -8
"""Of malloc.h."""
_POOLS = 2


def give_back() -> None:
    """Give free memory back to the system."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL("libc.so.6").malloc_trim(0)


def share_pools() -> None:
    """Let all threads of this process take memory from the same two pools.

    By default each has its own, and each keeps what it once took.
    """
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL("libc.so.6").mallopt(_M_ARENA_MAX, _POOLS)
