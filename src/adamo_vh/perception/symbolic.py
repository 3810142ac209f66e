"""The text mirror of a view: what the frame shows, under the same tags, as lines of text."""

from __future__ import annotations

import math
from collections.abc import Iterable
from enum import StrEnum

from adamo_vh.observation import AgentState, ObservedObject, ReferencePoint

NONE = "none"
"""What stands in place of an empty list."""

_CM3_PER_M3 = 1e6


class TextForm(StrEnum):
    """How much the text tells."""

    PAPER = "paper"
    """The fields of the original alone: object centre and volume, point, agent position."""
    FULL = "full"
    """Also each object's box in the frame, and the agent's heading, gaze and hand."""


def object_lines(objects: Iterable[ObservedObject], form: TextForm) -> str:
    """One line for each visible object, in the order given."""
    return "\n".join(_object_line(item, form) for item in objects) or NONE


def point_lines(points: Iterable[ReferencePoint]) -> str:
    """One line for each reference point, in the order given."""
    return "\n".join(f"- {point.tag}: {point.position.text()}" for point in points) or NONE


def agent_lines(agent: AgentState, form: TextForm) -> str:
    """The agent's own state."""
    lines = [f"- position {agent.position.text()}"]
    if form is TextForm.FULL:
        # Rounding first keeps 359.7 from being written as 360.
        heading_deg = round(math.degrees(agent.heading_rad)) % 360
        lines += [
            f"- heading {heading_deg} deg",
            f"- gaze {agent.gaze.text()}",
            f"- hand: {agent.held or 'empty'}",
        ]
    return "\n".join(lines)


def _object_line(item: ObservedObject, form: TextForm) -> str:
    volume_cm3 = item.volume_m3 * _CM3_PER_M3
    line = f"- {item.tag}: center {item.position.text(3)}, volume {volume_cm3:.1f} cm3"
    if form is TextForm.FULL:
        line += f", box [{', '.join(map(str, item.box_px))}] px"
    return line
