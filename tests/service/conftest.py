"""A server of the body, on a loopback socket, in the engine that all tests share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from adamo_vh.service.app import MAX_BODY_BYTES, serving
from adamo_vh.service.hosting import Host, Terms
from adamo_vh.serving.admission import Rules
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.pooling import Engines

JUDGE = "judge-of-the-tests"
SMALL = Terms(resolution="320x180")
RULES = Rules(MAX_BODY_BYTES, judge_token=JUDGE)
Serve = Callable[..., tuple[str, Host]]


@pytest.fixture
def make_host(lent: LentWorld, tmp_path: Path) -> Iterator[Callable[..., Host]]:
    """Makes hosts of sessions in the engine that is there."""
    with ExitStack() as stack:

        def make(**terms: Any) -> Host:
            engines = Engines(ready={("s1", "mara", 0): lent.lender})
            host = Host(tmp_path / "served", replace(SMALL, **terms), engines)
            stack.callback(host.close_all)
            return host

        yield make


@pytest.fixture
def serve(make_host: Callable[..., Host]) -> Iterator[Serve]:
    """Starts a server; gives its address and its sessions."""
    with ExitStack() as stack:

        def start(rules: Rules = RULES, **terms: Any) -> tuple[str, Host]:
            host = make_host(**terms)
            return stack.enter_context(serving(host, rules=rules)), host

        yield start
