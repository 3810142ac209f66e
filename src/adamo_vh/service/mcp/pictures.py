"""Pictures for MCP clients, several of which drop or refuse what is large."""

from __future__ import annotations

import io

from adamo_vh.inference.messages import ImagePart

MOST_BYTES = 700_000
"""Of a picture as it goes over the wire, in Base64."""
_TRIES = ((1.0, 85), (1.0, 70), (1.0, 50), (0.75, 70), (0.5, 70), (0.35, 70), (0.25, 60))
"""Scale and JPEG quality, in the order in which they are tried."""


def base64_bytes(data: bytes) -> int:
    """Bytes that some data take in Base64."""
    return 4 * ((len(data) + 2) // 3)


def fitted(picture: ImagePart, most_bytes: int = MOST_BYTES) -> ImagePart:
    """The picture itself if it is small enough; else with less quality, then smaller.

    Args:
        picture: Any.
        most_bytes: What it may take in Base64; the smallest try is taken if none is small enough.
    """
    if base64_bytes(picture.data) <= most_bytes:
        return picture
    from PIL import Image

    tried = picture
    with Image.open(io.BytesIO(picture.data)) as opened:
        whole = opened.convert("RGB")
    for scale, quality in _TRIES:
        size = (max(1, round(whole.width * scale)), max(1, round(whole.height * scale)))
        image = whole if scale == 1.0 else whole.resize(size, Image.Resampling.LANCZOS)
        buffer = io.BytesIO()
        image.save(buffer, "JPEG", quality=quality)
        tried = ImagePart(buffer.getvalue(), "image/jpeg", *size)
        if base64_bytes(tried.data) <= most_bytes:
            break
    return tried
