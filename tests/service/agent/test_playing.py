"""A program of somebody else's plays and is scored; in the box it sees its body and no more."""

from __future__ import annotations

import json
import shlex
import sys
from pathlib import Path
from typing import Any

import pytest
from tests.service.mcp.shared_engine import engines_of
from tests.session.test_outside_episodes import CALLS

import adamo_vh
from adamo_vh.analysis.comparison import compare
from adamo_vh.analysis.outcome import outcome_json, outcome_of, read_outcome
from adamo_vh.analysis.ranks import ranks
from adamo_vh.episode.result import EpisodeResult, read_manifest
from adamo_vh.errors import ConfigError
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.service.agent.box import box_problem
from adamo_vh.service.agent.playing import Program, play_program
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.runs import resume_episode

AGENT = Path(__file__).with_name("agent.py")
SMALL = {"task": "T8", "resolution": "160x90", "grid": 3}
FINISH = ("finish", {"answer": "They are on the floor."})
BOXED = pytest.mark.skipif(bool(box_problem()), reason=box_problem() or "there is a box")


def _command(**plan: Any) -> str:
    return shlex.join([sys.executable, str(AGENT), json.dumps(plan)])


def _play(
    lent: LentWorld,
    folder: Path,
    isolation: str = "none",
    passed: tuple[str, ...] = (),
    shown: tuple[Path, ...] = (),
    settings: Any = None,
    grace_s: float = 10.0,
    **plan: Any,
) -> EpisodeResult:
    program = Program(_command(**plan), isolation, passed, shown, grace_s)
    return play_program(
        program,
        {**SMALL, **(settings or {})},
        folder,
        engines=engines_of(lent),
    )


def _kept(folder: Path, name: str) -> str:
    return (folder / "agent" / name).read_text()


