"""Render every asset alone on a neutral tabletop, to look at: one PNG each and a contact sheet.

python benchmarks/closeups.py --out closeups            # all
python benchmarks/closeups.py --out closeups key tape   # some
"""

from __future__ import annotations

import argparse
import math
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from adamo_vh.runtime.assets import catalog
from adamo_vh.runtime.assets.asset import Asset
from adamo_vh.runtime.assets.mujoco_parts import add_asset

if TYPE_CHECKING:
    import mujoco
    from numpy.typing import NDArray

WIDTH, HEIGHT = 640, 480
ELEVATION_DEG = 35.0
AZIMUTH_DEG = 65.0
"""Viewing direction: from the front, a little from the left."""
FIELD_OF_VIEW_DEG = 30.0
FILL = 1.05
"""Size of the asset's bounding sphere against the frame's height; assets do not fill theirs."""
COLUMNS = 5


def main(arguments: Sequence[str] | None = None) -> None:
    """Parse the command line, render, save."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("names", nargs="*", help="assets; all of the catalog when none is named")
    parser.add_argument("--all", action="store_true", help="the whole catalog")
    parser.add_argument("--out", type=Path, required=True, help="folder for the pictures")
    parser.add_argument("--azimuth", type=float, default=AZIMUTH_DEG, help="degrees")
    options = parser.parse_args(arguments)
    # Read when MuJoCo is imported, which happens below.
    os.environ.setdefault("MUJOCO_GL", "egl")
    everything = [*catalog.OBJECTS, *catalog.FURNITURE]
    names = everything if options.all or not options.names else options.names
    options.out.mkdir(parents=True, exist_ok=True)
    pictures = {}
    for name in names:
        pictures[name] = render(catalog.build(name), options.azimuth)
        save(pictures[name], options.out / f"{name}.png")
    save(contact_sheet(pictures), options.out / "contact_sheet.png")
    print(f"{len(pictures)} close-ups in {options.out}")


def stage(asset: Asset) -> mujoco.MjSpec:
    """Put the asset on a neutral tabletop under a key light with a shadow and a fill light."""
    import mujoco

    reach = math.dist(asset.size, (0, 0, 0))
    spec = mujoco.MjSpec()
    spec.visual.global_.offwidth, spec.visual.global_.offheight = WIDTH, HEIGHT
    spec.visual.global_.fovy = FIELD_OF_VIEW_DEG
    spec.visual.quality.shadowsize = 2048
    spec.visual.quality.offsamples = 4
    spec.visual.map.znear, spec.visual.map.zfar = 0.01, 50.0
    spec.visual.headlight.ambient = (0.36, 0.36, 0.36)
    spec.visual.headlight.diffuse = (0.25, 0.25, 0.25)
    spec.visual.headlight.specular = (0.0, 0.0, 0.0)
    # MuJoCo scales near and far by this extent.
    spec.stat.extent, spec.stat.center = 1.0, (0.0, 0.0, 0.0)
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE, size=(20, 20, 0.1), rgba=(0.62, 0.58, 0.54, 1)
    )
    key = spec.worldbody.add_light(
        pos=(-2.0 * reach, -1.6 * reach, 4.0 * reach),
        dir=(2.0, 1.6, -4.0),
        diffuse=(0.68, 0.66, 0.62),
        specular=(0.5, 0.5, 0.5),
        castshadow=True,
    )
    key.type = mujoco.mjtLightType.mjLIGHT_SPOT
    key.cutoff = 40.0
    key.exponent = 2.0
    is_furniture = bool(asset.surfaces)
    lift = 0.0 if is_furniture else asset.size[2] / 2
    body = spec.worldbody.add_body(name="asset", pos=(0.0, 0.0, lift))
    add_asset(spec, body, asset, "asset")
    return spec


def render(asset: Asset, azimuth_deg: float = AZIMUTH_DEG) -> NDArray[np.uint8]:
    """(H, W, 3) picture of the asset, sized to the frame."""
    import mujoco

    model = stage(asset).compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    camera = mujoco.MjvCamera()
    camera.lookat[:] = (0.0, 0.0, asset.size[2] / 2)
    camera.azimuth, camera.elevation = azimuth_deg, -ELEVATION_DEG
    sphere_m = math.dist(asset.size, (0, 0, 0)) / 2
    camera.distance = sphere_m / FILL / math.tan(math.radians(FIELD_OF_VIEW_DEG / 2))
    with mujoco.Renderer(model, HEIGHT, WIDTH) as renderer:
        renderer.update_scene(data, camera)
        return np.asarray(renderer.render(), dtype=np.uint8).copy()


def contact_sheet(pictures: dict[str, NDArray[np.uint8]]) -> NDArray[np.uint8]:
    """All pictures at half size in a grid, with their names."""
    from PIL import Image, ImageDraw

    rows = math.ceil(len(pictures) / COLUMNS)
    tile = (WIDTH // 2, HEIGHT // 2)
    sheet = Image.new("RGB", (COLUMNS * tile[0], rows * tile[1]))
    draw = ImageDraw.Draw(sheet)
    for i, (name, picture) in enumerate(pictures.items()):
        corner = (i % COLUMNS * tile[0], i // COLUMNS * tile[1])
        sheet.paste(Image.fromarray(picture).resize(tile, Image.Resampling.LANCZOS), corner)
        draw.text((corner[0] + 6, corner[1] + 4), name, fill=(20, 20, 20), font_size=14)
    return np.asarray(sheet)


def save(picture: NDArray[np.uint8], path: Path) -> None:
    """Write a PNG."""
    from PIL import Image

    Image.fromarray(picture).save(path)


if __name__ == "__main__":
    main()
