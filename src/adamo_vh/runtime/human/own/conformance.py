"""What of a file could be used, what is missing, and what that means."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

_STRETCH = (0.7, 1.4)
"""Limbs that are drawn shorter or longer than this look unlike the file's."""
_MANY_PARTS = 40
"""More parts than this make drawing slow."""


@dataclass(frozen=True, slots=True)
class Conformance:
    """What a look over a figure's file brought."""

    name: str
    """Of the file."""
    sha256: str
    source: str
    """How its bones were recognised."""
    bones: Mapping[str, str]
    """The file's name of each bone that was found, by VRM's words."""
    missing: Mapping[str, str]
    """Bones that it lacks, and what that means."""
    height: float
    """Units of the file."""
    unit: str
    """What that unit seems to be."""
    scale: float
    """Metres of the drawn figure in one unit of the file."""
    drawn_m: float
    """How tall it is drawn."""
    up: str
    facing: str
    rest_pose: str
    """T, A or arms hanging."""
    stretches: Mapping[str, float]
    """How much longer than in the file each limb is drawn, beside the whole figure's scale."""
    shapes: tuple[str, ...]
    """Shapes of the face that move."""
    without: tuple[str, ...]
    """What the face cannot do."""
    triangles: int
    parts: int
    """Parts that are drawn one by one."""
    materials: int
    pictures: int
    skinned: int
    """Meshes that bones bend."""
    attached: int
    """Meshes that hang on a bone as they are."""
    notes: tuple[str, ...]
    """What was left out or changed."""
    licence: Mapping[str, str]
    """What the file says of its rights, by its own words."""

    @property
    def warnings(self) -> tuple[str, ...]:
        """What one should know before using it."""
        return tuple(self._warnings())

    def _warnings(self) -> Iterator[str]:
        means: dict[str, list[str]] = {}
        for bone, why in self.missing.items():
            means.setdefault(why, []).append(bone)
        for why, bones in means.items():
            yield f"no {' and '.join(bones)}: {why}"
        for what in self.without:
            yield f"the face {what}"
        low, high = _STRETCH
        if odd := [bone for bone, by in self.stretches.items() if not low <= by <= high]:
            bone = max(odd, key=lambda name: abs(self.stretches[name] - 1))
            yield (
                f"its proportions are unlike the standard body's: {bone} is drawn "
                f"{self.stretches[bone]:.2f} times as long as in the file"
            )
        if self.unit == "unknown units":
            yield f"it is {self.height:.4g} units tall; it is scaled to {self.drawn_m:.2f} m"
        if self.parts > _MANY_PARTS:
            yield f"{self.parts} parts are drawn one by one, which is slow; join its materials"
        yield from self.notes

    def lines(self) -> list[str]:
        """All of it for people, one fact a line."""
        names = ", ".join(f"{bone} = {name}" for bone, name in self.bones.items())
        licence = "; ".join(f"{key}: {text}" for key, text in self.licence.items())
        return [
            f"file       {self.name}, SHA-256 {self.sha256[:16]}",
            f"skeleton   {self.source}, {len(self.bones)} bones",
            f"bones      {names}",
            f"stands     {self.up} up, facing {self.facing}, rest pose {self.rest_pose}",
            f"height     {self.height:.4g} {self.unit}; drawn {self.drawn_m:.2f} m tall",
            f"face       {', '.join(self.shapes) or 'no shapes'}",
            f"meshes     {self.triangles:,} triangles in {self.parts} parts; "
            f"{self.skinned} skinned, {self.attached} attached; "
            f"{self.materials} materials, {self.pictures} pictures",
            f"licence    {licence or 'the file says nothing; ask its author'}",
            *(f"note       {text}" for text in self.warnings),
        ]
