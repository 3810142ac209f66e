"""Variations that may be scored: proven, known or found, played, kept and gone on with."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

import adamo_vh
from adamo_vh.benchmark.checkers import score
from adamo_vh.benchmark.tasks import TASKS
from adamo_vh.episode.result import read_manifest
from adamo_vh.errors import ConfigError, EngineError, SceneError
from adamo_vh.files import read_json
from adamo_vh.record.run_folder import EVENTS, SCENE
from adamo_vh.runtime.scenes import Scene, load_scene, scene_names
from adamo_vh.runtime.scenes.variation import DISTRACTORS, varied
from adamo_vh.session import variations
from adamo_vh.session.variations import (
    FIRST,
    accepted,
    first_fair_attempt,
    unfair,
    variation_of,
)

SMALL = (160, 90)


@pytest.fixture(scope="module")
def seventh() -> Iterator[adamo_vh.World]:
    made = adamo_vh.create_engine("s1", variation=7)
    yield made
    made.close()


# --- proven ---------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize(("scene", "number"), [("s1", 1002), ("s2", 2)])
def test_what_comes_with_the_package_is_proven(scene: str, number: int) -> None:
    """A sample; `python tools/variations.py --again` proves all of it."""
    split = "test" if number >= FIRST["test"] else "dev"
    attempt = accepted()[scene][split][number - FIRST[split]]
    assert first_fair_attempt(load_scene(scene), number) == attempt


def test_enough_of_both_splits_comes_with_the_package() -> None:
    for scene in scene_names():
        for split in FIRST:
            attempts = accepted()[scene][split]
            assert len(attempts) >= 60
            assert set(attempts) <= set(range(variations.MOST_ATTEMPTS))


@pytest.mark.parametrize("scene", scene_names())
def test_no_task_is_satisfied_where_a_known_variation_puts_things(scene: str) -> None:
    engine = adamo_vh.create_engine(scene, variation=1010)
    try:
        start = engine.state()
    finally:
        engine.close()
    assert {task.id: score(start, start, task).completion for task in TASKS} == {
        task.id: 0.0 for task in TASKS
    }
    smallest = min(start.objects, key=lambda item: item.box.volume_m3)
    assert smallest.id == 34


def near_already() -> Scene:
    scene = varied(load_scene("s1"), 7)
    plant = next(item for item in scene.objects if item.id == 50)
    x, y = plant.position
    moved = tuple(
        replace(item, on=plant.on, position=(x, y + 0.2)) if item.id == 4 else item
        for item in scene.objects
    )
    return replace(scene, objects=moved)


def on_the_floor() -> Scene:
    scene = load_scene("s1")
    moved = tuple(
        replace(item, on="floor", position=(1.5, 1.5)) if item.id == 57 else item
        for item in scene.objects
    )
    return replace(scene, objects=moved)


@pytest.mark.parametrize(
    ("scene", "why"),
    [(near_already(), "near each other"), (on_the_floor(), "idle")],
    ids=["T5", "T4"],
)
def test_what_is_not_fair_is_told(scene: Scene, why: str) -> None:
    assert why in unfair(scene)


# --- known or found -------------------------------------------------------------------------


def test_what_is_known_is_there_at_once() -> None:
    variation_of("s2", 3)
    started = time.process_time()
    variation_of("s2", 4)
    assert time.process_time() - started < 1.0


def test_what_is_found_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ADAMO_VH_CACHE_DIR", str(tmp_path))
    asked: list[int] = []

    def find(scene: Scene, number: int) -> int:
        asked.append(number)
        return 2

    monkeypatch.setattr(variations, "first_fair_attempt", find)
    found = variation_of("s1", 998_001)
    assert found == varied(load_scene("s1"), 998_001, 2)
    (kept,) = (tmp_path / "variations").iterdir()
    assert read_json(kept) == {"scene": "s1", "number": 998_001, "attempt": 2}
    variations._proven.cache_clear()
    assert variation_of("s1", 998_001) == found
    assert asked == [998_001]
    kept.write_text("[half")
    variations._proven.cache_clear()
    assert variation_of("s1", 998_001) == found
    assert asked == [998_001, 998_001]


def test_a_scene_that_no_drawing_suits_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(variations, "MOST_ATTEMPTS", 2)
    monkeypatch.setattr(variations, "unfair", lambda scene: "T2 sem: oracle 0.50")
    with pytest.raises(SceneError, match=r"none of 2 attempts .*T2 sem.*Use another number"):
        first_fair_attempt(load_scene("s1"), 12)


# --- played ---------------------------------------------------------------------------------


def test_an_engine_says_which_variation_it_is(seventh: adamo_vh.World) -> None:
    plain = adamo_vh.create_engine("s1")
    try:
        assert (plain.scene.variation, plain.scene.full_name) == (0, "s1")
        assert plain.scene.digest != seventh.scene.digest
        with pytest.raises(EngineError, match="'s1'"):
            seventh.restore(plain.snapshot())
    finally:
        plain.close()
    assert (seventh.scene.source, seventh.scene.name) == ("built-in", "s1")
    assert seventh.scene.full_name == "s1 variation 7"
    assert set(seventh.object_names) - {i.id for i in load_scene("s1").objects} <= set(DISTRACTORS)


def test_a_variation_is_played_recorded_and_replayed(tmp_path: Path) -> None:
    result = adamo_vh.run_episode(task="T2", variation=7, resolution=SMALL, out=tmp_path / "run")
    manifest = read_manifest(tmp_path / "run")
    assert result.variation == manifest.config.variation == manifest.initial.scene.variation == 7
    assert "variation 7" in (tmp_path / "run" / "episode.html").read_text("utf-8")
    kept = load_scene(str(tmp_path / "run" / SCENE))
    assert kept == variation_of("s1", 7)
    assert adamo_vh.replay_episode(tmp_path / "run").mismatches == ()


def test_a_run_keeps_its_own_scene_whatever_is_drawn_today(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    script = [{"tool": "Look", "args": {"x": 0, "y": 0, "z": 0}}]
    (tmp_path / "look.json").write_text(json.dumps(script))
    adamo_vh.run_episode(
        "Look",
        model=f"scripted:{tmp_path / 'look.json'}",
        variation=7,
        resolution=SMALL,
        out=tmp_path / "run",
    )

    def gone(scene: str, number: int) -> Scene:
        raise AssertionError("drawn again")

    monkeypatch.setattr(variations, "variation_of", gone)
    assert adamo_vh.replay_episode(tmp_path / "run").mismatches == ()
    events = (tmp_path / "run" / EVENTS).read_bytes().splitlines(keepends=True)
    (tmp_path / "run" / EVENTS).write_bytes(b"".join(events[:2]))
    (tmp_path / "run" / "result.json").unlink()
    assert adamo_vh.resume_episode(tmp_path / "run").variation == 7


def test_an_engine_that_is_handed_in_brings_its_variation(
    tmp_path: Path, seventh: adamo_vh.World
) -> None:
    result = adamo_vh.run_episode(
        "Pick the plate", engine=seventh, resolution=SMALL, out=tmp_path / "run"
    )
    assert result.variation == read_manifest(tmp_path / "run").config.variation == 7
    assert read_manifest(tmp_path / "run").engine == ""
    assert adamo_vh.replay_episode(tmp_path / "run").mismatches == ()
    with pytest.raises(ConfigError, match="The engine is of s1 variation 7"):
        adamo_vh.run_episode("Look", engine=seventh, variation=8, resolution=SMALL)


def test_engines_of_other_packages_have_none(monkeypatch: pytest.MonkeyPatch) -> None:
    from adamo_vh.session import bodies

    monkeypatch.setattr(bodies, "offered_by_others", lambda group: {"yard": object()})
    with pytest.raises(ConfigError, match="the scenes of 'yard' have none; use 0"):
        adamo_vh.create_engine("yard:big", variation=1)


# --- own scenes -----------------------------------------------------------------------------


def test_a_written_variation_is_a_scene_of_its_own(tmp_path: Path) -> None:
    from adamo_vh.session.builtin import inspect_scene_file, write_scene

    file = write_scene(variation_of("s2", 7), tmp_path / "seven.toml")
    assert inspect_scene_file(str(file)).findings == ()
    result = adamo_vh.run_episode("Look", scene=str(file), resolution=SMALL, out=tmp_path / "run")
    assert result.variation == 7
    assert read_manifest(tmp_path / "run").config.variation == 0
    assert adamo_vh.replay_episode(tmp_path / "run").mismatches == ()
    with pytest.raises(SceneError, match="this is variation 7 already"):
        adamo_vh.create_engine(str(file), variation=8)


def test_an_own_scene_has_variations_too(tmp_path: Path) -> None:
    from adamo_vh.session.builtin import write_scene

    own = replace(load_scene("s1"), name="mine", objects=load_scene("s1").objects[:4])
    file = write_scene(own, tmp_path / "mine.toml")
    result = adamo_vh.run_episode(
        "Look", scene=str(file), variation=3, resolution=SMALL, out=tmp_path / "run"
    )
    file.unlink()
    assert result.variation == 3
    assert adamo_vh.replay_episode(tmp_path / "run").mismatches == ()
