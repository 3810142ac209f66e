"""The episode page under the profile `lean`: plans, notes in arguments, close-ups, Finish."""

from __future__ import annotations

import base64
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from tests.report.test_page import HOSTILE, Page, page_of
from tests.run_folder import Recorder, config
from tests.tabletop import carried_out

from adamo_vh.action import Code, Feedback, Look, Outcome
from adamo_vh.cognition.budget import Budget
from adamo_vh.cognition.profile import PROFILES
from adamo_vh.cognition.turns import read_turn
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Reply, Rung, Usage
from adamo_vh.observation import Frame
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Ended, Started, Thought, read_trajectory, shown
from adamo_vh.report.timeline import ShownTurn, turns

LEAN = PROFILES["lean"]
DONE = Feedback(Outcome.DONE, Code.OK, "Done: so it is.")
REFUSED = Feedback(Outcome.REFUSED, Code.UNKNOWN_TAG, "Refused: no such object.")
CLOSEUP = Frame(b"a close-up", "image/png", 512, 400)


def lean(folder: Path, **settings: Any) -> Recorder:
    return Recorder(folder, replace(config(None, "Bring the tape"), profile=LEAN, **settings))


def call(name: str, note: str, confidence: float = 0.9, **arguments: Any) -> ToolCall:
    wish = {"note": note, "confidence": confidence, **arguments}
    return ToolCall(f"{name}-{note}", name, wish)


def finish(answer: str, confidence: float = 0.9) -> ToolCall:
    said = {"asked": "The tape.", "verified": "I hold Tape_4.", "unseen": "The shelf."}
    return call("Finish", "That is all.", confidence, **said, answer=answer)


def say(run: Recorder, **fields: Any) -> None:
    """The model answers in a way that `Recorder.think` does not know."""
    message = AIMessage(fields.pop("note", ""), fields.pop("calls", ()))
    reply = Reply(message, seconds=1.0, **fields)
    run.calls = [call.id for call in message.calls]
    run.writer.notify(Thought(run.step, "state", 3, read_turn(reply, run.config.profile)))


def show(run: Recorder, frame: Frame = CLOSEUP) -> None:
    run.writer.notify(shown(run.step, frame), frame)


def finished(run: Recorder, reason: TerminationReason = TerminationReason.ANSWERED) -> None:
    run.writer.notify(Ended(run.step, reason, "Here it is.", run.world.hash(), 9.0))


def lean_turns(run: Recorder) -> tuple[ShownTurn, ...]:
    return turns(read_trajectory(run.folder))


def test_a_plan_is_one_turn_with_every_call_and_its_feedback(tmp_path: Path) -> None:
    run = lean(tmp_path)
    run.think(
        "", call("Pick", "I take it.", object="Tape_4"), call("Walk", "I take it.", x=1, y=1, z=0)
    )
    run.acted("Pick", {"object": "Tape_4"}, DONE)
    run.acted("Walk", {"x": 1, "y": 1, "z": 0}, replace(DONE, text="Done: walked."))
    finished(run)
    (turn,) = lean_turns(run)
    assert (turn.label, turn.tone, turn.title) == ("1–2", "done", "Pick, Walk")
    page = page_of(tmp_path)
    for words in ('Pick(object="Tape_4")', "Walk(x=1, y=1, z=0)", "so it is", "walked."):
        assert words in page.text
    assert "Not executed" not in page.text
    assert [card["aria-label"] for card in page.named("article")] == ["Steps 1–2"]


def test_a_note_is_said_once_and_never_inside_the_call(tmp_path: Path) -> None:
    run = lean(tmp_path)
    same = [call("Look", "I search the shelf.", 0.75, x=x, y=0, z=0) for x in (0, 1)]
    run.think("", *same, call("Look", "And the corner.", x=2, y=0, z=0))
    for x in range(3):
        run.acted("Look", {"x": x, "y": 0, "z": 0}, DONE)
    page = page_of(tmp_path)
    assert page.text.count("I search the shelf.") == 1
    assert page.text.count("And the corner.") == 1
    assert page.text.count("confidence 0.75") == 2
    assert "note=" not in page.text
    assert "confidence=" not in page.text


def test_without_the_switch_a_note_argument_is_an_argument(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config())
    run.think("I look.", ToolCall("c", "Look", {"note": "odd"}))
    run.acted("Look", {"note": "odd"}, REFUSED)
    assert 'Look(note="odd")' in page_of(tmp_path).text


