"""Acts that move no thing: looking, turning and walking, and those that the body cannot do."""

from __future__ import annotations

import pytest
from tests.inference.baseline.meaning import read

from adamo_vh.inference.baseline.language.acts import read_act
from adamo_vh.inference.baseline.language.requests import understand

LOOKS = {
    "Look left": "look left",
    "Turn your head to the left": "look left",
    "Look behind you": "look back",
    "Turn around": "look back",
    "Look around": "look round",
    "Look up at the ceiling": "look up",
    "Look at the floor": "look down",
    "Look straight ahead": "look ahead",
    "Look at the plate": "look Plate",
    "Turn to the plant": "look IndoorPlant",
    "Examine the key": "look Key",
}

WALKS = {
    "Walk forward two steps": "walk ahead 1.2",
    "Take one step to the left": "walk left 0.6",
    "Take two steps back": "walk back 1.2",
    "Walk forward 1 m": "walk ahead 1",
    "Go to the middle of the room": "walk middle 1",
    "Walk to the nearest corner": "walk corner 1",
    "Go to the plate": "walk Plate",
    "Come back": "walk start 1",
    "Return to where you started": "walk start 1",
}

NEVER = {
    "Come here": "where you are",
    "Follow me": "where you are",
    "Look out of the window": "window",
    "Turn on the flashlight": "switch",
    "Flip the plate over": "switch",
    "Go to the sofa": "sofa",
}


@pytest.mark.parametrize(("text", "act"), {**LOOKS, **WALKS}.items())
def test_acts_are_read(text, act):
    assert read(text) == [f"! {act}"]


@pytest.mark.parametrize(("text", "why"), NEVER.items())
def test_what_the_body_cannot_do_is_refused_and_named(text, why):
    plan = understand(text)
    assert why in plan.problem
    assert not plan.acts


@pytest.mark.parametrize("text", ["put the cup on the floor", "the plate", "left of the plate"])
def test_wishes_are_no_acts(text):
    assert read_act(text, ()) is None


def test_several_acts_keep_their_order():
    assert read("Look left, then look at the plate, then come back") == [
        "! look left", "! look Plate", "! walk start 1"]  # fmt: skip
