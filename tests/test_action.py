"""Tool calls: what is valid becomes a typed action, everything else a clear refusal."""

from __future__ import annotations

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
    arguments_of,
    parse,
    tool_schema,
)
from adamo_vh.errors import InvalidActionError

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
        assert parse(type(action).__name__, arguments_of(action), ACTIONS) == action


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
