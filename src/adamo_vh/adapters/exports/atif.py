"""ATIF: the Agent Trajectory Interchange Format, version 1.7, one trajectory an episode.

Each turn is an agent step with its calls and, as its observation, what came back: feedback and
pictures. The symbolic state that the model read stands in `extra` of the step, for it is part of
its prompt and no message of the dialogue.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from shutil import rmtree
from typing import Any

from adamo_vh.adapters.exports.chat import chat_tools
from adamo_vh.adapters.exports.form import Form
from adamo_vh.adapters.exports.pictures import PictureFiles
from adamo_vh.adapters.exports.recorded import Episode
from adamo_vh.cognition.turns import offered
from adamo_vh.errors import RecordError
from adamo_vh.files import write_whole
from adamo_vh.inference.messages import ToolCall
from adamo_vh.inference.model import Reply
from adamo_vh.record.trajectory import (
    Acted,
    Ended,
    Event,
    LeftOut,
    Observed,
    Shown,
    Started,
    Thought,
)
from adamo_vh.session.bodies import tools_for

SCHEMA = "ATIF-v1.7"
TRAJECTORY = "trajectory.json"


def write_atif(episodes: Iterable[Episode], folder: Path, form: Form) -> int:
    """Write each episode as one trajectory with its pictures.

    Args:
        episodes: What is exported.
        folder: Takes a folder an episode: `trajectory.json` and `images/`.
        form: Nothing of it matters here.

    Returns:
        How many episodes were written.
    """
    count = 0
    for episode in episodes:
        place = folder / episode.name
        with episode.tolerated():
            try:
                told = trajectory(episode, PictureFiles(place))
            except RecordError:
                rmtree(place, ignore_errors=True)
                raise
            text = json.dumps(told, ensure_ascii=False, indent=1)
            write_whole(place / TRAJECTORY, text.encode())
            count += 1
    return count


def trajectory(episode: Episode, pictures: PictureFiles) -> dict[str, Any]:
    """An episode as an ATIF document.

    Args:
        episode: What is written.
        pictures: Where its pictures go.
    """
    manifest, config = episode.manifest, episode.manifest.config
    actions = tuple(tool.action_type for tool in tools_for(config))
    writer = _Steps(episode, pictures)
    for event in episode.trajectory.events:
        writer.take(event)
    agent: dict[str, Any] = {
        "name": "adamo-vh",
        "version": manifest.versions.get("adamo-vh", "unknown"),
        "model_name": manifest.model_name,
        "tool_definitions": chat_tools(offered(actions, config.profile)),
        "extra": {"profile": str(config.profile), "model_kind": str(manifest.model_kind)},
    }
    return {
        "schema_version": SCHEMA,
        "session_id": episode.name,
        "trajectory_id": episode.name,
        "agent": agent,
        "steps": writer.steps,
        "final_metrics": _final(episode, len(writer.steps)),
        "extra": _about(episode),
    }


def _final(episode: Episode, steps: int) -> dict[str, Any]:
    if (result := episode.result) is None:
        return {"total_steps": steps}
    usage = result.usage
    told: dict[str, Any] = {
        "total_prompt_tokens": usage.input_tokens,
        "total_completion_tokens": usage.output_tokens,
        "total_cached_tokens": usage.cached_tokens,
        "total_steps": steps,
    }
    return told if result.cost_usd is None else told | {"total_cost_usd": result.cost_usd}


def _about(episode: Episode) -> dict[str, Any]:
    config, result = episode.manifest.config, episode.result
    told = {
        "task": config.task,
        "scene": config.scene,
        "variation": config.variation,
        "labeling": episode.manifest.labeling or str(config.labeling),
        "seed": config.seed,
        "started_at": episode.manifest.started_at,
    }
    if result is None:
        return told
    return told | {
        "completion": result.completion,
        "strict": result.strict,
        "termination": str(result.termination),
    }


class _Steps:
    """Makes the steps of a trajectory from its events."""

    def __init__(self, episode: Episode, pictures: PictureFiles) -> None:
        self.steps: list[dict[str, Any]] = []
        self._episode = episode
        self._pictures = pictures
        self._results: list[dict[str, Any]] = []
        """Of the turn that is being carried out."""

    def take(self, event: Event) -> None:
        """Take the next event."""
        match event:
            case Started():
                if not self.steps:
                    self._add("system", event.system_prompt)
                self._add("user", event.instruction)
            case Thought():
                self._think(event)
            case Acted():
                said = event.feedback
                extra = {"outcome": str(said.outcome), "code": str(said.code or "")}
                self._result(event, said.text, extra)
            case LeftOut():
                self._result(event, f"Not executed: {event.why}.", {"outcome": "left_out"})
            case Observed() | Shown():
                self._show(event)
            case Ended():
                self._end(event)
            case _:
                pass

    def _add(self, source: str, message: str | list[dict[str, Any]], **more: Any) -> None:
        step_id = len(self.steps) + 1
        self.steps.append({"step_id": step_id, "source": source, "message": message, **more})

    def _think(self, event: Thought) -> None:
        reply = event.reply
        more: dict[str, Any] = {"extra": {"state_text": event.state_text, "ending": reply.ending}}
        if reply.message.calls:
            more["tool_calls"] = [_call(call) for call in reply.message.calls]
        if metrics := _metrics(reply):
            more["metrics"] = metrics
        self._results = []
        self._add("agent", reply.message.text, **more)

    def _result(self, event: Acted | LeftOut, text: str, extra: dict[str, Any]) -> None:
        extra |= {"name": event.name, "step": event.step}
        result = {"content": [{"type": "text", "text": text}], "extra": extra}
        known = {call["tool_call_id"] for call in self.steps[-1].get("tool_calls", ())}
        if event.call_id in known:
            result["source_call_id"] = event.call_id
        self._observe(result)

    def _observe(self, result: dict[str, Any]) -> None:
        self._results.append(result)
        self.steps[-1]["observation"] = {"results": self._results}

    def _show(self, event: Observed | Shown) -> None:
        frame = self._episode.picture(event)
        source = {"media_type": frame.media_type, "path": self._pictures.url(frame)}
        part = {"type": "image", "source": source}
        if self._results:
            self._results[-1]["content"].append(part)
            return
        step = self.steps[-1]
        if step["source"] == "agent":
            self._observe({"content": [part], "extra": {"step": event.step}})
        elif isinstance(step["message"], str):
            step["message"] = [{"type": "text", "text": step["message"]}, part]
        else:
            step["message"].append(part)

    def _end(self, event: Ended) -> None:
        ending = {"termination": str(event.reason), "why": event.why}
        self.steps[-1].setdefault("extra", {}).update(ending)
        self._results = []


def _call(call: ToolCall) -> dict[str, Any]:
    told: dict[str, Any] = {"tool_call_id": call.id, "function_name": call.name}
    if call.arguments is None:
        return told | {"arguments": {}, "extra": {"unreadable": call.raw}}
    return told | {"arguments": dict(call.arguments)}


def _metrics(reply: Reply) -> dict[str, Any]:
    usage = reply.usage
    if not usage.total_tokens:
        return {}
    told: dict[str, Any] = {
        "prompt_tokens": usage.input_tokens,
        "completion_tokens": usage.output_tokens,
        "cached_tokens": usage.cached_tokens,
        "extra": {"reasoning_tokens": usage.reasoning_tokens, "estimated": usage.estimated},
    }
    return told if reply.cost_usd is None else told | {"cost_usd": reply.cost_usd}
