"""An own figure is on record by its digest and a copy, and replay says if neither is there."""

from __future__ import annotations

import json
import shutil
import warnings
from pathlib import Path

import pytest
from tests.runtime.human.own.rigs import Rig, rig, t_pose

from adamo_vh.engine import acting_body
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import read_manifest
from adamo_vh.errors import ConfigError, FileError, RecordError
from adamo_vh.inference.messages import AIMessage
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.record.run_folder import FIGURE, MANIFEST
from adamo_vh.session.bodies import create_engine
from adamo_vh.session.figures import (
    check_figure,
    draw_figure,
    figure_digest,
    figure_glb,
    recorded_figure,
)
from adamo_vh.session.posing import joint_names
from adamo_vh.session.runs import replay_episode, run_episode
from adamo_vh.session.session import Session
from adamo_vh.session.spare import engine_for
from adamo_vh.session.verifying import verify_run
from adamo_vh.study.plan import Study, plan
from adamo_vh.study.running import check_parts

SMALL = (160, 90)
SHORT = Rig("mixamo", t_pose(), garments=("shoes", "hands"), plain=True)


@pytest.fixture(scope="module")
def me(tmp_path_factory):
    file = tmp_path_factory.mktemp("own") / "Me.vrm"
    file.write_bytes(rig(SHORT))
    return file


@pytest.fixture(scope="module")
def recorded(me, tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs") / "run"
    run_episode(task="T2", model="baseline", figure=str(me), resolution=SMALL, out=folder)
    return folder


@pytest.fixture
def run(recorded, tmp_path):
    """A run folder to spoil, whose own file is not where it was."""
    folder = Path(shutil.copytree(recorded, tmp_path / "run"))
    told = json.loads((folder / MANIFEST).read_bytes())
    told["config"]["figure"] = str(tmp_path / "gone" / "Me.vrm")
    (folder / MANIFEST).write_text(json.dumps(told))
    return folder


def test_the_record_holds_digest_and_copy(me, recorded):
    manifest = read_manifest(recorded)
    assert manifest.config.figure == str(me)
    assert manifest.figure_sha256 == figure_digest(str(me))
    assert (recorded / FIGURE).read_bytes() == me.read_bytes()
    assert verify_run(recorded, replayed=False).problems == ()


def test_the_copy_is_enough_to_replay(run):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        report = replay_episode(run)
    assert not report.mismatches
    assert not report.frames_differ


@pytest.mark.parametrize("how", ["missing", "changed"])
def test_replay_says_when_the_figure_is(run, how):
    if how == "missing":
        (run / FIGURE).unlink()
    else:
        (run / FIGURE).write_bytes(b"glTF" + bytes(40))
    with pytest.warns(UserWarning, match=f"{FIGURE} .*{how}.*mara stands in.*SHA-256"):
        report = replay_episode(run)
    assert not report.mismatches
    assert any(FIGURE in problem for problem in verify_run(run, replayed=False).problems)


def test_nobody_goes_on_with_another_figure(run):
    (run / FIGURE).unlink()
    with pytest.raises(RecordError, match="Put back the file with SHA-256"):
        Session.resume(run)


def test_a_file_outside_the_folder_is_read_only_if_it_may_be(me, recorded, tmp_path):
    folder = Path(shutil.copytree(recorded, tmp_path / "run"))
    (folder / FIGURE).unlink()
    manifest = read_manifest(folder)
    assert recorded_figure(folder, manifest).who == str(me)
    assert recorded_figure(folder, manifest, elsewhere=False).who == "mara"


def test_the_body_that_is_scored_is_the_same(me):
    with engine_for("s1", "mara") as ours, engine_for("s1", str(me)) as theirs:
        one, other = acting_body(ours).info, acting_body(theirs).info
        assert (one.radius_m, one.eye_height_m, one.reach_m, one.reach_top_m, one.fov_y_rad) == (
            other.radius_m,
            other.eye_height_m,
            other.reach_m,
            other.reach_top_m,
            other.fov_y_rad,
        )
        assert ours.state().hash() == theirs.state().hash()
        assert ours.scene.digest != theirs.scene.digest
        for engine in (ours, theirs):
            engine.reset(0)
            engine.body.pick(57)
        assert ours.state().hash() == theirs.state().hash()


def test_a_file_that_was_changed_is_another_figure(tmp_path):
    file = tmp_path / "me.glb"
    file.write_bytes(rig(SHORT))
    with engine_for("s1", str(file)) as first:
        pass
    file.write_bytes(rig(Rig("unity", garments=("shoes",), plain=True)))
    with engine_for("s1", str(file)) as second:
        assert second is not first
        assert second.scene.digest != first.scene.digest


def test_wrong_figures_are_refused_before_anything_is_asked(tmp_path):
    with pytest.raises(FileError, match="cannot be read"):
        create_engine("s1", str(tmp_path / "none.glb"))
    with pytest.raises(ConfigError, match="a file of your own"):
        create_engine("s1", "bob")
    broken = tmp_path / "x.vrm"
    broken.write_bytes(b"Kaydara FBX Binary")
    with pytest.raises(FileError, match="convert it"):
        run_episode(task="T2", model="openai:none", figure=str(broken))


def test_a_figure_is_checked_drawn_and_exported(me):
    assert check_figure(me).source == "names of bones (Mixamo)"
    picture = draw_figure(str(me))
    assert picture.shape[0] == 640
    assert (picture != 232).any(axis=2).mean() > 0.005
    content = figure_glb(str(me))
    assert content[:4] == b"glTF"
    assert figure_glb(str(me)) == content
    told = json.loads(content[20 : 20 + int.from_bytes(content[12:16], "little")])
    bones = [told["nodes"][node]["name"] for node in told["skins"][0]["joints"]]
    assert tuple(bones) == joint_names()


def test_a_conversation_keeps_the_figure_too(me, tmp_path):
    said = ScriptedModel("scripted", [AIMessage("done", ())])
    config = EpisodeConfig.of("Say done.", figure=str(me), resolution=SMALL)
    with Session.begin(config, tmp_path / "talk", model=said, page=False) as session:
        session.say("Say done.")
    assert (tmp_path / "talk" / FIGURE).is_file()


def test_a_file_that_changes_under_an_engine_is_told(tmp_path):
    file = tmp_path / "me.glb"
    file.write_bytes(rig(SHORT))
    engine = create_engine("s1", str(file))
    try:
        file.write_bytes(rig(Rig("unity", garments=("shoes",), plain=True)))
        said = ScriptedModel("scripted", [AIMessage("done", ())])
        with pytest.raises(RecordError, match="not the figure any more"):
            run_episode(
                "Say done.", model=said, engine=engine, resolution=SMALL, out=tmp_path / "run"
            )
    finally:
        engine.close()


def test_a_study_looks_at_its_figures_before_it_starts(tmp_path):
    wrong = tmp_path / "x.glb"
    wrong.write_bytes(b"no figure")
    episodes = plan(Study(("T2",), axes={"figure": ("mara", str(wrong))}))
    with pytest.raises(FileError, match="no GLB"):
        check_parts(episodes)
