"""Give OpenGL a model's textures, each with its smaller copies for far away.

OpenGL on a processor makes those copies slowly: it would take most of the time to a first picture.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from adamo_vh.runtime import opengl as gl
from adamo_vh.runtime.opengl import call

if TYPE_CHECKING:
    import mujoco

_FORMATS = {1: (gl.RED, gl.R8), 3: (gl.RGB, gl.RGB8), 4: (gl.RGBA, gl.RGBA8)}


def _flat(model: mujoco.MjModel) -> NDArray[np.intp]:
    """Which textures are plain pictures."""
    import mujoco

    return np.flatnonzero(model.tex_type == mujoco.mjtTexture.mjTEXTURE_2D.value)


@contextmanager
def left_out(model: mujoco.MjModel) -> Iterator[None]:
    """Let MuJoCo upload a single pixel for each picture; `upload` gives the rest."""
    flat = _flat(model)
    kept = model.tex_width[flat], model.tex_height[flat]
    model.tex_width[flat], model.tex_height[flat] = 1, 1
    try:
        yield
    finally:
        model.tex_width[flat], model.tex_height[flat] = kept


def upload(model: mujoco.MjModel, context: mujoco.MjrContext) -> None:
    """Upload the pictures into the textures that MuJoCo has made for them."""
    call("PixelStorei", "ui")(gl.UNPACK_ALIGNMENT, 1)
    for texture in _flat(model).tolist():
        height, width = int(model.tex_height[texture]), int(model.tex_width[texture])
        channels, begin = int(model.tex_nchannel[texture]), int(model.tex_adr[texture])
        data = model.tex_data[begin : begin + height * width * channels]
        picture = np.ascontiguousarray(data, np.uint8).reshape(height, width, channels)
        call("BindTexture", "uu")(gl.TEXTURE_2D, int(context.texture[texture]))
        call("TexParameteri", "uui")(gl.TEXTURE_2D, gl.GENERATE_MIPMAP, 0)
        kind, stored = _FORMATS[channels]
        for level, smaller in enumerate(halved(picture)):
            size = level, stored, smaller.shape[1], smaller.shape[0], 0
            call("TexImage2D", "uiiiiiuup")(gl.TEXTURE_2D, *size, kind, gl.UNSIGNED_BYTE, smaller)


def halved(picture: NDArray[np.uint8]) -> Iterator[NDArray[np.uint8]]:
    """A picture, and copies of half, a quarter and so on of its size, down to one pixel."""
    import cv2

    yield picture
    height, width, channels = picture.shape
    while max(height, width) > 1:
        height, width = max(1, height // 2), max(1, width // 2)
        smaller = cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA)
        picture = np.asarray(smaller, np.uint8).reshape(height, width, channels)
        yield picture
