"""The examples run as they stand, each in a folder of its own, and say what they promise."""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
SAYS = {
    "00_first_episode.py": ["completion:  1.0 strict: 1.0", "the same"],
    "01_own_loop.py": ["Done: walked", "on the floor", "Refused: no object tagged 'Plate_999'"],
    "02_own_model.py": ["answered", "is in your hand"],
    "03_own_tool.py": ["Done: Cup_45 is", "m away"],
    "04_own_scene.py": ["answered - Done:", "on the floor"],
    "05_own_task.py": ["completion: 1.0 strict: 1.0", "45 on floor - yes", "34 near 57 - yes"],
    "06_own_labeling.py": ["cup-45 is in your hand", "answered - I hold it."],
    "07_own_engine.py": ["the body says:", "answered - The red block lies beside the yellow one."],
    "08_many_at_once.py": ["T1 1.0 after", "T2 1.0 after", "T4 1.0 after", "T8 1.0 after"],
    "09_reinforcement_learning.py": ["reward 0.5", "ended: answered, completion 1.0, strict 1.0"],
    "10_mcp_client.py": ["Done: walked", "the end:  The episode has ended.", "score:    1.0"],
}


def test_every_example_is_run() -> None:
    assert sorted(SAYS) == sorted(path.name for path in EXAMPLES.glob("*.py"))


@pytest.mark.parametrize("name", SAYS)
def test_an_example_does_what_it_says(
    name: str,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [name])
    runpy.run_path(str(EXAMPLES / name), run_name="__main__")
    printed = capfd.readouterr().out
    assert [words for words in SAYS[name] if words not in printed] == [], printed
