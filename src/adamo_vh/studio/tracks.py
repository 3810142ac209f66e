"""A run folder as a track: its record is executed again, and every pose of it told."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from adamo_vh.engine import BodyInfo, World, acting_body
from adamo_vh.episode.result import Manifest, read_manifest
from adamo_vh.errors import AdamoError
from adamo_vh.record.run_folder import SCENE
from adamo_vh.record.trajectory import Acted, Event, read_trajectory
from adamo_vh.session.builtin import scene_title
from adamo_vh.session.figures import recorded_figure
from adamo_vh.session.posing import Posing
from adamo_vh.session.runs import replay_episode
from adamo_vh.studio import messages
from adamo_vh.studio.messages import Href, Message, Part, Places
from adamo_vh.studio.telling import Telling

_SAME_S = 1e-3
"""Seconds by which one moment of a motion, as it is on record and as it comes again, may differ."""


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """What can be shown: a greeting, and messages in order."""

    hello: Message
    messages: tuple[Message, ...]


def track_of(folder: Path, name: str, href: Href, at: Places) -> Track:
    """Make a track of a run folder.

    A record that cannot be executed again, in whole or in part, shows its events without poses from
    there on, and says why.

    Args:
        folder: The run folder.
        name: What it is called on the page.
        href: Where its pictures can be had.
        at: Where the meshes of its scene and figure can be had.

    Raises:
        RecordError: The folder holds no run, or one of another version.
    """
    making = _Making(folder, href)
    making.execute()
    part = Part(name, is_live=False)
    places = at if making.body is not None else Places()
    title = _title(folder, making.manifest)
    hello = messages.hello(part, making.manifest, making.body, title, places)
    return Track(hello, tuple(making.told))


def _title(folder: Path, manifest: Manifest) -> str:
    own = folder / SCENE
    return scene_title(str(own) if own.is_file() else manifest.config.scene)


class _Making:
    """A track while it is made."""

    def __init__(self, folder: Path, href: Href) -> None:
        self.folder = folder
        self.manifest = read_manifest(folder)
        self.damaged: list[str] = []
        self.events = read_trajectory(folder, self.damaged).events
        self.told: list[Message] = []
        self.body: BodyInfo | None = None
        """Of the engine, once it is open."""
        self._href = href
        self._telling = Telling(self._tell, href, None)
        self._came = 0
        """How many events have come again."""
        self._begun_s = 0.0
        """The simulated second at which the last of them came."""
        self._cut: set[int] = set()
        """Steps of the actions that were cut short again, where a person had done so."""

    def execute(self) -> None:
        """Tell all events: with poses as far as they can be executed again, and without after."""
        if lacks := recorded_figure(self.folder, self.manifest, elsewhere=False).lacks:
            self._say(lacks)
        if self.damaged:
            self._say(f"Some of the record cannot be read: {self.damaged[0]}")
        else:
            try:
                report = replay_episode(self.folder, watch=self._watch)
                if report.cut > len(self._cut):
                    self._say("Where a person cut an action short, she jumps to where it ended.")
                for mismatch in report.mismatches[:3]:
                    self._say(f"It came out otherwise than recorded: {mismatch}.")
            except AdamoError as error:
                self._say(f"What follows is shown as it is on record, and not seen: {error}")
        seconds = self._telling.seconds
        rest = Telling(
            lambda message, later: self._tell(message, seconds + later), self._href, None
        )
        for event in self.events[self._came :]:
            rest.notify(event)

    def _watch(self, world: World) -> Callable[[Event], None]:
        self.body = acting_body(world).info
        # Nothing is told twice of a second world: there is one for each track.
        posing = Posing(world, lambda: self._moment(posing))
        self._telling = Telling(self._tell, self._href, posing)
        self._telling.pose()
        return self._heard

    def _moment(self, posing: Posing) -> bool:
        self._telling.pose()
        act = next((e for e in islice(self.events, self._came, None) if isinstance(e, Acted)), None)
        stopped_s = None if act is None else act.feedback.stopped_s
        if act is None or stopped_s is None or posing.seconds - self._begun_s < stopped_s - _SAME_S:
            return True
        self._cut.add(act.step)
        return False

    def _heard(self, event: Event) -> None:
        # What came before the first instruction is not executed: its state holds it already.
        place = next(i for i in range(self._came, len(self.events)) if event == self.events[i])
        for told in self.events[self._came : place + 1]:
            self._telling.notify(told)
        self._came = place + 1
        self._begun_s = self._telling.seconds

    def _say(self, text: str) -> None:
        self._telling.tell(messages.notice(text, "warning"))

    def _tell(self, message: Message, seconds: float) -> None:
        self.told.append({"n": len(self.told) + 1, "t": round(seconds, 3), **message})
