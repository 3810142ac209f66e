"""The cache of baked assets: old sets go, but never from under a running process."""

from __future__ import annotations

import fcntl
from pathlib import Path

import pytest

from adamo_vh.files import CACHE_DIR
from adamo_vh.runtime.assets import bake, catalog

OLD, USED, OTHER = "0" * 16, "1" * 16, "not-ours"


@pytest.fixture
def sets(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setenv(CACHE_DIR, str(tmp_path))
    assets = tmp_path / "assets"
    for name in (OLD, USED, OTHER):
        (assets / name).mkdir(parents=True)
        (assets / name / "Plate.npz").write_bytes(b"old")
    bake._remove_old_sets.cache_clear()
    return assets


def test_a_new_set_removes_the_old_ones_that_nobody_uses(sets: Path) -> None:
    with (sets / USED / "in-use.lock").open("ab") as held:
        fcntl.flock(held, fcntl.LOCK_SH)
        asset = bake.load_asset("plate")
    assert asset.class_name == catalog.build("plate").class_name
    now = bake.cache_file("plate").parent.name
    assert sorted(path.name for path in sets.iterdir()) == sorted([now, USED, OTHER])


def test_reading_what_is_baked_removes_nothing(sets: Path) -> None:
    bake.load_asset("plate")
    (sets / OLD).mkdir()
    bake._remove_old_sets.cache_clear()
    bake.load_asset("plate")
    assert (sets / OLD).exists()


def test_a_file_made_of_the_assets_is_made_once(tmp_path, monkeypatch):
    monkeypatch.setenv("ADAMO_VH_CACHE_DIR", str(tmp_path))
    made = []

    def make():
        made.append(1)
        return b"content"

    assert bake.cached("scene_1.glb", make) == bake.cached("scene_1.glb", make) == b"content"
    assert made == [1]
    bake.cache_file("").with_name("scene_1.glb").unlink()
    assert bake.cached("scene_1.glb", make) == b"content" and made == [1, 1]
