"""What a reader is told: endings, estimates, exchanges, contradictions, the room."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from tests.report.test_floor_plan import furnished
from tests.report.test_page import page_of
from tests.report.test_page_lean import DONE, call, finished, lean, numbers, say
from tests.run_folder import Recorder, config

from adamo_vh.action import Feedback, Outcome
from adamo_vh.episode.result import write_record
from adamo_vh.inference.model import Ending, ModelKind, Usage
from adamo_vh.record.run_folder import MANIFEST
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Ended, Started, read_trajectory
from adamo_vh.report.exchanges import exchanges
from adamo_vh.report.timeline import turns

RESTS = Feedback(Outcome.DONE, "ok", "Done: Tape_4 rests at (1.00, 2.00, 0.50) on the sideboard.")


def answered(run: Recorder, answer: str) -> None:
    run.think("", call("Finish", "That is all.", answer=answer, verified="The feedback says so."))
    reason = TerminationReason.ANSWERED
    run.writer.notify(Ended(run.step, reason, answer, run.world.hash(), 9.0))


def put_away(run: Recorder, answer: str) -> None:
    """The tape is taken and put on the sideboard, and the model answers."""
    run.think("", call("Pick", "I take it.", object="Tape_4"))
    run.world = replace(run.world, body=replace(run.world.body, held=4))
    run.acted("Pick", {"object": "Tape_4"}, DONE)
    run.think("", call("Drop", "I put it down.", object="Tape_4", x=1, y=2, z=0.5))
    run.world = replace(run.world, body=replace(run.world.body, held=None))
    run.acted("Drop", {"object": "Tape_4", "x": 1, "y": 2, "z": 0.5}, RESTS)
    answered(run, answer)


@pytest.mark.parametrize(
    ("ending", "words"),
    [
        (Ending.CUT_OFF, "cut off"),
        (Ending.UNPARSED_CALL, "unparsed call"),
        (Ending.FILTERED, "filtered"),
    ],
)
def test_a_failed_reply_is_called_what_it_is(tmp_path: Path, ending: Ending, words: str) -> None:
    run = lean(tmp_path)
    say(run, note="I", unreadable="ended early.", ending=ending, finish_reason="length")
    finished(run, TerminationReason.PROTOCOL)
    page = page_of(tmp_path)
    assert f"Protocol failure, {words}: the reply ended early." in page.text
    assert f"{words} 1" in page.text
    assert [card["aria-label"] for card in page.named("article")] == [words.capitalize()]
    assert "the provider said length" in page.text


def test_estimated_tokens_are_marked(tmp_path: Path) -> None:
    run = lean(tmp_path)
    say(run, note="Hm.", usage=Usage(900, 20, estimated=True))
    assert numbers(page_of(tmp_path))["tokens are"] == "estimated"
    say(run, note="Hm.", usage=Usage(900, 20))
    page = page_of(tmp_path)
    assert numbers(page)["tokens are"] == "partly estimated"
    assert page.text.count("20 out, estimated") == 1


@pytest.mark.parametrize("kind", list(ModelKind))
def test_nobody_takes_a_player_for_a_vlm(tmp_path: Path, kind: ModelKind) -> None:
    run = lean(tmp_path)
    write_record(tmp_path, MANIFEST, replace(run.manifest, model_kind=kind))
    (mark,) = page_of(tmp_path).named("em", "kind")
    assert kind.value in mark["class"].split()
    text = page_of(tmp_path).text
    assert ("no VLM" in text or "no live model" in text) is (kind is not ModelKind.VLM)


def test_a_reason_in_words_stands_for_the_general_one(tmp_path: Path) -> None:
    run = lean(tmp_path)
    reason = TerminationReason.BUDGET
    run.writer.notify(Ended(0, reason, "", run.world.hash(), 1.0, "Of 500 tokens, 510 are used."))
    page = page_of(tmp_path)
    assert "Of 500 tokens, 510 are used." in page.text
    assert "the budget of the episode is used up" not in page.text


def test_long_notes_are_folded_and_nothing_of_them_is_lost(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config())
    sentences = [f"Sentence number {i} of a long note." for i in range(60)]
    run.think(" ".join(sentences))
    run.end("Done.")
    page = page_of(tmp_path)
    assert len(page.named("details", "rest")) == 1
    assert "Show the rest of the note" in page.text
    for sentence in sentences:
        assert sentence in page.text


def test_an_answer_against_the_feedback_is_flagged_at_the_top_and_in_its_turn(
    tmp_path: Path,
) -> None:
    put_away(lean(tmp_path), "Done: the tape (Tape_4) is on the sofa.")
    page = page_of(tmp_path)
    assert len(page.named("p", "doubt")) == 2
    assert page.text.count("the feedback of step 2 says that Tape_4 is on the sideboard.") == 2


def test_an_honest_answer_is_not_flagged(tmp_path: Path) -> None:
    put_away(lean(tmp_path), "Done: the tape (Tape_4) is on the sideboard.")
    assert page_of(tmp_path).named("p", "doubt") == []


def test_a_conversation_lists_its_exchanges_and_what_moved(tmp_path: Path) -> None:
    run = lean(tmp_path)
    put_away(run, "It is on the sideboard.")
    run.writer.notify(Started("Where is it?", "You are the mind.", run.world.hash(), "{}"))
    run.see()
    answered(run, "The tape is on the floor.")
    found = exchanges(
        turns(read_trajectory(tmp_path)),
        "Bring the tape",
        run.manifest.initial,
        run.config.labeling,
    )
    assert [exchange.steps for exchange in found] == [2, 0]
    assert [len(exchange.moved) for exchange in found] == [1, 0]
    assert [len(exchange.doubts) for exchange in found] == [0, 1]
    page = page_of(tmp_path)
    links = [link["href"] for link in page.named("a", "user")]
    assert links == ["#exchange-1", "#exchange-2"]
    assert [heading["id"] for heading in page.named("h2", "said")] == ["exchange-1", "exchange-2"]
    assert "Tape_4 on the sideboard" in page.text
    assert "nothing moved" in page.text
    assert len(page.named("g", "moved")) == 1


def test_the_page_draws_and_names_the_furniture(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config(), world=furnished())
    run.end("Done.")
    page = page_of(tmp_path)
    kinds = [piece["class"].split()[1] for piece in page.named("polygon", "piece")]
    assert kinds == ["flat", "wall", "standing", "standing", "hanging"]
    assert len(page.named("text", "name")) == 3


def test_headings_go_down_step_by_step(tmp_path: Path) -> None:
    put_away(lean(tmp_path), "Done.")
    levels = [int(tag[1]) for tag, _ in page_of(tmp_path).tags if tag in ("h1", "h2", "h3", "h4")]
    assert levels[0] == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))


def test_all_that_is_seen_has_a_name_for_those_who_do_not_see(tmp_path: Path) -> None:
    put_away(lean(tmp_path), "Done.")
    page = page_of(tmp_path)
    assert all(image["alt"] for image in page.named("img"))
    for button in page.named("button"):
        assert button["aria-label"]
    assert all("aria-label" in svg or "aria-hidden" in svg for svg in page.named("svg"))
