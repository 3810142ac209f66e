"""What is drawn on: a picture of colours and one of labels, with one depth."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from adamo_vh.errors import RenderingError
from adamo_vh.runtime import opengl as gl
from adamo_vh.runtime.opengl import call

COLOURS, LABELS = 0, 1
_PICTURES = (gl.COLOR_ATTACHMENT0 + COLOURS, gl.COLOR_ATTACHMENT0 + LABELS)


class Canvas:
    """Grows to the largest picture asked for. Lives in the graphics thread."""

    def __init__(self) -> None:
        """Make it, still without a size."""
        (self.frame,) = gl.made("Framebuffers")
        call("BindFramebuffer", "uu")(gl.FRAMEBUFFER, self.frame)
        self._buffers = gl.made("Renderbuffers", 3)
        self._room = self._size = (0, 0)
        self._pixels: dict[int, NDArray[np.uint8]] = {}

    def begin(self, width_px: int, height_px: int) -> None:
        """Start a picture, black and empty."""
        call("BindFramebuffer", "uu")(gl.FRAMEBUFFER, self.frame)
        if width_px > self._room[0] or height_px > self._room[1]:
            self._grow(max(width_px, self._room[0]), max(height_px, self._room[1]))
        if (width_px, height_px) != self._size:
            self._size = width_px, height_px
            shape = height_px, width_px, 4
            self._pixels = {which: np.empty(shape, np.uint8) for which in (COLOURS, LABELS)}
        self.draw_into(COLOURS, LABELS)
        call("Viewport", "iiii")(0, 0, width_px, height_px)
        call("Scissor", "iiii")(0, 0, width_px, height_px)
        call("Enable", "u")(gl.SCISSOR_TEST)
        call("ClearColor", "ffff")(0.0, 0.0, 0.0, 0.0)
        call("Clear", "u")(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT)
        call("Disable", "u")(gl.SCISSOR_TEST)

    def _grow(self, width_px: int, height_px: int) -> None:
        kinds = (gl.RGBA8, gl.RGBA8, gl.DEPTH_COMPONENT32F)
        places = (*_PICTURES, gl.DEPTH_ATTACHMENT)
        for buffer, kind, place in zip(self._buffers, kinds, places, strict=True):
            call("BindRenderbuffer", "uu")(gl.RENDERBUFFER, buffer)
            call("RenderbufferStorage", "uuii")(gl.RENDERBUFFER, kind, width_px, height_px)
            call("FramebufferRenderbuffer", "uuuu")(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer)
        self.draw_into(COLOURS, LABELS)
        if call("CheckFramebufferStatus", "u", "u")(gl.FRAMEBUFFER) != gl.FRAMEBUFFER_COMPLETE:
            raise RenderingError(
                f"OpenGL has no room for a picture of {width_px}x{height_px} pixels; "
                "ask for a smaller one."
            )
        self._room = width_px, height_px

    def draw_into(self, *which: int) -> None:
        """Draw into one of the pictures, or both."""
        targets = [place if i in which else gl.NONE for i, place in enumerate(_PICTURES)]
        call("DrawBuffers", "ip")(len(targets), np.array(targets, np.uint32))

    def read(self, which: int) -> NDArray[np.uint8]:
        """(H, W, 4) one of the pictures, bottom row first; the next `read` writes over it."""
        pixels = self._pixels[which]
        height_px, width_px = pixels.shape[:2]
        call("ReadBuffer", "u")(_PICTURES[which])
        place = (0, 0, width_px, height_px)
        call("ReadPixels", "iiiiuup")(*place, gl.RGBA, gl.UNSIGNED_BYTE, pixels)
        return pixels
