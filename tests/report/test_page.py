"""The episode page: whole, self-contained, and deaf to what an untrusted model writes into it."""

from __future__ import annotations

import base64
import hashlib
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from tests.run_folder import Recorder, config, played

from adamo_vh.action import Code, Feedback, Look, Outcome, Pick
from adamo_vh.episode.result import write_record
from adamo_vh.errors import RecordError
from adamo_vh.inference.messages import ToolCall
from adamo_vh.record.run_folder import FRAMES, MANIFEST
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import (
    Acted,
    Observed,
    Trajectory,
    read_trajectory,
)
from adamo_vh.record.writer import TrajectoryWriter
from adamo_vh.report.page import PAGE, render_page, write_page
from adamo_vh.report.timeline import CallText, turns

HOSTILE = "</p></script><script>alert(1)</script><img src=x onerror=alert(2)> \"'{{ 7*7 }}"


class Page(HTMLParser):
    """What a browser makes of a page."""

    def __init__(self, source: str) -> None:
        super().__init__()
        self.source = source
        self.tags: list[tuple[str, dict[str, str]]] = []
        self.texts: list[str] = []
        self.raw: dict[str, list[str]] = {"script": [], "style": []}
        self._open = ""
        self.feed(source)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, {name: value or "" for name, value in attrs}))
        self._open = tag

    def handle_endtag(self, tag: str) -> None:
        self._open = ""

    def handle_data(self, data: str) -> None:
        if self._open in self.raw:
            self.raw[self._open].append(data)
        else:
            self.texts.append(data)

    @property
    def text(self) -> str:
        return "".join(self.texts)

    def named(self, tag: str, class_name: str = "") -> list[dict[str, str]]:
        return [
            attributes
            for name, attributes in self.tags
            if name == tag and (not class_name or class_name in attributes.get("class", "").split())
        ]


def page_of(folder: Path) -> Page:
    return Page(write_page(folder).read_text(encoding="utf-8"))


@pytest.fixture
def full(tmp_path: Path) -> Page:
    played(tmp_path)
    return page_of(tmp_path)


def test_the_page_tells_the_whole_episode(full: Page, tmp_path: Path) -> None:
    trajectory = read_trajectory(tmp_path)
    for thought in trajectory.thoughts:
        assert thought.turn.note in full.text
        assert thought.state_text in full.text
    for act in trajectory.acts:
        assert act.feedback.text in full.text
        assert act.state_hash in full.text
    for word in ("T5", "tabletop", "SEM", "baseline", "rule-based", "1.00", "Tape_4 near"):
        assert word in full.text
    assert "The tape is now next to the indoor plant." in full.text
    assert 'Pick(object="Tape_4")' in full.text
    assert "You are the mind." in full.text


def test_every_step_has_a_card_an_entry_and_a_pose(full: Page) -> None:
    cards = full.named("article", "turn")
    assert [card["data-tone"] for card in cards] == [
        "done", "done", "refused", "done", "corrected", "answer",
    ]  # fmt: skip
    anchors = [card["id"] for card in cards]
    targets = [a["href"] for a in full.named("a") if "data-tone" in a]
    assert targets == [f"#{anchor}" for anchor in anchors]
    assert [pose["data-turn"] for pose in full.named("g", "pose")] == anchors


def test_each_picture_is_in_the_page_once(full: Page, tmp_path: Path) -> None:
    recorded = sorted(path.read_bytes() for path in (tmp_path / FRAMES).iterdir())
    sources = [image["src"] for image in full.named("img")]
    assert all(source.startswith("data:image/jpeg;base64,") for source in sources)
    assert sorted(base64.b64decode(s.partition(",")[2]) for s in sources) == recorded
    assert len(recorded) == 2  # Three views, two of them alike.
    assert all("objects:" in image["alt"] for image in full.named("img"))


def test_turns_without_a_new_picture_point_at_the_one_in_force(full: Page) -> None:
    assert [link["href"] for link in full.named("a", "same")] == [
        "#turn-1", "#turn-3", "#turn-3", "#turn-3",
    ]  # fmt: skip


