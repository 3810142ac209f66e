"""A task of your own: what is asked, how hard it is, and when it is done.

The conditions read the world's truth at the end of an episode. The oracle makes its plan from them,
which is how a task is shown to be possible before any model is asked.
"""

from __future__ import annotations

import adamo_vh
from adamo_vh import Task
from adamo_vh.benchmark.conditions import Near, OnFloor
from adamo_vh.benchmark.tasks import Family
from adamo_vh.benchmark.taxonomy import Act, Difficulty, Ref, Rel

TIDY = Task(
    id="TIDY",
    prompt="Put the cup on the floor and the key next to the plate",
    family=Family.SEVERAL,
    units=(Act.PICK, Act.DROP, Ref.TAG, Rel.FLOOR, Act.PICK, Act.DROP, Ref.TAG, Ref.TAG, Rel.PROX),
    printed=Difficulty(4, 3, 3, 10),
    conditions=(OnFloor(45), Near(34, 57)),
)


def main() -> None:
    """Play it and see every condition."""
    print("C-D level:", TIDY.computed)
    result = adamo_vh.run_episode(task=TIDY, scene="s1", resolution=(1280, 720))
    score = result.score
    assert score is not None, "broken: unscored"
    print("completion:", score.completion, "strict:", score.strict)
    for condition in score.conditions:
        print(" ", condition.text, "- yes" if condition.satisfied else "- no")


if __name__ == "__main__":
    main()
