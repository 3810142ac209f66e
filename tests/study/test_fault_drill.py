"""A small fault drill: real processes, killed at random moments."""

from __future__ import annotations

from pathlib import Path

import pytest
from benchmarks.fault_drill import drill


@pytest.mark.slow
def test_nothing_is_lost_doubled_or_reported_otherwise(tmp_path: Path) -> None:
    found = drill(tmp_path, kills=5, workers=2, episodes=8, seed=3)
    assert sum(found["kills"].values()) >= 5
    assert (found["lost"], found["doubled"], found["reports_that_differ"]) == (0, 0, 0)
