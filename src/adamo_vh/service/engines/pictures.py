"""Pictures on the wire: colours, ids of objects, and layers that are painted from boxes."""

from __future__ import annotations

import io
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.errors import EngineError
from adamo_vh.observation import NOTHING
from adamo_vh.service.engines.messages import NO_OBJECT, ColourCode, IdsCode, SeenBox

_Ids = NDArray[np.int16]
_WHITE = 0x7FFF
"""No object in "rgb555"."""
_MODES = {"png": ("PNG", ("RGB", "RGBA")), "jpeg": ("JPEG", ("RGB",))}


def read_colour(data: bytes, code: ColourCode, width_px: int, height_px: int) -> NDArray[np.uint8]:
    """(H, W, 3) colours.

    Raises:
        EngineError: The bytes are no such picture.
    """
    if code == "rgb8":
        return _raw(data, np.dtype(np.uint8), (height_px, width_px, 3)).astype(np.uint8)
    kind, modes = _MODES[code]
    picture = _opened(data, kind, modes, (width_px, height_px))
    return np.ascontiguousarray(np.asarray(picture.convert("RGB"), np.uint8))


def read_ids(data: bytes, code: IdsCode, width_px: int, height_px: int) -> _Ids:
    """(H, W) ids, `NOTHING` where no object is.

    Raises:
        EngineError: The bytes are no such picture, or a pixel holds what is no id.
    """
    if code == "rgb555":
        picture = _opened(data, "PNG", ("RGB", "RGBA"), (width_px, height_px))
        red, green, blue = np.moveaxis(np.asarray(picture.convert("RGB")), -1, 0) >> 3
        values = red.astype(np.uint16) << 10 | green.astype(np.uint16) << 5 | blue
        values[values == _WHITE] = NO_OBJECT
    elif code == "png16":
        picture = _opened(data, "PNG", ("I;16", "I;16B", "I", "L"), (width_px, height_px))
        values = np.asarray(picture).astype(np.uint16)
    else:
        values = _raw(data, np.dtype("<u2"), (height_px, width_px)).astype(np.uint16)
    ids: _Ids = values.view(np.int16)  # The number for no object is `NOTHING` then.
    if (beyond := ids < NOTHING).any():
        raise EngineError(f"a pixel holds {int(values[beyond][0])}, which is no id.")
    return ids


def ids_in(layers: Iterable[_Ids]) -> set[int]:
    """Every id that a pixel of any layer shows."""
    present = np.zeros(1 << 16, np.bool_)
    for layer in layers:
        present[layer.view(np.uint16)] = True
    present[NO_OBJECT] = False
    return set(np.flatnonzero(present).tolist())


def _raw(data: bytes, kind: np.dtype[Any], shape: tuple[int, ...]) -> NDArray[Any]:
    wanted = int(np.prod(shape)) * kind.itemsize
    if len(data) != wanted:
        raise EngineError(f"a picture has {len(data)} bytes, and {shape} needs {wanted}.")
    return np.frombuffer(data, kind).reshape(shape)


def _opened(data: bytes, kind: str, modes: tuple[str, ...], size: tuple[int, int]) -> Any:
    from PIL import Image

    try:
        picture = Image.open(io.BytesIO(data), formats=(kind,))
        # Before its pixels are unpacked: few bytes can make a picture that fills the memory.
        if picture.size != size:
            raise EngineError(f"a picture is {picture.size}, and {size} was asked for.")
        picture.load()
    except EngineError:
        raise
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise EngineError(f"a picture is no {kind}: {error}.") from None
    if picture.mode not in modes:
        raise EngineError(f"a picture is of kind {picture.mode}, and {modes[0]} is agreed.")
    return picture


def painted(seen: Iterable[SeenBox], width_px: int, height_px: int) -> tuple[_Ids, ...]:
    """Layers of ids that show each box of pixels tight, and with the number that was told.

    Which pixels of its box an object has is not known, so they are made up: the corners, and then
    from the middle. Boxes that overlap go into layers of their own, so that none covers another.

    Raises:
        EngineError: A box is missing or not in the picture, or cannot have so many pixels.
    """
    layers: list[_Ids] = [np.full((height_px, width_px), NOTHING, np.int16)]
    for item in seen:
        if item.box_px is None or item.pixels is None:
            raise EngineError(f"object {item.id} has no box_px and pixels, and no ids are sent.")
        left, top, right, bottom = item.box_px
        if not (0 <= left < right <= width_px and 0 <= top < bottom <= height_px):
            raise EngineError(f"the box {item.box_px} of object {item.id} is not in the picture.")
        area = (right - left) * (bottom - top)
        fewest = 1 if area == 1 else 2
        if not fewest <= item.pixels <= area:
            raise EngineError(
                f"object {item.id} cannot have {item.pixels} pixels in a box of {area}."
            )
        window = (slice(top, bottom), slice(left, right))
        layer = next((kept for kept in layers if (kept[window] == NOTHING).all()), None)
        if layer is None:
            layer = np.full((height_px, width_px), NOTHING, np.int16)
            layers.append(layer)
        layer[window][_chosen(bottom - top, right - left, item.pixels)] = item.id
    return tuple(layers)


def _chosen(rows: int, columns: int, count: int) -> NDArray[np.bool_]:
    """(rows, columns) which pixels of a box are painted: two corners, then from its middle."""
    row, column = np.mgrid[:rows, :columns]
    away = np.maximum(
        np.abs(row - (rows - 1) / 2) / rows, np.abs(column - (columns - 1) / 2) / columns
    )
    away[0, 0] = away[-1, -1] = -1.0
    order = np.argsort(away, axis=None, kind="stable")[:count]
    chosen = np.zeros(rows * columns, np.bool_)
    chosen[order] = True
    return chosen.reshape(rows, columns)


def raw_ids(layer: _Ids) -> bytes:
    """A layer of ids as "int16": `NOTHING` is 65535 there."""
    return layer.astype("<i2").tobytes()
