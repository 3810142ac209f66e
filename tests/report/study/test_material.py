"""What a report is made of: episodes grouped once, named, and found again by links."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.outcomes import made, repeated
from tests.report.study.material import TASKS, baseline, episodes, material, source

from adamo_vh.analysis.cells import Setting
from adamo_vh.errors import RecordError
from adamo_vh.inference.model import ModelKind
from adamo_vh.report.study.material import Material, names


@pytest.fixture(scope="module")
def of() -> Material:
    return material(source("mine", episodes(), baseline()))


def test_places_have_anchors_of_their_own(of: Material) -> None:
    anchors = [of.anchor(row.setting, row.scene, row.labeling, row.task) for row in of.cells]
    anchors += [
        of.anchor(setting, scene, labeling)
        for setting in of.settings
        for scene in ("s1", "s2")
        for labeling in ("sem", "opaq")
    ]
    anchors += [of.anchor(setting) for setting in of.settings]
    assert len(set(anchors)) == len(anchors) == 2 * (4 * 5 + 4 + 1)


def test_half_a_place_leads_to_the_whole_setting(of: Material) -> None:
    setting = of.settings[0]
    assert of.link(setting, scene="s1") == of.link(setting, labeling="sem") == of.link(setting)


def test_everything_played_is_found_in_order(of: Material) -> None:
    assert of.tasks == TASKS
    assert (of.scenes, of.labelings) == (("s1", "s2"), ("opaq", "sem"))
    assert [setting.model for setting in of.settings] == ["baseline", "openai:gpt-4o"]
    assert sum(len(group) for group in of.by_cell.values()) == len(of.outcomes) == 20 + 60


def test_a_mean_is_found_by_where_it_is_of(of: Material) -> None:
    setting = of.settings[1]
    everywhere, there = of.mean(setting), of.mean(setting, scene="s1", labeling="sem")
    assert everywhere is not None and everywhere.figures.n == 60
    assert there is not None and there.figures.n == 15
    assert of.mean(setting, scene="s9") is None


def test_a_cell_that_was_not_played_is_none(of: Material) -> None:
    assert of.cell(of.settings[0], "s1", "sem", "T15") is None
    row = of.cell(of.settings[0], "s1", "sem", "T1")
    assert row is not None and row.figures.n == 1


@pytest.mark.parametrize(
    ("labeling", "scene", "name"),
    [
        ("sem", "s1", "sem-s1"),
        ("SEM", "s2", "sem-s2"),
        ("sem", "my/room.toml", "0-0"),
        ("a name", "s1", "0-0"),
        ("ü", "s1", "0-0"),
        ("x" * 40, "s1", "0-0"),
    ],
)
def test_files_have_names_that_every_system_takes(labeling: str, scene: str, name: str) -> None:
    only = material(source("mine", iter([made("T1", labeling=labeling, scene=scene)])))
    assert only.short(labeling, scene) == name


def test_episodes_of_two_studies_are_not_mixed() -> None:
    first, second = (tuple(repeated("T1", 1.0, score)) for score in (0.0, 1.0))
    ways = {first[0].key: (2, 1)}
    pages = {second[0].key: "b/episode.html"}
    both = material(
        source("a", iter(first), distances=ways), source("b", iter(second), pages=pages)
    )
    assert both.distances == {f"a: {first[0].key}": (2, 1)}
    assert both.pages == {f"b: {second[0].key}": "b/episode.html"}
    means = [row.figures.completion.mean for row in both.cells]
    assert means == [0.5, 1.0]


def test_one_study_cannot_hold_two_episodes_of_a_name() -> None:
    with pytest.raises(RecordError, match="side by side"):
        material(source("mine", iter([made("T1", 1.0), made("T1", 0.0)])))


def test_a_chip_says_what_came_of_its_episode(of: Material) -> None:
    one = made("T1", 0.0, diagnosis="execution", diagnosis_code="gave_up")
    (chip,), more = of.chips([one])
    assert chip.title == f"{one.key}: completion 0.00, gave up"
    assert (chip.kind, chip.href, more) == ("c0", "", 0)


@pytest.mark.parametrize(
    ("score", "kind"),
    [(None, "cu"), (0.0, "c0"), (0.2, "c1"), (0.5, "c2"), (0.8, "c2"), (1.0, "c3")],
)
def test_a_chip_is_coloured_by_its_score(of: Material, score: float | None, kind: str) -> None:
    (chip,), _ = of.chips([made("T15", score)])
    assert chip.kind == kind


@pytest.mark.parametrize(
    ("axes", "name"),
    [
        ({"switches.plan": "1"}, "m, plan=1"),
        ({"switches.plan": "1", "k": "4"}, "m, k=4, plan=1"),
        ({"a.plan": "1", "b.plan": "2"}, "m, a.plan=1, b.plan=2"),
    ],
)
def test_a_setting_is_named_without_the_group_it_stands_in(axes: dict[str, str], name: str) -> None:
    one = Setting("m", ModelKind.RANDOM, "paper", tuple(sorted(axes.items())))
    other = replace(one, axes=tuple((axis, "9") for axis in sorted(axes)))
    assert names([one, other])[one] == name
