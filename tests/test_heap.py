"""Memory that is free again goes back to the system, and threads share what is kept."""

import platform
import threading
from pathlib import Path

import pytest

from adamo_vh.heap import give_back, share_pools

pytestmark = pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="only glibc is told")


def resident_mb() -> float:
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096 / 1e6


def test_what_is_free_between_what_is_kept_goes_back() -> None:
    blocks = [b"x" * (100_000 + n) for n in range(1000)]
    pins = blocks[::50]
    del blocks
    before = resident_mb()
    give_back()
    assert resident_mb() < before - 50
    assert len(pins) == 20


def test_threads_go_on_with_few_pools() -> None:
    share_pools()
    sizes: list[int] = []
    threads = [
        threading.Thread(target=lambda n=n: sizes.append(len(bytes(n * 100_000))))
        for n in range(20)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(sizes) == [n * 100_000 for n in range(20)]
