"""A run in which a person took part, as a track: it comes again, and ends where it was cut."""

from __future__ import annotations

from pathlib import Path

import pytest

from adamo_vh.engine import ObjectMoved
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.geometry import Vec3
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session.posing import Pose, Posing
from adamo_vh.session.session import Session
from adamo_vh.studio.messages import Places
from adamo_vh.studio.tracks import track_of


@pytest.mark.parametrize("stop_s", [0.0, 0.7, 6.0], ids=["at once", "walking", "reaching"])
def test_what_was_dragged_cut_and_undone_is_shown_again(
    engine: BuiltinEngine, tmp_path: Path, stop_s: float
) -> None:
    config = EpisodeConfig("Pick the plate", resolution=(160, 90))
    with Session.begin(config, tmp_path, engine=engine, page=False) as session:
        seen: list[tuple[float, Pose | None]] = []

        def moment() -> bool:
            seen.append((posing.seconds, posing.pose()))
            if posing.seconds > stop_s:
                session.stop()
            return posing.seconds <= stop_s

        session.apply(ObjectMoved(4, Vec3(0.2, 0.1, 0.8)), by_user=True)
        posing = Posing(session.engine, moment)
        session.say("Pick the plate")
        posing.close()
        session.undo()
        session.say("What do you hold?")
        end = session.engine.state().body.position
    track = track_of(tmp_path, "run", lambda name: name, Places())
    kinds = [m["event"]["type"] for m in track.messages if m["type"] == "event"]
    assert kinds[0] == "happened" and "restored" in kinds and kinds[-1] == "ended"
    assert [m["text"] for m in track.messages if m["type"] == "notice"] == []
    acts = [n for n, m in enumerate(track.messages) if m.get("event", {}).get("type") == "acted"]
    acted = next(n for n in acts if track.messages[n]["event"]["feedback"]["code"] == "cancelled")
    shown = [m for m in track.messages[:acted] if m["type"] == "pose"]
    seconds, pose = seen[-1]
    assert pose is not None
    assert shown[-2]["t"] == round(seconds, 3)
    assert (tuple(shown[-2]["body"]), tuple(shown[-2]["joints"])) == (pose.body, pose.joints)
    assert shown[-1]["body"] == shown[-2]["body"] and shown[-1]["held"] is None
    last = [m for m in track.messages if m["type"] == "pose"][-1]
    assert tuple(last["body"][:2]) == (round(end.x, 4), round(end.y, 4))
