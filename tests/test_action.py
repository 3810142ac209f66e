"""Tool calls: what is valid becomes a typed action, everything else a clear refusal."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import asdict, dataclass
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.action import (
    Code,
    Drop,
    Feedback,
    Look,
    Outcome,
    Pick,
    Walk,
    parse,
    tool_schema,
)
from adamo_vh.errors import ConfigError, InvalidActionError

ACTIONS = (Look, Walk, Pick, Drop)
json_values = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=6,
)
numbers = st.floats(-1e6, 1e6)


@pytest.mark.parametrize("action", ACTIONS)
def test_schemas_describe_every_argument(action: type) -> None:
    schema = tool_schema(action)
    assert schema.name == action.__name__
    assert schema.description.endswith(".")
    properties = schema.parameters["properties"]
    assert schema.parameters["required"] == list(properties)
    assert schema.parameters["additionalProperties"] is False
    assert all(field["description"] for field in properties.values())
    assert "metres" in str(properties) or action is Pick


@given(numbers, numbers, numbers)
def test_parsing_undoes_arguments(x: float, y: float, z: float) -> None:
    for action in (Look(x, y, z), Walk(x, y, z), Drop("Plate_57", x, y, z), Pick("57")):
        assert parse(type(action).__name__, asdict(action), ACTIONS) == action


@given(
    st.sampled_from(["Look", "Walk", "Pick", "Drop", "look", "Fly", ""]),
    st.dictionaries(st.sampled_from(["x", "y", "z", "object", "speed"]), json_values) | st.none(),
)
def test_anything_is_an_action_or_a_refusal(name: str, arguments: dict[str, Any] | None) -> None:
    refusal = None
    try:
        action = parse(name, arguments, ACTIONS)
    except InvalidActionError as error:
        refusal = Feedback.of_error(error)
    if refusal is None:
        assert type(action).__name__ == name
    else:
        assert refusal.code in (Code.UNKNOWN_TOOL, Code.BAD_ARGUMENT)
        assert refusal.outcome is Outcome.REFUSED
        assert refusal.text.startswith("Refused: ")


def test_numbers_as_text_and_ids_as_numbers_are_understood() -> None:
    assert parse("Look", {"x": "1.5", "y": 0, "z": -1}, ACTIONS) == Look(1.5, 0, -1)
    assert parse("Pick", {"object": 57}, ACTIONS) == Pick("57")


@pytest.mark.parametrize(
    ("name", "arguments", "part"),
    [
        ("Jump", {}, "there is no tool named 'Jump'. Tools: Look, Walk, Pick, Drop."),
        ("Look", None, "not a JSON object"),
        ("Look", {"x": 1, "y": 2}, "z: Field required. Usage: Look(x, y, z)."),
        ("Look", {"x": 1, "y": 2, "z": float("nan")}, "z: "),
        ("Pick", {"object": "57", "force": 1}, "force: "),
        ("Pick", {"object": "x" * 101}, "object: "),
    ],
)
def test_refusals_name_the_fault_and_the_usage(
    name: str, arguments: dict[str, Any] | None, part: str
) -> None:
    with pytest.raises(InvalidActionError) as caught:
        parse(name, arguments, ACTIONS)
    assert part in str(caught.value)


@pytest.mark.parametrize(
    "value",
    [True, False, "1_0", "0x10", "\u0663", "1,5", "", " ", "one", "+1", ".5", "1.", "01", "NaN",
     "inf", "Infinity", float("inf"), float("-inf"), float("nan"), None, [1], {"x": 1}, "1 m"],
)  # fmt: skip
def test_only_a_number_is_a_number(value: Any) -> None:
    with pytest.raises(InvalidActionError, match=r"x\b") as caught:
        parse("Walk", {"x": value, "y": 0, "z": 0}, ACTIONS)
    assert caught.value.code == Code.BAD_ARGUMENT


@pytest.mark.parametrize("value", ["1.5", " 1.5 ", "15e-1", "1.5E0", 1.5])
def test_a_number_may_be_written_as_json_writes_it(value: Any) -> None:
    assert parse("Walk", {"x": value, "y": 0, "z": 0}, ACTIONS) == Walk(1.5, 0, 0)


@dataclass(frozen=True, slots=True)
class Point:
    """A place."""

    x: float
    exact: bool = False


@dataclass(frozen=True, slots=True)
class Trace:
    """Follow a line."""

    points: list[Point]
    times: int | None = None
    speed: float | str = 1.0


def test_numbers_of_own_tools_are_held_to_the_same() -> None:
    good = {"points": [{"x": "1", "exact": True}], "times": None, "speed": "fast"}
    assert parse("Trace", good, [Trace]) == Trace([Point(1.0, True)], None, "fast")
    for bad in (
        {"points": [{"x": True}]},
        {"points": [], "times": "1_0"},
        {"points": [], "times": False},
    ):
        with pytest.raises(InvalidActionError):
            parse("Trace", bad, [Trace])


def test_a_tool_without_a_docstring_is_refused_in_words() -> None:
    @dataclass(frozen=True, slots=True)
    class Wave:
        hand: str

    with pytest.raises(ConfigError, match="Tool Wave has no description: give its class a doc"):
        tool_schema(Wave)


def test_descriptions_survive_a_python_without_docstrings() -> None:
    code = (
        "from adamo_vh.action import *; from adamo_vh.cognition.turns import Finish\n"
        "for a in (Look, Walk, Pick, Drop, Inspect, Survey, Finish):\n"
        "    print(tool_schema(a).description)"
    )
    said = [
        subprocess.run(
            [sys.executable, *flag, "-c", code], capture_output=True, text=True, check=True
        )
        for flag in ([], ["-OO"])
    ]
    assert said[0].stdout == said[1].stdout
    assert said[1].stdout.startswith("Turn body and gaze to a point in the room")
