"""What an engine may lack and still carry an agent: declared, told in the record, and heeded."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Abilities:
    """What an engine can do beyond what every engine must; one that does not say can do all."""

    ids: bool = True
    """It tells the object at each pixel; without, boxes of pixels alone (see `Percept`)."""
    closeup: bool = True
    """It draws a part of the view larger."""
    snapshot: bool = True
    """It goes back to any state it was in; without, its snapshots are empty."""
    events: bool = True
    """Things can happen in it that no body does."""
    deterministic: bool = True
    """The same calls give the same states."""

    def lacking(self) -> tuple[str, ...]:
        """What it cannot do, and what is missing for that, in sentences."""
        told = {
            "it tells boxes of pixels and not the object at each pixel, so that its pictures are "
            "checked against the world less closely": self.ids,
            "it draws no close-ups": self.closeup,
            "it keeps no states, so that nothing can go on from the middle": self.snapshot,
            "nothing happens in it but by its body": self.events,
            "it does not promise the same again, so that a replay may differ": self.deterministic,
        }
        return tuple(sentence for sentence, can in told.items() if not can)


def abilities(engine: object) -> Abilities:
    """What an engine says that it can do: its attribute `abilities`, if it has one."""
    said = getattr(engine, "abilities", None)
    return said if isinstance(said, Abilities) else Abilities()