def test_the_page_is_little_more_than_its_pictures(full: Page, tmp_path: Path) -> None:
    pictures = sum(path.stat().st_size for path in (tmp_path / FRAMES).iterdir())
    assert len(full.source) < pictures * 4 / 3 + 120_000


def test_the_page_needs_nothing_from_outside(full: Page) -> None:
    assert not re.search(r"https?:|url\(|@import|\bfetch\b", full.source)
    for _, attributes in full.tags:
        assert attributes.get("src", "data:").startswith("data:")
        assert attributes.get("href", "#").startswith("#")
    assert full.named("link") == []


def test_the_page_allows_its_own_script_and_style_alone(full: Page) -> None:
    policy = next(m["content"] for m in full.named("meta") if "http-equiv" in m)
    assert "default-src 'none'" in policy
    for kind in ("script", "style"):
        (text,) = full.raw[kind]
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert f"{kind}-src 'sha256-{digest}'" in policy
    assert [a for _, attributes in full.tags for a in attributes if a.startswith("on")] == []
    assert [attributes for _, attributes in full.tags if "style" in attributes] == []


def test_hostile_texts_stay_texts(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config(None, HOSTILE))
    feedback = Feedback(Outcome.REFUSED, HOSTILE, HOSTILE)
    calls = (
        ToolCall("a", HOSTILE, {HOSTILE: HOSTILE}),
        ToolCall("b", "Pick", None, HOSTILE),
    )
    run.think(HOSTILE, *calls)
    run.acted(HOSTILE, {HOSTILE: HOSTILE}, feedback)
    run.end(HOSTILE)
    manifest = replace(run.manifest, model_name=HOSTILE, versions={HOSTILE: HOSTILE})
    named = replace(manifest.initial.objects[0], class_name=HOSTILE, support=HOSTILE)
    world = replace(manifest.initial, objects=(named, *manifest.initial.objects[1:]))
    trajectory = Trajectory(tuple(_with_hostile_tags(e) for e in read_trajectory(tmp_path).events))
    frames = {path.name: path.read_bytes() for path in (tmp_path / FRAMES).iterdir()}

    page = Page(render_page(replace(manifest, initial=world), trajectory, None, frames.__getitem__))

    assert len(page.named("script")) == 1
    assert all(image["src"].startswith("data:") for image in page.named("img"))
    assert [a for _, attributes in page.tags for a in attributes if a.startswith("on")] == []
    assert page.text.count(HOSTILE) >= 12


def _with_hostile_tags(event: Any) -> Any:
    if isinstance(event, Observed):
        objects = (replace(event.objects[0], tag=HOSTILE), *event.objects[1:])
        return replace(event, objects=objects)
    if isinstance(event, Acted):
        return replace(event, agent=replace(event.agent, held=HOSTILE), state_hash=HOSTILE)
    return event


def test_a_killed_run_is_shown_as_not_finished(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config())
    run.act("I look.", Look(0.0, -1.0, 0.8), {"x": 0, "y": -1, "z": 0.8})
    run.think("Now the tape.", ToolCall("c", "Pick", {"object": "Tape_4"}))
    page = page_of(tmp_path)
    assert "Not finished." in page.text
    assert "no feedback was recorded" in page.text
    assert [card["data-tone"] for card in page.named("article")] == ["done", "cut"]


def test_a_run_that_stopped_before_its_first_view_has_a_page(tmp_path: Path) -> None:
    write_record(tmp_path, MANIFEST, Recorder(tmp_path / "other", config()).manifest)
    TrajectoryWriter(tmp_path).close()
    page = page_of(tmp_path)
    assert "Not finished." in page.text
    assert page.named("article") == []


def test_a_view_that_nothing_followed_is_shown(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config())
    run.act("I look.", Look(0.0, -1.0, 0.8), {"x": 0, "y": -1, "z": 0.8})
    run.end("", TerminationReason.STEP_LIMIT)
    page = page_of(tmp_path)
    assert [card["data-tone"] for card in page.named("article")] == ["done", "view"]
    assert "Stopped after 60 steps." in page.text
    assert "0.00" in page.text


