"""Episodes that fail in one known way, played in the real tabletop scene, and their diagnosis."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from adamo_vh.analysis.diagnosis import Code, Diagnosis, FailureClass, read_diagnosis
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Ending, ModelKind, Reply
from adamo_vh.inference.players.resumed import resumed
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session.explaining import explain_run
from adamo_vh.session.runs import run_episode

Said = str | tuple[str, dict[str, Any]] | Reply
FLOOR_SPOT = {"x": -1.6, "y": -1.0, "z": 0.0}
DONE = "Done: everything is as you asked."
BROKEN = Reply(AIMessage('{"tool": '), ending=Ending.UNPARSED_CALL, unreadable="was no JSON.")


def pick(number: int) -> Said:
    return ("Pick", {"object": str(number)})


def drop(number: int, x: float, y: float, z: float = 0.0) -> Said:
    return ("Drop", {"object": str(number), "x": x, "y": y, "z": z})


def explained(
    engine: BuiltinEngine, folder: Path, task: str, said: Sequence[Said], labeling: str = "sem"
) -> Diagnosis:
    replies = [_reply(item, number) for number, item in enumerate(said)]
    run_episode(
        task=task,
        labeling=labeling,
        engine=engine,
        model=resumed(replies, ScriptedModel("failing", (), ModelKind.SCRIPTED)),
        out=folder,
        resolution=(320, 180),
        grid=0,
    )
    return explain_run(folder, engine)


def _reply(said: Said, number: int) -> Reply:
    if isinstance(said, Reply):
        return said
    if isinstance(said, str):
        return Reply(AIMessage(said))
    name, arguments = said
    return Reply(AIMessage("Next.", (ToolCall(f"c{number}", name, arguments),)))


CASES: dict[str, tuple[str, Sequence[Said], Code]] = {
    "another object": ("T4", [pick(36), drop(36, -1.6, -1.0), DONE], Code.WRONG_OBJECT),
    "beside another one": ("T5", [pick(4), drop(4, -0.26, -0.33, 0.78), DONE], Code.WRONG_ANCHOR),
    "a tag of nothing": ("T2", [pick(99)] * 4, Code.UNKNOWN_TAG),
    "back on the table": ("T4", [pick(57), drop(57, 0.2, -0.4, 0.78), DONE], Code.WRONG_SUPPORT),
    "half a metre away": ("T5", [pick(4), drop(4, -0.15, -1.25, 0.78), DONE], Code.TOO_FAR),
    "not in a corner": ("T7", [pick(2), drop(2, -1.6, -1.0), DONE], Code.OUTSIDE_AREA),
    "back where it stood": ("T5", [pick(4), drop(4, -0.17, -0.6, 0.78), DONE], Code.TOO_FAR),
    "back, and says so": (
        "T5",
        [pick(4), drop(4, -0.17, -0.6, 0.78), "I cannot do that."],
        Code.GAVE_UP,
    ),
    "kept in the hand": ("T4", [pick(57), DONE], Code.NOT_RELEASED),
    "outside the room": ("T4", [pick(57), *[drop(57, 40.0, 0.0)] * 4], Code.REFUSED),
    "nothing done": ("T8", [("Look", FLOOR_SPOT), DONE], Code.FALSE_CLAIM),
    "gives up": ("T8", [("Look", FLOOR_SPOT), "I cannot do that."], Code.GAVE_UP),
    "one look is no search": (
        "T3",
        [("Walk", FLOOR_SPOT), ("Look", FLOOR_SPOT), "I cannot do that."],
        Code.GAVE_UP,
    ),
    "two looks are": (
        "T3",
        [("Look", FLOOR_SPOT), ("Look", {"x": 1.0, "y": 2.0, "z": 0.5}), "I cannot do that."],
        Code.NOT_RECOGNISED,
    ),
    "one of two": ("T8", [pick(37), drop(37, -1.6, -1.0), DONE], Code.GOAL_FORGOTTEN),
    "dropped, then taken": ("T4", [drop(57, -1.6, -1.0), pick(57), DONE], Code.WRONG_ORDER),
    "put down again": ("T2", [pick(57), drop(57, -1.6, -1.0), DONE], Code.EXTRA_GOAL),
    "put back": ("T2", [pick(57), drop(57, 0.33, -0.6, 0.78), DONE], Code.PUT_BACK),
    "the plant to the tape": ("T5", [pick(50), drop(50, -1.6, -1.0), DONE], Code.WRONG_ROLE),
    "one view for ever": ("T4", [("Look", FLOOR_SPOT)] * 5, Code.LOOP),
    "no JSON": ("T4", [pick(57), *[BROKEN] * 3], Code.UNREADABLE),
    "silence": ("T4", ["", ""], Code.EMPTY),
    "no such tool": ("T4", [("Grab", {"what": "plate"})] * 4, Code.UNKNOWN_TOOL),
    "no such argument": ("T4", [("Pick", {"thing": 57})] * 4, Code.BAD_ARGUMENTS),
    "text alone": ("T4", ["The plate is a lovely thing to look at."], Code.NO_CALL),
}


@pytest.mark.parametrize("name", CASES)
def test_each_way_to_fail_is_told(name: str, engine: BuiltinEngine, tmp_path: Path) -> None:
    task, said, code = CASES[name]
    found = explained(engine, tmp_path / "run", task, said)
    assert (found.class_, found.code) == (code.failure_class, code), found.summary
    assert found.evidence[0].step <= len(said)


def test_a_diagnosis_is_kept_and_comes_out_the_same(engine: BuiltinEngine, tmp_path: Path) -> None:
    run = tmp_path / "run"
    found = explained(engine, run, "T4", CASES["another object"][1])
    kept = (run / "diagnosis.json").read_text("utf-8")
    assert read_diagnosis(json.loads(kept)) == found
    assert explain_run(run, engine) == found
    assert (run / "diagnosis.json").read_text("utf-8") == kept


def test_the_evidence_shows_both_objects_and_where_the_way_was_left(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    found = explained(engine, tmp_path / "run", "T4", CASES["another object"][1])
    assert found.class_ is FailureClass.PERCEPTUAL
    shown = [item for item in found.evidence if item.frame]
    assert [item.text.split()[0] for item in shown] == ["Plate_57", "WineBottle_36"]
    assert all((tmp_path / "run" / "frames" / item.frame).is_file() for item in shown)
    assert found.distance == (2, 3, 2)
    assert found.left_path == 1


def test_what_was_never_in_view_was_never_found(engine: BuiltinEngine, tmp_path: Path) -> None:
    away = {"x": -2.9, "y": -1.0, "z": 1.0}
    walk = ("Walk", {"x": 1.5, "y": -1.0, "z": 0.0})
    said = [pick(57), drop(57, -1.6, -1.0), ("Look", away), walk, "I cannot find it."]
    found = explained(engine, tmp_path / "run", "T2", said)
    assert found.code is Code.EXTRA_GOAL  # It was in the first view, and in the hand.


@pytest.mark.parametrize(
    ("said", "words"),
    [
        ([pick(57)], "Nothing failed"),
        ([pick(57), pick(57)], "Nothing failed"),
    ],
)
def test_a_success_is_no_failure(
    said: Sequence[Said], words: str, engine: BuiltinEngine, tmp_path: Path
) -> None:
    found = explained(engine, tmp_path / "run", "T2", [*said, DONE])
    assert found.class_ is None and found.code is None
    assert words in found.summary


def test_what_nobody_asked_to_move_speaks_against_a_full_success(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    said = [pick(36), drop(36, -1.6, -1.0), pick(57), DONE]
    found = explained(engine, tmp_path / "run", "T2", said)
    assert found.code is Code.EXTRA_GOAL


def test_a_free_instruction_has_nothing_to_explain(engine: BuiltinEngine, tmp_path: Path) -> None:
    model = ScriptedModel("failing", (AIMessage(DONE),))
    run_episode(
        "Look round.", engine=engine, model=model, out=tmp_path / "run", resolution=(320, 180)
    )
    found = explain_run(tmp_path / "run", engine)
    assert found.class_ is None
    assert "No task" in found.summary
