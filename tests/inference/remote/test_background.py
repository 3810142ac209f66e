"""Asynchronous work runs on one loop, whoever asks for it."""

from __future__ import annotations

import asyncio
import sys
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

from adamo_vh.inference.remote.background import _loop, run_in_background


async def _here() -> asyncio.AbstractEventLoop:
    return asyncio.get_running_loop()


def test_threads_that_begin_at_once_share_one_loop() -> None:
    """Connections are bound to the loop they were opened on."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for _ in range(20):
            _loop.cache_clear()
            start = Barrier(8)

            def ask(_: int, start: Barrier = start) -> asyncio.AbstractEventLoop:
                start.wait()
                return run_in_background(_here())

            with ThreadPoolExecutor(8) as pool:
                assert len(set(pool.map(ask, range(8)))) == 1
    finally:
        sys.setswitchinterval(interval)


def test_it_can_be_asked_from_within_a_running_loop() -> None:
    async def outside() -> asyncio.AbstractEventLoop:
        return run_in_background(_here())

    assert asyncio.run(outside()) is run_in_background(_here())
