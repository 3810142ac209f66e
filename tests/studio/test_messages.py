"""What the page may ask: read strictly, refused in a sentence."""

from __future__ import annotations

import json

import pytest

from adamo_vh.errors import ConfigError
from adamo_vh.studio import messages
from adamo_vh.studio.messages import Act, Move, Say, Speed, Stop, read_wish

GOOD = [
    ({"type": "say", "text": "Take the cup"}, Say("Take the cup")),
    ({"type": "stop"}, Stop()),
    ({"type": "move", "object_id": 7, "point": [0, 1.5, 0.8]}, Move(7, (0.0, 1.5, 0.8))),
    ({"type": "act", "name": "Walk", "arguments": {"x": 1}}, Act("Walk", {"x": 1})),
    ({"type": "speed", "factor": 2}, Speed(2)),
]
BAD = [
    "",
    "[]",
    "nonsense",
    '{"type": "fly"}',
    '{"type": "say"}',
    '{"type": "say", "text": ""}',
    '{"type": "say", "text": 5}',
    json.dumps({"type": "say", "text": "x" * 5000}),
    '{"type": "stop", "more": 1}',
    '{"type": "move", "object_id": "7", "point": [0, 0, 0]}',
    '{"type": "move", "object_id": -1, "point": [0, 0, 0]}',
    '{"type": "move", "object_id": 1, "point": [0, 0]}',
    '{"type": "move", "object_id": 1, "point": [0, 0, NaN]}',
    '{"type": "move", "object_id": 1, "point": [0, 0, 1e300]}',
    '{"type": "speed", "factor": 3}',
    '{"type": "approval", "on": "yes"}',
    '{"type": "act", "name": "", "arguments": {}}',
]


@pytest.mark.parametrize(("told", "meant"), GOOD)
def test_a_wish_is_read(told, meant):
    assert read_wish(json.dumps(told)) == meant


@pytest.mark.parametrize("told", BAD)
def test_what_is_no_wish_is_refused_in_one_line(told):
    with pytest.raises(ConfigError) as error:
        read_wish(told)
    assert "\n" not in str(error.value) and len(str(error.value)) < 400
    assert "nothing was done" in str(error.value)


def test_a_notice_hides_nothing_and_turns_nothing():
    told = messages.notice("a\u202eb\x1b[2Jc", "warning")
    assert "\u202e" not in told["text"] and "\x1b" not in told["text"]
    assert told["level"] == "warning"
