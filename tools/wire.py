"""Write the published schema of the messages between ADAMO and an engine: docs/wire/engine.json."""

from __future__ import annotations

import json
from pathlib import Path

from adamo_vh.service.engines.messages import wire_schema

FILE = Path(__file__).resolve().parents[1] / "docs" / "wire" / "engine.json"


def text() -> str:
    """The schema as it is published."""
    return json.dumps(wire_schema(), indent=1) + "\n"


if __name__ == "__main__":
    FILE.parent.mkdir(exist_ok=True)
    FILE.write_text(text(), encoding="utf-8")
