"""Printed words as a further sense: read where the extra is installed, done without elsewhere."""

from __future__ import annotations

import sys

import cv2
import numpy as np
import pytest
from tests.inference.baseline.room import TOOLS, TextRoom

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline import BaselineModel
from adamo_vh.inference.baseline.language.requests import understand
from adamo_vh.inference.baseline.mind.choosing import degree, thing_of
from adamo_vh.inference.baseline.sight.kinds import classify
from adamo_vh.inference.baseline.sight.measures import Sight
from adamo_vh.inference.baseline.sight.printed import PrintReader, installed, named_kinds
from adamo_vh.inference.model import Sampling


@pytest.mark.parametrize(
    ("words", "kind"),
    [
        (("PEANUT", "BUTTER"), "PeanutButter"),
        (("TOMATT", "SOUP"), "TomatoSoup"),
        (("RED", "WINE"), "WineBottle"),
        (("PILLS",), "Pills"),
        (("PAINKILLER",), "Painkiller"),
    ],
)
def test_words_name_kinds_of_things(words, kind):
    named = named_kinds(words)
    assert max(named, key=lambda name: named[name]) == kind


@pytest.mark.parametrize("words", [(), ("",), ("P12",), ("zzz", "qqq")])
def test_other_words_name_nothing(words):
    assert named_kinds(words) == {}


def test_a_name_read_on_a_thing_says_what_it_is():
    bare = Sight(3000, {"grey": 1.0})
    read = Sight(3000, {"grey": 1.0}, words=("PILLS",))
    assert classify("7", 257.0, read)["Pills"] > classify("7", 257.0, bare)["Pills"]
    assert classify("7", 257.0, read)["Pills"] > 0.8


def test_words_are_a_label():
    wish = understand("Put all objects with a printed label on the floor").goals[0].target
    thing = thing_of("7", Vec3(0, 0, 0.8), 500.0)
    plain, printed = Sight(3000, {"red": 1.0}), Sight(3000, {"red": 1.0}, words=("SOUP",))
    assert degree(wish, thing, printed, [thing]) > 0.9
    assert degree(wish, thing, plain, [thing]) < 0.5


@pytest.mark.skipif(not installed(), reason="the extra `ocr` is not installed")
def test_print_is_read_the_same_every_time():
    picture = np.full((90, 200, 3), 240, np.uint8)
    cv2.putText(picture, "TOMATO", (20, 40), 0, 1.0, (20, 20, 20), 2, cv2.LINE_AA)
    cv2.putText(picture, "SOUP", (40, 78), 0, 1.0, (20, 20, 20), 2, cv2.LINE_AA)
    words = PrintReader().words(picture)
    assert "SOUP" in words
    assert words == PrintReader().words(picture)
    assert PrintReader().words(picture[:2]) == ()


def test_without_the_extra_it_goes_on_and_says_so_once(monkeypatch):
    monkeypatch.setitem(sys.modules, "rapidocr", None)
    model, room = BaselineModel(ocr=True), TextRoom("Put the plate on the floor")
    first = model.complete(room.messages(), TOOLS, Sampling()).message
    assert "adamo-vh[ocr]" in first.text
    assert first.calls[0].name == "Pick"
    room.run()
    later = model.complete(room.messages(), TOOLS, Sampling()).message
    assert "adamo-vh[ocr]" not in later.text
    assert BaselineModel(ocr=None).info.name == "baseline"


def test_the_name_tells_the_senses():
    assert BaselineModel().info.name == "baseline"
    assert BaselineModel(ocr=True).info.name == "baseline:ocr"
