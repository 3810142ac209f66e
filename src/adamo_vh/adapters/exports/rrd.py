"""Recordings for Rerun: one `.rrd` file an episode, to be scrubbed through in its viewer.

Time is the timeline `event`: a number that grows with everything that happened; `step` counts the
calls. The room's boxes are those of its first state, and of its last one where it ended. They are
the truth and for people who look on: no player is told of them.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from adamo_vh.adapters.exports.form import Form
from adamo_vh.adapters.exports.recorded import Episode
from adamo_vh.engine import WorldState
from adamo_vh.errors import RecordError
from adamo_vh.extras import needed
from adamo_vh.files import make_folder
from adamo_vh.geometry import Vec3
from adamo_vh.observation import AgentState
from adamo_vh.perception import Labeling
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

_APPLICATION = "adamo-vh"


def write_rrd(episodes: Iterable[Episode], folder: Path, form: Form) -> int:
    """Write each episode as one recording.

    Args:
        episodes: What is exported.
        folder: Takes `NAME.rrd` for each.
        form: Nothing of it matters here.

    Returns:
        How many episodes were written.

    Raises:
        ConfigError: The extra is not installed.
    """
    needed("rerun", "rerun")
    count = 0
    for episode in episodes:
        path = folder / f"{episode.name}.rrd"
        make_folder(path.parent)
        with episode.tolerated():
            try:
                _write(episode, path)
            except RecordError:
                path.unlink(missing_ok=True)
                raise
            count += 1
    return count


def _write(episode: Episode, path: Path) -> None:
    import rerun as rr

    stream = rr.RecordingStream(_APPLICATION, recording_id=episode.name)
    stream.set_log_tick_enabled(False)
    stream.set_log_time_enabled(False)
    stream.save(path, default_blueprint=_blueprint())
    stream.send_recording_name(episode.name)
    stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    writer = _Writer(episode, stream)
    writer.room(episode.manifest.initial)
    for event in episode.trajectory.events:
        writer.take(event)
    if episode.result is not None:
        writer.room(episode.result.final)
    stream.flush()
    stream.disconnect()


def _blueprint() -> Any:
    """What the viewer shows at first."""
    import rerun.blueprint as rrb

    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(
                rrb.Spatial2DView(origin="view", name="What it sees"),
                rrb.TextLogView(origin="mind", name="What it says and is told"),
            ),
            rrb.Vertical(
                rrb.Spatial3DView(origin="world", name="The room"),
                rrb.TextDocumentView(origin="state_text", name="The state in words"),
            ),
        ),
        collapse_panels=True,
    )


class _Writer:
    """Writes one event after another."""

    def __init__(self, episode: Episode, stream: Any) -> None:
        self._episode = episode
        self._stream = stream
        self._path: list[tuple[float, float, float]] = []
        self._events = 0

    def room(self, world: WorldState) -> None:
        """Write where all objects are."""
        import rerun as rr

        boxes = [item.box for item in world.objects]
        turns = [box.orientation for box in boxes]
        self._log(
            "world/objects",
            rr.Boxes3D(
                centers=[_xyz(box.center) for box in boxes],
                sizes=[_xyz(box.size) for box in boxes],
                quaternions=[rr.Quaternion(xyzw=[q.x, q.y, q.z, q.w]) for q in turns],
                labels=[Labeling.SEM.tag(item.id, item.class_name) for item in world.objects],
                show_labels=True,
            ),
        )

    def take(self, event: Event) -> None:
        """Write an event."""
        import rerun as rr

        self._events += 1
        self._stream.set_time("event", sequence=self._events)
        if isinstance(step := getattr(event, "step", None), int):
            self._stream.set_time("step", sequence=step)
        match event:
            case Started():
                self._say(f"Asked: {event.instruction}", "INFO")
            case Thought():
                document = rr.TextDocument(event.state_text, media_type="text/plain")
                self._log("state_text", document)
                self._say(event.turn.note or f"({event.reply.ending})", "DEBUG")
            case Acted():
                self._say(f"{event.name}: {event.feedback.text}", _level(event))
                self._body(event.agent)
            case LeftOut():
                self._say(f"{event.name} was not executed: {event.why}", "WARN")
            case Observed():
                self._view(event)
                self._body(event.agent)
            case Shown():
                self._picture("closeup", event)
            case Ended():
                self._say(f"Ended ({event.reason}): {event.answer}", "INFO")
            case _:
                pass

    def _view(self, event: Observed) -> None:
        import rerun as rr

        self._picture("view/frame", event)
        edges = [seen.box_px for seen in event.objects]
        self._log(
            "view/boxes",
            rr.Boxes2D(
                mins=[(left, top) for left, top, _, _ in edges],
                sizes=[(right - left, bottom - top) for left, top, right, bottom in edges],
                labels=[seen.tag for seen in event.objects],
                show_labels=False,
            ),
        )

    def _picture(self, entity: str, event: Observed | Shown) -> None:
        import rerun as rr

        frame = self._episode.picture(event)
        self._log(entity, rr.EncodedImage(contents=frame.data, media_type=frame.media_type))

    def _body(self, agent: AgentState) -> None:
        import rerun as rr

        place, eyes, gaze = (_xyz(at) for at in (agent.position, agent.eyes, agent.gaze))
        if self._path[-1:] != [place]:
            self._path.append(place)
        self._log("world/body", rr.Points3D([eyes], labels=[agent.held or ""], radii=[0.08]))
        self._log("world/gaze", rr.LineStrips3D([[eyes, gaze]], radii=[0.01]))
        self._log("world/way", rr.LineStrips3D([self._path], radii=[0.02]))

    def _say(self, text: str, level: str) -> None:
        import rerun as rr

        self._log("mind", rr.TextLog(text, level=level))

    def _log(self, entity: str, what: Any) -> None:
        self._stream.log(entity, what)


def _xyz(point: Vec3) -> tuple[float, float, float]:
    return (point.x, point.y, point.z)


def _level(act: Acted) -> str:
    return "WARN" if act.feedback.outcome == "refused" else "INFO"
