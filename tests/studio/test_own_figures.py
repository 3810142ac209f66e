"""Own figures in the studio: on offer by their file's name, and from a run's own folder."""

from __future__ import annotations

import json
import os
import shutil

import pytest
from tests.runtime.human.own.rigs import Rig, rig, t_pose

from adamo_vh.errors import ConfigError
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.record.run_folder import FIGURE
from adamo_vh.session.runs import run_episode
from adamo_vh.studio.face import _versioned
from adamo_vh.studio.library import Run, figure_of
from adamo_vh.studio.messages import Places
from adamo_vh.studio.offer import Offer
from adamo_vh.studio.one_page import whole
from adamo_vh.studio.rooms import Asked, Rooms
from adamo_vh.studio.tracks import track_of


@pytest.fixture(scope="module")
def me(tmp_path_factory):
    file = tmp_path_factory.mktemp("own") / "My figure.vrm"
    file.write_bytes(rig(Rig("mixamo", t_pose(), garments=("shoes", "lids"), plain=True)))
    return file


@pytest.fixture(scope="module")
def recorded(me, tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs") / "run"
    look = ToolCall("c1", "Look", {"x": 0.5, "y": 0.0, "z": 0.8})
    model = ScriptedModel("scripted", [AIMessage("I look.", (look,)), AIMessage("Done.")])
    run_episode("Look", model=model, figure=str(me), resolution=(160, 90), out=folder)
    return folder


def test_it_is_offered_first_and_by_its_name_alone(me):
    offer = Offer(figures=[me])
    assert offer.figures()[0] == me.name
    assert "mara" in offer.figures()
    assert offer.figure(me.name) == str(me)
    offer.check("baseline", "s1", me.name, None)
    for path in (str(me), "../x.glb", "/etc/passwd", "nobody"):
        with pytest.raises(ConfigError, match="no figure"):
            offer.check("baseline", "s1", path, None)


def test_a_room_is_opened_with_it(me, tmp_path):
    rooms = Rooms(tmp_path, Offer(figures=[me]))
    try:
        config = rooms._config(Asked(figure=me.name))
        assert config.figure == str(me)
    finally:
        rooms.close_all()


def test_a_file_that_changes_is_another_mesh(me, tmp_path):
    copy = tmp_path / "me.glb"
    shutil.copy(me, copy)
    before = _versioned(str(copy))
    assert _versioned(str(copy)) == before
    os.utime(copy, (1, 1))
    assert _versioned(str(copy)) != before
    assert _versioned("mara") == ("mara", "")


def test_a_recorded_run_is_shown_with_its_own_copy(recorded, tmp_path):
    folder = shutil.copytree(recorded, tmp_path / "run")
    run = Run("run", folder, 0.0)
    assert figure_of(run) == str(folder / FIGURE)
    track = track_of(folder, "run", lambda frame: frame, Places("scene", "figure"))
    assert track.hello["figure"] == {"name": "My figure.vrm", "glb": "figure"}
    assert str(tmp_path) not in json.dumps(track.hello)
    assert not [m for m in track.messages if m["type"] == "notice"]
    told = whole(track, run)["hello"]
    assert told["figure"]["glb"].startswith("data:model/gltf-binary")


def test_where_the_copy_is_missing_mara_stands_in_and_the_page_says_so(recorded, tmp_path):
    folder = shutil.copytree(recorded, tmp_path / "run")
    (folder / FIGURE).unlink()
    assert figure_of(Run("run", folder, 0.0)) == "mara"
    track = track_of(folder, "run", lambda frame: frame, Places("scene", "figure"))
    notices = [m["text"] for m in track.messages if m["type"] == "notice"]
    assert any("stands in" in text for text in notices)
    assert [m for m in track.messages if m["type"] == "pose"]
