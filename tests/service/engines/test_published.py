"""What is said on the wire is what the published schema promises to those who write an engine."""

from __future__ import annotations

import json
from typing import Any

import pytest
from pydantic import ValidationError
from tests.service.engines.test_line import TINY, world_of
from tools.wire import FOLDER

from adamo_vh.engine import LightChanged
from adamo_vh.geometry import Vec3
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.service.engines.messages import METHODS, codec

SCHEMA: dict[str, Any] = json.loads((FOLDER / "engine.json").read_text(encoding="utf-8"))


def fits(value: Any, schema: Any, where: str = "") -> None:
    """A small part of JSON Schema: enough to see that members and kinds are those of the schema."""
    if "$ref" in schema:
        schema = SCHEMA["$defs"][schema["$ref"].rpartition("/")[2]]
    if "anyOf" in schema or "oneOf" in schema:
        return
    kinds = {"object": dict, "array": list, "string": str, "integer": int, "boolean": bool}
    kind = kinds.get(schema.get("type", ""), object)
    assert isinstance(value, kind), f"{where} is {value!r}"
    if isinstance(value, dict) and "properties" in schema:
        assert set(value) <= set(schema["properties"]), where
        assert set(schema.get("required", ())) <= set(value), where
        for name, inner in value.items():
            fits(inner, schema["properties"][name], f"{where}.{name}")
    if isinstance(value, list) and isinstance(schema.get("items"), dict):
        for inner in value:
            fits(inner, schema["items"], f"{where}[]")


def test_every_message_of_a_life_fits_the_schema(engine: BuiltinEngine) -> None:
    said: dict[str, Any] = {}

    def note(method: str) -> Any:
        def change(answer: dict[str, Any], messages: list[str | bytes]) -> list[str | bytes]:
            said[method] = answer["result"]
            return messages

        return change

    world, _ = world_of(engine, **{method: note(method) for method in METHODS})
    body, kept = world.bodies["agent"], world.snapshot()
    world.reset(0)
    world.state()
    body.see(*TINY)
    body.rays(Vec3(0, 0, 1), Vec3(0, 0, -1).array()[None])
    body.look(Vec3(1, 1, 1))
    body.walk(Vec3(1, 1, 0))
    body.pick(57)
    body.drop(Vec3(0, 0, 0))
    body.say("Done.")
    world.apply(LightChanged(0, 0.5))
    world.restore(kept)
    type(world)(world.line, "s1")
    assert set(said) == set(METHODS) == set(SCHEMA["methods"])
    for method, result in said.items():
        fits(result, SCHEMA["methods"][method]["result"], method)


def test_the_hello_is_in_the_schema() -> None:
    name = SCHEMA["hello"]["$ref"].rpartition("/")[2]
    assert SCHEMA["$defs"][name]["required"] == ["wire", "engine", "frame", "abilities"]


@pytest.mark.parametrize("method", sorted(METHODS))
def test_a_number_where_a_message_belongs_is_refused(method: str) -> None:
    for kind in METHODS[method]:
        with pytest.raises(ValidationError):
            codec(kind).validate_python(7)
