"""`adamo-vh verify-run`, and `--sign`: what they print, and how they end."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

from tests.cli.process import walk
from tests.keys import key_file, public_key_file

SMALL = ("--resolution", "160x90")
OLD = Path(__file__).resolve().parents[1] / "data" / "format_1" / "s1-sem-paper-T4"


def test_a_signed_run_is_verified_and_a_changed_one_is_not(tmp_path: Path) -> None:
    key, other = key_file(tmp_path / "key"), key_file(tmp_path / "other")
    public = public_key_file(key)
    script = tmp_path / "said.json"
    script.write_text(json.dumps([{"tool": "Look", "args": {"x": 0, "y": -1, "z": 0.8}}]))
    run = ("run", "--task", "T1", "--model", f"scripted:{script}", *SMALL, "--json")
    (begun,) = walk([[*run, "--out", "r", "--sign", "key"]], cwd=tmp_path)
    assert begun.code == 0, begun.all
    changed = tmp_path / "changed"
    shutil.copytree(tmp_path / "r", changed)
    events = changed / "events.jsonl"
    events.write_text(events.read_text().replace('"note"', '"nope"').replace("finished", "done"))
    done = walk(
        [
            ["verify-run", "r"],
            ["verify-run", "r", "--key", str(public), "--json"],
            ["verify-run", "r", "--key", str(other), "--no-replay"],
            ["verify-run", "changed", "--no-replay"],
            ["verify-run", str(OLD), "--no-replay"],
            ["verify-run", "nowhere"],
            [*run, "--out", "x", "--sign", "nokey"],
            ["bench", "--tasks", "T1", "--out", "y", "--sign", str(script)],
        ],
        cwd=tmp_path,
    )
    same, told, wrong, differs, old, nowhere, no_key, no_such = done
    assert (same.code, same.out[:12]) == (0, "Same: digest")
    assert "every state hash equal in 1 steps; signed by SHA256:" in same.out
    found = json.loads(told.out)
    assert (told.code, found["ok"], found["problems"], found["steps"]) == (0, True, [], 1)
    assert (wrong.code, "signed by another key" in wrong.out) == (1, True)
    assert differs.code == 1
    assert "Different: events.jsonl was changed after the result was written" in differs.out
    assert (old.code, "no digest" in old.out) == (0, True)
    assert (nowhere.code, "neither a run folder" in nowhere.err) == (2, True)
    assert (no_key.code, "nokey cannot be read" in no_key.err) == (2, True)
    assert (no_such.code, "openssl genpkey" in no_such.err) == (2, True)
    assert not (tmp_path / "x").exists() and not (tmp_path / "y").exists()


def test_a_signed_study_is_verified_and_says_which_episode_differs(tmp_path: Path) -> None:
    key_file(tmp_path / "key")
    study = ("bench", "--tasks", "T1", "--model", "random", "--repetitions", "2", *SMALL)
    limits = ("--set", "limits.max_steps=4", "--workers", "1", "--out", "s", "--sign", "key")
    begun, told = walk(
        [[*study, *limits, "--json"], ["verify-run", "s", "--key", "key", "--json"]], cwd=tmp_path
    )
    assert begun.code == 0, begun.all
    found = json.loads(told.out)
    assert told.code == 0, told.all
    assert (found["ok"], found["episodes"], found["problems"]) == (True, 2, {})
    assert (found["chain"]["links"], found["chain"]["problems"]) == (2, [])
    assert found["steps"] == 8 and found["signed_by"] == found["chain"]["signed_by"]
    runs = tmp_path / "s" / "episodes" / "s1" / "T01" / "sem" / "random" / "paper" / "v0000"
    frame = next((runs / "r02" / "frames").iterdir())
    frame.write_bytes(b"")
    shutil.rmtree(runs / "r01")
    (wrong,) = walk([["verify-run", "s", "--no-replay"]], cwd=tmp_path)
    key = "s1/T01/sem/random/paper/v0000"
    assert wrong.code == 1
    assert f"Different: {key}/r02: frames/{frame.name} is another picture" in wrong.out
    assert f"Different: {key}/r01 has no result any more, and the chain knows one" in wrong.out
    assert "0 of 1 episodes are the same" in wrong.out
