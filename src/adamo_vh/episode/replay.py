"""Execute a recorded episode again, without its model, and compare every state."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from adamo_vh.action_server import ActionServer, execute_call
from adamo_vh.engine import World
from adamo_vh.errors import RecordError
from adamo_vh.observation import Frame
from adamo_vh.record.trajectory import (
    Acted,
    Event,
    Happened,
    Observed,
    Restored,
    Started,
    Trajectory,
    frame_name,
)


@dataclass(frozen=True, slots=True)
class ReplayReport:
    """Whether a recorded episode came out the same when it was executed again."""

    steps: int
    """Actions executed again."""
    mismatches: tuple[str, ...]
    """What differed, in order; empty if every state hash is the same."""
    frames_differ: int
    """Frames with other bytes: possible on another machine, no error there."""
    cut: int = 0
    """Actions that a person cut short: the world goes to where they ended."""


def replay(
    server: ActionServer,
    world: World,
    recorded: Trajectory,
    start: int = 0,
    came: Callable[[Event], None] | None = None,
) -> ReplayReport:
    """Replay a trajectory.

    Args:
        server: Of the same scene and settings, just reset.
        world: Behind it; for what happened in it that its body did not do.
        recorded: What happened.
        start: Begin after this many steps, from the state that was saved there.
        came: Is told of every event from there on, as soon as the world stands as after it. Whoever
            hears of them looks on as well: he is shown what was cut short, and may cut it again.

    Raises:
        RecordError: There is no such step.
    """
    acts = recorded.acts
    if not 0 <= start <= len(acts):
        raise RecordError(f"step {start}: the episode has steps 0 to {len(acts)}.")
    began = next((e for e in recorded.events if isinstance(e, Started)), None)
    if began is None or not began.saved:
        raise RecordError("The episode broke before its first view; there is nothing to replay.")
    now = server.load(acts[start - 1].saved if start else began.saved)
    mismatches: list[str] = []
    frames_differ = cut = 0
    before = acts[start - 1].state_hash if start else began.state_hash
    if now != before:
        mismatches.append(f"the state after step {start} differs from the recorded one")
    frame: Frame | None = None
    for event in _events_after(recorded, start):
        if isinstance(event, Started) and event.saved and event is not began:
            # A further instruction begins where it stands; free play may have gone back before.
            server.load(event.saved)
        if isinstance(event, Acted | Happened | Restored):
            if isinstance(event, Acted) and event.is_cut:
                cut += 1
                if came is not None:
                    execute_call(server, event.name, event.arguments)
            digest, frame = _led_to(event, server, world)
            if digest != event.state_hash:
                what = event.name if isinstance(event, Acted) else event.type
                mismatches.append(
                    f"step {event.step}: {what} led to state {digest[:12]}, recorded "
                    f"{event.state_hash[:12]}"
                )
        if isinstance(event, Observed):
            # A view that no action brought was asked for: at the start, or to see what changed.
            seen = frame or server.observe().observation.frame
            frames_differ += frame_name(seen) != event.frame
            frame = None
        if came is not None:
            came(event)
    return ReplayReport(len(acts) - start - cut, tuple(mismatches), frames_differ, cut)


def _led_to(
    event: Acted | Happened | Restored, server: ActionServer, world: World
) -> tuple[str, Frame | None]:
    """Let an event come again; the digest of the world then, and the view that it brought."""
    if isinstance(event, Happened):
        world.apply(event.event)
        return world.state().hash(), None
    if isinstance(event, Restored) or event.is_cut:
        return server.load(event.saved), None
    result = execute_call(server, event.name, event.arguments)
    view = result.observation
    return result.state_hash, None if view is None else view.frame


def _events_after(recorded: Trajectory, start: int) -> Iterator[Event]:
    """The events after a number of actions; the views that followed the last of them are passed."""
    count, has_begun = 0, False
    for event in recorded.events:
        count += isinstance(event, Acted)
        has_begun = has_begun or isinstance(event, Started)
        happened_since = isinstance(event, Happened | Restored) and has_begun and count == start
        if count > start or happened_since or (start == 0 and has_begun):
            yield event
