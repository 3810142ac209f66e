"""OpenEnv's own validator and clients against our server, in an environment of their own."""

from __future__ import annotations

import os
import subprocess
import sys
import venv
from pathlib import Path

import pytest
from tests.service.conftest import Serve

pytestmark = pytest.mark.extras

OPENENV = "openenv==0.10.0"
PLAYS = """
import sys
from openenv.core.generic_client import GenericEnvClient
from openenv.core.mcp_client import MCPToolClient

with GenericEnvClient(base_url=sys.argv[1]).sync() as env:
    first = env.reset(split="S1", index=2)
    print(first.observation["result"]["instruction"])
    action = {"type": "call_tool", "tool_name": "Pick", "arguments": {"object": "Tape_4"}}
    step = env.step(action)
    print("reward", step.reward, "done", step.done)
    print("state", env.state()["step_count"])
for production in (False, True):
    client = MCPToolClient(base_url=sys.argv[1])
    client.use_production_mode = production
    with client.sync() as env:
        if not production:
            env.reset(task="T3")
        print([tool.name for tool in env.list_tools()])
        print("looking at" in str(env.call_tool("Look", x=0.0, y=-1.0, z=0.8)))
"""


@pytest.fixture(scope="module")
def openenv(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The commands of an environment that has OpenEnv and nothing of ours."""
    given = os.environ.get("ADAMO_VH_OPENENV")
    if given:
        return Path(given)
    folder = tmp_path_factory.mktemp("openenv")
    venv.create(folder, with_pip=True)
    pip = [str(folder / "bin" / "python"), "-m", "pip", "install", "--quiet", OPENENV]
    subprocess.run(pip, check=True, timeout=900)
    return folder / "bin"


def test_the_validator_passes(serve: Serve, openenv: Path) -> None:
    command = [str(openenv / "openenv"), "validate", f"{serve()[0]}/openenv"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Verdict: PASS" in done.stdout and "FAIL" not in done.stdout


def test_its_clients_play(serve: Serve, openenv: Path) -> None:
    command = [str(openenv / "python"), "-c", PLAYS, f"{serve()[0]}/openenv"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=180, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.splitlines() == [
        "Pick the blue circular object",
        "reward 1.0 done False",
        "state 1",
        *["['Look', 'Walk', 'Pick', 'Drop', 'Finish', 'observe']", "True"] * 2,
    ]
    assert sys.executable != str(openenv / "python")
