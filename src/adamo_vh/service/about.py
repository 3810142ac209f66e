"""What a server tells of itself and of its sessions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib.metadata import version

from adamo_vh.action_server.wire import VERSION
from adamo_vh.benchmark.tasks import builtin_tasks
from adamo_vh.cognition.profile import PROFILES
from adamo_vh.perception import Labeling
from adamo_vh.service.hosted import Hosted
from adamo_vh.service.hosting import Host
from adamo_vh.session.builtin import scene_names


@cache
def _version() -> str:
    return version("adamo-vh")


@dataclass(frozen=True, slots=True)
class About:
    """What a server offers."""

    version: int
    """Of the messages."""
    adamo_vh: str
    """Of the program."""
    scenes: tuple[str, ...]
    labelings: tuple[str, ...]
    profiles: tuple[str, ...]
    tasks: tuple[str, ...]
    scene: str
    """Where a session plays that names none."""
    labeling: str
    profile: str
    sessions: int
    """So many can be played at once."""

    @classmethod
    def of(cls, host: Host) -> About:
        """What a host offers."""
        terms = host.terms
        return cls(
            VERSION,
            _version(),
            scene_names(),
            tuple(Labeling),
            tuple(PROFILES),
            tuple(task.id for task in builtin_tasks()),
            terms.scene,
            terms.labeling,
            terms.profile,
            terms.most_sessions,
        )


@dataclass(frozen=True, slots=True)
class Playing:
    """A session, as a judge is told of it."""

    session: str
    task: str | None
    instruction: str
    player: str
    steps: int
    ended: bool
    run: str
    """Its run folder."""

    @classmethod
    def of(cls, hosted: Hosted) -> Playing:
        """A session now."""
        body = hosted.body
        return cls(
            hosted.id,
            body.config.task,
            body.instruction,
            body.manifest.model_name,
            body.steps,
            body.ended,
            str(hosted.folder),
        )


@dataclass(frozen=True, slots=True)
class Scored:
    """How much of a task is done now."""

    completion: float | None
    """Fraction of its conditions; null without a task."""
