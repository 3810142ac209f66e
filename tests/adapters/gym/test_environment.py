"""Rooms in Gymnasium: its checker, and the same score and state as an episode of ours."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import adamo_vh
import adamo_vh.gym
from adamo_vh.adapters.gym import environment
from adamo_vh.adapters.gym.environment import RoomEnv
from adamo_vh.episode.result import EpisodeResult, read_result
from adamo_vh.errors import ConfigError
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.session.lending import Lender, LentWorld
from adamo_vh.session.verifying import verify_run

SMALL = "160x90"
ID = "adamo_vh/S1-T3-v0"
LOOK = {"name": "Look", "arguments": {"x": 0.0, "y": -1.0, "z": 0.8}}
FINISH = {"name": "Finish", "arguments": {"answer": "Done."}}


class OneEngine:
    """Lends the tests' own engine, in place of those of the process."""

    def __init__(self, lender: Lender) -> None:
        self._lender = lender

    @contextmanager
    def lent(self, config: object) -> Iterator[LentWorld]:
        world = self._lender.lend()
        try:
            yield world
        finally:
            world.close()


@pytest.fixture(autouse=True)
def _shared(lent: LentWorld, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(environment, "process_engines", lambda: OneEngine(lent.lender))


def made(**settings: Any) -> gymnasium.Env[Any, Any]:
    return gymnasium.make(ID, resolution=SMALL, **settings)


def calls_of(folder: Path) -> list[Mapping[str, Any]]:
    """The calls of a recorded episode, as actions."""
    acts = read_trajectory(folder).acts
    return [{"name": act.name, "arguments": dict(act.arguments or {})} for act in acts]


@pytest.fixture
def record(lent: LentWorld, tmp_path: Path) -> tuple[Path, EpisodeResult]:
    """T8 by the baseline, in an episode of ours."""
    folder = tmp_path / "ours"
    world = lent.lender.lend()
    result = adamo_vh.run_episode(task="T8", resolution=SMALL, engine=world, out=folder)
    return folder, result


@pytest.mark.parametrize("actions", ["call", "structured"])
def test_the_checker_of_gymnasium_has_nothing_to_say(actions: str) -> None:
    env = made(actions=actions, render_mode="rgb_array")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped)
    env.close()


def test_the_same_calls_come_to_the_same_state_and_score(
    record: tuple[Path, EpisodeResult], tmp_path: Path
) -> None:
    folder, ours = record
    env = gymnasium.make("adamo_vh/S1-T8-v0", resolution=SMALL, out=tmp_path / "runs")
    env.reset(seed=1)
    rewards = [float(env.step(json.dumps(call))[1]) for call in calls_of(folder)]
    _, reward, terminated, truncated, info = env.step(json.dumps(FINISH))
    assert (terminated, truncated, reward) == (True, False, 0.0)
    assert rewards == [0.0, 0.5, 0.0, 0.5]
    assert sum(rewards) == ours.completion == info["completion"]
    assert (info["state_hash"], info["strict"]) == (ours.state_hash, ours.strict)
    env.close()
    (run,) = (tmp_path / "runs").iterdir()
    result = read_result(run)
    assert result is not None and result.score == ours.score
    assert verify_run(run, replayed=False).problems == ()


def test_an_observation_has_the_view_and_the_words_of_it() -> None:
    env = made()
    seen, info = env.reset(seed=0)
    assert seen in env.observation_space
    assert seen["image"].shape == (90, 160, 3) and seen["image"].std() > 10
    assert seen["text"].startswith("Instruction: Pick the blue circular object\n\n# Symbolic state")
    assert "Tape_4" in info["objects"]
    again, _, _, _, told = env.step(json.dumps(LOOK))
    assert told["outcome"] == "done" and told["feedback"] in again["text"]
    assert not np.array_equal(again["image"], seen["image"])
    env.close()


def test_a_view_comes_as_the_profile_grants_it() -> None:
    walk = json.dumps({"name": "Walk", "arguments": {"x": 1.0, "y": 1.0, "z": 0.0}})
    env = made()
    first, _ = env.reset()
    assert np.array_equal(env.step(walk)[0]["image"], first["image"])
    env.close()
    env = made(profile="lean")
    first, _ = env.reset()
    assert not np.array_equal(env.step(walk)[0]["image"], first["image"])
    env.close()


