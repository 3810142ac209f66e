"""Whatever stands in a run folder, its page shows text: no markup, no hidden characters."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from pathlib import Path
from typing import Any
from unicodedata import category

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.report.test_page import HOSTILE, Page
from tests.run_folder import Recorder, config, played

from adamo_vh.episode.result import EpisodeResult, Manifest, read_manifest, read_result
from adamo_vh.inference.messages import ToolCall
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Ended, Started, Trajectory, read_trajectory
from adamo_vh.report.page import render_page

Run = tuple[Manifest, Trajectory, EpisodeResult | None]

ESCAPE = "\x1b[31m\x9b0m\x1b]0;title\x07\x00\x7f\x85"
TURNED = "\u202eabc\u202c \u2066def\u2069 \u200f\u061c"
UNSEEN = "a\u200bb\u200c\u2060\ufeff\u00ad\U000e0041\u3164"
BROKEN = "\ud800 \udfff \ufffe"
PIECES = (
    HOSTILE,
    ESCAPE,
    TURNED,
    UNSEEN,
    BROKEN,
    "plain words",
    "\r\n\t",
    "z\u0300\u0301\u0302" * 9,
)
OURS = {"type", "frame"}
"""Fields that are no text: the kind of an event, the name of a picture."""


def poisoned(value: Any, text: str) -> Any:
    """The same record with every text in it replaced."""
    if isinstance(value, Enum) or value is None:
        return value
    if is_dataclass(value) and not isinstance(value, type):
        texts = {f.name: getattr(value, f.name) for f in fields(value) if f.name not in OURS}
        return replace(value, **{name: poisoned(item, text) for name, item in texts.items()})
    if isinstance(value, str):
        return text
    if isinstance(value, Mapping):
        return dict((text, poisoned(item, text)) for item in value.values())
    if isinstance(value, list | tuple):
        return type(value)(poisoned(item, text) for item in value)
    return value


def poisoned_page(run: Run, text: str) -> Page:
    manifest, trajectory, result = run
    # Settings that decide how a record is read stay as they are.
    bad = replace(poisoned(manifest, text), config=replace(manifest.config, instruction=text))
    events = Trajectory(tuple(poisoned(event, text) for event in trajectory.events))
    return Page(render_page(bad, events, poisoned(result, text), lambda _: b"", [text]))


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> list[Run]:
    """An episode that was scored, a conversation, and one whose calls could not be read."""
    folders = [tmp_path_factory.mktemp("run") for _ in range(3)]
    played(folders[0])
    talk = Recorder(folders[1], config(None, "First"))
    for said in ("Second", "Third"):
        talk.think("I look.", ToolCall("a", "Look", {"x": "1"}), ToolCall("b", "Pick", None, "{"))
        talk.left_out("Pick", "why not")
        talk.writer.notify(Ended(0, TerminationReason.LOOP, "", talk.world.hash(), 1.0, "so"))
        talk.writer.notify(Started(said, "You are the mind.", talk.world.hash(), "{}"))
        talk.see()
    broken = Recorder(folders[2], config())
    broken.end("ProviderError: gone.", TerminationReason.BROKEN)
    return [(read_manifest(f), read_trajectory(f), read_result(f)) for f in folders]


def assert_harmless(page: Page) -> None:
    hidden = {c for c in page.source if c not in "\n\t" and category(c) in ("Cc", "Cf", "Cs", "Zl")}
    assert hidden == set()
    assert len(page.named("script")) == 1 and len(page.named("style")) == 1
    assert all(image["src"].startswith("data:") for image in page.named("img"))
    for _, attributes in page.tags:
        assert [name for name in attributes if name.startswith("on") or name == "style"] == []
        assert attributes.get("href", "#").startswith("#")
    assert not re.search(r"z[\u0300-\u036f]{5}", page.source)


@pytest.mark.parametrize("text", PIECES)
@pytest.mark.parametrize("number", range(3))
def test_every_text_of_a_record_is_harmless(runs: list[Run], number: int, text: str) -> None:
    assert_harmless(poisoned_page(runs[number], f"x{text}"))


@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck))
@given(
    number=st.integers(0, 2),
    text=st.lists(
        st.sampled_from(PIECES) | st.text(st.characters(), min_size=1, max_size=40),
        min_size=1,
        max_size=4,
    ).map("".join),
)
def test_any_text_gives_the_same_structure(runs: list[Run], number: int, text: str) -> None:
    text = f"x{text}"  # An empty text is left out of the page, with its frame.
    page = poisoned_page(runs[number], text)
    assert_harmless(page)
    tags = {tag for tag, _ in page.tags}
    assert tags <= {tag for tag, _ in poisoned_page(runs[number], "x" * 2000).tags} | {"line"}


def test_hidden_characters_go_and_the_words_stay(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config(None, f"Bring {TURNED}the tape{UNSEEN}"))
    run.think(f"I {ESCAPE}look.\nThen I go on.")
    run.end("日本語 עברית 👩‍👩‍👧 e\u0301")
    frames = (tmp_path / "frames").joinpath
    source = render_page(
        run.manifest, read_trajectory(tmp_path), None, lambda name: frames(name).read_bytes()
    )
    assert_text = Page(source).text
    for words in (
        "Bring abc def the tapeab",
        "I [31m0m]0;title look.\nThen",
        "日本語 עברית 👩‍👩‍👧 e\u0301",
    ):
        assert words in assert_text
