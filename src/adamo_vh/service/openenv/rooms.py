"""Sessions of OpenEnv: each plays one episode after the other, on a body of the server's."""

from __future__ import annotations

import base64
import secrets
import threading
from collections import OrderedDict
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

from adamo_vh.action import ToolSchema, tool_schema
from adamo_vh.action_server.wire import Act, Create, Done, Observe, Seen, Sent, Think, View
from adamo_vh.action_server.wire import Finish as End
from adamo_vh.cognition.turns import Finish, offered
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import ConfigError, EpisodeOverError
from adamo_vh.record.turn import FINISH
from adamo_vh.service.hosted import Hosted
from adamo_vh.service.hosting import Host, NoSessionError
from adamo_vh.service.openenv.catalog import chosen, drawn
from adamo_vh.service.openenv.messages import (
    CallTool,
    ListTools,
    Observation,
    Reset,
    Shown,
    State,
    Told,
    plain,
)
from adamo_vh.session.bodies import tools_for
from adamo_vh.session.pooling import BusyError

OBSERVE = "observe"
"""The tool that looks again without doing anything."""
_PLAYER = "openenv"
_LOOK_AGAIN = ToolSchema(
    OBSERVE,
    "Receive the last view again, with the symbolic state. Nothing is done.",
    {"type": "object", "properties": {}, "required": []},
)
_MOST_ROOMS = 1_000
Payload = dict[str, Any]
"""Observation, reward and done, as OpenEnv sends them."""


class Room:
    """One client's session; for one request at a time."""

    def __init__(self, host: Host, name: str) -> None:
        """Begin without an episode.

        Args:
            host: The server's sessions.
            name: Of this one; whoever knows it may play.
        """
        self.name = name
        self._host = host
        self._hosted: Hosted | None = None
        self._completion: float | None = None
        self._episode_id: str | None = None
        self._image: Shown | None = None
        """The last view that the rules of the profile granted, and the tags in it."""
        self._objects: tuple[str, ...] = ()
        self._lock = threading.Lock()

    def reset(self, asked: Reset) -> Payload:
        """Begin an episode; the one before stays on record as far as it is.

        Raises:
            ConfigError: A setting is wrong; the episode before goes on.
            BusyError: The server has no room.
        """
        with self._lock:
            before, wish = self._hosted, _created(asked)
            try:
                hosted = self._host.create(wish)
            except BusyError:
                if before is None:
                    raise
                # Its own episode takes the room that it needs.
                self._hosted = None
                self._drop(before)
                hosted = self._host.create(wish)
            else:
                self._drop(before)
            self._hosted, self._episode_id = hosted, asked.episode_id or hosted.id
            self._completion = hosted.completion()
            self._look(hosted)
            told = self._told(hosted, image=self._image)
            return self._payload(OBSERVE, told, None, hosted)

    def step(self, asked: CallTool | ListTools) -> Payload:
        """Carry out an action.

        Raises:
            ConfigError: There is no episode yet.
            EpisodeOverError: It has ended.
            EngineError: The world failed; the episode counts for nothing.
        """
        if isinstance(asked, ListTools):
            tools = [_listed(tool) for tool in self.tools()]
            return {"observation": {"tools": tools}, "reward": None, "done": False}
        with self._lock:
            hosted = self._playing()
            told = self._carried_out(hosted, asked)
            before, self._completion = self._completion, hosted.completion()
            gained = None
            if before is not None and self._completion is not None:
                gained = self._completion - before
            return self._payload(asked.tool_name, told, gained, hosted)

    def call(self, name: str, arguments: Mapping[str, Any]) -> Told:
        """Carry a tool call out for a player who is told no reward; begins an episode if needed."""
        if self._hosted is None:
            self.reset(Reset())
        with self._lock:
            hosted = self._playing()
            told = self._carried_out(hosted, CallTool(name, dict(arguments)))
            self._completion = hosted.completion()
            return told

    def state(self) -> State:
        """Where the episode stands; nothing of the room."""
        hosted = self._hosted
        if hosted is None:
            return State()
        config = hosted.body.config
        steps, over = hosted.body.steps, hosted.body.ended
        return State(self._episode_id, steps, config.task, config.scene, over)

    def tools(self) -> tuple[ToolSchema, ...]:
        """The tools of the episode, or of the profile that the server begins with."""
        if self._hosted is not None:
            own = self._hosted.body.tools
        else:
            config = EpisodeConfig.of("Look.", profile=self._host.terms.profile)
            actions = tuple(tool.action_type for tool in tools_for(config))
            own = tuple(offered(actions, config.profile))
        if not any(tool.name == FINISH for tool in own):
            own = (*own, tool_schema(Finish))
        return (*own, _LOOK_AGAIN)

    def close(self) -> None:
        """Leave; the record stays."""
        with self._lock:
            hosted, self._hosted = self._hosted, None
            self._drop(hosted)

    def _drop(self, hosted: Hosted | None) -> None:
        if hosted is None:
            return
        # The server may have closed it already: nobody had asked anything for long.
        with suppress(NoSessionError):
            self._host.close(hosted.id)

    def _playing(self) -> Hosted:
        if self._hosted is None:
            raise ConfigError("There is no episode yet: reset first.")
        if self._hosted.body.ended:
            raise EpisodeOverError("The episode has ended: reset to begin another one.")
        return self._host.find(self._hosted.id)

    def _carried_out(self, hosted: Hosted, asked: CallTool) -> Told:
        if asked.tool_name == OBSERVE:
            return self._told(hosted, image=self._image)
        note = asked.metadata.get("note")
        if isinstance(note, str) and note:
            hosted.perform(Think(note[:20_000]))
        if asked.tool_name == FINISH:
            hosted.perform(End(str(asked.arguments.get("answer") or "Done.")))
            return self._told(hosted, feedback="The episode is over.")
        sent = hosted.perform(Act(asked.tool_name, asked.arguments))
        done = sent.answer
        assert isinstance(done, Done)
        feedback = done.feedback
        before = self._image
        if done.view is not None:
            self._take(sent, done.view)
        elif not hosted.body.ended and hosted.body.config.profile.fresh_view:
            self._look(hosted)
        closeups = tuple(_shown(sent, picture.name) for picture in done.pictures)
        return self._told(
            hosted,
            feedback=feedback.text,
            outcome=str(feedback.outcome),
            code=str(feedback.code),
            image=None if self._image is before else self._image,
            closeups=closeups,
        )

    def _look(self, hosted: Hosted) -> None:
        sent = hosted.perform(Observe())
        assert isinstance(sent.answer, Seen)
        self._take(sent, sent.answer.view)

    def _take(self, sent: Sent, view: View) -> None:
        self._image = _shown(sent, view.picture.name)
        self._objects = tuple(item.tag for item in view.objects)

    def _told(self, hosted: Hosted, **more: Any) -> Told:
        body = hosted.body
        return Told(body.instruction, body.state_text(), objects=self._objects, **more)

    def _payload(self, tool: str, told: Told, reward: float | None, hosted: Hosted) -> Payload:
        observation = plain(Observation(tool, told, self.name))
        return {"observation": observation, "reward": reward, "done": hosted.body.ended}


