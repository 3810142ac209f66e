"""Perceive: labels, visibility, reference points, the annotated frame and its text mirror."""

from adamo_vh.perception.labeling import Labeling, Tagger
from adamo_vh.perception.overlay import ImageFormat
from adamo_vh.perception.perceive import PerceptionConfig, agent_state, perceive
from adamo_vh.perception.symbolic import TextForm, agent_lines, object_lines, point_lines

__all__ = [
    "ImageFormat",
    "Labeling",
    "PerceptionConfig",
    "Tagger",
    "TextForm",
    "agent_lines",
    "agent_state",
    "object_lines",
    "perceive",
    "point_lines",
]
