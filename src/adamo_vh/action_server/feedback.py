"""The sentences of feedback: the one place where a `BodyReport` becomes words.

Every sentence starts with the outcome, says what happened, and never reads as success when the
body did something else than asked.
"""

from __future__ import annotations

from adamo_vh.action import Code, Feedback, Outcome
from adamo_vh.engine import BodyReport
from adamo_vh.geometry import Vec3

_WHY = {
    Code.HAND_EMPTY: "your hand is empty",
    Code.NO_FREE_SPOT: "no free, supported spot within 0.5 m of that point",
}


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
    if report.point is None:
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


def dropped(report: BodyReport, tag: str, target: Vec3, support: str) -> Feedback:
    """After Drop at a target; `support` names what the object rests on, in the agent's words."""
    if report.code == Code.CANCELLED:
        return _stopped(report)
    if report.outcome is Outcome.REFUSED or report.point is None:
        return _refusal(report, "no place to stand has that point within reach")
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


def _stopped(report: BodyReport) -> Feedback:
    return _feedback(report, f"stopped on request before the end, at {report.point}")


def _closer(report: BodyReport) -> str:
    return f"walked {report.walked_m:.2f} m closer; " if report.walked_m >= 0.01 else ""


def _feedback(report: BodyReport, text: str) -> Feedback:
    sentence = f"{report.outcome.capitalize()}: {text}."
    return Feedback(report.outcome, report.code, sentence, report.walked_m)


def _refusal(report: BodyReport, unreachable: str) -> Feedback:
    why = _WHY.get(Code(report.code), unreachable)
    if report.point is not None:
        why = f"{why}; the nearest is at {report.point}"
    return Feedback(report.outcome, report.code, f"Refused: {why}.")
