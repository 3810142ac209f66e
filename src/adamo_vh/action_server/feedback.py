"""The sentences of feedback: the one place where a `BodyReport` becomes words.

Every sentence starts with the outcome, says what happened, and never reads as success when the
body did something else than asked.
"""

from __future__ import annotations

from dataclasses import replace

from adamo_vh.action import Code, Feedback, Outcome
from adamo_vh.engine import BodyInfo, BodyReport
from adamo_vh.geometry import Vec3

_ROUNDING_M = 0.01
"""Coordinates are told with two digits: a wall that is told back may be this far outside."""


def looked(report: BodyReport) -> Feedback:
    """After Look."""
    if report.code == Code.CANCELLED:
        return _stopped(report)
    if report.outcome is Outcome.DONE:
        return _feedback(report, f"looking at {report.point}")
    return _feedback(report, f"the neck does not turn that far; looking at {report.point}")


def walked(report: BodyReport, target: Vec3) -> Feedback:
    """After Walk to a target."""
    if report.code == Code.CANCELLED:
        return _stopped(report)
    if report.outcome is Outcome.REFUSED or report.point is None:
        return _refusal(report, "no way leads there")
    if report.outcome is Outcome.DONE:
        if report.walked_m < 0.01:
            return _feedback(report, f"you already stand at {report.point}")
        return _feedback(report, f"walked {report.walked_m:.2f} m to {report.point}")
    left = report.point.horizontal_distance(target)
    place = Vec3(target.x, target.y, 0.0)
    return _feedback(
        report, f"{place} is not reachable; stopped at {report.point}, {left:.2f} m from it"
    )


def picked(report: BodyReport, tag: str) -> Feedback:
    """After Pick."""
    if report.code == Code.CANCELLED:
        return _stopped(report)
    if report.outcome is Outcome.REFUSED:
        return _refusal(report, f"no place to stand has {tag} within reach")
    return _feedback(report, f"{_closer(report)}{tag} is in your hand")


def dropped(report: BodyReport, tag: str, target: Vec3, support: str, body: BodyInfo) -> Feedback:
    """After Drop at a target; `support` names what the object rests on, in the agent's words."""
    if report.code == Code.CANCELLED:
        return _stopped(report)
    if report.outcome is Outcome.REFUSED or report.point is None:
        free = f"no free, supported spot within {body.correction_m:g} m of that point"
        return _refusal(report, "no place to stand has that point within reach", free)
    rest = f"{tag} rests at {report.point} {support}"
    if report.outcome is Outcome.DONE:
        return _feedback(report, f"{_closer(report)}{rest}")
    off = report.point.distance(target)
    return _feedback(
        report,
        f"{_closer(report)}the very point was not free or not supported; {rest}, "
        f"{off:.2f} m from it",
    )


def shown(what: str) -> Feedback:
    """After a picture was shown."""
    return Feedback(Outcome.DONE, Code.OK, f"Done: {what}.")


def moved_inside(said: Feedback, asked: Vec3, taken: Vec3) -> Feedback:
    """The same feedback, for a point that was a little outside the room; else unchanged."""
    if asked.distance(taken) <= _ROUNDING_M:
        return said
    outside = f"{asked} is outside the room, so {taken} was taken"
    what = said.text.partition(": ")[2]
    if said.outcome is Outcome.REFUSED:
        return replace(said, text=f"Refused: {outside}; {what}")
    code = Code.MOVED_INSIDE if said.outcome is Outcome.DONE else said.code
    return replace(said, outcome=Outcome.CORRECTED, code=code, text=f"Corrected: {outside}; {what}")


def _stopped(report: BodyReport) -> Feedback:
    where = f", at {report.point}" if report.point is not None else ""
    return _feedback(report, f"stopped on request before the end{where}")


def _closer(report: BodyReport) -> str:
    return f"walked {report.walked_m:.2f} m closer; " if report.walked_m >= 0.01 else ""


def _feedback(report: BodyReport, text: str) -> Feedback:
    sentence = f"{report.outcome.capitalize()}: {text}."
    return Feedback(report.outcome, report.code, sentence, report.walked_m, report.stopped_s)


def _refusal(report: BodyReport, unreachable: str, no_spot: str = "") -> Feedback:
    known: dict[str, str] = {
        Code.UNREACHABLE: unreachable,
        Code.NO_FREE_SPOT: no_spot,
        Code.HAND_EMPTY: "your hand is empty",
        Code.HAND_FULL: "your hand is full",
        Code.GONE: "it is not in the room any more",
    }
    # An engine from outside may have reasons of its own.
    reason = report.code.replace("_", " ") or "no reason given"
    why = known.get(report.code) or f"the body cannot do that ({reason})"
    if report.point is not None:
        why = f"{why}; the nearest is at {report.point}"
    return Feedback(Outcome.REFUSED, report.code, f"Refused: {why}.")
