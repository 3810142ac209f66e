"""A scene as the text of a scene file, which reads back as the same scene."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import Any

from adamo_vh.runtime.scenes.scene import Scene


def scene_toml(scene: Scene) -> str:
    """The whole scene as TOML: plain fields, then sections, then lists of sections."""
    data = asdict(scene)
    kinds = {name: (isinstance(v, Mapping), _is_sections(v)) for name, v in data.items()}
    order = sorted(data, key=lambda name: kinds[name])
    lines = [f"# {scene.full_name}"]
    for name in order:
        value, (section, several) = data[name], kinds[name]
        if section:
            lines += ["", f"[{name}]", *_fields(value)]
        elif several:
            for item in value:
                lines += ["", f"[[{name}]]", *_fields(item)]
        else:
            lines += _fields({name: value})
    return "\n".join(lines) + "\n"


def _is_sections(value: Any) -> bool:
    return isinstance(value, tuple) and bool(value) and isinstance(value[0], Mapping)


def _fields(section: Mapping[str, Any]) -> Iterator[str]:
    for name, value in section.items():
        # What a scene holds, text, numbers, truth and lists of numbers, JSON and TOML spell alike.
        yield f"{name} = {json.dumps(value)}"
