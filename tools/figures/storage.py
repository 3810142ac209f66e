"""Write a figure in the compact form that `looks.load_figure` reads."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from adamo_vh.runtime.human.looks import Figure

GRID_PER_M = 16000
"""Steps of the stored places in a metre: 16 bits reach 2 m at 0.06 mm."""


def save_figure(figure: Figure, path: Path) -> None:
    """Write a compressed file; the same figure gives the same bytes."""
    arrays: dict[str, Any] = {}
    facts = []
    for i, garment in enumerate(figure.garments):
        arrays[f"vertices{i}"] = np.round(garment.vertices * GRID_PER_M).astype(np.int16)
        arrays[f"normals{i}"] = np.round(garment.normals * 127).astype(np.int8)
        arrays[f"uvs{i}"] = np.round(garment.uvs * 65535).astype(np.uint16)
        arrays[f"faces{i}"] = garment.faces.astype(np.uint16)
        arrays[f"bone_ids{i}"] = garment.bone_ids
        arrays[f"weights{i}"] = np.round(garment.weights * 255).astype(np.uint8)
        arrays[f"texture{i}"] = np.frombuffer(_png(garment.material.texture), np.uint8)
        facts.append(
            {
                "name": garment.name,
                "specular": garment.material.specular,
                "shininess": garment.material.shininess,
                "grid_per_m": GRID_PER_M,
            }
        )
    arrays["facts"] = np.array(json.dumps({"garments": facts}))
    path.parent.mkdir(parents=True, exist_ok=True)
    # `np.savez_compressed` stamps the time of day; a fixed date keeps the bytes the same.
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, array in arrays.items():
            content = io.BytesIO()
            np.lib.format.write_array(content, np.asarray(array), allow_pickle=False)
            entry = zipfile.ZipInfo(f"{name}.npy", (1980, 1, 1, 0, 0, 0))
            archive.writestr(entry, content.getvalue(), zipfile.ZIP_DEFLATED, 9)


def _png(picture: Any) -> bytes:
    from PIL import Image

    content = io.BytesIO()
    Image.fromarray(picture).save(content, "PNG", optimize=True)
    return content.getvalue()
