"""What a session is made of: parts that can be handed in, and what is written down of all."""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import version
from typing import TypedDict

from adamo_vh.abilities import abilities
from adamo_vh.action_server import Tool
from adamo_vh.action_server.frame_cache import FrameCache
from adamo_vh.cognition.budget import Budget, BudgetGuard, Ledger
from adamo_vh.cognition.guards import Guard
from adamo_vh.cognition.memory.protocol import NewMemory
from adamo_vh.cognition.oversight import Consent
from adamo_vh.engine import World
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import Manifest
from adamo_vh.inference.model import Model, ModelInfo
from adamo_vh.perception import Tagger
from adamo_vh.record.trajectory import Observer
from adamo_vh.session.bodies import own_engine
from adamo_vh.session.figures import digest_in

_REPORTED = ("adamo-vh", "mujoco", "numpy", "pillow", "opencv-python-headless", "pydantic-ai-slim")


class Parts(TypedDict, total=False):
    """What can be handed in from outside, each in place of what the settings name.

    A session that is resumed needs the same ones as when it began.
    """

    engine: World | None
    """Is reset, and not closed."""
    model: Model | None
    """Is not closed."""
    tools: Sequence[Tool] | None
    """The body's primitives, in place of those of the profile."""
    labeling: Tagger | None
    """Makes and reads the tags."""
    memory: NewMemory | None
    """Makes the memory, in place of the short-term memory."""
    guards: Sequence[Guard]
    """Further reasons to stop."""
    consent: Consent | None
    """Is asked before a turn is carried out, and says why not; see `Oversight`."""
    observers: Sequence[Observer]
    """Are told of every event that is new; a fault of theirs ends nothing."""
    frame_cache: FrameCache | None
    """Keeps views for several sessions, so that the same picture is drawn once."""


def describe(config: EpisodeConfig, who: ModelInfo, world: World, parts: Parts) -> Manifest:
    """The manifest of an episode that is about to begin; `who` decides in it."""
    now = datetime.now(UTC).isoformat(timespec="seconds")
    tagger = parts.get("labeling")
    return Manifest(
        config,
        who.name,
        who.kind,
        _versions(),
        now,
        world.state(),
        who.capabilities,
        engine=own_engine(world) if parts.get("engine") else "",
        engine_lacks=abilities(world).lacking(),
        labeling="" if tagger is None else type(tagger).__name__,
        isolation=who.isolation,
        figure_sha256=digest_in(world),
    )


@cache
def _versions() -> Mapping[str, str]:
    """What an episode is played with."""
    return {"python": platform.python_version(), **{name: version(name) for name in _REPORTED}}


def capped(parts: Parts, cap: Budget | None) -> Parts:
    """The parts with a guard of what all instructions may take together."""
    guards = (*parts.get("guards", ()), *((BudgetGuard(Budget(), Ledger(), cap),) if cap else ()))
    return {**parts, "guards": guards}
