"""What people read steers no terminal and hides nothing."""

from __future__ import annotations

import sys
from unicodedata import category

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.readable import encodable, readable

HOSTILE = {
    "colour": "a\x1b[31mb",
    "title": "a\x1b]0;owned\x07b",
    "link": "a\x1b]8;;http://evil\x1b\\b",
    "C1": "a\x9b31mb\x85c",
    "bell and backspace": "a\x07\x08\x7fb",
    "bidi override": "a\u202egnp.exe\u202c",
    "bidi isolate": "a\u2066b\u2069",
    "bidi mark": "a\u200e\u200f\u061cb",
    "zero width": "a\u200b\u200c\u2060\ufeffb",
    "joiner between letters": "a\u200db",
    "tags": "a\U000e0041\U000e007fb",
    "selectors": "a\U000e0100\ufe00b",
    "fillers": "a\u3164\u115f\uffa0b",
    "soft hyphen": "a\xadb",
    "surrogate": "a\ud800b",
    "no character": "a\uffff\ufdd0b",
}


@pytest.mark.parametrize("name", HOSTILE)
def test_nothing_hostile_is_left(name: str) -> None:
    shown = readable(HOSTILE[name])
    assert shown.startswith("a") and ("b" in shown or "exe" in shown)
    assert not any(
        category(c) in ("Cc", "Cf", "Cs", "Cn") or c in "\u3164\u115f\uffa0" for c in shown
    )


@pytest.mark.parametrize(
    "text",
    [
        "plain",
        "拿起盘子",
        "نص عربي",
        "עברית",
        "हिन्दी",
        "e\u0301",
        "👨\u200d👩\u200d👧",
        "🏳️\u200d🌈",
        "❤️",
        "a–b×c",
        "",
    ],
)
def test_every_language_and_picture_stays(text: str) -> None:
    assert readable(text) == text


def test_a_line_is_one_line_unless_lines_are_wanted() -> None:
    assert readable("a\r\nb\tc\rd\u2028e") == "a b c d e"
    assert readable("a\r\nb\tc\rd\u2028e", lines=True) == "a\nb\tc d e"


def test_marks_do_not_pile_up() -> None:
    assert len(readable("Z" + "\u0351" * 500)) == 5


@given(st.text(st.characters()))
def test_it_holds_for_every_text(text: str) -> None:
    shown = readable(text)
    assert readable(shown) == shown
    assert not any(category(c) in ("Cc", "Cs", "Zl", "Zp") for c in shown)
    shown.encode("utf-8")


def test_no_invisible_format_is_forgotten() -> None:
    """All formats of Unicode, but the few that are seen: number signs above digits."""
    seen = set("\u0600\u0601\u0602\u0603\u0604\u0605\u06dd\u08e2\u0890\u0891\U000110bd\U000110cd")
    formats = {c for c in map(chr, range(sys.maxunicode + 1)) if category(c) == "Cf"} - seen
    left = {c for c in formats if readable(f"a{c}b") != "ab"}
    assert {hex(ord(c)) for c in left if not 0x13430 <= ord(c) <= 0x1343F} == set()


def test_a_lone_surrogate_is_made_encodable() -> None:
    assert encodable("a\ud800b é") == "a?b é"
