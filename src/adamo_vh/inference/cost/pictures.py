"""What a picture costs in tokens, by each provider's published rule.

Only the size counts, in pixels. `docs/tokens.md` names the documentation of every rule.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Protocol


class ImageRule(Protocol):
    """How a family of models counts a picture."""

    @property
    def name(self) -> str:
        """Short name, for reports."""
        ...

    def tokens(self, width_px: int, height_px: int) -> int:
        """Tokens of a picture of this size."""
        ...


@dataclass(frozen=True, slots=True)
class Tiles:
    """OpenAI: fit into 2048 px, bring the short side down to 768 px, count tiles of 512 px."""

    name: str
    base: int
    per_tile: int

    def tokens(self, width_px: int, height_px: int) -> int:
        """Tokens of a picture of this size."""
        scale = min(1.0, 2048 / max(width_px, height_px))
        scale *= min(1.0, 768 / (scale * min(width_px, height_px)))
        across, down = _ceil(width_px * scale / 512), _ceil(height_px * scale / 512)
        return self.base + self.per_tile * across * down


@dataclass(frozen=True, slots=True)
class Patches:
    """OpenAI's smaller models: patches of 32 px, at most `cap`, times a factor."""

    name: str
    factor: float = 1.0
    cap: int = 1536

    def tokens(self, width_px: int, height_px: int) -> int:
        """Tokens of a picture of this size."""
        across, down = width_px / 32, height_px / 32
        if _ceil(across) * _ceil(down) > self.cap:
            shrink = math.sqrt(self.cap / (across * down))
            across, down = across * shrink, down * shrink
            # Shrunk a little more, so that one side is a whole number of patches.
            fit = min(_floor(across) / across, _floor(down) / down) or 1.0
            across, down = across * fit, down * fit
        patches = min(self.cap, _ceil(across) * _ceil(down))
        return round(patches * self.factor)


@dataclass(frozen=True, slots=True)
class Visual:
    """Anthropic: patches of 28 px of the largest picture that keeps to both limits."""

    name: str
    longest_px: int
    cap: int

    def tokens(self, width_px: int, height_px: int) -> int:
        """Tokens of a picture of this size."""
        long, short = max(width_px, height_px), min(width_px, height_px)
        low, high = 1, min(long, self.longest_px)
        while low < high:
            middle = (low + high + 1) // 2
            low, high = (middle, high) if self._fits(middle, long, short) else (low, middle - 1)
        return self._patches(low, long, short)

    def _fits(self, scaled: int, long: int, short: int) -> bool:
        return self._patches(scaled, long, short) <= self.cap

    def _patches(self, scaled: int, long: int, short: int) -> int:
        other = max(1, round(short * scaled / long))
        return math.ceil(scaled / 28) * math.ceil(other / 28)


@dataclass(frozen=True, slots=True)
class Crops:
    """Gemini 2: one tile up to 384 px, else as many crops of two thirds of the short side."""

    name: str
    per_tile: int = 258

    def tokens(self, width_px: int, height_px: int) -> int:
        """Tokens of a picture of this size."""
        if max(width_px, height_px) <= 384:
            return self.per_tile
        unit = max(1, math.floor(min(width_px, height_px) / 1.5))
        return self.per_tile * math.ceil(width_px / unit) * math.ceil(height_px / unit)


@dataclass(frozen=True, slots=True)
class Grid:
    """Qwen: both sides rounded to cells, from 4 to 16,384 of them, and a sign at either end."""

    name: str
    cell_px: int

    def tokens(self, width_px: int, height_px: int) -> int:
        """Tokens of a picture of this size."""
        cell, least, most = self.cell_px, 4, 16384
        across = max(1, round(width_px / cell))
        down = max(1, round(height_px / cell))
        if across * down > most:
            shrink = math.sqrt(width_px * height_px / (most * cell * cell)) * cell
            across = max(1, _floor(width_px / shrink))
            down = max(1, _floor(height_px / shrink))
        elif across * down < least:
            grow = math.sqrt(least * cell * cell / (width_px * height_px)) / cell
            across, down = _ceil(width_px * grow), _ceil(height_px * grow)
        return across * down + 2


@dataclass(frozen=True, slots=True)
class Fixed:
    """The same for every picture."""

    name: str
    each: int

    def tokens(self, width_px: int, height_px: int) -> int:
        """Tokens of a picture of this size."""
        return self.each


OPENAI_TILES = Tiles("openai-tiles", 85, 170)
"""GPT-4o and GPT-4.1; also the rule where none is known, since the paper's figures are GPT-4o's."""
OPENAI_PATCHES = Patches("openai-patches", 1.62)
"""GPT-4.1 mini and GPT-5 mini."""
ANTHROPIC = Visual("anthropic", 1568, 1568)
"""Claude up to 4.6."""
ANTHROPIC_HIGH = Visual("anthropic-high", 2576, 4784)
"""Claude from 4.7 on."""
GEMINI = Crops("gemini")
"""Gemini 2."""
GEMINI_3 = Fixed("gemini-3", 1120)
"""Gemini 3 at its default resolution of pictures."""
QWEN = Grid("qwen", 28)
"""Qwen2-VL and Qwen2.5-VL."""
QWEN_3 = Grid("qwen-3", 32)
"""Qwen3-VL and later."""

_BY_NAME: tuple[tuple[str, ImageRule], ...] = (
    (r"gemma", Fixed("gemma", 256)),
    (r"gemini-[12]\b", GEMINI),
    (r"gemini", GEMINI_3),
    (r"qwen-?[12](?!\d)|qwen-vl", QWEN),
    (r"qwen|qwq|qvq", QWEN_3),
    (r"gpt-4o-mini", Tiles("openai-tiles-4o-mini", 2833, 5667)),
    (r"o4-mini", Patches("openai-patches-o4-mini", 1.72)),
    (r"gpt-(4\.1|5[\d.]*)-nano", Patches("openai-patches-nano", 2.46)),
    (r"gpt-(4\.1|5[\d.]*)-mini", OPENAI_PATCHES),
    (r"gpt-5", Tiles("openai-tiles-5", 70, 140)),
    (r"\bo[13]\b", Tiles("openai-tiles-o", 75, 150)),
)
_VERSION = re.compile(r"(\d{1,2})(?:[-.](\d{1,2})(?!\d))?(?!\d)")


def rule_for(uri: str) -> ImageRule:
    """The rule of a model, from its name alone; GPT-4o's where no other is known.

    Args:
        uri: Model URI or name.
    """
    name = re.split(r"@(?=https?://)", uri.lower())[0]
    if "claude" in name:
        found = _VERSION.search(name, name.index("claude"))
        version = (int(found[1]), int(found[2] or 0)) if found else (0, 0)
        return ANTHROPIC_HIGH if version >= (4, 7) else ANTHROPIC
    return next((rule for pattern, rule in _BY_NAME if re.search(pattern, name)), OPENAI_TILES)


def estimate_image(width_px: int, height_px: int, rule: ImageRule = OPENAI_TILES) -> int:
    """Tokens of a picture of a size under a rule."""
    return rule.tokens(max(1, width_px), max(1, height_px))


def _ceil(value: float) -> int:
    """Rounded up, but not for the noise of a floating-point number."""
    return max(1, math.ceil(value - 1e-9))


def _floor(value: float) -> int:
    return math.floor(value + 1e-9)
