"""Execute a recorded episode again, without its model, and compare every state."""

from __future__ import annotations

from dataclasses import dataclass

from adamo.action_server import ActionServer, execute_call
from adamo.cognition.trajectory import Started, Trajectory, frame_name
from adamo.errors import RecordError


@dataclass(frozen=True, slots=True)
class ReplayReport:
    """Whether a recorded episode came out the same when it was executed again."""

    steps: int
    """Actions executed again."""
    mismatches: tuple[str, ...]
    """What differed, in order; empty if every state hash is the same."""
    frames_differ: int
    """Frames with other bytes: possible on another machine, no error there."""


def replay(server: ActionServer, recorded: Trajectory, start: int = 0) -> ReplayReport:
    """Replay a trajectory.

    Args:
        server: Of the same scene and settings, just reset.
        recorded: What happened.
        start: Begin after this many steps, from the state that was saved there.

    Raises:
        RecordError: There is no such step.
    """
    acts = recorded.acts
    if not 0 <= start <= len(acts):
        raise RecordError(f"step {start}: the episode has steps 0 to {len(acts)}.")
    began = next((e for e in recorded.events if isinstance(e, Started)), None)
    if began is None:
        raise RecordError("The episode has no beginning.")
    server.load(acts[start - 1].saved if start else began.saved)
    mismatches, frames_differ = [], 0
    before = acts[start - 1].state_hash if start else began.state_hash
    if server.state_hash() != before:
        mismatches.append(f"the state after step {start} differs from the recorded one")
    frames = {view.step: view.frame for view in recorded.views}
    if start == 0 and 0 in frames:
        frames_differ += frame_name(server.observe().frame) != frames[0]
    for act in acts[start:]:
        result = execute_call(server, act.name, act.arguments)
        if result.state_hash != act.state_hash:
            mismatches.append(
                f"step {act.step}: {act.name} led to state {result.state_hash[:12]}, "
                f"recorded {act.state_hash[:12]}"
            )
        if result.observation is not None:
            frames_differ += frame_name(result.observation.frame) != frames.get(act.step)
    return ReplayReport(len(acts) - start, tuple(mismatches), frames_differ)
