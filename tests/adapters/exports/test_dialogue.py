"""An episode as one conversation: everything once, with the pictures where they came."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.adapters.exports.runs import run
from tests.run_folder import Recorder, config, played

from adamo_vh.action import Code, Feedback, Outcome
from adamo_vh.adapters.exports.dialogue import dialogue
from adamo_vh.adapters.exports.recorded import Episode, recorded
from adamo_vh.errors import RecordError
from adamo_vh.inference.messages import Message, ToolCall, pictures_of
from adamo_vh.session.lending import LentWorld


def told(folder: Path) -> tuple[Message, ...]:
    (episode,) = recorded([folder])
    return dialogue(episode)


def test_every_call_is_followed_by_its_result(tmp_path: Path) -> None:
    played(tmp_path)
    said = told(tmp_path)
    assert [message.role for message in said] == [
        "system", "human", *["ai", "tool"] * 5, "ai",
    ]  # fmt: skip
    assert said[1].role == "human" and said[1].text.startswith("Pick")
    # The first view, and one after each of the two looks.
    assert [len(pictures_of(message)) for message in said] == [
        0,
        1,
        0,
        0,
        0,
        1,
        0,
        0,
        0,
        1,
        0,
        0,
        0,
    ]


def test_a_call_that_was_left_out_says_why(tmp_path: Path) -> None:
    run_ = Recorder(tmp_path, config())
    two = [ToolCall(name, "Look", {"x": 0, "y": 0, "z": 0}) for name in ("one", "two")]
    run_.think("I look twice.", *two)
    run_.acted("Look", two[0].arguments, Feedback(Outcome.DONE, Code.OK, "Done: you look."))
    run_.left_out("Look", "one action a turn")
    run_.end("That is all.")
    said = told(tmp_path)
    assert [getattr(message, "call_id", "") for message in said][3:5] == ["one", "two"]
    assert said[4].role == "tool" and said[4].text == "Not executed: one action a turn."


def test_close_ups_belong_to_the_call_that_asked_for_them(lent: LentWorld, tmp_path: Path) -> None:
    run(tmp_path, lent, "lean", "T3")
    said = told(tmp_path)
    shown = sum(len(pictures_of(message)) for message in said)
    assert shown == len(list((tmp_path / "frames").iterdir()))


def test_a_name_that_leads_out_of_the_folder_is_none_of_a_picture(tmp_path: Path) -> None:
    played(tmp_path / "run")
    secret = tmp_path / "secret.jpg"
    secret.write_bytes(b"secret")
    events = tmp_path / "run" / "events.jsonl"
    lines = events.read_text().splitlines(keepends=True)
    frame = next(iter((tmp_path / "run" / "frames").iterdir())).name
    events.write_text("".join(line.replace(frame, "../../secret.jpg") for line in lines))
    episode: Episode
    (episode,) = recorded([tmp_path / "run"])
    with pytest.raises(RecordError, match="lacks the picture"):
        dialogue(episode)
