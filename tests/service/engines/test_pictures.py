"""Pictures on the wire, in each of the agreed codes; what is no such picture is refused."""

from __future__ import annotations

import io
import struct
import zlib
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from adamo_vh.errors import EngineError
from adamo_vh.geometry import Box, Vec3
from adamo_vh.observation import NOTHING
from adamo_vh.perception.visibility import visible_objects
from adamo_vh.service.engines.messages import NO_OBJECT, SeenBox
from adamo_vh.service.engines.pictures import ids_in, painted, raw_ids, read_colour, read_ids

SIZE = WIDTH, HEIGHT = 12, 7
CUBE = Box(Vec3(0, 0, 0), Vec3(1, 1, 1))


def encoded(values: Any, kind: str = "PNG", **options: Any) -> bytes:
    file = io.BytesIO()
    Image.fromarray(values).save(file, kind, **options)
    return file.getvalue()


@pytest.fixture
def rgb() -> Any:
    return np.random.default_rng(1).integers(0, 256, (HEIGHT, WIDTH, 3)).astype(np.uint8)


@pytest.fixture
def ids() -> Any:
    layer = np.full((HEIGHT, WIDTH), NOTHING, np.int16)
    layer[1:3, 2:5], layer[4, 0], layer[6, 11] = 57, 0, 32766
    return layer


def test_colours_come_in_three_codes(rgb: Any) -> None:
    assert np.array_equal(read_colour(rgb.tobytes(), "rgb8", *SIZE), rgb)
    assert np.array_equal(read_colour(encoded(rgb), "png", *SIZE), rgb)
    opaque = np.dstack([rgb, np.full((HEIGHT, WIDTH), 255, np.uint8)])
    assert np.array_equal(read_colour(encoded(opaque), "png", *SIZE), rgb)
    lossy = read_colour(encoded(rgb, "JPEG", quality=95), "jpeg", *SIZE)
    assert lossy.shape == rgb.shape and lossy.dtype == np.uint8


def test_ids_come_in_three_codes(ids: Any) -> None:
    numbers = np.where(ids == NOTHING, NO_OBJECT, ids).astype(np.uint16)
    assert np.array_equal(read_ids(raw_ids(ids), "int16", *SIZE), ids)
    assert np.array_equal(read_ids(encoded(numbers), "png16", *SIZE), ids)
    fifths = np.dstack([numbers >> 10 & 31, numbers >> 5 & 31, numbers & 31]).astype(np.int64)
    for rounding in (-4, 0, 3):
        rgb = (fifths * 8 + 4 + rounding).astype(np.uint8)
        rgb[ids == NOTHING] = 254, 255, 250
        assert np.array_equal(read_ids(encoded(rgb), "rgb555", *SIZE), ids)
    assert ids_in([ids]) == {0, 57, 32766}
    assert ids_in([]) == set()


@pytest.mark.parametrize("code", ["png", "jpeg", "rgb8"])
@pytest.mark.parametrize("data", [b"", b"\x89PNG\r\n\x1a\n", b"x" * 999])
def test_bytes_that_are_no_colours_are_refused(code: Any, data: bytes) -> None:
    with pytest.raises(EngineError, match=r"a picture (has|is no)"):
        read_colour(data, code, *SIZE)


@pytest.mark.parametrize("code", ["png16", "rgb555", "int16"])
@pytest.mark.parametrize("data", [b"", b"\x89PNG\r\n\x1a\n", b"x" * 999])
def test_bytes_that_are_no_ids_are_refused(code: Any, data: bytes) -> None:
    with pytest.raises(EngineError, match=r"a picture (has|is no)"):
        read_ids(data, code, *SIZE)


def test_a_picture_of_another_size_or_kind_is_refused(rgb: Any) -> None:
    with pytest.raises(EngineError, match=r"a picture is \(12, 6\), and \(12, 7\) was asked for"):
        read_colour(encoded(rgb[:-1]), "png", *SIZE)
    with pytest.raises(EngineError, match="of kind L, and RGB is agreed"):
        read_colour(encoded(rgb[:, :, 0]), "png", *SIZE)
    with pytest.raises(EngineError, match="a picture is no JPEG"):
        read_colour(encoded(rgb), "jpeg", *SIZE)
    with pytest.raises(EngineError, match="of kind RGB, and I;16 is agreed"):
        read_ids(encoded(rgb), "png16", *SIZE)
    with pytest.raises(EngineError, match="of kind L, and RGB is agreed"):
        read_ids(encoded(rgb[:, :, 0]), "rgb555", *SIZE)


def test_a_small_file_does_not_become_a_huge_picture() -> None:
    def chunk(kind: bytes, data: bytes) -> bytes:
        check = zlib.crc32(kind + data)
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", check)

    head = struct.pack(">IIBBBBB", 100_000, 100_000, 8, 2, 0, 0, 0)
    bomb = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(b"\0" * 999))
    with pytest.raises(EngineError, match="a picture is"):
        read_colour(bomb, "png", *SIZE)


@pytest.mark.parametrize("value", [32768, 40000, 65534])
def test_a_pixel_must_hold_an_id(value: int) -> None:
    layer = np.full((HEIGHT, WIDTH), value, "<u2")
    for data, code in ((layer.tobytes(), "int16"), (encoded(layer), "png16")):
        with pytest.raises(EngineError, match=f"a pixel holds {value}, which is no id"):
            read_ids(data, code, *SIZE)  # type: ignore[arg-type]


BOXES = st.integers(0, 50).flatmap(
    lambda number: st.tuples(
        st.just(number),
        st.tuples(st.integers(0, 30), st.integers(0, 15)),
        st.tuples(st.integers(2, 20), st.integers(2, 10)),
        st.floats(0, 1),
    )
)


@given(st.lists(BOXES, max_size=8, unique_by=lambda box: box[0]))
def test_what_is_painted_from_boxes_has_their_boxes_and_numbers(boxes: list[Any]) -> None:
    seen = []
    for number, (left, top), (width, height), share in boxes:
        pixels = 2 + round(share * (width * height - 2))
        seen.append(SeenBox(number, CUBE, (left, top, left + width, top + height), pixels))
    layers = painted(seen, 64, 36)

    class View:
        id_layers = layers

    found = {item.id: (item.box_px, item.pixels) for item in visible_objects(View(), 1)}  # type: ignore[arg-type]
    large = {item.id: (item.box_px, item.pixels) for item in seen if (item.pixels or 0) >= 4}
    assert found == large


def test_boxes_that_overlap_go_into_layers_of_their_own() -> None:
    apart = [SeenBox(1, CUBE, (0, 0, 4, 4), 9), SeenBox(2, CUBE, (5, 0, 8, 4), 9)]
    assert len(painted(apart, *SIZE)) == 1
    assert len(painted([*apart, SeenBox(3, CUBE, (3, 0, 6, 4), 12)], *SIZE)) == 2
    assert [layer.dtype for layer in painted([], *SIZE)] == [np.int16]
