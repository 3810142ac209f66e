"""Scenes as data: TOML files and their loader."""

from adamo_vh.runtime.scenes.scene import Scene, load_scene, parse_scene, scene_names

__all__ = ["Scene", "load_scene", "parse_scene", "scene_names"]
