"""Study files and options: what they may say, and what is said to those that are wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from adamo_vh.errors import ConfigError, FileError
from adamo_vh.study.plan import plan
from adamo_vh.study.study_file import read_study


def _file(folder: Path, text: str) -> str:
    path = folder / "mine.toml"
    path.write_text(text)
    return str(path)


def test_a_file_says_everything(tmp_path: Path) -> None:
    study = read_study(
        _file(
            tmp_path,
            """
            tasks = ["t1", "T8"]
            scenes = ["S1", "s2"]
            labelings = ["opaq"]
            models = ["random"]
            repetitions = 3
            resolution = "640x360"
            limits = {max_steps = 40}
            axes.k = [4, 50]
            """,
        ),
        {},
    )
    assert (study.tasks, study.scenes, study.name) == (("T1", "T8"), ("s1", "s2"), "mine")
    episodes = plan(study)
    assert len(episodes) == 2 * 2 * 3 * 2
    assert episodes[0].config.resolution == (640, 360)
    assert episodes[0].config.limits.max_steps == 40


def test_options_replace_what_the_file_says(tmp_path: Path) -> None:
    file = _file(tmp_path, 'tasks = ["T1"]\nmodels = ["random"]\naxes.k = [4, 50]\n')
    study = read_study(file, {"tasks": ["T2"], "k": 6})
    assert (study.tasks, study.models, dict(study.axes)) == (("T2",), ("random",), {})
    assert study.settings == {"k": 6}


def test_a_file_may_start_from_one_of_the_papers_studies(tmp_path: Path) -> None:
    study = read_study(_file(tmp_path, 'study = "memory"\nrepetitions = 2\naxes.grid = [3]\n'), {})
    assert study.repetitions == 2
    assert dict(study.axes) == {
        "k": (4, 6, 10, 50),
        "switches.buffer_unit": ("step", "block"),
        "grid": (3,),
    }


@pytest.mark.parametrize(
    ("given", "found"),
    [(0, (0,)), ("0-4", (0, 1, 2, 3, 4)), ("0,2, 7-9", (0, 2, 7, 8, 9)), ([1, "3-4"], (1, 3, 4))],
)
def test_variations_are_numbers_and_ranges(given: object, found: tuple[int, ...]) -> None:
    assert read_study(None, {"variations": given}).variations == found


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("task = 'T1'", "Did you mean tasks"),
        ("labelings = 3", "labelings is 3: write a list of texts"),
        ("tasks = [1]", "write a list of texts"),
        ("tasks = ['T1', 't1']", "T1 stands twice in tasks"),
        ("tasks = []", "no tasks"),
        ("repetition = 3", "Did you mean repetitions"),
        ("repetitions = '3'", "whole number from 1"),
        ("variations = '4-2'", "a range as"),
        ("variations = -1", "from 0 to 9999"),
        ("variations = true", "from 0 to 9999"),
        ("seed = 3", "no setting 'seed'"),
        ("study = 'nature'", "name one of paper"),
        ("axes = 3", "write a table"),
        ("axes.k = 4", "write the list of its values"),
        ("axes.k = []", "no axis k"),
        ("axes.tasks = ['T1']", "list its values under tasks"),
        ("axes.task = ['T1']", "list its values under tasks"),
        ("axes.sede = [1]", "cannot set or vary 'sede'"),
        ("axes.limits.max = [1]", "no 'max' in limits"),
        ("limits = 3", "write a table"),
        ("limits = {max = 3}", "no 'max' in limits"),
        ("k = 0", "at least 1 step"),
        ("resolution = '640'", "write WIDTHxHEIGHT"),
        ("labelings = ['none']", "no labeling 'none'"),
        ("profiles = ['fat']", "no profile 'fat'"),
        ("switches = {plna = 3}", "no 'plna' in switches"),
        ("sampling = {temperature = 'hot'}", "sampling"),
    ],
)
def test_a_wrong_file_is_told_what_helps(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ConfigError) as caught:
        plan(read_study(_file(tmp_path, text), {}))
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_what_is_no_toml_is_a_clear_error(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="not valid TOML"):
        read_study(_file(tmp_path, "tasks = ["), {})


def test_a_name_that_is_neither_study_nor_file_is_told_both() -> None:
    with pytest.raises(ConfigError, match=r"paper.*or a TOML file"):
        read_study("nature", {})