@pytest.mark.parametrize(
    "action",
    ["", "I would rather talk.", "[1]", '{"name": 3}', '{"name": "Jump"}', '{"name": "Pick"}',
     '{"name": "Pick", "arguments": "Plate_57"}', '{"name": "Look", "arguments": {"x": 1e999}}',
     "{" * 3000, '{"name": "Look", "arguments": {"x": NaN, "y": 0, "z": 0}}'],
)  # fmt: skip
def test_what_is_no_valid_call_is_refused_and_counts_as_a_step(action: str) -> None:
    env = made()
    env.reset()
    _, reward, terminated, truncated, info = env.step(action)
    assert (reward, terminated, truncated) == (0.0, False, False)
    assert (info["outcome"], info["steps"]) == ("refused", 1)
    env.close()


def test_structured_actions_point_at_what_is_in_view() -> None:
    env = made(actions="structured")
    room = env.unwrapped
    assert isinstance(room, RoomEnv)
    _, info = env.reset()
    tape = info["objects"].index("Tape_4")
    point = np.zeros(3, np.float32)
    pick = {"tool": room.tools.index("Pick"), "object": tape, "point": point}
    _, reward, *_, info = env.step(pick)
    assert (info["outcome"], reward) == ("done", 1.0)
    # What is in the hand is put down, whatever the number of the object says.
    floor = np.array([0.6, 0.6, -1.0], np.float32)
    drop = {"tool": room.tools.index("Drop"), "object": 63, "point": floor}
    _, reward, *_, info = env.step(drop)
    assert (info["outcome"] != "refused", reward) == (True, -1.0)
    *_, terminated, truncated, _ = env.step(
        {"tool": room.tools.index("Finish"), "object": 0, "point": point}
    )
    assert (terminated, truncated) == (True, False)
    env.close()


def test_a_limit_truncates_and_an_end_needs_a_reset() -> None:
    env = made(max_steps=2)
    env.reset()
    env.step(json.dumps(LOOK))
    *_, terminated, truncated, info = env.step('{"name": "Jump"}')
    assert (terminated, truncated, info["termination"]) == (False, True, "step_limit")
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.unwrapped.step(json.dumps(LOOK))
    env.reset()
    assert env.step(json.dumps(LOOK))[4]["steps"] == 1
    env.close()
    env.close()


def test_close_ups_are_in_the_info() -> None:
    env = made(profile="lean")
    _, info = env.reset()
    call = {"name": "Inspect", "arguments": {"object": info["objects"][0]}}
    info = env.step(json.dumps(call))[4]
    (closeup,) = info["closeups"]
    assert closeup.ndim == 3 and closeup.dtype == np.uint8
    env.close()


def test_every_scene_and_task_has_its_id() -> None:
    ids = {name for name in gymnasium.registry if name.startswith("adamo_vh/")}
    assert {f"adamo_vh/{scene}-T{n}-v0" for scene in ("S1", "S2") for n in range(1, 16)} <= ids
    assert "adamo_vh/Room-v0" in ids
    adamo_vh.gym.register()  # Twice is no fault.
    spec = gymnasium.spec("adamo_vh/S2-T10-v0")
    assert spec.kwargs == {"scene": "s2", "task": "T10"}


@pytest.mark.parametrize(
    ("settings", "match"),
    [
        ({"actions": "joystick"}, "Use call or structured"),
        ({"resolution": "big"}, "write WIDTHxHEIGHT"),
        ({"colour": "red"}, "no setting 'colour'"),
        ({"max_steps": 0}, "max_steps is 0"),
    ],
)
def test_a_wrong_setting_is_said_when_it_is_made(settings: dict[str, Any], match: str) -> None:
    with pytest.raises(ConfigError, match=match):
        gymnasium.make("adamo_vh/Room-v0", **settings)


def test_a_wrong_option_is_said_at_the_reset() -> None:
    env = made()
    with pytest.raises(ConfigError, match=r"no option 'scene'. Options: variation"):
        env.reset(options={"scene": "s2"})
    env.close()
