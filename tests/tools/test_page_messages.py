"""The messages that the page's tests read are those that the server tells today."""

from __future__ import annotations

from typing import get_args

from tools.page_messages import FILE, events, text

from adamo_vh.engine import WorldEvent
from adamo_vh.record.trajectory import Event, Happened, Stood


def test_the_kept_messages_are_those_of_the_server() -> None:
    assert FILE.read_text(encoding="utf-8") == text(), "run: python -m tools.page_messages"


def test_every_kind_that_a_page_is_told_is_among_them() -> None:
    # Stood is for the checker, and never told.
    assert {type(event) for event in events()} == set(get_args(Event)) - {Stood}
    happened = {type(event.event) for event in events() if isinstance(event, Happened)}
    assert happened == set(get_args(WorldEvent))
