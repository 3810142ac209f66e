"""A real episode is what its result says, and a forged one is not, however well it is sealed."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from tests.keys import key_file

from adamo_vh.episode.result import read_result
from adamo_vh.episode.sealing import sign_run, write_result
from adamo_vh.errors import RecordError
from adamo_vh.inference.model import Reply
from adamo_vh.inference.players.random import RandomModel
from adamo_vh.inference.players.wrapper import Wrapped
from adamo_vh.record.run_folder import EVENTS, MANIFEST, RESULT
from adamo_vh.record.signing import Signer, fingerprint
from adamo_vh.record.termination import Limits
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session.runs import resume_episode, run_episode
from adamo_vh.session.verifying import verify_run

OLD = Path(__file__).resolve().parents[1] / "data" / "format_1" / "s1-sem-paper-T4"


@pytest.fixture(scope="module")
def episode(s1_engine: BuiltinEngine, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run") / "episode"
    run_episode(task="T1", model="random:1", resolution="160x90", out=folder, engine=s1_engine)
    return folder


@pytest.fixture
def copy(episode: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(episode, tmp_path / "copy"))


def _resealed(folder: Path) -> None:
    """Seal a forged record as if nothing had happened: nothing in a seal is secret."""
    result = read_result(folder)
    assert result is not None
    write_result(folder, result, read_trajectory(folder))


def _events(folder: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in (folder / EVENTS).read_text().splitlines()]


def _write_events(folder: Path, events: list[dict[str, Any]]) -> None:
    (folder / EVENTS).write_text("".join(json.dumps(event) + "\n" for event in events))


def test_an_episode_is_what_its_result_says(copy: Path, engine: BuiltinEngine) -> None:
    found = verify_run(copy, engine=engine)
    assert (found.problems, len(found.digest), found.signed_by) == ((), 64, "")
    assert found.steps == len(read_trajectory(copy).acts)
    assert found.frames_differ == 0


def test_a_signature_is_checked(copy: Path, tmp_path: Path) -> None:
    signer = Signer(key_file(tmp_path / "key"))
    sign_run(copy, signer)
    found = verify_run(copy, key=signer.key, replayed=False)
    assert (found.problems, found.signed_by) == ((), fingerprint(signer.key))
    told = json.loads((copy / RESULT).read_text())
    told["answer"] = "All done."
    (copy / RESULT).write_text(json.dumps(told))
    _resealed(copy)
    (problem,) = verify_run(copy, key=signer.key, replayed=False).problems[-1:]
    assert "not signed" in problem


def test_a_state_that_no_step_led_to_is_found_by_replay(copy: Path, engine: BuiltinEngine) -> None:
    events = _events(copy)
    acted = next(event for event in events if event["type"] == "acted")
    acted["state_hash"] = "f" * 64
    _write_events(copy, events)
    _resealed(copy)
    found = verify_run(copy, engine=engine)
    assert [p for p in found.problems if p.startswith("step 1:")]
    assert verify_run(copy, replayed=False).problems == ()


def test_an_invented_end_is_found(copy: Path, engine: BuiltinEngine) -> None:
    told = json.loads((copy / RESULT).read_text())
    told["final"]["objects"][0]["support"] = "floor"
    told["score"]["completion"] = 1.0
    (copy / RESULT).write_text(json.dumps(told))
    _resealed(copy)
    problems = verify_run(copy, replayed=False).problems
    assert "the world at the end is not in the state that the last step led to" in problems[0]
    assert "score is not what the record gives" in problems[1]


def test_a_scene_that_began_otherwise_is_found(copy: Path, engine: BuiltinEngine) -> None:
    told = json.loads((copy / MANIFEST).read_text())
    told["initial"]["objects"][0]["support"] = "floor"
    (copy / MANIFEST).write_text(json.dumps(told))
    _resealed(copy)
    assert any(p.startswith("step 0:") for p in verify_run(copy, engine=engine).problems)


def test_an_old_record_has_no_digest_and_is_replayed_all_the_same(engine: BuiltinEngine) -> None:
    found = verify_run(OLD, engine=engine)
    assert (found.digest, found.problems) == ("", ())
    assert found.steps == len(read_trajectory(OLD).acts)


def test_damage_is_told_in_one_line(copy: Path, tmp_path: Path) -> None:
    (copy / EVENTS).write_text("{}\n")
    (problem,) = verify_run(copy).problems
    assert "line 1 is damaged" in problem and "\n" not in problem
    (copy / RESULT).unlink()
    assert verify_run(copy).problems
    with pytest.raises(RecordError, match="neither a run folder"):
        verify_run(tmp_path)


def test_an_episode_that_has_not_ended_is_told(copy: Path) -> None:
    (copy / RESULT).unlink()
    (problem,) = verify_run(copy, replayed=False).problems
    assert problem.startswith("result.json is missing")


class _Stops:
    """Ends an episode in the middle, as a kill does."""

    def __init__(self, after: int) -> None:
        self.left = after

    def __call__(self, *asked: Any) -> Reply:
        ask, messages, tools, sampling = asked
        self.left -= 1
        if self.left < 0:
            raise KeyboardInterrupt
        reply: Reply = ask(messages, tools, sampling)
        return reply


def test_an_episode_that_was_gone_on_with_is_what_its_result_says(
    tmp_path: Path, engine: BuiltinEngine
) -> None:
    run = tmp_path / "run"
    limits = Limits(max_steps=5)
    settings: dict[str, Any] = {"task": "T1", "resolution": "160x90", "limits": limits}
    with pytest.raises(KeyboardInterrupt):
        run_episode(model=Wrapped(RandomModel(1), _Stops(3)), engine=engine, out=run, **settings)
    assert verify_run(run, engine=engine).problems[0].startswith("result.json is missing")
    resume_episode(run, engine=engine, model=RandomModel(1))
    found = verify_run(run, engine=engine)
    assert (found.problems, len(found.digest)) == ((), 64)


def test_a_variation_is_sealed_with_its_scene(tmp_path: Path) -> None:
    run = tmp_path / "run"
    run_episode(
        task="T1",
        model="random:1",
        resolution="160x90",
        variation=1,
        out=run,
        limits=Limits(max_steps=3),
    )
    found = verify_run(run)
    assert found.problems == ()
    result = read_result(run)
    assert result is not None and result.seal is not None
    assert set(result.seal.files) == {"manifest.json", "events.jsonl", "scene.toml"}
    path = run / "scene.toml"
    path.write_text(path.read_text() + "\n# brighter\n")
    (problem,) = verify_run(run, replayed=False).problems
    assert problem == "scene.toml was changed after the result was written"
    path.unlink()
    (problem,) = verify_run(run, replayed=False).problems
    assert problem == "scene.toml is missing"


def test_a_script_is_sealed_too(tmp_path: Path, engine: BuiltinEngine) -> None:
    script, run = tmp_path / "said.json", tmp_path / "run"
    script.write_text('[{"tool": "Walk", "args": {"x": 0, "y": -2, "z": 0}}]')
    model = f"scripted:{script}"
    run_episode(task="T1", model=model, resolution="160x90", engine=engine, out=run)
    assert verify_run(run, engine=engine).problems == ()
    (run / "script.json").write_text("[]")
    (problem,) = verify_run(run, replayed=False).problems
    assert problem == "script.json was changed after the result was written"


def test_an_engine_of_ones_own_is_asked_for(copy: Path, engine: BuiltinEngine) -> None:
    told = json.loads((copy / MANIFEST).read_text())
    (copy / MANIFEST).write_text(json.dumps({**told, "engine": "MyEngine"}))
    _resealed(copy)
    (problem,) = verify_run(copy).problems
    assert "cannot be executed again" in problem and "hand it in again" in problem
    assert verify_run(copy, engine=engine).problems == ()
