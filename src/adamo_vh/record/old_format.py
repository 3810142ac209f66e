"""Records of format 1, as those of today: they can be read, replayed and shown, not continued."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import TypeAdapter

from adamo_vh.inference.messages import ToolCall
from adamo_vh.record.turn import Wish

OLD_FORMAT = 1
_REPLY = [
    "usage",
    "waited_s",
    "requests",
    "cost_usd",
    "settings",
    "rung",
    "unreadable",
    "ending",
    "finish_reason",
]
_SCORE = ("completion", "strict", "conditions", "violations")


def upgraded_event(line: bytes, head: Mapping[str, Any], before: Sequence[Any]) -> dict[str, Any]:
    """An event of today from a line of an old record.

    Args:
        line: The line.
        head: The manifest, as plain data.
        before: The events so far: they tell which calls were still to be done.
    """
    event: dict[str, Any] = json.loads(line)
    if event["type"] == "thought":
        return _thought(event, head["config"]["profile"])
    if event["type"] in ("acted", "left_out"):
        event["call_id"] = _call_id(before)
    return event


def upgraded_result(result: dict[str, Any]) -> dict[str, Any]:
    """A result of today from an old one."""
    score = {name: result.pop(name) for name in _SCORE}
    return {**result, "score": None if score["completion"] is None else score}


def _thought(event: dict[str, Any], profile: Mapping[str, Any]) -> dict[str, Any]:
    message = {"text": event["note"], "calls": event["calls"], "kept": event.get("kept", "")}
    reply = {name: event[name] for name in _REPLY if event.get(name) is not None}
    noted, can_finish = profile["note_argument"], profile["finish_check"]
    calls = TypeAdapter(list[ToolCall]).validate_python(event["calls"])
    wishes = [Wish.of(call, noted=noted, can_finish=can_finish) for call in calls]
    told = TypeAdapter(list[Wish]).dump_python(wishes, mode="json")
    return {
        "type": "thought",
        "step": event["step"],
        "state_text": event["state_text"],
        "messages": event["messages"],
        "turn": {
            "reply": {**reply, "message": message, "seconds": event["model_s"]},
            "wishes": told,
        },
    }


def _call_id(before: Sequence[Any]) -> str:
    """The call whose turn it is: calls are done, or left out, in their order."""
    done = 0
    for event in reversed(before):
        if event.type == "thought":
            wishes = event.turn.wishes
            return str(wishes[done].call.id) if done < len(wishes) else ""
        done += event.type in ("acted", "left_out")
    return ""
