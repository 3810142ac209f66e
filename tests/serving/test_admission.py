"""Who is let in: the rules alone, without a wire."""

from __future__ import annotations

from typing import Any

import pytest

from adamo_vh.serving.admission import Asked, Refusal, Role, Rules, admitted
from adamo_vh.serving.rate import Meter, Rate

OPEN = Rules(1000)
LOCKED = Rules(1000, token="player's", judge_token="judge's", hosts=("lab.example", "10.0.0.7"))


def scope(method: str = "GET", path: str = "/", **headers: str) -> dict[str, Any]:
    sent = {"host": "localhost:8000", **headers}
    pairs = [(k.replace("_", "-").encode(), v.encode()) for k, v in sent.items()]
    return {"method": method, "raw_path": path.encode(), "query_string": b"", "headers": pairs}


def judged(rules: Rules, method: str = "GET", path: str = "/", **headers: str) -> Role | int:
    found = admitted(Asked.of(scope(method, path, **headers)), rules)
    return found.status if isinstance(found, Refusal) else found


@pytest.mark.parametrize("host", ["127.0.0.1", "[::1]:80", "localhost", "LOCALHOST:1", "127.9.9.9"])
def test_this_machine_goes_by_its_own_names(host: str) -> None:
    assert judged(OPEN, host=host) is Role.PLAYER


@pytest.mark.parametrize(
    "host",
    ["evil.example", "localhost.evil.example", "0.0.0.0", "10.0.0.7", "", "[", "x" * 9],
)
def test_other_names_are_not_served(host: str) -> None:
    assert judged(OPEN, host=host) == 403


@pytest.mark.parametrize("host", ["lab.example:8000", "LAB.example", "10.0.0.7", "localhost"])
def test_allowed_names_are_served_with_a_token(host: str) -> None:
    assert judged(LOCKED, host=host, authorization="Bearer player's") is Role.PLAYER
    assert judged(LOCKED, host=host) == 401


@pytest.mark.parametrize(
    ("brought", "role"),
    [
        ("Bearer player's", Role.PLAYER),
        ("Bearer judge's", Role.JUDGE),
        ("Bearer judge's ", 401),
        ("Bearer ", 401),
        ("Basic player's", 401),
        ("Bearer pläyer's", 401),
        ("", 401),
    ],
)
def test_the_token_is_the_role(brought: str, role: Role | int) -> None:
    assert judged(LOCKED, authorization=brought) == role


def test_without_tokens_whatever_is_brought_is_a_players() -> None:
    assert judged(OPEN, authorization="Bearer sk-anything") is Role.PLAYER
    judged_only = Rules(1000, judge_token="judge's")
    assert judged(judged_only) is Role.PLAYER
    assert judged(judged_only, authorization="Bearer sk-anything") == 401


@pytest.mark.parametrize("method", ["POST", "PUT", "PATCH"])
def test_what_carries_a_body_says_what_it_is(method: str) -> None:
    assert judged(OPEN, method) is Role.PLAYER  # It carries nothing.
    for size in ({"content_length": "2"}, {"transfer_encoding": "chunked"}):
        assert judged(OPEN, method, **size) == 415
        assert judged(OPEN, method, content_type="text/plain", **size) == 415
    assert judged(OPEN, method, content_type="Application/JSON; charset=utf-8") is Role.PLAYER


def test_a_larger_size_holds_for_its_path_alone() -> None:
    rules = Rules(10, max_message_bytes=20, roomy={"/engine": 99})
    sizes = [rules.most_bytes(p, message=m) for p in ("/", "/engine") for m in (False, True)]
    assert sizes == [10, 20, 99, 99]


def test_each_address_has_its_own_rate() -> None:
    meter = Meter(Rate(per_s=0.001, burst=2))
    assert [meter.wait_s("a") > 0 for _ in range(3)] == [False, False, True]
    assert meter.wait_s("b") == 0.0
    for number in range(20_000):
        meter.wait_s(str(number))
    assert len(meter._left) == 10_000
    assert Meter(Rate(per_s=0)).wait_s("a") == 0.0