class Rooms:
    """The sessions of those who come over HTTP, where no connection holds one."""

    def __init__(self, host: Host) -> None:
        """Start with none."""
        self._host = host
        self._rooms: OrderedDict[str, Room] = OrderedDict()
        self._lock = threading.Lock()
        self.nobody = Room(host, "")
        """What those are told who have no session."""

    def alone(self) -> Room:
        """A session that a connection holds, and nobody else finds."""
        return Room(self._host, secrets.token_urlsafe(12))

    def make(self) -> Room:
        """A new session; the oldest ones are left if there are too many."""
        room = Room(self._host, secrets.token_urlsafe(12))
        with self._lock:
            self._rooms[room.name] = room
            spare = [
                self._rooms.popitem(last=False)[1] for _ in range(len(self._rooms) - _MOST_ROOMS)
            ]
        for one in spare:
            one.close()
        return room

    def find(self, name: object) -> Room:
        """A session by its name.

        Raises:
            ConfigError: No name is given.
            NoSessionError: There is none of this name.
        """
        if not isinstance(name, str):
            raise ConfigError("session_id is missing: send the one that /reset gave.")
        with self._lock:
            room = self._rooms.get(name)
        if room is None:
            raise NoSessionError("There is no such session, or it was closed; reset again.")
        return room

    def close(self, name: object) -> None:
        """Close a session."""
        room = self.find(name)
        with self._lock:
            self._rooms.pop(room.name, None)
        room.close()


def _created(asked: Reset) -> Create:
    task, scene = asked.task, asked.scene
    if asked.split is not None:
        scene, task = chosen(asked.split, asked.index)
    elif task is None and asked.instruction is None:
        task = drawn(asked.seed)
    return Create(
        task=task,
        instruction=asked.instruction if task is None else None,
        scene=scene,
        labeling=asked.labeling,
        profile=asked.profile,
        seed=asked.seed or 0,
        variation=asked.variation,
        resolution=asked.resolution,
        player=_PLAYER,
    )


def _shown(sent: Sent, name: str) -> Shown:
    frame = sent.frames[name]
    data = base64.b64encode(frame.data).decode()
    return Shown(frame.media_type, data, frame.width_px, frame.height_px)


def _listed(tool: ToolSchema) -> dict[str, Any]:
    return {
        "name": tool.name,
        "description": tool.description,
        "input_schema": tool.parameters,
    }
