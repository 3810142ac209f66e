"""Exports: whole folders, filters, and errors that name the fix; no extra is needed here."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path
from typing import Any

import pytest
from pydantic import TypeAdapter
from tests.adapters.exports.runs import run
from tests.run_folder import Recorder, config, played
from tests.study.episodes import record, small_study

from adamo_vh.adapters.exports.exporting import FORMATS, export
from adamo_vh.adapters.exports.form import Form
from adamo_vh.adapters.exports.recorded import Choice, recorded
from adamo_vh.errors import ConfigError, RecordError
from adamo_vh.record.run_folder import EVENTS, MANIFEST
from adamo_vh.record.termination import TerminationReason
from adamo_vh.session.lending import LentWorld
from adamo_vh.study.plan import plan
from adamo_vh.study.store import episode_folder, write_study

PRIVILEGED = ("saved", "state_hash", "completion", "strict", "qpos", "conditions")


def _lines(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Three episodes with a score, one that broke, one that is damaged, one not played."""
    folder, what = tmp_path / "study", small_study()
    planned = plan(what)
    write_study(folder, what, planned)
    for one in planned[:3]:
        record(folder, one)
    record(folder, planned[3], TerminationReason.BROKEN)
    record(folder, planned[4])
    (episode_folder(folder, planned[4].key) / EVENTS).write_bytes(b"{}\n{}\n")
    return folder


def test_sft_is_chat_that_the_openai_library_takes(lent: LentWorld, tmp_path: Path) -> None:
    from openai.types.chat import ChatCompletionMessageParam

    run(tmp_path / "run", lent, "lean", "T3")
    done = export([tmp_path / "run"], "sft", tmp_path / "out")
    assert done.episodes == 1
    lines = _lines(tmp_path / "out" / "train.jsonl")
    codec: TypeAdapter[Any] = TypeAdapter(list[ChatCompletionMessageParam])
    for line in lines:
        codec.validate_python(line["messages"])
        assert set(line) == {"messages", "tools", "parallel_tool_calls"}
        weights = [m["weight"] for m in line["messages"] if m["role"] == "assistant"]
        assert weights == [*[0] * (len(weights) - 1), 1]
        assert line["messages"][-1]["role"] == "assistant"
    pictures = [
        part["image_url"]["url"]
        for message in lines[0]["messages"]
        for part in message.get("content", ())
        if part["type"] == "image_url"
    ]
    assert pictures and all((tmp_path / "out" / name).is_file() for name in pictures)


def test_sft_holds_nothing_privileged(lent: LentWorld, tmp_path: Path) -> None:
    run(tmp_path / "run", lent, "paper", "T3")
    export([tmp_path / "run"], "sft", tmp_path / "out")
    text = (tmp_path / "out" / "train.jsonl").read_text()
    assert [word for word in PRIVILEGED if word in text] == []


def test_sft_gives_scores_and_inline_pictures_when_asked(lent: LentWorld, tmp_path: Path) -> None:
    run(tmp_path / "run", lent, "paper", "T3")
    form = Form(inline_pictures=True, with_score=True)
    export([tmp_path / "run"], "sft", tmp_path / "out", form=form)
    line = _lines(tmp_path / "out" / "train.jsonl")[0]
    assert (line["episode"], line["completion"], line["strict"]) == ("run", 1.0, 1.0)
    assert "data:image/jpeg;base64," in json.dumps(line)
    assert not (tmp_path / "out" / "images").exists()


def test_atif_tells_every_step_in_order(tmp_path: Path) -> None:
    played(tmp_path / "run")
    export([tmp_path / "run"], "atif", tmp_path / "out")
    told = json.loads((tmp_path / "out" / "run" / "trajectory.json").read_text())
    assert told["schema_version"] == "ATIF-v1.7"
    assert [step["step_id"] for step in told["steps"]] == list(range(1, len(told["steps"]) + 1))
    assert [step["source"] for step in told["steps"]] == ["system", "user", *["agent"] * 6]
    assert told["steps"][2]["tool_calls"][0]["arguments"] == {"object": "Tape_4"}
    (look,) = told["steps"][3]["observation"]["results"]
    assert [part["type"] for part in look["content"]] == ["text", "image"]
    picture = look["content"][1]["source"]
    assert (tmp_path / "out" / "run" / picture["path"]).is_file()
    assert told["steps"][4]["observation"]["results"][0]["extra"]["outcome"] == "refused"
    assert told["final_metrics"]["total_prompt_tokens"] > 0


