"""Write the C# side of the wire for engines to engines/unity/Adamo, from docs/wire/engine.json."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
SCHEMA = ROOT / "docs" / "wire" / "engine.json"
FOLDER = ROOT / "engines" / "unity" / "Adamo"
_HEAD = """// Written by tools/csharp.py from docs/wire/engine.json; change that, and write it anew.
using System.Collections.Generic;

namespace Adamo
{
"""
_PLAIN = {
    "number": ("double", "Json.Number"),
    "integer": ("int", "Json.Whole"),
    "boolean": ("bool", "Json.Truth"),
    "string": ("string", "Json.Words"),
}


def texts() -> dict[str, str]:
    """Each file as it is shipped."""
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    kinds = {name: told for name, told in schema["$defs"].items() if name != "Nothing"}
    classes = [_class(name, told, kinds) for name, told in kinds.items() if "properties" in told]
    words = [_words(name, told) for name, told in kinds.items() if "enum" in told]
    version = f"        public const int Version = {schema['wire']};\n"
    wire = f"    public static class Wire\n    {{\n{version}    }}\n"
    return {
        "Messages.cs": _HEAD + "\n".join([wire, *words, *classes]) + "}\n",
        "IAdamoEngine.cs": _HEAD + _interface(schema["methods"]) + "}\n",
    }


def _named(ref: str) -> str:
    return ref.rpartition("/")[2]


def _pascal(name: str) -> str:
    return "".join(part[:1].upper() + part[1:] for part in name.split("_"))


def _doc(text: str, indent: str) -> str:
    safe = text.replace("&", "&amp;").replace("<", "&lt;").replace("\n\n", " ").replace("\n", " ")
    return f"{indent}/// <summary>{safe}</summary>\n" if text else ""


def _words(name: str, told: dict[str, Any]) -> str:
    """An enum of the wire: its words as constants."""
    rows = "".join(
        f'        public const string {_pascal(word)} = "{word}";\n' for word in told["enum"]
    )
    doc = _doc(told.get("description", ""), "    ")
    return f"{doc}    public static class {name}\n    {{\n{rows}    }}\n"


class _Field:
    """A member of a message: its C# type, and how it is read and written."""

    def __init__(self, told: dict[str, Any], kinds: dict[str, Any]) -> None:
        self.initial = ""
        self.type, self._read, self._write = _kind(told, kinds)
        default = told.get("default")
        if isinstance(default, bool):
            self.initial = f" = {str(default).lower()}"
        elif isinstance(default, int | float):
            self.initial = f" = {default}"
        elif isinstance(default, str):
            self.initial = f' = "{default}"'
        elif isinstance(default, dict | list):
            self.initial = f" = new {self.type}()"

    def read(self, value: str) -> str:
        return self._read.replace("$", value)

    def write(self, value: str) -> str:
        return self._write.replace("$", value)


def _kind(told: dict[str, Any], kinds: dict[str, Any]) -> tuple[str, str, str]:
    """C# type, expression that reads it and expression that writes it; $ is the value."""
    if "$ref" in told:
        name = _named(told["$ref"])
        if "enum" in kinds[name]:
            return "string", "Json.Words($)", "$"
        return name, f"{name}.Read($)", "$.Write()"
    if "anyOf" in told:
        return _choice(told["anyOf"], kinds)
    if told["type"] == "array":
        item, read, write = _kind(told.get("items") or told["prefixItems"][0], kinds)
        inner = _inner(read)
        return (
            f"List<{item}>",
            f"Json.List($, {inner} => {read.replace('$', inner)})",
            f"Json.Each($, {inner} => {write.replace('$', inner)})",
        )
    if told["type"] == "object":
        item, read, write = _kind(told["additionalProperties"], kinds)
        inner = _inner(read)
        return (
            f"Dictionary<string, {item}>",
            f"Json.Table($, {inner} => {read.replace('$', inner)})",
            f"Json.Entries($, {inner} => {write.replace('$', inner)})",
        )
    kind, reader = _PLAIN[told["type"]]
    return kind, f"{reader}($)", "$"


def _inner(read: str) -> str:
    """A name for what a list holds that no list inside of it has taken."""
    return "xyz"[read.count("=>")]


def _choice(options: list[dict[str, Any]], kinds: dict[str, Any]) -> tuple[str, str, str]:
    some = [option for option in options if option.get("type") != "null"]
    if len(some) > 1:
        return "object", "$", "$"  # Told apart by its "type": as it was read.
    kind, read, write = _kind(some[0], kinds)
    if kind in ("int", "double", "bool"):
        return f"{kind}?", f"$ == null ? ({kind}?)null : {read}", "$"
    return (
        kind,
        f"$ == null ? null : {read}",
        write if write == "$" else f"$ == null ? null : {write}",
    )


def _class(name: str, told: dict[str, Any], kinds: dict[str, Any]) -> str:
    fields = {key: _Field(inner, kinds) for key, inner in told["properties"].items()}
    required = set(told.get("required", ()))
    rows, reads, writes = [], [], []
    for key, item in fields.items():
        member = _pascal(key)
        rows.append(f"        public {item.type} {member}{item.initial};\n")
        found = item.read(f'map["{key}"]')
        ask = "" if key in required else f'if (map.ContainsKey("{key}")) '
        reads.append(f"            {ask}read.{member} = {found};\n")
        writes.append(f'                {{ "{key}", {item.write(member)} }},\n')
    return (
        f"{_doc(told.get('description', ''), '    ')}    public sealed class {name}\n    {{\n"
        f"{''.join(rows)}\n"
        f"        public static {name} Read(object json)\n        {{\n"
        f"            var map = Json.Map(json);\n            var read = new {name}();\n"
        f"{''.join(reads)}            return read;\n        }}\n\n"
        f"        public object Write()\n        {{\n"
        f"            return new Dictionary<string, object>\n            {{\n"
        f"{''.join(writes)}            }};\n        }}\n    }}\n"
    )


def _interface(methods: dict[str, Any]) -> str:
    rows, cases = [], []
    for method, told in methods.items():
        wish, answer = _named(told["params"]["$ref"]), _named(told["result"]["$ref"])
        takes = [] if wish == "Nothing" else [f"{wish} wish"]
        gives = [] if wish == "Nothing" else [f"{wish}.Read(wish)"]
        if method == "capture":
            takes.append("List<byte[]> pictures")
            gives.append("pictures")
        result = "void" if answer == "Nothing" else answer
        rows.append(f"        {result} {_pascal(method)}({', '.join(takes)});\n")
        call = f"engine.{_pascal(method)}({', '.join(gives)})"
        done = f"{call}; return new Dictionary<string, object>();"
        cases.append(
            f'                case "{method}": '
            + (done if result == "void" else f"return {call}.Write();")
            + "\n"
        )
    return (
        "    /// <summary>What a project offers to carry an agent.</summary>\n"
        "    /// <remarks>\n    /// All points are in ADAMO's frame, see Frame.\n"
        "    /// Throw AdamoException for what cannot be done; its message is told.\n"
        "    /// </remarks>\n"
        f"    public interface IAdamoEngine\n    {{\n{''.join(rows)}    }}\n\n"
        "    /// <summary>Carries a request out.</summary>\n"
        "    public static class Requests\n    {\n"
        "        public static object Answer(\n"
        "            IAdamoEngine engine, string method, object wish, List<byte[]> pictures)\n"
        "        {\n            switch (method)\n            {\n"
        f"{''.join(cases)}"
        '                default: throw new AdamoException("there is no method " + method + ".");\n'
        "            }\n        }\n    }\n"
    )


if __name__ == "__main__":
    for name, text in texts().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
