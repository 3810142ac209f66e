"""Task files: what they can say, that nothing is lost on the way, and what is told of faults."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from adamo_vh.benchmark.conditions import (
    And,
    Beside,
    Condition,
    Holds,
    InArea,
    Near,
    Not,
    NothingElseMoved,
    On,
    Once,
    OnFloor,
    Or,
    Ordered,
    Stays,
)
from adamo_vh.benchmark.tasks import TASKS, Family, Task, builtin_tasks, task
from adamo_vh.benchmark.tasks.reading import parse_task, read_task
from adamo_vh.benchmark.tasks.writing import task_text
from adamo_vh.benchmark.taxonomy import COSTS, Act, Difficulty, Ref, Rel
from adamo_vh.errors import AdamoError, ConfigError, FileError
from adamo_vh.readable import readable

FILE = """
id = "TIDY-1"
prompt = "Put the cup on the floor, then the key left of the plate"
units = ["pick", "drop", "tag", "floor", "pick", "drop", "tag", "tag", "side", "order"]
scenes = ["s1"]
conditions = [
  { ordered = [{ on_floor = 45 }, { left_of = { object = 34, anchor = 57 } }] },
  { not = { in_area = { object = 45, area = "corner" } } },
  { nothing_else_moved = true },
]
"""

ids = st.integers(0, 9999)
names = st.from_regex(r"[A-Za-z0-9][A-Za-z0-9 _/.-]{0,30}", fullmatch=True)
pairs = st.tuples(ids, ids).filter(lambda pair: pair[0] != pair[1])
atoms: st.SearchStrategy[Condition] = st.one_of(
    st.builds(Holds, ids),
    st.builds(OnFloor, ids),
    st.builds(Stays, ids),
    st.builds(On, ids, names),
    st.builds(InArea, ids, names),
    pairs.map(lambda pair: Near(*pair)),
    pairs.map(lambda pair: Beside(*pair, "left")),
    pairs.map(lambda pair: Beside(*pair, "right")),
)
several = st.recursive(
    atoms,
    lambda inner: st.one_of(
        st.lists(inner, min_size=2, max_size=3).map(lambda parts: And(tuple(parts))),
        st.lists(inner, min_size=2, max_size=3).map(lambda parts: Or(tuple(parts))),
        st.lists(inner, min_size=2, max_size=3).map(lambda parts: Ordered(tuple(parts))),
        inner.map(Not),
        inner.map(Once),
    ),
    max_leaves=6,
).filter(lambda condition: _depth(condition) <= 6)
prompts = st.text(
    st.characters(exclude_categories=["C", "Zl", "Zp"]), min_size=1, max_size=80
).filter(lambda text: bool(text.strip()) and readable(text) == text)


def _depth(condition: Condition) -> int:
    parts = getattr(condition, "parts", (getattr(condition, "part", None),))
    return 1 + max((_depth(part) for part in parts if part is not None), default=0)


@st.composite
def tasks(draw: st.DrawFn) -> Task:
    units = tuple(draw(st.lists(st.sampled_from(sorted(COSTS)), min_size=1, max_size=9)))
    conditions = tuple(draw(st.lists(several, min_size=1, max_size=4)))
    figures = draw(st.one_of(st.none(), st.tuples(*[st.integers(0, 99)] * 4)))
    return Task(
        draw(st.from_regex(r"[A-Za-z0-9][A-Za-z0-9_-]{0,39}", fullmatch=True)),
        draw(prompts),
        draw(st.sampled_from(Family)),
        units,
        Difficulty(*figures) if figures else Difficulty.of(units),
        conditions,
        tuple(draw(st.lists(names, max_size=2))),
        tuple(draw(st.lists(several, max_size=2))),
    )


def test_a_file_says_it_all() -> None:
    found = parse_task(FILE, "tidy.toml")
    assert found.id == "TIDY-1"
    assert found.conditions == (
        Ordered((OnFloor(45), Beside(34, 57, "left"))),
        Not(InArea(45, "corner")),
        NothingElseMoved((34, 45)),
    )
    assert found.units == (
        *(Act.PICK, Act.DROP, Ref.TAG, Rel.FLOOR),
        *(Act.PICK, Act.DROP, Ref.TAG, Ref.TAG, Rel.SIDE, Rel.ORDER),
    )
    assert found.computed == Difficulty(4, 3, 6, 13)
    assert found.printed == found.computed  # Not printed anywhere: as computed.
    assert (found.family, found.scenes, found.goals) == (
        Family.SEVERAL, ("s1",), found.conditions,
    )  # fmt: skip


@settings(max_examples=150)
@given(tasks())
def test_what_is_written_is_read_again(item: Task) -> None:
    assert parse_task(task_text(item), "own.toml") == item


@pytest.mark.parametrize("item", TASKS, ids=lambda item: item.id)
def test_built_in_tasks_are_written_as_they_are_read(item: Task) -> None:
    assert parse_task(task_text(item), item.id) == item


def test_built_in_tasks_are_read_once() -> None:
    assert builtin_tasks() is builtin_tasks() is TASKS


def test_a_task_is_found_by_its_file(tmp_path: Path) -> None:
    path = tmp_path / "tidy.toml"
    path.write_text(FILE)
    assert task(str(path)) == read_task(path) == parse_task(FILE, "x")


def test_no_file_takes_the_name_of_a_built_in_task(tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text(FILE.replace("TIDY-1", "t8"))
    with pytest.raises(ConfigError, match=r"t8 is not the built-in task of that name"):
        task(str(path))
    path.write_text(task_text(task("T8")))
    assert task(str(path)) == task("T8")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('id = "TIDY-1"', "", r"id: is missing; add it"),
        ('id = "TIDY-1"', 'id = "a b"', r'id: "a b" is no name'),
        ('id = "TIDY-1"', "id = 7", r"id: must be a text, not 7"),
        ('id = "TIDY-1"', 'id = "x"\nname = 3', r"name: there is no such field; use id, prompt"),
        ("prompt = ", "units2 = 1 #", r"units2: there is no such field"),
        ("prompt = ", "prompt = 5 #", r"prompt: must be a text, not 5"),
        ("prompt = ", 'prompt = "  " #', r"prompt: has no letters"),
        ("prompt = ", 'prompt = "a\\u001bb" #', r"prompt: holds control characters"),
        ('["pick",', '["take",', r'units\[0\]: there is no unit "take"; use one of pick, drop'),
        ('["pick",', "[3,", r"units\[0\]: there is no unit 3"),
        ("units = [", "units = [] # [", r"units: is empty"),
        ('["s1"]', '"s1"', r'scenes: must be a list, not "s1"'),
        ("scenes =", 'family = "hard"\nscenes =', r'family: there is no family "hard"'),
        ("scenes =", "printed = 4\nscenes =", r"printed: must be a table \{act = "),
        ("scenes =", "printed = { act = 4 }\nscenes =", r"printed.ref: is missing"),
        ("{ on_floor = 45 }", "{ on_roof = 45 }", r"\.ordered\[0\]: there is no condition \"on_r"),
        ("{ on_floor = 45 }", "{ on_floor = true }", r"on_floor: must be a whole number, not true"),
        ("{ on_floor = 45 }", '{ on_floor = "45" }', r'on_floor: must be a whole number, not "45"'),
        ("{ on_floor = 45 }", "{ on_floor = -1 }", r"on_floor: -1 is out of range; use 0 to 9999"),
        ("{ on_floor = 45 }", "{ on_floor = 45, holds = 4 }", r"must be a table with one key"),
        ("{ on_floor = 45 }", "45", r"conditions\[0\].ordered\[0\]: must be a table with one key"),
        ("{ on_floor = 45 }, ", "", r"ordered: must be a list of 2 to 60 conditions"),
        ("anchor = 57", "anchor = 34", r"left_of.anchor: 34 is the object itself"),
        ("anchor = 57", "anchors = 57", r"left_of.anchors: there is no such field"),
        (", anchor = 57", "", r"left_of.anchor: is missing"),
        ('area = "corner"', 'area = "\\n"', r'not.in_area.area: "\\n" is no name'),
        ("= true", "= false", r"nothing_else_moved: must be true"),
        ("conditions = [", "conditions = [] # [", "is not valid TOML"),
    ],
)
def test_a_fault_names_its_field_and_its_fix(old: str, new: str, told: str) -> None:
    assert old in FILE
    with pytest.raises(AdamoError, match=told) as error:
        parse_task(FILE.replace(old, new, 1), "tidy.toml")
    assert str(error.value).startswith("tidy.toml")
    assert "\n" not in str(error.value)


def test_a_syntax_error_names_its_line() -> None:
    with pytest.raises(FileError, match=r"tidy.toml is not valid TOML: .*line 3"):
        parse_task(FILE.replace('prompt = "', "prompt = ", 1), "tidy.toml")


def test_conditions_can_only_be_so_deep() -> None:
    deep = "{ not = " * 7 + "{ holds = 1 }" + " }" * 7
    with pytest.raises(ConfigError, match=r"more than 6 conditions inside each other"):
        parse_task(FILE.replace("{ on_floor = 45 }", deep), "tidy.toml")


def test_an_own_oracle_is_what_is_brought_about() -> None:
    found = parse_task(FILE + "oracle = [{ on_floor = 45 }]", "tidy.toml")
    assert found.goals == (OnFloor(45),)


values = st.recursive(
    st.one_of(st.booleans(), st.integers(-(2**70), 2**70), st.floats(), st.text(max_size=20)),
    lambda inner: st.one_of(
        st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=12), inner, max_size=3)
    ),
    max_leaves=10,
)
LINES = FILE.strip().splitlines()


def told_of(text: str) -> str | None:
    """What is told of a file, in one line; None if it can be read."""
    told = None
    try:
        parse_task(text, "x.toml")
    except AdamoError as error:
        told = str(error)
    assert told is None or (len(told.splitlines()) == 1 and len(told) < 700), told
    return told


def toml_value(value: object) -> str:
    match value:
        case bool() | str():
            return json.dumps(value, ensure_ascii=True)
        case list():
            return f"[{', '.join(map(toml_value, value))}]"
        case dict():
            members = (f"{json.dumps(k)} = {toml_value(v)}" for k, v in value.items())
            return f"{{{', '.join(members)}}}"
        case _:
            return str(value)


@settings(max_examples=200)
@given(st.sampled_from(["id", "prompt", "units", "scenes", "conditions", "oracle"]), values)
def test_whatever_stands_in_a_field_is_read_or_told_in_a_line(field: str, value: object) -> None:
    kept = parse_task(FILE, "x")
    lines = task_text(kept).split("conditions = ")[0]
    lines = "\n".join(line for line in lines.splitlines() if not line.startswith(f"{field} ="))
    ending = "" if field == "conditions" else "\nconditions = [{ holds = 1 }]"
    told = told_of(f"{lines}\n{field} = {toml_value(value)}{ending}")
    assert told is None or told.startswith("x.toml")


@settings(max_examples=200)
@given(st.integers(0, len(FILE)), st.integers(0, 40), st.text(max_size=10))
def test_a_file_damaged_anywhere_is_read_or_told_in_a_line(at: int, cut: int, put: str) -> None:
    told_of(FILE[:at] + put + FILE[at + cut :])
