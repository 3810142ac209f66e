"""Long texts are folded where they end well; numbers read as people write them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.report.templating import environment


def folded(text: str) -> tuple[str, str]:
    shown: tuple[str, str] = environment().filters["folded"](text)
    return shown


def printed(template: str, **values: object) -> str:
    return environment().from_string(template).render(**values)


def test_short_texts_are_not_folded() -> None:
    assert folded("A note.") == ("A note.", "")
    assert folded("x" * 600) == ("x" * 600, "")


def test_long_texts_are_folded_at_a_paragraph_a_sentence_or_a_word() -> None:
    words = "word " * 60
    assert folded(f"{words}\n{words}\n{words}")[0] == words.rstrip()
    assert folded(f"{words}end. {words}{words}")[0] == f"{words}end."
    assert folded("word " * 400)[0].endswith("word")
    assert folded("x" * 2000) == ("x" * 420, "x" * 1580)


@given(st.text("ab .\n", max_size=1500))
def test_nothing_but_white_space_is_lost_where_it_is_folded(text: str) -> None:
    shown, rest = folded(text)
    assert (shown + rest).split() == text.split() or "".join((shown + rest).split()) == "".join(
        text.split()
    )
    assert not rest or len(shown) <= 420


def test_what_is_printed_is_readable_and_escaped() -> None:
    assert printed("{{ said }}", said="<b>\x1b[1m\u202eno\n") == "&lt;b&gt;[1mno\n"
    assert printed("{{ said }}", said=["\u200b", 3]) == "[&#39;\\u200b&#39;, 3]"
    assert printed("{{ said }}", said=3) == "3"


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(0.05, "50 ms"), (2.34, "2.3 s"), (200.0, "3 min 20 s"), (float("nan"), "unknown time")],
)
def test_seconds_read_as_people_say_them(seconds: float, words: str) -> None:
    assert printed("{{ s | seconds }}", s=seconds) == words
