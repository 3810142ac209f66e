"""The few calls and numbers of OpenGL that drawing needs, without the wrapper's cost.

PyOpenGL's `OpenGL.GL` takes half a second to import and ten times as long for each call, and a
picture takes a thousand calls.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from adamo_vh.errors import RenderingError

DEPTH_BUFFER_BIT, COLOR_BUFFER_BIT = 0x100, 0x4000
TRIANGLES = 0x0004
GEQUAL = 0x0206
SRC_ALPHA, ONE_MINUS_SRC_ALPHA = 0x0302, 0x0303
NONE, FRONT, COLOR_ATTACHMENT0, DEPTH_ATTACHMENT = 0, 0x0404, 0x8CE0, 0x8D00
CCW = 0x0901
CULL_FACE, DEPTH_TEST, BLEND = 0x0B44, 0x0B71, 0x0BE2
LIGHTING, FOG, ALPHA_TEST = 0x0B50, 0x0B60, 0x0BC0
SCISSOR_TEST, STENCIL_TEST, MULTISAMPLE = 0x0C11, 0x0B90, 0x809D
POLYGON_OFFSET_FILL = 0x8037
TEXTURE_2D, TEXTURE0, TEXTURE1 = 0x0DE1, 0x84C0, 0x84C1
AMBIENT, DIFFUSE, SPECULAR, POSITION, SPOT_DIRECTION = 0x1200, 0x1201, 0x1202, 0x1203, 0x1204
SPOT_EXPONENT, SPOT_CUTOFF = 0x1205, 0x1206
EMISSION, SHININESS, LIGHT0 = 0x1600, 0x1601, 0x4000
COMPILE = 0x1300
UNSIGNED_BYTE, UNSIGNED_INT, FLOAT = 0x1401, 0x1405, 0x1406
MODELVIEW, PROJECTION = 0x1700, 0x1701
RED, R8, RGB, RGB8 = 0x1903, 0x8229, 0x1907, 0x8051
UNPACK_ALIGNMENT, GENERATE_MIPMAP = 0x0CF5, 0x8191
DEPTH_COMPONENT, RGBA, RGBA8, DEPTH_COMPONENT32F = 0x1902, 0x1908, 0x8058, 0x8CAC
NEAREST, LINEAR = 0x2600, 0x2601
TEXTURE_MAG_FILTER, TEXTURE_MIN_FILTER = 0x2800, 0x2801
TEXTURE_WRAP_S, TEXTURE_WRAP_T, CLAMP_TO_EDGE = 0x2802, 0x2803, 0x812F
TEXTURE_COMPARE_MODE, TEXTURE_COMPARE_FUNC, COMPARE_R_TO_TEXTURE = 0x884C, 0x884D, 0x884E
VERTEX_ARRAY, NORMAL_ARRAY, TEXTURE_COORD_ARRAY = 0x8074, 0x8075, 0x8078
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, STREAM_DRAW = 0x8892, 0x8893, 0x88E0
FRAGMENT_SHADER, VERTEX_SHADER = 0x8B30, 0x8B31
COMPILE_STATUS, LINK_STATUS = 0x8B81, 0x8B82
FRAMEBUFFER, RENDERBUFFER, FRAMEBUFFER_COMPLETE = 0x8D40, 0x8D41, 0x8CD5
LOWER_LEFT, ZERO_TO_ONE = 0x8CA1, 0x935F


class _Memory(ctypes.c_void_p):
    """What a call takes as an address: an array of numpy, something of ctypes, or None.

    It is held until the call returns. Numbers are refused: the address of an array does not keep
    the array, and while the call runs, other threads do, too, and may be given its memory.
    """

    @classmethod
    def from_param(cls, value: Any) -> Any:
        if isinstance(value, int):
            raise TypeError("OpenGL takes what lies at an address, not the address.")
        if isinstance(value, np.ndarray):
            assert value.flags.c_contiguous
            return ctypes.c_void_p(value.ctypes.data)
        return ctypes.c_void_p.from_param(value)


_KINDS = {
    "b": ctypes.c_ubyte,
    "i": ctypes.c_int,
    "u": ctypes.c_uint,
    "f": ctypes.c_float,
    "d": ctypes.c_double,
    "z": ctypes.c_ssize_t,
    "p": _Memory,
}


@cache
def call(name: str, takes: str = "", gives: str = "") -> Callable[..., Any]:
    """A function of OpenGL.

    Args:
        name: Without the prefix gl.
        takes: Its arguments: b, i, u, f, d as in OpenGL's own names, z a size, p memory:
            a contiguous array of numpy, something of ctypes, or None.
        gives: What it returns, empty for nothing.

    Raises:
        RenderingError: This OpenGL is too old to have it.
    """
    from OpenGL.platform import PLATFORM

    try:
        found = getattr(PLATFORM.GL, f"gl{name}")
    except AttributeError as error:
        raise RenderingError(
            f"This OpenGL has no gl{name}: ADAMO draws with OpenGL 4.5 or newer. Update the "
            "graphics driver, or use Mesa's ('apt-get install libgl1-mesa-dri')."
        ) from error
    found.restype = _KINDS[gives] if gives else None
    found.argtypes = [_KINDS[kind] for kind in takes]
    return found  # type: ignore[no-any-return]


def floats(*values: float) -> Any:
    """Numbers for a call that takes an address."""
    return (ctypes.c_float * len(values))(*values)


def made(kind: str, count: int = 1) -> tuple[int, ...]:
    """New objects of a kind: Textures, Framebuffers, Renderbuffers."""
    names = np.zeros(count, np.uint32)
    call(f"Gen{kind}", "ip")(count, names)
    return tuple(int(name) for name in names)


def program(vertex: str, fragment: str) -> int:
    """Compile and link two shaders.

    Raises:
        RenderingError: The driver refuses them.
    """
    linked: int = call("CreateProgram", "", "u")()
    for kind, source in ((VERTEX_SHADER, vertex), (FRAGMENT_SHADER, fragment)):
        shader = call("CreateShader", "u", "u")(kind)
        text = ctypes.c_char_p(source.encode())
        call("ShaderSource", "uipp")(shader, 1, ctypes.byref(text), None)
        call("CompileShader", "u")(shader)
        _check(shader, "Shader", COMPILE_STATUS)
        call("AttachShader", "uu")(linked, shader)
        call("DeleteShader", "u")(shader)
    call("LinkProgram", "u")(linked)
    _check(linked, "Program", LINK_STATUS)
    return linked


def _check(name: int, kind: str, status: int) -> None:
    good = ctypes.c_int()
    call(f"Get{kind}iv", "uup")(name, status, ctypes.byref(good))
    if not good.value:
        log = ctypes.create_string_buffer(2000)
        call(f"Get{kind}InfoLog", "uipp")(name, len(log), None, log)
        raise RenderingError(f"OpenGL refuses what ADAMO draws with: {log.value.decode()!r}.")


def uniform(linked: int, name: str) -> int:
    """Where a program keeps one of its settings."""
    text = ctypes.c_char_p(name.encode())
    where: int = call("GetUniformLocation", "up", "i")(linked, text)
    return where
