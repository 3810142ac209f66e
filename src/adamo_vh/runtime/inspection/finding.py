"""What an inspection finds wrong with a scene."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum

from adamo_vh.errors import SceneError

_MOST_OF_A_KIND = 20


class Severity(StrEnum):
    """How bad it is."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True, slots=True)
class SceneFinding:
    """One thing that is wrong."""

    severity: Severity
    where: str
    """Field of the scene file."""
    problem: str
    fix: str
    blocks: bool = False
    """Whether the scene cannot be simulated before this is fixed."""


def error(where: str, problem: str, fix: str, *, blocks: bool = False) -> SceneFinding:
    """Something that must be fixed."""
    return SceneFinding(Severity.ERROR, where, problem, fix, blocks)


def warning(where: str, problem: str, fix: str) -> SceneFinding:
    """Something that is probably not meant."""
    return SceneFinding(Severity.WARNING, where, problem, fix)


def faults_of(fault: SceneError) -> tuple[SceneFinding, ...]:
    """What is wrong with a scene that cannot be read, as findings."""
    found = (error(where, problem, "", blocks=True) for where, problem in fault.faults)
    return tuple(bounded(found))


def bounded(findings: Iterable[SceneFinding]) -> Iterator[SceneFinding]:
    """The first findings of one kind, and one that counts the others: files are untrusted."""
    more: list[SceneFinding] = []
    for count, finding in enumerate(findings):
        if count < _MOST_OF_A_KIND:
            yield finding
        else:
            more.append(finding)
    if more:
        first = more[0]
        problem = f"{len(more)} more of this kind, from here on"
        yield SceneFinding(first.severity, first.where, problem, first.fix, first.blocks)
