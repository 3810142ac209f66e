"""Whatever an engine answers, and whatever it is asked: a sentence, never another fault."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.dialled import Passing
from tests.service.engines.test_line import TINY, world_of

from adamo_vh.engine import ObjectMoved, acting_body
from adamo_vh.errors import EngineError
from adamo_vh.geometry import Vec3
from adamo_vh.observation import NOTHING
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.service.engines.answering import Answerer
from adamo_vh.service.engines.messages import METHODS
from adamo_vh.service.engines.reading import read_hello, read_message
from adamo_vh.service.engines.remote import RemoteWorld

ODD = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**70), 2**70),
    st.floats(),
    st.text(max_size=20),
    st.lists(st.integers(), max_size=3),
    st.dictionaries(st.text(max_size=5), st.integers(), max_size=3),
)
ONE = np.array([[0.0, 0.0, -1.0]])


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Every place in a JSON value."""
    yield path
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from places(inner, (*path, key))
    elif isinstance(value, list):
        for index, inner in enumerate(value[:3]):
            yield from places(inner, (*path, index))


def with_odd(value: Any, path: tuple[Any, ...], odd: Any) -> Any:
    """The value with something odd at a place of it."""
    if not path:
        return odd
    changed = copy.deepcopy(value)
    inner = changed
    for part in path[:-1]:
        inner = inner[part]
    inner[path[-1]] = odd
    return changed


def said_by(call: Callable[[], object]) -> str:
    """The sentence of an error of the engine; empty if there is none."""
    try:
        call()
    except EngineError as error:
        return str(error)
    return ""


def use(world: RemoteWorld, method: str) -> None:
    """Ask for something through the protocol of engines."""
    body = acting_body(world)
    calls: dict[str, Any] = {
        "scene": lambda: RemoteWorld(world.line, "s1"),
        "bodies": lambda: RemoteWorld(world.line, "s1"),
        "reset": lambda: world.reset(0),
        "state": world.state,
        "capture": lambda: body.see(*TINY),
        "rays": lambda: body.rays(Vec3(0, 0, 1), ONE),
        "look": lambda: body.look(Vec3(1, 1, 1)),
        "walk": lambda: body.walk(Vec3(1, 1, 0)),
        "pick": lambda: body.pick(57),
        "drop": lambda: body.drop(Vec3(0, 0, 0)),
        "say": lambda: body.say("Done."),
        "snapshot": world.snapshot,
        "restore": lambda: world.restore(b"bm90aGluZw=="),
        "apply": lambda: world.apply(ObjectMoved(57, Vec3(0, 0, 0))),
    }
    calls[method]()


@pytest.mark.parametrize("method", sorted(METHODS))
def test_an_odd_answer_is_a_sentence_or_harmless(engine: BuiltinEngine, method: str) -> None:
    @settings(max_examples=25)
    @given(data=st.data())
    def tried(data: st.DataObject) -> None:
        def change(answer: dict[str, Any], messages: list[str | bytes]) -> list[str | bytes]:
            spots = [path for path in places(answer) if path]
            odd = with_odd(answer, data.draw(st.sampled_from(spots)), data.draw(ODD))
            return [json.dumps(odd), *messages[1:]]

        world, _ = world_of(engine, **{method: change})
        told = said_by(lambda: use(world, method))
        assert "\n" not in told
        assert len(told) < 900

    tried()


@given(st.text(max_size=60) | st.binary(max_size=60))
def test_any_first_message_is_a_hello_or_a_sentence(message: str | bytes) -> None:
    said = said_by(lambda: read_hello(message))
    assert said, "no random message is a hello"
    assert "\n" not in said_by(lambda: read_message(message))


@settings(max_examples=60)
@given(
    method=st.sampled_from([*METHODS, "hello", "close"]),
    params=ODD | st.dictionaries(st.sampled_from(["body", "point", "seed", "scene"]), ODD),
)
def test_an_engine_answers_any_request(s1_engine: BuiltinEngine, method: str, params: Any) -> None:
    answerer = Answerer(lambda *_: Passing(s1_engine))
    answerer.answer({"id": 1, "method": "scene", "params": {"scene": "s1", "figure": ""}})
    answer, attached = answerer.answer({"id": 2, "method": method, "params": params})
    assert answer["id"] == 2
    assert ("result" in answer) != ("error" in answer)
    assert len(attached) == answer.get("attachments", 0)


@settings(max_examples=30)
@given(data=st.data())
def test_odd_bytes_are_no_picture(s1_engine: BuiltinEngine, data: st.DataObject) -> None:
    def change(answer: dict[str, Any], messages: list[str | bytes]) -> list[str | bytes]:
        which = data.draw(st.integers(1, len(messages) - 1))
        answer["result"]["colour"] = data.draw(st.sampled_from(["png", "jpeg", "rgb8"]))
        answer["result"]["ids"] = data.draw(st.sampled_from(["png16", "rgb555", "int16"]))
        messages[0] = json.dumps(answer)
        messages[which] = data.draw(st.binary(max_size=200))
        return messages

    world, _ = world_of(s1_engine, capture=change)
    with pytest.raises(EngineError, match="failed in capture"):
        acting_body(world).see(*TINY)


@settings(max_examples=30)
@given(shift=st.integers(0, TINY[0] * TINY[1] - 1), number=st.integers(0, 65535))
def test_a_pixel_of_any_value_is_checked(s1_engine: BuiltinEngine, shift: int, number: int) -> None:
    def change(answer: dict[str, Any], messages: list[str | bytes]) -> list[str | bytes]:
        layer = np.frombuffer(messages[2], "<u2").copy()  # type: ignore[arg-type]
        layer[shift] = number
        return [*messages[:2], layer.tobytes(), *messages[3:]]

    world, _ = world_of(s1_engine, capture=change)
    s1_engine.reset(0)
    own = s1_engine.body.see(*TINY)
    if number in own.objects or number == 65535:
        percept = acting_body(world).see(*TINY)
        told = int(percept.id_layers[0].ravel()[shift])
        assert told == (NOTHING if number == 65535 else number)
    else:
        with pytest.raises(EngineError, match=f"{number}"):
            acting_body(world).see(*TINY)
