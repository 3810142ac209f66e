"""A scene as files that any other engine can load: a GLB for each asset, and one JSON."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from pathlib import Path
from typing import Any

from adamo_vh.engine import BodyInfo, WorldState
from adamo_vh.files import make_folder, write_whole
from adamo_vh.runtime.assets.glb_writing import asset_glb
from adamo_vh.runtime.embodiment import MAX_PITCH_RAD
from adamo_vh.runtime.scenes.scene import Scene
from adamo_vh.runtime.world import (
    furniture_solids,
    furniture_surfaces,
    light_colour,
    load_room,
    scene_assets,
)

FORMAT = 1
ROOM = "room_shell"
"""Name of the mesh of floor, walls and ceiling."""


def export_scene(scene: Scene, state: WorldState, body: BodyInfo, folder: Path) -> list[Path]:
    """Write a scene with its meshes.

    Args:
        scene: What is where.
        state: The world at its start, after everything has come to rest.
        body: The body that is to live in it.
        folder: Where to; is made.

    Returns:
        What was written, the JSON first.
    """
    make_folder(folder)
    assets = scene_assets(scene)
    meshes = {**assets, ROOM: load_room(scene)}
    written = [
        write_whole(folder / f"{name}.glb", asset_glb(asset, name))
        for name, asset in sorted(meshes.items())
    ]
    text = json.dumps(_described(scene, state, body), indent=1)
    return [write_whole(folder / "scene.json", text.encode()), *written]


def _described(scene: Scene, state: WorldState, body: BodyInfo) -> dict[str, Any]:
    assets = scene_assets(scene)
    asset_of = {item.id: item.asset for item in scene.objects}
    outlines = {outline.name: outline for outline in state.furniture}
    furniture = [
        {
            **asdict(outlines[piece.name]),
            "mesh": f"{piece.asset}.glb",
            "position": [*piece.position, 0.0],
            "yaw_rad": math.radians(piece.yaw_deg),
            "surfaces": [asdict(s) for s in furniture_surfaces(piece, assets[piece.asset])],
            "solids": [asdict(s) for s in furniture_solids(piece, assets[piece.asset])],
        }
        for piece in scene.furniture
    ]
    objects = [{**asdict(item), "mesh": f"{asset_of[item.id]}.glb"} for item in state.objects]
    lights = [{**asdict(light), "colour": light_colour(light.diffuse)} for light in scene.lights]
    return {
        "format": FORMAT,
        "frame": "right-handed, z up, metres; the meshes have y up as glTF has it",
        "scene": {**asdict(state.scene), "source": "", "title": scene.title},
        "mesh": f"{ROOM}.glb",
        "ambient": scene.ambient,
        "lights": lights,
        "body": {**asdict(body), "max_pitch_rad": MAX_PITCH_RAD},
        "start": asdict(state.body),
        "furniture": furniture,
        "objects": objects,
    }
