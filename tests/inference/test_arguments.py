"""Arguments are one strict JSON object, and whatever was written goes back as one."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.inference.arguments import UNREADABLE, read_arguments, wire_arguments
from adamo_vh.inference.messages import ToolCall


@pytest.mark.parametrize(
    ("raw", "arguments"),
    [
        ('{"x": 1, "y": -2.5}', {"x": 1, "y": -2.5}),
        ("", {}),
        ("{}", {}),
        ('{"object": "caf\\u00e9"}', {"object": "café"}),
        ('{"object": "\\ud800"}', {"object": "?"}),
        ("{x: 1}", None),
        ('{"x": 1', None),
        ("[1, 2]", None),
        ('"Plate_57"', None),
        ("null", None),
        ('{"x": NaN}', None),
        ('{"x": 1e999}', None),
        ("[" * 100_000, None),
        ('{"x": ' + "9" * 5000 + "}", None),
    ],
)
def test_arguments_are_one_strict_json_object_or_none(
    raw: str, arguments: dict[str, object] | None
) -> None:
    assert read_arguments(raw) == arguments


@given(st.text(max_size=40))
def test_whatever_a_model_wrote_goes_back_as_a_valid_json_object(raw: str) -> None:
    call = ToolCall("a", "Look", read_arguments(raw), raw)
    sent = wire_arguments(call)
    assert json.loads(json.dumps(sent, allow_nan=False).encode()) == sent
    assert call.arguments is not None or UNREADABLE in sent