def test_a_broken_episode_is_unscored_and_says_why(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config())
    run.end("ProviderError: no answer after 6 tries.", TerminationReason.BROKEN)
    page = page_of(tmp_path)
    assert "Unscored." in page.text
    assert "ProviderError: no answer after 6 tries." in page.text
    assert page.named("div", "figures") == []


def test_a_free_instruction_has_no_score(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config(None, "Wave at me"))
    run.end("I cannot wave.")
    page = page_of(tmp_path)
    assert "A free instruction has no checker." in page.text
    assert page.named("div", "figures") == []


def test_violations_are_listed(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config("T2"))
    run.act("Wrong one.", Pick("37"), {"object": "Glass_37"})
    run.end("Done.")
    assert "Glass_37 was left in the hand" in page_of(tmp_path).text


def test_a_page_can_be_drawn_again(tmp_path: Path) -> None:
    played(tmp_path)
    first = write_page(tmp_path)
    before = first.read_bytes()
    assert write_page(tmp_path) == tmp_path / PAGE
    assert first.read_bytes() == before
    assert list(tmp_path.glob("*.part")) == []


def test_a_lost_picture_is_said_to_be_missing(tmp_path: Path) -> None:
    played(tmp_path)
    for path in (tmp_path / FRAMES).iterdir():
        path.unlink()
    page = page_of(tmp_path)
    assert page.named("img") == []
    assert len(page.named("p", "missing")) == 2


def test_a_frame_name_cannot_lead_out_of_the_folder(tmp_path: Path) -> None:
    run = played(tmp_path)
    events = [
        replace(e, frame="../manifest.json") if isinstance(e, Observed) else e
        for e in read_trajectory(tmp_path).events
    ]
    asked: list[str] = []

    def frames(name: str) -> bytes:
        asked.append(name)
        return b""

    render_page(run.manifest, Trajectory(tuple(events)), None, frames)
    assert asked == []


def test_what_is_no_run_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordError, match=r"manifest\.json is missing"):
        write_page(tmp_path)


def test_a_view_belongs_to_the_turn_that_read_it(tmp_path: Path) -> None:
    played(tmp_path)
    found = turns(read_trajectory(tmp_path))
    assert [turn.label for turn in found] == ["1", "2", "3", "4", "5", ""]
    assert [turn.arrived for turn in found] == [True, False, True, False, True, False]
    assert [turn.view.step for turn in found if turn.view] == [0, 0, 2, 2, 4, 4]
    assert [turn.agent.held for turn in found if turn.agent] == ["Tape_4"] * 4 + [None] * 2


def test_an_empty_message_is_a_turn_of_its_own(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config())
    run.think("")
    run.end("Nothing to do.")
    assert [turn.tone for turn in turns(read_trajectory(tmp_path))] == ["empty", "answer"]


def test_only_the_first_call_of_a_message_counts(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config())
    calls = (ToolCall("a", "Pick", {"object": "4"}), ToolCall("b", "Pick", {"object": "57"}))
    run.think("Two at once.", *calls)
    run.acted("Pick", {"object": "4"}, Feedback(Outcome.DONE, Code.OK, "Done: it is in your hand."))
    run.left_out("Pick", "one action a turn")
    (turn,) = turns(read_trajectory(tmp_path))
    assert [str(deed.call) for deed in turn.deeds] == ['Pick(object="4")', 'Pick(object="57")']
    assert [deed.left_out for deed in turn.deeds] == ["", "one action a turn"]
    assert "Not executed, one action a turn:" in page_of(tmp_path).text


def test_calls_are_spelt_as_the_model_made_them() -> None:
    call = CallText.of("Drop", {"object": "Été_4", "x": 0.1, "y": -1, "deep": [None, True]})
    assert str(call) == 'Drop(object="Été_4", x=0.1, y=-1, deep=[null, true])'
    assert str(CallText.of("Drop", None, '{"object": ')) == 'Drop({"object": )'
