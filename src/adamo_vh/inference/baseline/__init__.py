"""The embedded default model: grammar, symbolic text and classical vision; no learned weights."""

from adamo_vh.inference.baseline.model import BaselineModel

__all__ = ["BaselineModel"]
