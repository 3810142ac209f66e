"""Messages of the wire: what goes in comes out, and what is none is told in a line."""

from __future__ import annotations

import dataclasses
import json
from typing import Any, get_args

import pytest

from adamo_vh.action import Feedback, Outcome
from adamo_vh.action_server import LocalActionServer
from adamo_vh.action_server.wire import (
    Act,
    Answer,
    Attach,
    Create,
    Done,
    Failed,
    Finish,
    Load,
    Noted,
    Observe,
    Picture,
    Problem,
    Request,
    Seen,
    View,
    pictures_of,
    read,
    result_of,
    sighting_of,
    to_json,
    to_plain,
)
from adamo_vh.errors import ConfigError
from adamo_vh.runtime.builtin import BuiltinEngine

REQUESTS = [
    Create("T1", profile="lean", switches={"plan": 1}, player="bot"),
    Attach("abc"),
    Observe("r1"),
    Act("Look", {"x": 1.5, "y": None, "z": [1, {"a": "ä\U0001f600"}]}, "note"),
    Act("Look", None),
    Finish("Done.", "loop"),
    Load("saved-1"),
]


@pytest.mark.parametrize("message", REQUESTS, ids=lambda one: one.type)
def test_a_request_comes_out_as_it_went_in(message: Any) -> None:
    assert read(Request, to_json(message)) == message
    assert json.loads(to_json(message)) == to_plain(message)


def test_every_message_has_a_type_of_its_own() -> None:
    kinds = [kind for union in (Request, Answer) for kind in get_args(union)]
    types = [next(f.default for f in dataclasses.fields(k) if f.name == "type") for k in kinds]
    assert len(set(types)) == len(types) >= 15


def test_what_the_body_answers_comes_out_as_it_went_in(engine: BuiltinEngine) -> None:
    server = LocalActionServer(engine, resolution=(320, 180))
    seen = server.observe()
    shown, frame = seen.observation, seen.observation.frame
    picture = Picture("a.jpg", frame.media_type, 320, 180, "/frames/a.jpg")
    view = View(picture, shown.objects, shown.points, shown.agent, shown.camera)
    sent = read(Answer, to_json(Seen(view, seen.state_hash, "saved-1", 0.5)))
    assert sighting_of(sent, {"a.jpg": frame}) == dataclasses.replace(
        seen, saved="saved-1", waited_s=0.5
    )
    feedback = Feedback(Outcome.DONE, "ok", "Done.", 1.5)
    done = Done(feedback, shown.agent, seen.state_hash, "saved-2", view, (picture,))
    result = result_of(read(Answer, to_json(done)), {"a.jpg": frame})
    assert (result.feedback, result.agent, result.observation) == (feedback, shown.agent, shown)
    assert result.pictures == (frame,)
    assert pictures_of(done) == pictures_of(sent) == (picture,)
    assert pictures_of(Noted()) == pictures_of(Failed(Problem("x"))) == ()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "EOF"),
        ("[]", "it:"),
        ('{"type": "fly"}', "expected tags"),
        ('{"type": "act"}', "act.name"),
        ('{"type": "act", "name": 5}', "valid string"),
        ('{"type": "act", "name": "Look", "arguments": [1]}', "act.arguments"),
        ('{"type": "act", "name": "Look", "more": 1}', "act.more"),
        ('{"type": "create", "seed": -1}', "create.seed"),
        ('{"type": "create", "seed": 1e400}', "create.seed"),
        ('{"type": "say", "text": "' + "x" * 20_001 + '"}', "20000 characters"),
        ('{"type": "act", "name": "L", "arguments": ' + "[" * 500, "recursion"),
        ('{"type": "act\\u001b[31m"}', "expected tags"),
        (b"\xff\xfe", "JSON"),
    ],
)
def test_what_is_no_message_is_told_in_a_line(text: str | bytes, said: str) -> None:
    with pytest.raises(ConfigError, match="The message is wrong") as caught:
        read(Request, text)
    assert said in str(caught.value) and str(caught.value).isprintable()
    assert len(str(caught.value)) < 400