def test_calls_that_were_left_out_say_why(tmp_path: Path) -> None:
    run = lean(tmp_path)
    picks = [call("Pick", f"n{i}", object=f"A_{i}") for i in range(2)]
    run.think("", picks[0], finish("Done."), picks[1])
    run.acted("Pick", {"object": "A_0"}, DONE)
    run.left_out("Finish", "Finish comes alone")
    run.left_out("Pick", "an earlier call did not go as planned")
    run.think("", *picks)
    run.acted("Pick", {"object": "A_0"}, DONE)
    run.left_out("Pick", "the step limit is reached")
    finished(run, TerminationReason.STEP_LIMIT)
    assert [[deed.left_out for deed in turn.deeds] for turn in lean_turns(run)] == [
        ["", "Finish comes alone", "an earlier call did not go as planned"],
        ["", "the step limit is reached"],
    ]
    assert "Not executed, the step limit is reached:" in page_of(tmp_path).text


def test_a_plan_that_a_kill_cut_off_gives_no_reasons(tmp_path: Path) -> None:
    run = lean(tmp_path)
    run.think("", *(call("Look", "n", x=x, y=0, z=0) for x in range(2)))
    run.acted("Look", {"x": 0, "y": 0, "z": 0}, DONE)
    (turn,) = lean_turns(run)
    assert [deed.tone for deed in turn.deeds] == ["done", "cut"]
    assert "no feedback was recorded" in page_of(tmp_path).text


def test_a_doubted_pick_shows_the_close_up_in_its_place(tmp_path: Path) -> None:
    run = lean(tmp_path)
    run.think("", call("Pick", "Perhaps this.", 0.3, object="Tape_4"))
    run.acted("Inspect", {"object": "Tape_4"}, DONE)
    show(run)
    run.think("", call("Inspect", "Once more.", object="Tape_4"))
    run.acted("Inspect", {"object": "Tape_4"}, DONE)
    show(run)
    first, second = lean_turns(run)
    assert (first.tone, first.title) == ("doubted", 'Pick(object="Tape_4")')
    assert (second.tone, second.deeds[0].is_doubted) == ("done", False)
    page = page_of(tmp_path)
    assert "Not executed: the model was not sure enough." in page.text
    data = base64.b64encode(CLOSEUP.data).decode()
    (image,) = (image for image in page.named("img") if image["src"].endswith(data))
    assert [a["data-picture"] for a in page.named("a", "closeup")] == [image["id"]]


def test_a_view_that_did_not_last_stands_with_its_call(tmp_path: Path) -> None:
    run = lean(tmp_path)
    spots = [{"x": 0.33, "y": -1.35, "z": 0.95}, {"x": -1.0, "y": 0.4, "z": 0.2}]
    run.think("", *(call("Look", "I search.", **spot) for spot in spots))
    for spot in spots:
        run.world = carried_out(run.world, Look(**spot))
        run.acted("Look", spot, DONE)
        run.see()
    run.think("", finish("Nothing there."))
    finished(run)
    search, answer = lean_turns(run)
    assert [len(deed.pictures) for deed in search.deeds] == [1, 0]
    assert answer.arrived and answer.view and answer.view.step == 2
    assert len(page_of(tmp_path).named("img")) == 3


def test_finish_is_the_answer_and_tells_what_was_verified(tmp_path: Path) -> None:
    run = lean(tmp_path)
    run.think("", finish("Here it is."))
    finished(run)
    (turn,) = lean_turns(run)
    assert (turn.tone, turn.deeds, turn.label) == ("answer", (), "")
    page = page_of(tmp_path)
    for words in ("Here it is.", "I hold Tape_4.", "The shelf.", "That is all."):
        assert words in page.text
    assert "Finish(" not in page.text


def test_an_end_that_was_not_accepted_is_sent_back(tmp_path: Path) -> None:
    run = lean(tmp_path)
    run.think("The tape is there.")
    run.think("", finish("It should be there.", 0.2))
    run.think("", finish("It is there."))
    finished(run)
    assert [turn.tone for turn in lean_turns(run)] == ["returned", "returned", "answer"]
    text = page_of(tmp_path).text
    assert "asked to call Finish" in text
    assert "asked to look again" in text


def test_a_finish_without_its_arguments_has_a_page(tmp_path: Path) -> None:
    run = lean(tmp_path)
    run.think("", ToolCall("a", "Finish", None, '{"asked": '))
    run.think("", ToolCall("b", "Finish", {"verified": ["one", 2], "answer": None}))
    finished(run, TerminationReason.EMPTY_REPLY)
    assert '["one", 2]' in page_of(tmp_path).text


