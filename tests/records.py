"""Whether two run folders tell of the same episode."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from adamo_vh.record.run_folder import EVENTS, FRAMES, MANIFEST, RESULT

OWN = {"seconds", "world_s", "model_s", "waited_s", "started_at", "run", "seal"}
"""What no two runs have in common: when and where they were, and how long they took."""


def told(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: told(v) for k, v in value.items() if k not in OWN}
    return [told(item) for item in value] if isinstance(value, list) else value


def record_of(folder: Path) -> dict[str, Any]:
    """All that a run folder says, but for time and place."""
    record: dict[str, Any] = {path.name: path.read_bytes() for path in (folder / FRAMES).iterdir()}
    for name in (MANIFEST, RESULT):
        record[name] = told(json.loads((folder / name).read_bytes()))
    lines = (folder / EVENTS).read_text(encoding="utf-8").splitlines()
    return record | {str(i): told(json.loads(line)) for i, line in enumerate(lines)}


def assert_the_same_record(one: Path, other: Path) -> None:
    records = record_of(one), record_of(other)
    assert records[0].keys() == records[1].keys()
    assert [name for name in records[0] if records[0][name] != records[1][name]] == []
