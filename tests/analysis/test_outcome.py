"""The row of an episode: what it takes from the records, and what follows from it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from tests.run_folder import Recorder, config, played

from adamo_vh.action import Drop, Pick
from adamo_vh.analysis.outcome import Outcome, outcome_json, outcome_of, read_outcome
from adamo_vh.cognition.profile import PROFILES
from adamo_vh.episode.result import read_manifest, read_result
from adamo_vh.errors import RecordError
from adamo_vh.inference.messages import ToolCall
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import read_trajectory


def row(folder: Path) -> Outcome:
    result = read_result(folder)
    assert result is not None
    return outcome_of(
        "s1/T05", read_manifest(folder), read_trajectory(folder), result, axes={"k": "4"}
    )


def test_a_row_says_what_the_records_say(tmp_path: Path) -> None:
    played(tmp_path)
    found = row(tmp_path)
    assert (found.scene, found.task, found.labeling, found.model) == ("s1", "T5", "sem", "baseline")
    assert (found.completion, found.strict, found.conditions_open) == (1.0, 1.0, 0)
    assert found.calls == {"Drop": 1, "Look": 2, "Pick": 1, "Walk": 1}
    assert (found.steps, found.refused, found.corrected) == (5, 1, 1)
    assert (found.family, found.printed_level, found.computed_level) == ("single object", 5, 5)
    assert found.ended_by_agent and found.claims_success is True
    assert not found.is_early_stop and not found.is_false_claim
    assert found.shortest_m is None and found.cost_usd is None
    assert found.axes == {"k": "4"}


def test_a_row_survives_its_json(tmp_path: Path) -> None:
    played(tmp_path)
    found = row(tmp_path)
    assert read_outcome(outcome_json(found)) == found
    assert "\n" not in outcome_json(found)


@pytest.mark.parametrize("text", ["", "{}", "[1]", '{"key": 1}', b"\xff"])
def test_what_is_no_row_is_refused(text: str | bytes) -> None:
    with pytest.raises(RecordError, match="An outcome cannot be read"):
        read_outcome(text)


def test_a_task_of_ones_own_has_no_printed_level(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config(None, "Say hello"))
    run.end("Hello!")
    found = row(tmp_path)
    assert (found.task, found.family, found.printed_level) == ("Say hello", "", None)
    assert found.completion is None and not found.is_scored and not found.is_complete


def test_ending_early_with_a_claim_is_a_false_claim(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config("T2"))
    run.end("Done: the plate is in my hand.")
    found = row(tmp_path)
    assert found.completion == 0.0 and found.conditions_open == 1
    assert found.is_early_stop and found.is_false_claim


def test_ending_early_with_an_admission_is_no_false_claim(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config("T2"))
    run.end("I could not find the plate.")
    found = row(tmp_path)
    assert found.is_early_stop and not found.is_false_claim and found.claims_success is False


def test_half_done_and_claimed_is_a_false_claim(tmp_path: Path) -> None:
    run = Recorder(tmp_path, config("T8"))
    run.act("", Pick("37"), {"object": "37"})
    run.act("", Drop("37", 1.0, -1.0, 0.0), {"object": "37", "x": 1.0, "y": -1.0, "z": 0.0})
    run.end("The glass and the plate are on the floor.")
    found = row(tmp_path)
    assert found.completion == 0.5 and found.is_false_claim


@pytest.mark.parametrize(
    "reason",
    [
        TerminationReason.STEP_LIMIT,
        TerminationReason.LOOP,
        TerminationReason.PROTOCOL,
        TerminationReason.EMPTY_REPLY,
        TerminationReason.BUDGET,
    ],
)
def test_what_a_limit_or_silence_ended_claims_nothing(
    tmp_path: Path, reason: TerminationReason
) -> None:
    run = Recorder(tmp_path, config("T2"))
    run.end("Done.", reason)
    found = row(tmp_path)
    assert found.is_scored and not found.ended_by_agent and found.claims_success is None
    assert not found.is_early_stop and not found.is_false_claim


@pytest.mark.parametrize("reason", [TerminationReason.BROKEN, TerminationReason.RUN_BUDGET])
def test_a_fault_of_ours_is_unscored(tmp_path: Path, reason: TerminationReason) -> None:
    run = Recorder(tmp_path, config("T2"))
    run.end("The provider answered 500.", reason)
    found = row(tmp_path)
    assert found.completion is None and found.strict is None and not found.is_scored
    assert not found.is_early_stop and not found.is_false_claim


FINISH = {
    "note": "Over.",
    "confidence": 0.9,
    "asked": "Pick the plate",
    "verified": "by the feedback: the plate is in the hand",
    "unseen": "the rest of the room",
    "answer": "The plate is in my hand.",
}


@pytest.mark.parametrize(
    ("changes", "claims"),
    [
        ({}, True),
        ({"answer": "I could not find the plate."}, False),
        ({"confidence": 0.3}, None),
        ({"unseen": "whether it is the plate"}, None),
        ({"verified": "I could not verify that it is the plate"}, None),
    ],
)
def test_the_fields_of_finish_can_take_a_claim_back(
    tmp_path: Path, changes: dict[str, object], claims: bool | None
) -> None:
    setting = replace(config("T2"), profile=PROFILES["lean"])
    run = Recorder(tmp_path, setting)
    said = FINISH | changes
    run.think("", ToolCall("c0", "Finish", said))
    run.end(str(said["answer"]), reason=TerminationReason.STEP_LIMIT)
    _end_by_finish(tmp_path)
    assert row(tmp_path).claims_success is claims


def _end_by_finish(folder: Path) -> None:
    """Let the record end with the Finish that stands last in it."""
    for name in ("events.jsonl", "result.json"):
        text = (folder / name).read_text("utf-8")
        (folder / name).write_text(text.replace("step_limit", "answered"), "utf-8")
