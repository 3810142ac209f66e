"""Perceive: labels, visibility, reference points, the annotated frame and its text mirror."""

from adamo.perception.labeling import Labeling
from adamo.perception.overlay import ImageFormat
from adamo.perception.perceive import PerceptionConfig, agent_state, perceive
from adamo.perception.symbolic import TextForm, agent_lines, object_lines, point_lines

__all__ = [
    "ImageFormat",
    "Labeling",
    "PerceptionConfig",
    "TextForm",
    "agent_lines",
    "agent_state",
    "object_lines",
    "perceive",
    "point_lines",
]
