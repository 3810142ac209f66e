"""A body on a server, as an `ActionServer`: any mind drives it as if it were here."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, replace
from typing import Any, Self
from uuid import uuid4

from adamo_vh.action import (
    Action,
    Drop,
    Inspect,
    Look,
    Pick,
    Survey,
    ToolSchema,
    Walk,
    action_name,
)
from adamo_vh.action_server.lines import Answered, CutError, Line, open_line
from adamo_vh.action_server.protocol import ActionResult, Sighting
from adamo_vh.action_server.wire import (
    VERSION,
    Act,
    Attach,
    Create,
    Described,
    DescribeState,
    Done,
    Failed,
    Finish,
    Load,
    Noted,
    Observe,
    Request,
    Say,
    Seen,
    Think,
    Welcome,
    read,
    result_of,
    sighting_of,
    to_plain,
)
from adamo_vh.errors import (
    AdamoError,
    ConfigError,
    EngineError,
    EpisodeOverError,
    InvalidActionError,
)

_KNOWN = {action_name(kind): kind for kind in (Look, Walk, Pick, Drop, Inspect, Survey)}
_FINISH = "Finish"
_FAULTS: Mapping[str, type[AdamoError]] = {
    "episode_over": EpisodeOverError,
    "invalid_request_error": ConfigError,
    "not_found": ConfigError,
    "judge_only": ConfigError,
}
"""What is raised for what a server says; an `EngineError` for all else."""


class RemoteBody:
    """One session on a server. Implements `ActionServer`.

    A connection that is cut is made again, and what was asked is asked again under its number, so
    that the server does nothing twice.
    """

    def __init__(self, line: Line, asked: Create | Attach, retry_s: float = 60.0) -> None:
        """Begin a session, or go on in one; use `connect`.

        Args:
            line: To the server.
            asked: What to begin, or where to go on.
            retry_s: So long a cut connection is tried again.
        """
        self._line = line
        self._retry_s = retry_s
        self.session = ""
        """Its id: who has it can go on in it."""
        self._ended = False
        welcome: Welcome = self._asked(asked, Welcome)[0]
        if welcome.version != VERSION:
            raise ConfigError(
                f"The server speaks version {welcome.version} of the wire, and this client "
                f"{VERSION}; install the same version of adamo-vh on both sides."
            )
        self._welcome = welcome
        self.session = welcome.session

    @property
    def instruction(self) -> str:
        """What is to be done."""
        return self._welcome.instruction

    @property
    def system_prompt(self) -> str:
        """What a player is told of the room, the tools and the rules."""
        return self._welcome.system_prompt

    @property
    def tools(self) -> tuple[ToolSchema, ...]:
        """The tools on offer, as a model sees them."""
        return self._welcome.tools

    @property
    def settings(self) -> Mapping[str, Any]:
        """Scene, labeling, profile and limits, as plain data."""
        return self._welcome.settings

    @property
    def ended(self) -> bool:
        """Whether the episode is over: all that a player is told of it."""
        return self._ended

    @property
    def actions(self) -> tuple[type, ...]:
        """The action types on offer.

        Raises:
            ConfigError: The server has a tool that this client does not know.
        """
        names = [tool.name for tool in self.tools if tool.name != _FINISH]
        if unknown := [name for name in names if name not in _KNOWN]:
            raise ConfigError(
                f"The server has a tool {unknown[0]!r} that this client does not know; use `call`."
            )
        return tuple(_KNOWN[name] for name in names)

    def observe(self) -> Sighting:
        """The view from where the body stands now; the same one, if nothing was done since."""
        seen, frames = self._asked(Observe(), Seen)
        return sighting_of(seen, frames)

    def execute(self, action: Action) -> ActionResult:
        """Carry out one action."""
        return self.call(action_name(type(action)), asdict(action))

    def refuse(self, error: InvalidActionError) -> ActionResult:
        """Answer a call that is no valid action, in the server's words; nothing changes."""
        name, arguments = error.call or ("", None)
        return self.call(name, arguments)

    def call(self, name: str, arguments: Mapping[str, Any] | None, note: str = "") -> ActionResult:
        """Carry a tool call out; one that is no valid action is refused and changes nothing.

        Args:
            name: Of the tool.
            arguments: Its arguments; None if they could not be read.
            note: What was thought before it.
        """
        told = None if arguments is None else dict(arguments)
        done, frames = self._asked(Act(name, told, note), Done)
        return result_of(done, frames)

    def think(self, thought: str | Mapping[str, Any]) -> None:
        """Put on record what was thought: a note, or the reply of a model as plain data."""
        told = Think(thought) if isinstance(thought, str) else Think(reply=dict(thought))
        self._asked(told, Noted)

    def say(self, text: str) -> None:
        """Say something through the body; after the end, nobody hears it."""
        with suppress(EpisodeOverError):
            self._asked(Say(text), Noted)

    def finish(self, answer: str = "", reason: str | None = None, why: str = "") -> None:
        """End the episode.

        Args:
            answer: What is said to the user.
            reason: Why, if the player's own limits ended it; see `TerminationReason`.
            why: In words, where there is more to say.
        """
        plain = {"answer": answer, "reason": reason, "why": why}
        self._asked(read(Finish, _json(plain)), Noted)

    def load(self, saved: str) -> str:
        """Go back to a saved state; in a scored episode, only to where it stands."""
        noted, _ = self._asked(Load(saved), Noted)
        return str(noted.state_hash)

    def state_text(self) -> str:
        """The symbolic state in words; empty if the profile has none."""
        described, _ = self._asked(DescribeState(), Described)
        return str(described.text)

    def close(self) -> None:
        """Hang up; the session stays on the server for a while, and can be gone on with."""
        self._line.close()

    def __enter__(self) -> Self:
        """The body itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Hang up."""
        self.close()

    def _asked(self, request: Request, kind: type) -> tuple[Any, Mapping[str, Any]]:
        """The answer of a kind, and its pictures."""
        answer, frames = self._tried(replace(request, request=uuid4().hex))
        if isinstance(answer, Failed):
            fault = _FAULTS.get(answer.error.type, EngineError)
            self._ended = self._ended or fault is EpisodeOverError
            raise fault(answer.error.message)
        if not isinstance(answer, kind):
            raise EngineError(
                f"The server answers {to_plain(answer)['type']!r} to {request.type!r}."
            )
        self._ended = self._ended or getattr(answer, "ended", False)
        return answer, frames

    def _tried(self, request: Request) -> Answered:
        """Ask until there is an answer."""
        begun, wait_s = time.monotonic(), 0.1
        while True:
            try:
                return self._line.ask(request, self.session)
            except CutError as cut:
                left_s = self._retry_s - (time.monotonic() - begun)
                if left_s <= 0:
                    raise EngineError(
                        f"The server cannot be reached ({cut}). Is it running? Go on later with "
                        f"the session {self.session or '(none yet)'}."
                    ) from None
                time.sleep(min(wait_s, left_s))
                wait_s = min(2 * wait_s, 5.0)


