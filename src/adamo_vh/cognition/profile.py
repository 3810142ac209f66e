"""Profiles: how the agent is spoken to and what it may do in a turn, as independent switches.

`paper` is the paper's protocol to the letter (Sec. 3.1). `lean` and `single` are ours: the same
body for far fewer tokens, with models that plan several calls in one turn and with those that make
one. Every switch can be set by itself, on top of any profile, so that each can be ablated. Results
of different profiles are always reported apart.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from typing import Any, Literal

from adamo_vh.errors import ConfigError

_ON, _OFF = ("on", "true", "yes", "1"), ("off", "false", "no", "0")


class StateText(StrEnum):
    """Where the symbolic state stands in the prompt."""

    FIRST = "first"
    """The whole state, always the latest, right behind the instructions: the paper's place. It
    changes with every action, so no provider cache can hold what comes after it."""
    LAST = "last"
    """The whole state, always the latest, at the end: the prompt before it only grows."""
    CHANGES = "changes"
    """With each result only what changed; all that was said before stays where it was."""
    NONE = "none"
    """No state in words: the model has the pictures and what feedback says."""


class BufferUnit(StrEnum):
    """What the short-term memory counts: k is that many of these."""

    STEP = "step"
    """What the model said, with the results of its calls and the views that followed."""
    BLOCK = "block"
    """The original program's: what the model said with its results is one, and so is every other
    message, that with a picture too."""


NO_PICTURES: Literal["none"] = "none"
"""The value of `pictures` that leaves all of them out, for models that read text alone."""
NEW_PICTURES: Literal["new"] = "new"
"""The value of `pictures` that shows each one until the next action alone."""


@dataclass(frozen=True, slots=True)
class Profile:
    """The switches; the defaults are the paper's protocol."""

    name: str = "paper"
    """What the switches started from."""
    state: StateText = StateText.FIRST
    terse: bool = False
    """The same facts in fewer words: short lines, no boxes in the text (they are drawn), no
    reference points on walls and above the hand's reach, tools with names and types alone."""
    fresh_view: bool = False
    """A new view after every turn that changed what is seen; otherwise after Look only."""
    pictures: int | Literal["none", "new"] = 0
    """Only the pictures of the last so many views stay in the prompt; 0 keeps all within k, "new"
    shows a picture until the next action, when the text of its view has to do, and "none" shows
    none at all."""
    pictures_in_results: bool = False
    """Views come inside the tool's result; otherwise as human messages after it."""
    closeups: bool = False
    """Offer Inspect (one object close up) and Survey (all in view on one sheet)."""
    note_argument: bool = False
    """The reasoning note is a required argument of every call, with a confidence; otherwise it is
    the text before the call."""
    min_confidence: float = 0.0
    """A Pick with less confidence than this shows the object close up first; needs the note
    argument and close-ups. 0 switches it off."""
    finish_check: bool = False
    """The episode is ended by a tool that asks what is verified and what was not looked at."""
    plan: int = 1
    """Calls that are executed in one turn, until the first surprise."""
    buffer_unit: BufferUnit = BufferUnit.STEP
    exact_sampling: bool = False
    """Send temperature and top-p both, as the paper did, even where a provider refuses them."""

    def __post_init__(self) -> None:
        """Refuse switches that make no sense together."""
        count = 0 if isinstance(self.pictures, str) else self.pictures
        if count < 0 or self.plan < 1 or not 0 <= self.min_confidence <= 1:
            raise ConfigError(
                "pictures is at least 0, new or none; plan is at least 1, and min_confidence from "
                "0 to 1."
            )
        if not self.has_pictures and self.state is StateText.NONE:
            raise ConfigError(
                "With pictures=none and state=none the model would see nothing: leave one of "
                "them out."
            )
        if self.pictures == NEW_PICTURES and self.state is StateText.NONE:
            raise ConfigError(
                "With pictures=new a view is its text after the next action, and state=none leaves "
                "that out: set pictures=1."
            )
        if not self.has_pictures and self.closeups:
            raise ConfigError("closeups are pictures: with pictures=none, set closeups=off.")
        if self.min_confidence and not (self.note_argument and self.closeups):
            raise ConfigError(
                "min_confidence needs note_argument (which asks for a confidence) and closeups: "
                "turn them on, or set min_confidence=0."
            )

    @property
    def has_pictures(self) -> bool:
        """Whether the model is shown pictures at all."""
        return self.pictures != NO_PICTURES

    def without_pictures(self) -> Profile:
        """The same for a model that sees none.

        Raises:
            ConfigError: Pictures are all that it is told by.
        """
        return replace(self, pictures=NO_PICTURES, closeups=False, min_confidence=0.0)

    def with_one_picture(self) -> Profile:
        """The same for a server that takes one picture a prompt: no close-up beside the view."""
        pictures = 1 if isinstance(self.pictures, int) else self.pictures
        return replace(self, pictures=pictures, closeups=False, min_confidence=0.0)

    def __str__(self) -> str:
        """The name, and what differs from what the name stands for."""
        start = PROFILES.get(self.name, PAPER)
        changed = ", ".join(
            f"{field.name}={_spelled(getattr(self, field.name))}"
            for field in fields(self)
            if field.name != "name" and getattr(self, field.name) != getattr(start, field.name)
        )
        return f"{self.name} ({changed})" if changed else self.name


