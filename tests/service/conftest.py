"""A server of the body, on a loopback socket, in the engine that all tests share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.service.app import MAX_BODY_BYTES, serving
from adamo_vh.service.hosting import Host, Terms
from adamo_vh.serving.admission import Rules
from adamo_vh.session.lending import Lender, LentWorld
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


@pytest.fixture(scope="module")
def standing_host(
    s1_engine: BuiltinEngine, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Host]:
    """One host for the tests of a module in which nobody plays for long."""
    s1_engine.reset(0)
    engines = Engines(ready={("s1", "mara", 0): Lender(s1_engine)})
    host = Host(tmp_path_factory.mktemp("standing"), SMALL, engines)
    yield host
    host.close_all()


@pytest.fixture(scope="module")
def standing(standing_host: Host) -> Iterator[str]:
    """The address of its server: to start one takes longer than to be refused by it."""
    with serving(standing_host, rules=RULES) as url:
        yield url


@pytest.fixture
def serve(make_host: Callable[..., Host]) -> Iterator[Serve]:
    """Starts a server; gives its address and its sessions."""
    with ExitStack() as stack:

        def start(rules: Rules = RULES, **terms: Any) -> tuple[str, Host]:
            host = make_host(**terms)
            return stack.enter_context(serving(host, rules=rules)), host

        yield start
