"""`adamo-vh run --body URL`: what it prints, and what it refuses."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
import typer

from adamo_vh.cli.app import app
from adamo_vh.cli.exits import Exit
from adamo_vh.errors import ConfigError, EngineError
from adamo_vh.record.termination import Limits
from adamo_vh.service.app import serving
from adamo_vh.service.hosting import Host, Terms
from adamo_vh.serving.admission import Rules
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.pooling import Engines

JUDGE = "the-judge-of-these"


@pytest.fixture
def url(lent: LentWorld, tmp_path: Path) -> Iterator[str]:
    engines = Engines(ready={("s1", "mara", 0): lent.lender})
    host = Host(tmp_path / "served", Terms(limits=Limits(max_steps=3)), engines)
    with ExitStack() as stack:
        stack.callback(host.close_all)
        yield stack.enter_context(serving(host, rules=Rules(1_000_000, judge_token=JUDGE)))


def run(*words: str) -> int:
    try:
        return int(
            app(
                ["run", "--model", "random", "--resolution", "320x180", *words],
                standalone_mode=False,
            )
            or 0
        )
    except typer.Exit as ended:
        return int(ended.exit_code)


def test_a_player_is_told_that_it_ended_and_a_judge_how(
    url: str, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run("--task", "T1", "--body", url) == Exit.DONE
    told = capfd.readouterr().out
    assert "session" in told and "kept by the server" in told and "completion" not in told
    assert run("--task", "T1", "--body", url, "--judge-token", JUDGE) == Exit.DONE
    assert "completion 0.00" in capfd.readouterr().out
    assert run("--task", "T1", "--body", url, "--json") == Exit.DONE
    found = json.loads(capfd.readouterr().out)
    assert found["ended"] is True and set(found) == {"session", "ended", "answer"}
    assert run("Look around.", "--body", url, "--judge-token", JUDGE, "--json") == Exit.DONE
    assert json.loads(capfd.readouterr().out)["completion"] is None


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--out", "here"], "--out is the server's to say"),
        (["--max-steps", "5"], "--max-steps is the server's to say"),
        (["--record"], "--record is the server's to say"),
        (["--agent-cmd", "true"], "does not go with --agent-cmd"),
        (["--scene", "s9"], "There is no scene 's9' here"),
    ],
)
def test_what_is_the_servers_is_not_said_here(url: str, words: list[str], said: str) -> None:
    with pytest.raises(Exception, match=said):
        run("--task", "T1", "--body", url, *words)


def test_a_server_that_is_none_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ConfigError, match="write http://"):
        run("--task", "T1", "--body", "localhost")
    monkeypatch.setattr("adamo_vh.session.away.connect", _refuses)
    with pytest.raises(EngineError, match="Is it running"):
        run("--task", "T1", "--body", "http://127.0.0.1:1")


def _refuses(*_: object, **__: object) -> None:
    raise EngineError("The server cannot be reached. Is it running?")
