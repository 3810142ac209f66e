"""The first episode: say what to do, read what came of it, open its page.

The `baseline` needs no key. It is rule-based and sees only what a model would see.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import adamo_vh


def main() -> None:
    """Run a task of the benchmark and keep its record."""
    folder = Path(tempfile.mkdtemp()) / "run"
    result = adamo_vh.run_episode(task="T4", scene="s1", model="baseline", out=folder)
    print("ended:      ", result.termination, "-", result.answer)
    print("completion: ", result.completion, "strict:", result.strict)
    print("calls:      ", result.model_calls)
    print("page:       ", folder / "episode.html")
    replayed = adamo_vh.replay_episode(folder)
    print("replay:     ", "the same" if not replayed.mismatches else "different")


if __name__ == "__main__":
    main()
