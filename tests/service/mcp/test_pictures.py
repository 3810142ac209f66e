"""Pictures that are too large go with less quality, then smaller."""

from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from adamo_vh.inference.messages import ImagePart
from adamo_vh.service.mcp.pictures import MOST_BYTES, base64_bytes, fitted


def _noise(width: int, height: int, form: str = "PNG") -> ImagePart:
    pixels = np.random.default_rng(1).integers(0, 256, (height, width, 3), dtype=np.uint8)
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, form)
    return ImagePart(buffer.getvalue(), f"image/{form.lower()}", width, height)


def test_a_small_one_goes_as_it_is() -> None:
    picture = _noise(64, 64)
    assert fitted(picture) is picture


@pytest.mark.parametrize("size", [(800, 450), (1600, 900)])
def test_a_large_one_is_made_to_fit(size: tuple[int, int]) -> None:
    picture = _noise(*size)
    small = fitted(picture)
    assert small is not picture and base64_bytes(small.data) <= MOST_BYTES
    with Image.open(io.BytesIO(small.data)) as opened:
        assert opened.size == (small.width_px, small.height_px) and opened.format == "JPEG"
    # Quality goes first, size only where that is not enough.
    assert (small.width_px == size[0]) == (size[0] == 800)


def test_what_never_fits_is_as_small_as_it_gets() -> None:
    assert fitted(_noise(64, 64), most_bytes=10).width_px == 16
