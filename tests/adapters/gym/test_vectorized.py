"""Many rooms at once, each in a process of its own."""

from __future__ import annotations

import json
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AsyncVectorEnv, SyncVectorEnv

import adamo_vh.gym

LOOK = json.dumps({"name": "Look", "arguments": {"x": 0.0, "y": -1.0, "z": 0.8}})
PICK = json.dumps({"name": "Pick", "arguments": {"object": "Tape_4"}})
JUMP = json.dumps({"name": "Jump", "arguments": {}})


def room() -> gymnasium.Env[Any, Any]:
    return gymnasium.make("adamo_vh.gym:adamo_vh/S1-T3-v0", resolution="160x90")


def played(envs: Any) -> tuple[Any, Any, Any]:
    """What two different actions bring after a first one."""
    envs.reset(seed=[1, 2])
    envs.step((LOOK, LOOK))
    seen, rewards, *_ = envs.step((PICK, JUMP))
    return seen["image"], seen["text"], rewards


@pytest.mark.slow
def test_processes_come_to_what_one_process_comes_to() -> None:
    assert adamo_vh.gym.rooms()
    one = SyncVectorEnv([room, room])
    here = played(one)
    one.close()
    many = AsyncVectorEnv([room, room], context="spawn", shared_memory=False)
    there = played(many)
    many.close()
    assert np.array_equal(here[0], there[0])
    assert here[1] == there[1]
    assert list(here[2]) == list(there[2]) == [1.0, 0.0]