@BOXED
def test_in_the_box_it_plays_and_sees_no_more_than_its_body(
    lent: LentWorld, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", "not-for-the-agent")
    run, package = tmp_path / "run", Path(adamo_vh.__file__).parent
    paths = [str(run), str(run.parent), str(package), str(package.parent), "/usr/bin", str(AGENT)]
    result = _play(lent, run, "bwrap", paths=paths, calls=[*CALLS, FINISH])
    assert result.strict == 1.0 and result.isolation == "bwrap" and result.is_ranked
    assert result.model.startswith("outside:python") and result.warnings == ()
    seen = json.loads(_kept(run, "stdout.txt").splitlines()[0])
    visible = [path for path, there in seen["paths"].items() if there]
    assert visible == ["/usr/bin", str(AGENT)]
    assert not seen["package"] and not seen["network"] and seen["here"] == ["seen.json"]
    assert seen["processes"] < 6
    environment = seen["environment"]
    assert "OPENAI_API_KEY" not in environment and environment["HOME"] == "/agent"
    assert environment["ADAMO_VH_INSTRUCTION"] == read_manifest(run).config.instruction
    record = json.loads(_kept(run, "agent.json"))
    assert record["isolation"] == "bwrap" and record["exit_code"] == 0
    assert environment["ADAMO_VH_MCP_TOKEN"] not in (run / "manifest.json").read_text()


@BOXED
def test_what_is_hidden_stays_hidden_in_what_is_shown(lent: LentWorld, tmp_path: Path) -> None:
    run, package = tmp_path / "run", Path(adamo_vh.__file__).parent
    (tmp_path / "other").write_text("This may be read.")
    paths = [str(run), str(package), str(package / "runtime"), str(tmp_path / "other")]
    shown = (tmp_path, package.parent)
    _play(lent, run, "bwrap", shown=shown, paths=paths, calls=[FINISH])
    seen = json.loads(_kept(run, "stdout.txt").splitlines()[0])["paths"]
    assert [path for path, there in seen.items() if there] == [str(tmp_path / "other")]


@BOXED
def test_in_the_box_a_program_that_is_not_there_is_no_zero(lent: LentWorld, tmp_path: Path) -> None:
    program = Program(f"/usr/bin/env {tmp_path}/no-such", "bwrap")
    result = play_program(program, SMALL, tmp_path / "run", engines=engines_of(lent))
    assert result.termination is TerminationReason.BROKEN and result.completion is None
    assert "exit code 127" in result.answer


@BOXED
def test_what_it_started_ends_with_it(lent: LentWorld, tmp_path: Path) -> None:
    result = _play(lent, tmp_path / "run", "bwrap", children=600, calls=[FINISH])
    assert result.termination is TerminationReason.ANSWERED


def test_without_a_box_it_is_marked_and_never_ranked(
    lent: LentWorld, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("AGENT_TOKEN", "a-secret-of-the-user")
    run = tmp_path / "run"
    plan: dict[str, Any] = {
        "calls": [*CALLS[:2], FINISH],
        "paths": [],
        "words": "\x1b[31mI have a-secret-of-the-user",
    }
    result = _play(lent, run, passed=("AGENT_TOKEN",), **plan)
    assert result.completion == 0.5 and result.isolation == "none" and not result.is_ranked
    assert json.loads(_kept(run, "stdout.txt").splitlines()[0])["environment"]["AGENT_TOKEN"] == (
        "[key]"
    )
    assert "a-secret" not in _kept(run, "stderr.txt")
    page = (run / "episode.html").read_text()
    assert "isolation</span> none" in page and "never ranked" in page
    manifest, recorded = read_manifest(run), read_trajectory(run)
    outcome = outcome_of("one", manifest, recorded, result)
    assert outcome.model.endswith("(not isolated)") and not outcome.is_ranked
    assert read_outcome(outcome_json(outcome)) == outcome
    assert compare([outcome], [outcome]) is None and ranks([outcome]) == ()


def test_who_ends_without_an_answer_is_scored_as_it_stands(lent: LentWorld, tmp_path: Path) -> None:
    result = _play(lent, tmp_path / "run", calls=CALLS[:2])
    assert result.termination is TerminationReason.EMPTY_REPLY and result.completion == 0.5
    assert result.warnings == ("The program ended without a final answer.",)


def test_who_breaks_is_unscored_and_can_be_gone_on_with(lent: LentWorld, tmp_path: Path) -> None:
    run = tmp_path / "run"
    result = _play(lent, run, calls=CALLS[:2], code=3)
    assert result.termination is TerminationReason.BROKEN and result.completion is None
    assert "exit code 3" in result.answer and _kept(run, "agent.json").count('"exit_code": 3')
    again = resume_episode(run, model=ScriptedModel("other", ()), engine=lent.lender.lend())
    assert again.completion == 0.5


def test_who_never_ends_is_stopped_by_the_clock(lent: LentWorld, tmp_path: Path) -> None:
    limits = Limits(max_seconds=1.0)
    result = _play(lent, tmp_path / "run", grace_s=0.5, sleeps=600, settings={"limits": limits})
    assert result.termination is TerminationReason.TIME_LIMIT and result.completion == 0.0
    assert json.loads(_kept(tmp_path / "run", "agent.json"))["ended_by_us"]


@pytest.mark.parametrize(
    ("program", "words"),
    [
        (Program(""), "--agent-cmd is empty"),
        (Program("'"), "cannot be read"),
        (Program("no-such-program-at-all x"), "there is no program 'no-such-program-at-all'"),
        (Program("true", "maybe"), "--isolation 'maybe': use auto, bwrap, none"),
        (Program("true", "none", ("NO_SUCH_NAME",)), "--agent-env NO_SUCH_NAME"),
        (Program("true", "none", (), (Path("/no/such"),)), "--agent-bind /no/such"),
    ],
)
def test_what_is_wrong_is_told_before_anything_starts(
    tmp_path: Path, program: Program, words: str
) -> None:
    with pytest.raises(ConfigError, match=words):
        play_program(program, SMALL, tmp_path / "run")
    assert not (tmp_path / "run").exists()
