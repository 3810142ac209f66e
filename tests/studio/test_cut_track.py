"""A run in which a person took part, as a track: it comes again, and says where it jumps."""

from __future__ import annotations

from adamo_vh.engine import ObjectMoved
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.geometry import Vec3
from adamo_vh.session.posing import Posing
from adamo_vh.session.session import Session
from adamo_vh.studio.messages import Places
from adamo_vh.studio.tracks import track_of


def test_what_was_dragged_cut_and_undone_is_shown_again(engine, tmp_path):
    config = EpisodeConfig("Pick the plate", resolution=(160, 90))
    with Session.begin(config, tmp_path, engine=engine, page=False) as session:

        def moment() -> bool:
            if posing.seconds > 0.7:
                session.stop()
            return posing.seconds <= 0.7

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
    (notice,) = [m["text"] for m in track.messages if m["type"] == "notice"]
    assert "cut an action short" in notice
    last = [m for m in track.messages if m["type"] == "pose"][-1]
    assert tuple(last["body"][:2]) == (round(end.x, 4), round(end.y, 4))
