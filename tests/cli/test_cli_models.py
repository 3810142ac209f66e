"""`adamo-vh models check`: what a user reads about a model, with the fix for what is missing."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tests.brain import Brain
from tests.fake_provider import FakeProvider, fault
from typer.testing import CliRunner

from adamo_vh.cli.app import app
from adamo_vh.errors import ModelConfigError
from adamo_vh.session.runs import run_episode


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ADAMO_VH_CACHE_DIR", str(tmp_path))
    return tmp_path


def check(uri: str, *options: str) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["models", "check", uri, *options])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result.exit_code, result.output


def test_a_good_model_is_all_ok_and_asked_natively() -> None:
    with FakeProvider(Brain()) as server:
        code, text = check(server.uri())
    assert code == 0
    lines = text.splitlines()
    assert [line.split()[0] for line in lines[:8]] == ["ok"] * 7 + ["=>"]
    assert "native" in lines[7]
    assert "5 requests" in lines[8]
    assert "fix" not in text


def test_the_second_time_nothing_is_asked_unless_told_so() -> None:
    brain = Brain()
    with FakeProvider(brain) as server:
        check(server.uri())
        assert "--refresh" in check(server.uri())[1]
        assert len(brain.asked) == 5
        brain.tools = "400"
        assert "schema: no tools" in check(server.uri(), "--refresh")[1]
        assert "schema: no tools" in check(server.uri())[1]


def test_what_is_missing_comes_with_its_fix() -> None:
    with FakeProvider(Brain(tools="400", schema="ignored", pictures="500")) as server:
        code, text = check(server.uri())
    assert code == 0
    for words in ("--mmproj", "--jinja", "json_schema", "not tested", "react: no tools"):
        assert words in text


def test_json_holds_everything() -> None:
    with FakeProvider(Brain(tools="leaked")) as server:
        code, text = check(server.uri(), "--json")
        facts = json.loads(text)
        assert json.loads(check(server.uri(), "--json")[1]) == {**facts, "cached": True}
    assert code == 0
    assert facts["reachable"] is True
    assert (facts["rung"], facts["tools"], facts["pictures"]) == ("leaked", "leaked", "yes")
    assert facts["usage"]["input_tokens"] > 0


def test_what_cannot_be_reached_fails_and_is_asked_again_next_time(own_cache: Path) -> None:
    with FakeProvider(lambda _: fault(401, "bad key")) as server:
        code, text = check(server.uri())
        assert code == 1
        assert text.startswith("FAIL reachable")
        assert "Check the API key" in text
        code, text = check(server.uri(), "--json")
        assert code == 1
        assert json.loads(text)["reachable"] is False
    assert not list(own_cache.rglob("*.json"))


def test_the_baseline_needs_no_server() -> None:
    code, text = check("baseline")
    assert code == 0
    assert "nothing to check" in text
    assert json.loads(check("baseline", "--json")[1])["kind"] == "rule-based"


def test_an_unknown_model_is_refused_with_a_list_of_the_known() -> None:
    with pytest.raises(ModelConfigError, match="openai:NAME"):
        check("nosuch:thing")


def test_a_recorded_run_needs_no_server(tmp_path: Path) -> None:
    run_episode("Look around", resolution=(128, 72), out=tmp_path / "run", record=True)
    for kind in ("replay", "cassette"):
        code, text = check(f"{kind}:{tmp_path / 'run'}")
        assert code == 0
        assert "nothing to check" in text