def test_of_a_study_the_scored_episodes_are_taken(study: Path, tmp_path: Path) -> None:
    done = export([study], "atif", tmp_path / "out")
    assert done.episodes == 3
    assert len(list((tmp_path / "out").rglob("trajectory.json"))) == 3
    (problem,) = done.problems
    assert "is damaged" in problem


def test_an_episode_that_cannot_be_told_is_left_out_and_named(study: Path, tmp_path: Path) -> None:
    pictures = sorted((study / "episodes").rglob("frames/*"))
    pictures[0].unlink()
    done = export([study], "atif", tmp_path / "out")
    assert (done.episodes, len(done.problems)) == (2, 2)
    assert any("lacks the picture" in problem for problem in done.problems)
    assert len(list((tmp_path / "out").rglob("images"))) == 2


def test_filters_look_at_the_score(study: Path) -> None:
    assert len(list(recorded([study], Choice(), []))) == 3
    assert list(recorded([study], Choice(strict_only=True), [])) == []
    assert list(recorded([study], Choice(min_completion=0.9), [])) == []
    with pytest.raises(ConfigError, match="use 0 to 1"):
        Choice(min_completion=1.5)


def test_two_folders_of_one_name_stay_two_episodes(tmp_path: Path) -> None:
    for parent in ("a", "b"):
        played(tmp_path / parent / "run")
    names = [one.name for one in recorded([tmp_path / "a" / "run", tmp_path / "b" / "run"])]
    assert names == ["run", "run-2"]


def test_what_is_wrong_is_said_and_leaves_nothing_behind(tmp_path: Path) -> None:
    run_folder = tmp_path / "run"
    played(run_folder)
    out = tmp_path / "out"
    with pytest.raises(ConfigError, match=r"no format 'csv'. Use one of sft"):
        export([run_folder], "csv", out)
    with pytest.raises(ConfigError, match="already holds something; name a new folder"):
        export([run_folder], "atif", run_folder)
    with pytest.raises(RecordError, match="no run folder"):
        export([tmp_path / "nothing"], "atif", out)
    unscored = tmp_path / "unscored"
    Recorder(unscored, config(None, "Wave.")).end("Done.")
    with pytest.raises(RecordError, match="filters leave none over"):
        export([unscored], "atif", out, choice=Choice(strict_only=True))
    (run_folder / MANIFEST).write_text("{")
    with pytest.raises(RecordError, match=MANIFEST):
        export([run_folder], "atif", out)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run", "unscored"]


@pytest.mark.parametrize(
    ("to", "module", "extra"),
    [
        ("parquet", "pyarrow", "export"),
        ("inspect", "inspect_ai", "inspect"),
        ("rerun", "rerun", "rerun"),
    ],
)
def test_a_missing_extra_is_one_line(to: str, module: str, extra: str, tmp_path: Path) -> None:
    if importlib.util.find_spec(module):
        pytest.skip(f"{module} is here")
    played(tmp_path / "run")
    with pytest.raises(ConfigError, match=rf"pip install 'adamo-vh\[{extra}\]'"):
        export([tmp_path / "run"], to, tmp_path / "out")
    assert set(FORMATS) > {to}


def test_answers_that_were_neither_call_nor_answer_are_nothing_to_learn(
    lent: LentWorld, tmp_path: Path
) -> None:
    from tests.session.test_lean_resume import SAID, Live

    import adamo_vh

    adamo_vh.run_episode(
        "Put it down.",
        model=Live(0),
        engine=lent,
        profile="lean",
        resolution="160x90",
        out=tmp_path / "run",
    )
    export([tmp_path / "run"], "sft", tmp_path / "out")
    failures = sum(reply.ending.is_failure for reply in SAID)
    assert failures and len(_lines(tmp_path / "out" / "train.jsonl")) == len(SAID) - failures
