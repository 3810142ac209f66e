"""One sheet with a close-up of every object in view."""

from __future__ import annotations

import math
from collections.abc import Sequence

from PIL import Image

from adamo_vh.observation import Percept
from adamo_vh.perception.closeup import STRIP, Closeup, aim, detail, seen_corners, strip_px, titled
from adamo_vh.perception.visibility import PixelBox

SHEET_PX = 1008
"""Width of a full sheet."""
MAX_CELLS = 40
"""A longer sheet would show each object too small once a provider has scaled it down."""
_MOST_COLUMNS = 5
_LARGEST_CELL_PX = 320
_GAP_PX = 8
_FONT_PX = 17

SheetItem = tuple[int, str, PixelBox]
"""Id, tag and box in the view of an object."""


def contact_sheet(view: Percept, items: Sequence[SheetItem], closeup: Closeup) -> Image.Image:
    """Draw all objects row by row, each close up and below its tag.

    Args:
        view: What the eyes see.
        items: What to show, in this order; at least one, and at most `MAX_CELLS`.
        closeup: Draws each.
    """
    columns = min(_MOST_COLUMNS, math.ceil(math.sqrt(len(items))))
    cell = min(_LARGEST_CELL_PX, (SHEET_PX - _GAP_PX) // columns - _GAP_PX)
    rows = -(-len(items) // columns)
    step_x, step_y = cell + _GAP_PX, cell + strip_px(_FONT_PX) + _GAP_PX
    sheet = Image.new("RGB", (columns * step_x + _GAP_PX, rows * step_y + _GAP_PX), STRIP)
    for number, (object_id, tag, box) in enumerate(items):
        aimed = aim(view.camera.position, seen_corners(view, box), cell, slimmest=1.0)
        picture = titled(detail(view, object_id, tag, aimed, closeup), tag, _FONT_PX)
        row, column = divmod(number, columns)
        sheet.paste(picture, (_GAP_PX + column * step_x, _GAP_PX + row * step_y))
    return sheet
