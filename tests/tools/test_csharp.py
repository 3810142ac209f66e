"""The C# client is in step with the published wire."""

from __future__ import annotations

import json

from tools.csharp import FOLDER, SCHEMA, texts


def test_the_shipped_classes_are_those_of_the_schema() -> None:
    for name, text in texts().items():
        shipped = (FOLDER / name).read_text(encoding="utf-8")
        assert shipped == text, f"{name} is old: python tools/csharp.py"


def test_every_method_and_message_is_there() -> None:
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    messages, interface = texts()["Messages.cs"], texts()["IAdamoEngine.cs"]
    for name in schema["$defs"].keys() - {"Nothing"}:
        assert f"class {name}\n" in messages
    for method in schema["methods"]:
        assert f'case "{method}":' in interface


def test_nothing_in_the_wire_is_left_as_it_was_read_but_events() -> None:
    assert [
        line.split()[2]
        for line in texts()["Messages.cs"].splitlines()
        if "public object " in line and ";" in line
    ] == ["Event;"]