def test_protocol_failures_are_said_and_counted(tmp_path: Path) -> None:
    run = lean(tmp_path)
    say(run, note="Action: Pick[", unreadable="it holds the start of a call.", rung=Rung.REACT)
    finished(run, TerminationReason.PROTOCOL)
    assert [turn.tone for turn in lean_turns(run)] == ["unreadable"]
    page = page_of(tmp_path)
    assert "Protocol failure, unparsed call: it holds the start of a call." in page.text
    assert "replies in a row were neither a call nor an answer" in page.text
    assert numbers(page)["protocol failures"] == "1"
    assert numbers(page)["calls asked as"] == "react"


def numbers(page: Page) -> dict[str, str]:
    """The figures of the summary."""
    found = re.findall(r"<dt>([^<]+)</dt><dd[^>]*>([^<]*)</dd>", page.source)
    return dict(reversed(found))  # The summary comes before the turns.


@pytest.mark.parametrize(
    ("costs", "words"), [((0.25, 1.0), "$1.25"), ((0.25, None), "price unknown")]
)
def test_the_summary_accounts_for_tokens_and_money(
    tmp_path: Path, costs: tuple[float | None, ...], words: str
) -> None:
    run = lean(tmp_path)
    for cost in costs:
        say(run, usage=Usage(1500, 40, 1000, 30), cost_usd=cost, requests=2, note="Hm.")
    found = numbers(page_of(tmp_path))
    assert found["tokens in"] == "3,000"
    assert found["cached"] == "2,000"
    assert found["tokens out"] == "80"
    assert found["reasoning"] == "60"
    assert found["requests"] == "4"
    assert found["cost"] == words
    assert "estimated" not in found.values()


def test_a_player_without_tokens_has_no_price(tmp_path: Path) -> None:
    run = lean(tmp_path)
    say(run, note="Hm.")
    assert numbers(page_of(tmp_path))["tokens"] == "none"
    assert "price unknown" not in page_of(tmp_path).text


def test_settings_name_profile_and_budget(tmp_path: Path) -> None:
    run = lean(tmp_path, budget=Budget(tokens=200_000, usd=0.5))
    finished(run)
    page = page_of(tmp_path)
    assert f"profile {LEAN}" in page.text
    assert "200,000 tokens, 0.5 US dollars" in page.text


def test_a_conversation_reads_as_one(tmp_path: Path) -> None:
    run = lean(tmp_path)
    run.think("", finish("Which one?"))
    finished(run)
    run.writer.notify(Started("The blue one", "You are the mind.", run.world.hash(), "{}"))
    run.see()
    run.think("", call("Pick", "The blue one.", object="Tape_4"))
    run.acted("Pick", {"object": "Tape_4"}, DONE)
    finished(run, TerminationReason.LOOP)
    asked, done = lean_turns(run)
    assert asked.started and done.started and done.started.instruction == "The blue one"
    assert asked.ended and done.ended and done.ended.reason is TerminationReason.LOOP
    page = page_of(tmp_path)
    assert "conversation, 2 instructions" in page.text
    assert len(page.named("h2", "said")) == 2
    assert len(page.named("p", "finish")) == 2
    assert "Not scored" not in page.text
    assert page.text.count("System prompt") == 1


@pytest.mark.parametrize("reason", list(TerminationReason))
def test_every_reason_to_end_has_a_word(tmp_path: Path, reason: TerminationReason) -> None:
    run = lean(tmp_path)
    finished(run, reason)
    (line,) = page_of(tmp_path).named("p", "finish")
    assert line["data-tone"] in ("ended", "truncated", "broken")
    assert (line["data-tone"] == "broken") is not reason.is_scored


def test_hostile_notes_and_endings_stay_texts(tmp_path: Path) -> None:
    run = lean(tmp_path)
    run.think("", call(HOSTILE, HOSTILE, object=HOSTILE), call("Pick", HOSTILE + "2"))
    run.acted(HOSTILE, {"object": HOSTILE}, replace(DONE, text=HOSTILE))
    show(run)
    say(run, note=HOSTILE, unreadable=HOSTILE)
    run.think("", ToolCall("f", "Finish", dict.fromkeys(("note", "verified", "answer"), HOSTILE)))
    finished(run)
    run.writer.notify(Started(HOSTILE, HOSTILE, run.world.hash(), "{}"))
    page = page_of(tmp_path)
    assert len(page.named("script")) == 1
    assert all(image["src"].startswith("data:") for image in page.named("img"))
    assert [a for _, attributes in page.tags for a in attributes if a.startswith("on")] == []
    assert page.text.count(HOSTILE) >= 8
