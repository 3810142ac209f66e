"""What makes one person differ from another."""

from __future__ import annotations

from dataclasses import dataclass

Colour = tuple[int, int, int]
"""sRGB, 0 to 255."""


@dataclass(frozen=True, slots=True)
class Variant:
    """One person. The skeleton is the same for all."""

    name: str
    skin: Colour
    lips: Colour
    hair: Colour
    iris: Colour
    top: Colour
    trim: Colour
    """Of the collar, the cuffs and the hem."""
    trousers: Colour
    shoes: Colour
    soles: Colour
    hair_style: str
    """short, bob or curls."""
    neckline: str
    """crew, roll or shirt."""
    feminine: float
    """Build and face, from 0 to 1."""
    girth: float = 1.0
    """Of the body under the clothes."""
    stubble: float = 0.0
    """How strongly a short beard shows, from 0 to 1."""
    blush: float = 0.5


PEOPLE: dict[str, Variant] = {
    person.name: person
    for person in (
        Variant(
            name="mara", skin=(224, 168, 134), lips=(190, 98, 88), hair=(76, 46, 30),
            iris=(104, 74, 40), top=(202, 142, 44), trim=(178, 118, 32), trousers=(78, 66, 60),
            shoes=(124, 70, 48), soles=(70, 52, 42), hair_style="bob", neckline="crew",
            feminine=1.0,
        ),
        Variant(
            name="jonas", skin=(230, 180, 150), lips=(196, 124, 108), hair=(122, 84, 46),
            iris=(98, 96, 70), top=(92, 112, 70), trim=(76, 94, 58), trousers=(96, 78, 60),
            shoes=(112, 82, 56), soles=(54, 44, 38), hair_style="short", neckline="shirt",
            feminine=0.0, girth=1.03, stubble=0.55, blush=0.4,
        ),
        Variant(
            name="amina", skin=(128, 80, 54), lips=(134, 62, 58), hair=(38, 27, 24),
            iris=(62, 38, 22), top=(130, 42, 52), trim=(106, 32, 42), trousers=(84, 82, 58),
            shoes=(86, 58, 44), soles=(48, 40, 36), hair_style="curls", neckline="roll",
            feminine=1.0, girth=1.02, blush=0.35,
        ),
        Variant(
            name="ken", skin=(216, 164, 124), lips=(186, 112, 94), hair=(34, 29, 28),
            iris=(66, 44, 28), top=(176, 84, 48), trim=(150, 66, 36), trousers=(82, 74, 64),
            shoes=(70, 60, 54), soles=(104, 82, 58), hair_style="short", neckline="crew",
            feminine=0.15, girth=0.97, blush=0.3,
        ),
    )
}  # fmt: skip
