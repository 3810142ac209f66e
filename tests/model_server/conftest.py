"""What holds for all served models: many clients are made."""

from __future__ import annotations

import pytest


@pytest.fixture(autouse=True, scope="module")
def _one_authority(one_authority: None) -> None:
    """Every client is made quickly."""
