"""How an episode begins: what is wrong is told before anything is paid, what is kept holds."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest
from tests.brain import Brain
from tests.fake_provider import Canned, FakeProvider, call, completion

from adamo_vh import run_episode
from adamo_vh.episode.result import read_manifest
from adamo_vh.errors import ConfigError, SceneError
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session.minds import lasting, model_of

SMALL = (320, 180)


@pytest.mark.parametrize(
    ("setting", "error"),
    [
        ({"scene": "nowhere"}, SceneError),
        ({"task": "T99"}, ConfigError),
        ({"figure": "nobody"}, ConfigError),
        ({"variation": -1}, ConfigError),
    ],
)
def test_what_is_wrong_is_told_before_the_model_is_asked(
    setting: dict[str, object], error: type[Exception], tmp_path: Path
) -> None:
    with FakeProvider(Brain()) as server:
        settings = {"task": "T4", "resolution": SMALL, "model": server.uri(), **setting}
        with pytest.raises(error):
            run_episode(out=tmp_path / "run", **settings)  # type: ignore[arg-type]
        assert server.requests == []
    assert not (tmp_path / "run").exists()


def test_a_warning_is_said_once_although_its_numbers_change(engine: BuiltinEngine) -> None:
    def counting(text: str, *calls: dict[str, object]) -> Canned:
        canned = completion(text, calls)
        assert isinstance(canned.body, dict)
        return replace(
            canned, body={**canned.body, "usage": {"prompt_tokens": 9, "completion_tokens": 3}}
        )

    looks = [counting("n", call("Look", {"x": x, "y": 1, "z": 1}, f"c{x}")) for x in (0, 1, 2)]
    with FakeProvider([*looks, counting("Done.")]) as server:
        result = run_episode(
            task="T4", engine=engine, model=server.uri(), tool_calls="native", resolution=SMALL
        )
    assert result.steps == 3
    assert len(result.warnings) == 1 and "counted 9 tokens" in result.warnings[0]


def test_a_replay_can_be_resumed_from_another_folder(
    tmp_path: Path, engine: BuiltinEngine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    run_episode(task="T4", out="first", engine=engine, resolution=SMALL)
    run_episode(task="T4", out="second", engine=engine, model="replay:first", resolution=SMALL)
    monkeypatch.chdir(os.sep)
    kept = read_manifest(tmp_path / "second").config.model
    assert kept == f"replay:{tmp_path / 'first'}"
    assert model_of(kept, answered=1) is not None
    assert lasting("cassette:run") == f"cassette:{Path.cwd() / 'run'}"
    assert lasting("openai:replay:x") == "openai:replay:x"
