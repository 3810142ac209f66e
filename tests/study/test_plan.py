"""The plan: which episodes, under which keys, with which seeds."""

from __future__ import annotations

import hashlib
import re

import pytest

from adamo_vh.errors import ConfigError, ModelConfigError
from adamo_vh.study.axes import slug
from adamo_vh.study.named import NAMED
from adamo_vh.study.plan import Study, plan
from adamo_vh.study.study_file import read_study


def test_a_key_says_what_an_episode_is_and_stays_the_same() -> None:
    (episode,) = plan(Study(("T8",), labelings=("opaq",)))
    assert episode.key == "s1/T08/opaq/baseline/paper/v0000/r01"
    assert episode.config.seed == int.from_bytes(
        hashlib.sha256(b"s1/T08/opaq/baseline/paper/v0000/r01").digest()[:4], "big"
    )
    assert episode.config.task == "T8"


def test_a_further_axis_stands_behind_the_key() -> None:
    episodes = plan(Study(("T1",), axes={"k": (4, 50), "text_form": ("full",)}))
    assert [one.key for one in episodes] == [
        "s1/T01/sem/baseline/paper/v0000/r01/k=4/text_form=full",
        "s1/T01/sem/baseline/paper/v0000/r01/k=50/text_form=full",
    ]
    assert [one.config.k for one in episodes] == [4, 50]
    assert episodes[0].cell.axes == (("k", "4"), ("text_form", "full"))


def test_every_combination_is_planned_once() -> None:
    study = Study(
        ("T1", "T8"),
        scenes=("s1", "s2"),
        labelings=("sem", "opaq"),
        models=("baseline", "random"),
        repetitions=3,
    )
    episodes = plan(study)
    assert len(episodes) == 8 * (1 + 3)
    assert len({one.key for one in episodes}) == len(episodes)
    assert len({one.config.seed for one in episodes}) == len(episodes)
    assert plan(study) == episodes


@pytest.mark.parametrize(
    ("model", "runs"),
    [("baseline", 1), ("random:7", 1), ("random", 5), ("openai:gpt-4o", 5), ("scripted:x.json", 1)],
)
def test_what_is_deterministic_is_played_once_a_variation(model: str, runs: int) -> None:
    assert len(plan(Study(("T1",), models=(model,), repetitions=5))) == runs


def test_an_unknown_model_is_refused_and_none_is_asked() -> None:
    with pytest.raises(ModelConfigError, match="Unknown model 'gpt'"):
        plan(Study(("T1",), models=("gpt",)))


@pytest.mark.parametrize(
    "uri", ["openai:GPT-4o", "openai:gpt-4o", "openai:a/b@http://127.0.0.1:8000/v1", "x" * 90]
)
def test_a_slug_is_a_plain_name_that_meets_no_other(uri: str) -> None:
    found = slug(uri)
    assert re.fullmatch(r"[a-z0-9._=,+-]{1,80}", found)
    assert found != slug(uri + "x")
    assert slug("baseline") == "baseline"


@pytest.mark.parametrize("bad", ["..", ".", "/", "a/../b", "\\", "", " "])
def test_no_name_leads_out_of_the_folder(bad: str) -> None:
    found = slug(bad)
    assert "/" not in found
    assert found not in (".", "..", "")


def test_values_with_parts_are_an_axis_too() -> None:
    low, high = plan(read_study("sampling", {"tasks": ["T1"]}))[::2]
    assert low.key.endswith("/sampling=temperature=0,top_p=0")
    assert (high.config.sampling.temperature, high.config.sampling.top_p) == (0.8, 1.0)


def test_parts_of_a_group_and_switches_can_be_set_and_varied() -> None:
    study = Study(
        ("T1",),
        settings={"limits.max_steps": 9},
        axes={"switches.plan": (1, 3)},
        profiles=("lean",),
    )
    one, three = plan(study)
    assert one.config.limits.max_steps == three.config.limits.max_steps == 9
    assert (one.config.profile.plan, three.config.profile.plan) == (1, 3)


@pytest.mark.parametrize(
    ("name", "episodes"),
    [("paper", 900), ("memory", 1800), ("sampling", 675), ("points", 1125), ("resolution", 675)],
)
def test_the_papers_studies_have_their_size(name: str, episodes: int) -> None:
    assert len(plan(read_study(name, {"models": ["random"]}))) == episodes
    assert name in NAMED


@pytest.mark.parametrize(
    ("study", "said"),
    [
        ({"tasks": ()}, "no tasks"),
        ({"tasks": ("T1", "T1")}, "T1 stands twice in tasks"),
        ({"tasks": ("T1",), "repetitions": 0}, "whole number from 1"),
        ({"tasks": ("T1",), "repetitions": True}, "whole number from 1"),
        ({"tasks": ("T1",), "axes": {"k": (4, 4)}}, "4 stands twice in axis k"),
        ({"tasks": ("T1",), "axes": {"k": (4,)}, "settings": {"k": 5}}, "set and varied"),
    ],
)
def test_a_study_that_cannot_be_played_is_refused(study: dict, said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        Study(**study)


def test_two_names_of_one_thing_are_not_played_twice() -> None:
    with pytest.raises(ConfigError, match="twice"):
        plan(Study(("T1",), profiles=("paper", "PAPER")))


def test_a_plan_beyond_all_use_is_refused_before_it_is_made() -> None:
    study = Study(("T1",), models=("random",), repetitions=10**9)
    with pytest.raises(ConfigError, match="split it"):
        plan(study)