def connect(
    url: str,
    *,
    session: str = "",
    token: str = "",
    transport: str = "auto",
    timeout_s: float = 120.0,
    retry_s: float = 60.0,
    **settings: Any,
) -> RemoteBody:
    """A body on a server, e.g. one of `adamo-vh serve`.

        with adamo_vh.connect("http://127.0.0.1:8000", task="T1") as body:
            view = body.observe().observation
            body.call("Look", {"x": 0, "y": 0, "z": 1})
            body.finish("I looked.")

    Args:
        url: Of the server.
        session: Go on in this session; a new one is begun without.
        token: What the server asks of players.
        transport: "auto", "websocket" or "http".
        timeout_s: For an answer to come, seconds.
        retry_s: So long a cut connection is tried again, seconds.
        **settings: Of a new session: task or instruction, scene, labeling, profile, switches, seed,
            variation, resolution, player.

    Raises:
        ConfigError: A setting is wrong, or the server lets nobody in.
        EngineError: It cannot be reached, or has no room.
    """
    asked: Create | Attach = Attach(session)
    if not session:
        asked = read(Create, _json(settings))
    elif settings:
        raise ConfigError(f"Session {session!r} has its settings; leave {', '.join(settings)} out.")
    line = open_line(url, token, transport, timeout_s)
    try:
        return RemoteBody(line, asked, retry_s)
    except BaseException:
        line.close()
        raise


def _json(plain: Mapping[str, Any]) -> str:
    try:
        return json.dumps(plain)
    except (TypeError, ValueError) as error:
        raise ConfigError(f"This cannot be sent: {error}.") from None
