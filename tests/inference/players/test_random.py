"""The random player draws valid calls only, the same ones every time, and ends some day."""

from __future__ import annotations

from collections import Counter

import pytest
from tests.inference.baseline.room import FINISH, TOOLS, LeanRoom, TextRoom, with_notes

from adamo_vh.action import Drop, Look, Pick, Walk, parse
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    Message,
    SystemMessage,
    TextPart,
    ToolMessage,
)
from adamo_vh.inference.model import ModelKind, Sampling
from adamo_vh.inference.players.random import END_CHANCE, RandomModel

LEAN = [with_notes(tool) for tool in (*TOOLS, FINISH)]


def draw(messages: list[Message], seed: int, tools=TOOLS) -> AIMessage:
    return RandomModel(seed).complete(messages, tools, Sampling()).message


def test_its_name_is_its_uri():
    assert (RandomModel().info.name, RandomModel(7).info.name) == ("random", "random:7")
    assert RandomModel().info.kind is ModelKind.RANDOM


def test_seed_and_messages_decide():
    messages = TextRoom("Pick the plate").messages()
    assert draw(messages, 3) == draw(messages, 3)
    assert len({str(draw(messages, seed)) for seed in range(20)}) > 15


def test_tools_are_drawn_evenly():
    messages = TextRoom("Pick the plate").messages()
    names = Counter(draw(messages, seed).calls[0].name for seed in range(600))
    assert set(names) == {"Look", "Walk", "Pick"}
    assert min(names.values()) > 150


@pytest.mark.parametrize("full", [True, False])
def test_what_is_held_can_be_dropped_and_nothing_else_picked(full):
    room = TextRoom("Pick the plate", full=full).run()
    names = Counter(
        message.calls[0].name
        for seed in range(300)
        if (message := draw(room.messages(), seed)).calls
    )
    assert set(names) == {"Look", "Walk", "Drop"}


def test_every_call_is_valid_and_every_note_is_there():
    room = TextRoom("Pick the plate")
    for seed in range(100):
        message = draw(room.messages(), seed)
        call = message.calls[0]
        assert message.text
        action = parse(call.name, call.arguments, (Look, Walk, Pick, Drop))
        if isinstance(action, Look | Walk):
            assert -3 <= action.x <= 3
            assert -5 <= action.y <= 3


def test_it_ends_with_the_documented_chance():
    room = TextRoom("Pick the plate").run()
    ends = sum(not draw(room.messages(), seed).calls for seed in range(1000))
    assert ends / 1000 == pytest.approx(END_CHANCE, abs=0.025)
    begin = TextRoom("Pick the plate").messages()
    assert all(draw(begin, seed).calls for seed in range(200))


def test_the_lean_layout_gets_its_arguments():
    room = LeanRoom("Pick the plate").run()
    names = set()
    for seed in range(300):
        message = draw(room.messages(), seed, LEAN)
        arguments = dict(message.calls[0].arguments or {})
        names.add(message.calls[0].name)
        assert arguments.pop("note")
        assert 0 <= arguments.pop("confidence") <= 1
        assert message.text == ""
    assert names == {"Look", "Walk", "Drop", "Finish"}


def test_without_anything_to_do_it_ends():
    message = RandomModel().complete([], [], Sampling()).message
    assert message.text
    assert not message.calls


def test_odd_messages_do_not_stop_it():
    messages: list[Message] = [
        SystemMessage("?"),
        HumanMessage((TextPart(""),)),
        AIMessage("x"),
        ToolMessage("1", "Wave", ""),
    ]
    assert draw(messages, 1).calls[0].name in ("Look", "Walk")
