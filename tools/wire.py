"""Write what is published of the wire to docs/wire: JSON Schema of all messages, and OpenAPI."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from adamo_vh.service.app import create_api
from adamo_vh.service.engines.messages import wire_schema
from adamo_vh.service.hosting import Host, Terms
from adamo_vh.service.wire import messages_schema

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "wire"


@cache
def texts() -> dict[str, str]:
    """Each file as it is published."""
    files = {
        "engine.json": wire_schema(),
        "session.json": messages_schema(),
        "openapi.json": openapi(),
    }
    return {name: json.dumps(told, indent=1) + "\n" for name, told in files.items()}


def openapi() -> dict[str, Any]:
    """The OpenAPI of a server with all faces, as it stands at ``/openapi.json``."""
    with TemporaryDirectory() as folder:
        host = Host(Path(folder), Terms())
        try:
            return create_api(host).openapi()
        finally:
            host.close_all()


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, text in texts().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
