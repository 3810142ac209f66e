"""Read the arrays of a file, each within its bytes, all together within a bound."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.own.container import Container
from adamo_vh.runtime.human.own.faults import AGAIN, Broken

MOST_VALUES = 60_000_000
"""Numbers that are read of one file: a quarter of a gigabyte."""
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_TYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_FULL = {5120: 127.0, 5121: 255.0, 5122: 32767.0, 5123: 65535.0}


class Numbers:
    """The arrays of one file."""

    def __init__(self, container: Container) -> None:
        """Read none yet."""
        self._document, self._content = container.document, container.content
        self._left = MOST_VALUES

    def floats(self, number: int, width: int) -> Array:
        """An array of finite numbers.

        Args:
            number: Which.
            width: Numbers of one entry.

        Raises:
            Broken: It is not there, has another shape, or holds what is no number.
        """
        values, full = self._values(number, width)
        found = values.astype(np.float64)
        if full is not None:
            found = np.maximum(found / full, -1.0)
        if not np.isfinite(found).all():
            raise Broken(f"array {number} holds values that are no numbers (NaN). {AGAIN}")
        return found

    def wholes(self, number: int, width: int) -> NDArray[np.int64]:
        """An array of whole numbers from 0, as indices are.

        Raises:
            Broken: It is not there, has another shape, or holds what can be no index.
        """
        values, _ = self._values(number, width)
        if values.dtype.kind == "f":
            raise Broken(f"array {number} holds fractions where indices belong. {AGAIN}")
        if values.dtype.kind == "i" and values.min(initial=0) < 0:
            raise Broken(f"array {number} holds negative numbers where indices belong. {AGAIN}")
        return values.astype(np.int64)

    def width(self, number: int) -> int:
        """How many numbers an entry of an array has; 0 if it is none that we know.

        Raises:
            Broken: It is not there.
        """
        self.count(number)
        return _WIDTHS.get(self._document.accessors[number].type, 0)

    def raw(self, number: int) -> bytes:
        """The bytes of a part of the buffer.

        Raises:
            Broken: It is not there.
        """
        begin, length, _ = self._place(number)
        return self._content[begin : begin + length]

    def count(self, number: int) -> int:
        """How many entries an array has.

        Raises:
            Broken: It is not there.
        """
        if number >= len(self._document.accessors):
            raise Broken(f"array {number} is missing. {AGAIN}")
        return self._document.accessors[number].count

    def _values(self, number: int, width: int) -> tuple[NDArray[np.generic], float | None]:
        count = self.count(number)
        told = self._document.accessors[number]
        if _WIDTHS.get(told.type) != width or told.component not in _TYPES:
            raise Broken(f"array {number} has another type than belongs there. {AGAIN}")
        self._left -= count * width
        if self._left < 0:
            raise Broken("it holds too much data. Reduce its triangles or its morph targets.")
        kind = np.dtype(_TYPES[told.component])
        if told.view is None:
            values = np.zeros((count, width), kind)
        else:
            values = self._strided(told.view, told.offset, (count, width), kind)
        if told.sparse is not None:
            values = values.copy()
            sparse = told.sparse
            if sparse.indices.component not in _TYPES or sparse.count > count:
                raise Broken(f"array {number} is sparse in a wrong way. {AGAIN}")
            places = np.dtype(_TYPES[sparse.indices.component])
            shape = (sparse.count, 1)
            at = self._strided(sparse.indices.view, sparse.indices.offset, shape, places)[:, 0]
            rows = (sparse.count, width)
            new = self._strided(sparse.values.view, sparse.values.offset, rows, kind)
            if len(at) and (at.dtype.kind == "f" or int(at.max()) >= count or int(at.min()) < 0):
                raise Broken(f"array {number} is sparse in a wrong way. {AGAIN}")
            values[at] = new
        return values, _FULL.get(told.component) if told.normalized else None

    def _strided(
        self, view: int, offset: int, shape: tuple[int, int], kind: np.dtype[np.generic]
    ) -> NDArray[np.generic]:
        begin, length, stride = self._place(view)
        count, width = shape
        step = stride or width * kind.itemsize
        if step < width * kind.itemsize or step > 4096:
            raise Broken(f"part {view} of its buffer has a wrong stride. {AGAIN}")
        if count and offset + (count - 1) * step + width * kind.itemsize > length:
            raise Broken(f"an array goes beyond part {view} of its buffer. {AGAIN}")
        if not count:
            return np.zeros(shape, kind)
        return np.ndarray(shape, kind, self._content, begin + offset, strides=(step, kind.itemsize))

    def _place(self, number: int) -> tuple[int, int, int | None]:
        """Where a part of the buffer is: first byte, length, stride."""
        if number >= len(self._document.views):
            raise Broken(f"part {number} of its buffer is missing. {AGAIN}")
        view = self._document.views[number]
        if view.buffer >= len(self._document.buffers):
            raise Broken(f"its buffer {view.buffer} is missing. {AGAIN}")
        if view.offset + view.length > len(self._content):
            raise Broken(f"part {number} of its buffer is missing. {AGAIN}")
        return view.offset, view.length, view.stride
