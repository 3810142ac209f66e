"""What an engine may lack is declared, and told in sentences."""

from __future__ import annotations

from dataclasses import fields

import pytest

from adamo_vh.abilities import Abilities, abilities


def test_an_engine_that_says_nothing_can_do_all() -> None:
    assert abilities(object()) == Abilities()
    assert Abilities().lacking() == ()


def test_only_what_is_of_the_kind_counts_as_said() -> None:
    class Odd:
        abilities = "many"

    class Plain:
        abilities = Abilities(events=False)

    assert abilities(Odd()) == Abilities()
    assert abilities(Plain()) == Abilities(events=False)


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("ids", "boxes of pixels"),
        ("closeup", "no close-ups"),
        ("snapshot", "nothing can go on from the middle"),
        ("events", "but by its body"),
        ("deterministic", "a replay may differ"),
    ],
)
def test_each_lack_is_one_sentence(name: str, told: str) -> None:
    (sentence,) = Abilities(**{name: False}).lacking()
    assert told in sentence
    assert len(Abilities(**{item.name: False for item in fields(Abilities)}).lacking()) == 5
