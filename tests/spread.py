"""Many cases of one kind: some in every run of the tests, all in the long one."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def spread(cases: Iterable[Any], every: int) -> list[Any]:
    """The cases, of which only the first, the last and each so-many-th are quick tests."""
    found = list(cases)
    return [
        case
        if not number % every or number == len(found) - 1
        else pytest.param(case, marks=pytest.mark.slow)
        for number, case in enumerate(found)
    ]
