"""The forecast of a study: from its plan, before anything is started."""

from __future__ import annotations

import pytest

from adamo_vh.study.outlook import ModelOutlook, Outlook, outlook
from adamo_vh.study.plan import Study, plan


def _remote(model_s: float, world_s: float) -> ModelOutlook:
    return ModelOutlook("m", True, 1, 1, 1, 1, 1, None, None, 6.85, model_s, world_s)


def _local(model_s: float, world_s: float) -> ModelOutlook:
    return ModelOutlook("l", False, 1, 1, 0, 0, 0, 0.0, 0.0, 0.1, model_s, world_s)


def test_waiting_is_shared_by_what_is_in_flight_and_work_by_the_cores() -> None:
    assert Outlook((_remote(3200, 10),), {}, 2, 16, 2).seconds == pytest.approx(3210 / 32)
    assert Outlook((_remote(32, 1000),), {}, 2, 16, 2).seconds == pytest.approx(500)
    assert Outlook((_local(60, 40),), {}, 8, 1, 2).seconds == pytest.approx(50)


@pytest.mark.slow
def test_a_paid_model_is_forecast_without_a_key(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OPENAI_API_KEY", raising=False)
    study = Study(
        ("T1", "T15"),
        models=("openai:gpt-4o", "random"),
        repetitions=15,
        settings={"resolution": "640x360"},
    )
    ahead = outlook(plan(study), 2, 16)
    paid, free = ahead.models
    assert (paid.model, paid.episodes, paid.is_remote) == ("openai:gpt-4o", 30, True)
    assert paid.calls == 15 * 2 + 15 * 11
    assert paid.tokens_low < paid.tokens < paid.tokens_high
    assert paid.usd is not None and paid.usd_high is not None
    assert 0 < paid.usd < paid.usd_high
    assert paid.model_s == pytest.approx(paid.calls * 6.85)
    assert (free.tokens, free.usd) == (0, 0.0)
    assert 0 < free.seconds_per_call < 5
    assert ahead.action_s["s1 640x360"] > 0
