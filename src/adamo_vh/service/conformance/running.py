"""Look an engine over: every check, from a reset, and how long it takes."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from enum import StrEnum

from adamo_vh.abilities import Abilities, abilities
from adamo_vh.engine import World, acting_body
from adamo_vh.errors import AdamoError, ConfigError
from adamo_vh.geometry import Vec3
from adamo_vh.readable import readable
from adamo_vh.service.conformance.action_checks import ACTION_CHECKS
from adamo_vh.service.conformance.check import Check, NotTriedError, Probe, told
from adamo_vh.service.conformance.memory_checks import MEMORY_CHECKS
from adamo_vh.service.conformance.room_checks import ROOM_CHECKS
from adamo_vh.service.conformance.sight_checks import SIGHT_CHECKS

CHECKS = told(ROOM_CHECKS | SIGHT_CHECKS | ACTION_CHECKS | MEMORY_CHECKS)
"""All of them, in the order in which they are made."""
_MOST_FOUND = 4
_LONGEST = 400


class Verdict(StrEnum):
    """What came of a check."""

    PASSED = "passed"
    FAILED = "failed"
    MISSING = "missing"
    """The engine declares that it cannot do this."""
    NOT_TRIED = "not tried"
    """Something else that the check needs does not work, or the scene has nothing for it."""


@dataclass(frozen=True, slots=True)
class Finding:
    """What one check brought."""

    name: str
    verdict: Verdict
    mandatory: bool
    expected: str
    found: str
    """What was found instead; empty if all is well."""
    mend: str
    seconds: float


@dataclass(frozen=True, slots=True)
class Latency:
    """How long a call takes."""

    call: str
    median_ms: float


@dataclass(frozen=True, slots=True)
class Conformance:
    """What a look over an engine brought."""

    engine: str
    scene: str
    abilities: Abilities
    findings: tuple[Finding, ...]
    latencies: tuple[Latency, ...] = ()

    @property
    def conforms(self) -> bool:
        """Whether the engine keeps to all that is mandatory and to what it says it can."""
        return not any(finding.verdict is Verdict.FAILED for finding in self.findings)

    def count(self, verdict: Verdict) -> int:
        """How many checks came out so."""
        return sum(finding.verdict is verdict for finding in self.findings)


def conform(
    world: World,
    only: Iterable[str] = (),
    *,
    timed: bool = False,
    watch: Callable[[Finding], None] = lambda finding: None,
) -> Conformance:
    """Look an engine over.

    Args:
        world: Is reset, lived in, and left as after a reset.
        only: Names of checks, or their first words; all by default.
        timed: Measure how long its calls take, too.
        watch: Is told of each finding at once.

    Raises:
        ConfigError: There is no such check.
        EngineError: It is no engine at all.
    """
    acting_body(world)
    chosen, able, probe = _chosen(only), abilities(world), Probe(world)
    findings = []
    for check in chosen:
        findings.append(_finding(check, probe, able))
        watch(findings[-1])
    latencies: tuple[Latency, ...] = ()
    if timed:
        with suppress(AdamoError):  # What does not work is among the findings already.
            latencies = tuple(_latencies(world))
    source = world.scene.source or type(world).__name__
    return Conformance(source, world.scene.full_name, able, tuple(findings), latencies)


def engine_faults(world: World, only: Iterable[str] = ()) -> tuple[str, ...]:
    """What an engine does otherwise than the contract says, in sentences; empty if nothing."""
    try:
        report = conform(world, only)
        world.reset(0)
    except AdamoError as error:
        return (str(error),)
    failed = (item for item in report.findings if item.verdict is Verdict.FAILED)
    return tuple(f"{item.name}: {item.found}" for item in failed)


def _chosen(only: Iterable[str]) -> tuple[Check, ...]:
    names = list(only)
    for name in names:
        if not any(name in (check.name, check.group) for check in CHECKS):
            groups = ", ".join(dict.fromkeys(check.group for check in CHECKS))
            raise ConfigError(f"There is no check {name!r}; use a name, or one of {groups}.")
    return tuple(c for c in CHECKS if not names or c.name in names or c.group in names)


def _finding(check: Check, probe: Probe, able: Abilities) -> Finding:
    started = time.perf_counter()
    if check.needs and not getattr(able, check.needs):
        verdict, found = Verdict.MISSING, f"declared: {check.needs} = false"
    else:
        verdict, found = _judged(check, probe)
    seconds = time.perf_counter() - started
    text, mandatory = readable(found)[:_LONGEST], not check.needs
    return Finding(check.name, verdict, mandatory, check.expected, text, check.mend, seconds)


def _judged(check: Check, probe: Probe) -> tuple[Verdict, str]:
    try:
        probe.world.reset(0)
        found = [text for text, _ in zip(check.run(probe), range(_MOST_FOUND), strict=False)]
    except NotTriedError as error:
        return Verdict.NOT_TRIED, str(error)
    except AdamoError as error:
        return Verdict.FAILED, str(error)
    except Exception as error:
        # Whatever somebody's engine raises is a finding.
        return Verdict.FAILED, f"{type(error).__name__}: {error}"
    finally:
        _try_reset(probe.world)
    return (Verdict.FAILED, "; ".join(found)) if found else (Verdict.PASSED, "")


def _try_reset(world: World) -> None:
    try:
        world.reset(0)
    except Exception:  # Said by the next check.
        return


def _latencies(world: World) -> Iterable[Latency]:
    body = acting_body(world)
    eyes = body.state().eyes
    down = Vec3(0.0, 0.0, -1.0).array()[None].repeat(36, axis=0)

    def new_view(size: tuple[int, int], turn: int) -> None:
        body.look(eyes + Vec3(1.0, 0.1 * turn, -0.5))
        body.see(*size)

    calls: dict[str, Callable[[int], object]] = {
        "state": lambda turn: world.state(),
        "36 rays": lambda turn: body.rays(eyes, down),
        "look and see 640x360": lambda turn: new_view((640, 360), turn),
        "look and see 1920x1080": lambda turn: new_view((1920, 1080), turn),
        "snapshot": lambda turn: world.snapshot(),
    }
    for name, call in calls.items():
        taken = []
        for turn in range(5):
            started = time.perf_counter()
            call(turn)
            taken.append((time.perf_counter() - started) * 1000)
        yield Latency(name, statistics.median(taken))
    world.reset(0)
