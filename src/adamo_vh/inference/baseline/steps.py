"""What the model says in a turn: a note, and calls with how sure it is of each."""

from __future__ import annotations

from dataclasses import dataclass

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.memory import Search

Arguments = tuple[tuple[str, str | float], ...]


@dataclass(frozen=True, slots=True)
class Move:
    """One call with its reasons."""

    conclusion: str
    name: str
    arguments: Arguments = ()
    search: Search = Search.NONE
    confidence: float = 0.9

    @property
    def tag(self) -> str:
        """The object that it is about."""
        return str(dict(self.arguments).get("object", ""))

    @property
    def point(self) -> Vec3 | None:
        """The point that it is about."""
        values = dict(self.arguments)
        if "x" not in values:
            return None
        return Vec3(float(values["x"]), float(values["y"]), float(values["z"]))

    def describe(self) -> str:
        """The call in a few words."""
        words = [self.name, self.tag] if self.tag else [self.name]
        if self.point is not None:
            words.append(f"{'at' if self.name == 'Drop' else 'to'} {self.point}")
        return " ".join(words)


@dataclass(frozen=True, slots=True)
class Finish:
    """The end of an episode."""

    answer: str
    verified: str = ""
    unseen: str = ""
    confidence: float = 0.9


@dataclass(frozen=True, slots=True)
class Step:
    """One turn: calls, or the end."""

    note: str = ""
    moves: tuple[Move, ...] = ()
    finish: Finish | None = None


def to_point(point: Vec3) -> Arguments:
    """A point as arguments."""
    p = point.rounded(3)
    return (("x", p.x), ("y", p.y), ("z", p.z))
