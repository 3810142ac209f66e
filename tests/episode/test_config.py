"""Settings: read from what people write, and refused before anything starts."""

from __future__ import annotations

import math
from typing import Any

import pytest

from adamo_vh.benchmark.conditions import Near
from adamo_vh.benchmark.tasks import task
from adamo_vh.cognition.budget import Budget
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import ConfigError
from adamo_vh.inference.model import Sampling
from adamo_vh.perception import Labeling, TextForm
from adamo_vh.record.termination import Limits


def test_texts_are_read() -> None:
    config = EpisodeConfig.of(
        task="t4", labeling="OPAQ", profile="lean", switches={"plan": "3"}, resolution="960x540",
        text_form="paper", limits=None,
    )  # fmt: skip
    assert (config.task, config.instruction) == ("T4", task("T4").prompt)
    assert (config.labeling, config.text_form) == (Labeling.OPAQ, TextForm.PAPER)
    assert (config.resolution, config.profile.plan) == ((960, 540), 3)
    assert config.limits == Limits()


@pytest.mark.parametrize(
    ("settings", "part"),
    [
        ({"resolution": (0, 0)}, "use 64x64"),
        ({"resolution": (640.5, 360)}, "whole number"),
        ({"resolution": "640 by 360"}, "WIDTHxHEIGHT"),
        ({"resolution": "\u0661\u0662\u0663x360"}, "WIDTHxHEIGHT"),
        ({"seed": -1}, "from 0"),
        ({"seed": 1.5}, "whole number"),
        ({"seed": True}, "whole number"),
        ({"variation": -1}, "use 0, the scene as it is"),
        ({"variation": 1_000_000}, "up to 999999"),
        ({"variation": 1.0}, "whole number"),
        ({"k": "7"}, "whole number"),
        ({"grid": math.nan}, "whole number"),
        ({"sampling": Sampling(temperature=math.nan)}, "temperature"),
        ({"sampling": Sampling(temperature=-1)}, "temperature"),
        ({"sampling": Sampling(top_p=1.5)}, "top_p"),
        ({"sampling": Sampling(max_tokens=0)}, "max_tokens"),
        ({"colour": "red"}, "There is no setting 'colour'"),
    ],
)
def test_what_makes_no_sense_is_refused(settings: dict[str, Any], part: str) -> None:
    with pytest.raises(ConfigError, match=part):
        EpisodeConfig.of("Look", **settings)


@pytest.mark.parametrize(
    "caps",
    [
        {"max_steps": -3},
        {"max_steps": 0},
        {"max_steps": 2.5},
        {"max_steps": math.nan},
        {"max_seconds": -1},
        {"max_seconds": math.nan},
        {"max_seconds": math.inf},
        {"max_repeats": -1},
        {"max_unreadable": 0},
    ],
)
def test_limits_are_amounts(caps: dict[str, Any]) -> None:
    with pytest.raises(ConfigError, match=next(iter(caps))):
        Limits(**caps)


@pytest.mark.parametrize("cap", [-1, math.nan, math.inf, True, "5"])
@pytest.mark.parametrize("name", ["tokens", "usd", "calls", "seconds"])
def test_a_budget_is_of_amounts(name: str, cap: Any) -> None:
    with pytest.raises(ConfigError, match=name):
        Budget(**{name: cap})


def test_a_task_names_all_that_it_is_about() -> None:
    assert task("T9").objects == {37, 57, 30, 3}
    assert Near(37, 57) in task("T9").conditions
    assert task("T7").areas == {"corner"}