PAPER = Profile()
PROFILES: Mapping[str, Profile] = {
    "paper": PAPER,
    "paper-exact": Profile("paper-exact", exact_sampling=True),
    "lean": Profile(
        "lean",
        state=StateText.CHANGES,
        terse=True,
        fresh_view=True,
        pictures=1,
        pictures_in_results=True,
        closeups=True,
        note_argument=True,
        min_confidence=0.5,
        finish_check=True,
        plan=12,
    ),
    "single": Profile(
        "single",
        state=StateText.CHANGES,
        terse=True,
        pictures=NEW_PICTURES,
        pictures_in_results=True,
        closeups=True,
        note_argument=True,
        min_confidence=0.5,
        finish_check=True,
    ),
}
SWITCHES = tuple(field.name for field in fields(Profile) if field.name != "name")


def profile(name: str, switches: Mapping[str, Any] | None = None) -> Profile:
    """A profile by its name, with some switches set otherwise.

    Args:
        name: "paper", "paper-exact", "lean" or "single".
        switches: New values by switch; texts are read ("on", "off", numbers, "changes").

    Raises:
        ConfigError: The name, a switch or a value is unknown.
    """
    if name.lower() not in PROFILES:
        raise ConfigError(f"There is no profile {name!r}. Use one of {', '.join(PROFILES)}.")
    start = PROFILES[name.lower()]
    chosen = {key.replace("-", "_"): value for key, value in (switches or {}).items()}
    if unknown := sorted(chosen.keys() - set(SWITCHES)):
        raise ConfigError(f"There is no switch {unknown[0]!r}. Switches: {', '.join(SWITCHES)}.")
    values = {key: _read(key, value, getattr(start, key)) for key, value in chosen.items()}
    if values.get("pictures") == NO_PICTURES:
        values.setdefault("closeups", False)
    # Without a note there is no confidence, and without close-ups nothing that it could lead to.
    if not (values.get("note_argument", True) and values.get("closeups", True)):
        values.setdefault("min_confidence", 0.0)
    return replace(start, **values)


def told_without(told: str, switches: Collection[str]) -> str:
    """What a profile is called, as `str` tells it, without some of the switches that differ.

    Args:
        told: Such as "paper (plan=3, terse=on)".
        switches: Names of those that are told elsewhere.
    """
    name, _, rest = told.partition(" (")
    kept = [part for part in rest.rstrip(")").split(", ") if part.split("=")[0] not in switches]
    return f"{name} ({', '.join(kept)})" if any(kept) else name


def _read(switch: str, value: Any, usual: Any) -> Any:
    text = str(value).strip().lower()
    if switch == "pictures" and text in (NO_PICTURES, NEW_PICTURES):
        return text
    try:
        if isinstance(usual, bool):
            return {**dict.fromkeys(_ON, True), **dict.fromkeys(_OFF, False)}[text]
        return type(usual)(text)
    except (KeyError, ValueError):
        offer = "on or off" if isinstance(usual, bool) else "a number"
        if switch == "pictures":
            offer = "a number, new or none"
        if isinstance(usual, StrEnum):
            offer = ", ".join(type(usual))
        raise ConfigError(f"Switch {switch}: {value!r} is not understood; use {offer}.") from None


def _spelled(value: Any) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    return str(value)
