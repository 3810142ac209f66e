"""What is published of the wire to players: the JSON Schema of its messages."""

from __future__ import annotations

from typing import Any

from pydantic import TypeAdapter

from adamo_vh.action_server.wire import VERSION, Answer, Request, codec


def messages_schema() -> dict[str, Any]:
    """The JSON Schema of every message of the WebSocket, by name."""
    inputs: Any = [
        ("Request", "validation", codec(Request)),
        ("Answer", "serialization", codec(Answer)),
    ]
    named, made = TypeAdapter.json_schemas(inputs)
    unions = {name: schema for (name, _), schema in named.items()}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"ADAMO: messages of the WebSocket /v1/session, version {VERSION}",
        **made,
        "$defs": {**unions, **made["$defs"]},
    }
