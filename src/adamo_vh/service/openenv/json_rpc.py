"""The MCP calls that OpenEnv takes as plain JSON-RPC: tools/list, tools/call and its sessions.

It is a part of OpenEnv's wire and no whole MCP; that is served at `/mcp` of the server itself.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from adamo_vh.errors import AdamoError, ConfigError
from adamo_vh.service.openenv.messages import Reset, Shown, Told, plain, read
from adamo_vh.service.openenv.rooms import Room, Rooms
from adamo_vh.service.problems import told as problem

_INVALID_REQUEST, _NO_METHOD, _INVALID_PARAMS, _FAULT = -32600, -32601, -32602, -32603
_FIELDS = {"jsonrpc", "method", "params", "id"}


def answer(rooms: Rooms, asked: object, own: Room | None = None) -> dict[str, Any]:
    """Answer a request.

    Args:
        rooms: The sessions over HTTP.
        asked: The request as JSON data.
        own: The session of the connection, if it came over one.
    """
    if not isinstance(asked, Mapping) or asked.get("jsonrpc") != "2.0" or asked.keys() - _FIELDS:
        return _failed(None, _INVALID_REQUEST, "Send JSON-RPC 2.0: jsonrpc, method, params, id.")
    number = asked.get("id")
    number = number if isinstance(number, str | int) else None
    params = asked.get("params", {})
    if not isinstance(params, Mapping):
        return _failed(number, _INVALID_PARAMS, "params is a JSON object.")
    do = _METHODS.get(str(asked.get("method")))
    if do is None:
        offer = ", ".join(_METHODS)
        return _failed(number, _NO_METHOD, f"There is no such method. Methods: {offer}.")
    try:
        return {"jsonrpc": "2.0", "id": number, "result": do(rooms, params, own)}
    except ConfigError as error:
        return _failed(number, _INVALID_PARAMS, str(error))
    except AdamoError as error:
        return _failed(number, _FAULT, problem(error)[1].error.message)


def _create(rooms: Rooms, params: Mapping[str, Any], own: Room | None) -> Any:
    room = own or rooms.make()
    if params:
        room.reset(read(Reset, dict(params)))
    return {"session_id": room.name}


def _close(rooms: Rooms, params: Mapping[str, Any], own: Room | None) -> Any:
    rooms.close(params.get("session_id"))
    return {"session_id": params["session_id"], "closed": True}


def _list(rooms: Rooms, params: Mapping[str, Any], own: Room | None) -> Any:
    room = own or (rooms.find(params["session_id"]) if "session_id" in params else rooms.nobody)
    tools = [
        {"name": tool.name, "description": tool.description, "inputSchema": tool.parameters}
        for tool in room.tools()
    ]
    return {"tools": tools}


def _call(rooms: Rooms, params: Mapping[str, Any], own: Room | None) -> Any:
    room = own or rooms.find(params.get("session_id"))
    name, arguments = params.get("name"), params.get("arguments", {})
    if not isinstance(name, str) or not isinstance(arguments, Mapping):
        raise ConfigError("name is a text, and arguments a JSON object.")
    told = room.call(name, arguments)
    shown = [*([told.image] if told.image else []), *told.closeups]
    words = "\n\n".join(part for part in (told.feedback, told.text) if part)
    return {
        "content": [{"type": "text", "text": words}, *map(_image, shown)],
        "structuredContent": _without_pictures(told),
        "isError": False,
    }


_METHODS: Mapping[str, Callable[[Rooms, Mapping[str, Any], Room | None], Any]] = {
    "openenv/session/create": _create,
    "openenv/session/close": _close,
    "tools/list": _list,
    "tools/call": _call,
}


def _image(shown: Shown) -> dict[str, Any]:
    return {"type": "image", "data": shown.data, "mimeType": shown.media_type}


def _without_pictures(told: Told) -> dict[str, Any]:
    told_of: dict[str, Any] = plain(told)
    return {key: value for key, value in told_of.items() if key not in ("image", "closeups")}


def _failed(number: str | int | None, code: int, text: str) -> dict[str, Any]:
    return {"jsonrpc": "2.0", "id": number, "error": {"code": code, "message": text}}
