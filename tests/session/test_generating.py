"""Generated tasks are proved before anybody is asked to do them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from adamo_vh.benchmark.tasks import task as find_task
from adamo_vh.errors import ConfigError
from adamo_vh.session.generating import generate, write_task
from adamo_vh.session.proving import LUCK, is_settled


def test_a_task_is_proved_and_written(tmp_path: Path) -> None:
    made = list(generate(31, 1, ["s1"], random_episodes=1))
    assert [one.task.id for one in made] == ["DEV-31-001"]
    assert all(one.random < LUCK for one in made)
    for one in made:
        path = write_task(tmp_path, one.task)
        assert find_task(str(path)) == one.task
        assert write_task(tmp_path, one.task) == path
        path.write_text("other")
        with pytest.raises(ConfigError, match="another task"):
            write_task(tmp_path, one.task)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"count": 0}, "use 1 to 1000"),
        ({"seed": -1}, "whole number from 0"),
        ({"split": "train"}, "use dev or test"),
    ],
)
def test_what_is_wrong_is_told_before_anything_is_made(
    arguments: dict[str, Any], said: str
) -> None:
    with pytest.raises(ConfigError, match=said):
        next(generate(**{"seed": 0, "count": 1, **arguments}))


@pytest.mark.parametrize("completions", [[0.0] * 20, [1.0] * 20, [0.5, 0.0, 0.0, 0.0] * 5])
def test_no_more_is_played_by_lot_than_settles_it(completions: list[float]) -> None:
    played = next(
        (n for n in range(20) if is_settled(sum(completions[:n]), n, len(completions))), 20
    )
    assert 0 < played < 20
    is_luck = sum(completions) / 20 >= LUCK
    assert (sum(completions[:played]) / played >= LUCK) is is_luck
