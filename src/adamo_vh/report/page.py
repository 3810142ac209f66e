"""The episode page: one HTML file that shows a whole episode and opens without a network.

Notes, answers and feedback are what an untrusted model said: everything is escaped, and the page
forbids itself every script but its own.
"""

from __future__ import annotations

import base64
import hashlib
import math
import re
import warnings
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING

from adamo_vh.cognition.budget import Budget
from adamo_vh.episode.result import (
    EpisodeResult,
    Manifest,
    read_manifest,
    read_result,
    total_cost,
)
from adamo_vh.errors import AdamoError
from adamo_vh.files import write_whole
from adamo_vh.geometry import Vec3
from adamo_vh.inference.model import Usage
from adamo_vh.perception import Labeling
from adamo_vh.record.run_folder import FRAMES
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import Ended, Thought, Trajectory, read_trajectory
from adamo_vh.report.floor_plan import MARGIN_M, floor_plan
from adamo_vh.report.timeline import turns

if TYPE_CHECKING:
    from jinja2 import Environment

PAGE = "episode.html"
"""Name of the page in a run folder."""

_FRAME_NAME = re.compile(r"[0-9a-f]{8,64}\.(jpg|png)")
"""A recorded name must not lead out of the folder: what it names is put into the page."""
_ENDINGS = {
    TerminationReason.ANSWERED: ("ended", "Answered", "The model ended the episode."),
    TerminationReason.EMPTY_REPLY: (
        "truncated",
        "Empty reply",
        "The model said nothing, also after a reminder.",
    ),
    TerminationReason.PROTOCOL: (
        "truncated",
        "Unreadable",
        "{limits.max_unreadable} answers in a row could not be read.",
    ),
    TerminationReason.LOOP: (
        "truncated",
        "Loop",
        "Stopped: {limits.max_repeats} times the same call into the same state, or no call.",
    ),
    TerminationReason.BUDGET: (
        "truncated",
        "Budget",
        "Stopped: the budget of the episode is used up.",
    ),
    TerminationReason.STEP_LIMIT: (
        "truncated",
        "Step limit",
        "Stopped after {limits.max_steps} steps.",
    ),
    TerminationReason.TIME_LIMIT: (
        "truncated",
        "Time limit",
        "Stopped after {limits.max_seconds:g} s.",
    ),
    TerminationReason.RUN_BUDGET: (
        "broken",
        "Unscored",
        "The budget of the whole run was used up; the episode does not count.",
    ),
    TerminationReason.BROKEN: (
        "broken",
        "Unscored",
        "The episode broke through a fault that is not the model's; it does not count.",
    ),
}
_MEDIA_TYPE = {"jpg": "image/jpeg", "png": "image/png"}


def write_page(folder: Path) -> Path:
    """Draw the page of a run folder, from its records alone; an old page is replaced.

    Args:
        folder: The run folder; the episode may be unfinished.

    Returns:
        The page.

    Raises:
        RecordError: The folder holds no readable run.
    """
    page = render_page(
        read_manifest(folder),
        read_trajectory(folder),
        read_result(folder),
        lambda name: (folder / FRAMES / name).read_bytes(),
    )
    return write_whole(folder / PAGE, page.encode("utf-8", "xmlcharrefreplace"))


def try_page(folder: Path) -> None:
    """Draw the page of a run folder; a fault is a warning, because no score is lost for a page."""
    try:
        write_page(folder)
    except Exception as error:
        reason = f"{error}" if isinstance(error, AdamoError) else f"{type(error).__name__}: {error}"
        again = f"once that is mended: adamo-vh report {folder}"
        warnings.warn(f"the page is not drawn: {reason} ({again})", stacklevel=2)


def render_page(
    manifest: Manifest,
    trajectory: Trajectory,
    result: EpisodeResult | None,
    frames: Callable[[str], bytes],
) -> str:
    """Render the page of an episode.

    Args:
        manifest: How the episode was set up.
        trajectory: What happened.
        result: What came of it; None if it did not get that far.
        frames: Gives a recorded picture by its name. A picture that it fails to find (`OSError`,
            `LookupError`) is shown as missing.

    Returns:
        A complete HTML document without any reference to the outside.
    """
    steps = turns(trajectory, manifest.config.profile)
    limits = manifest.config.limits
    style, script = _text("episode.css"), _text("episode.js")
    return (
        _environment()
        .get_template("episode.html.j2")
        .render(
            config=manifest.config,
            manifest=manifest,
            events=trajectory,
            ended=trajectory.ended,
            verdict=_verdict(manifest, trajectory.ended, result),
            result=result,
            calls=dict(sorted(Counter(act.name for act in trajectory.acts).items())),
            account=_account(trajectory.thoughts),
            turns=steps,
            caps=_caps(manifest.config.budget),
            ending=lambda ended: _ending(limits, ended),
            plan=floor_plan(manifest.initial, steps, result.final if result else None),
            plan_margin=MARGIN_M,
            named=_naming(manifest),
            picture=lambda name: _data_url(name, frames),
            style=style,
            script=script,
            style_hash=_csp_hash(style),
            script_hash=_csp_hash(script),
        )
    )


def _verdict(
    manifest: Manifest, ended: Ended | None, result: EpisodeResult | None
) -> tuple[str, str, str]:
    """How the episode ended: a tone for the colour, a headline and a sentence."""
    if ended is None:
        return (
            "unfinished",
            "Not finished",
            "The record has no end: the run was stopped, or it is still going on.",
        )
    if result is None and manifest.config.task and ended.reason.is_scored:
        return "unfinished", "Not scored", "The episode ended, but its result was never written."
    return _ending(manifest.config.limits, ended)


def _ending(limits: Limits, ended: Ended) -> tuple[str, str, str]:
    """How one instruction ended: a tone for the colour, a headline and a sentence."""
    tone, headline, sentence = _ENDINGS[ended.reason]
    return tone, headline, sentence.format(limits=limits)


@dataclass(frozen=True, slots=True)
class _Account:
    """What the model took."""

    usage: Usage
    cost_usd: float | None
    """None if the price of any answer is unknown: an unknown price is not 0."""
    is_estimated: bool
    """Whether no provider counted the tokens."""
    requests: int
    rungs: tuple[str, ...]
    """How calls were asked for."""
    unreadable: int
    """Protocol failures."""


def _account(thoughts: Sequence[Thought]) -> _Account:
    return _Account(
        sum((thought.usage for thought in thoughts), Usage()),
        total_cost(thoughts),
        any(thought.usage.estimated for thought in thoughts),
        sum(thought.requests for thought in thoughts),
        tuple(sorted({thought.rung.value for thought in thoughts if thought.rung})),
        sum(bool(thought.unreadable) for thought in thoughts),
    )


def _caps(budget: Budget) -> str:
    """The caps of an episode in words; empty without any."""
    units = {"tokens": "tokens", "usd": "US dollars", "calls": "model calls", "seconds": "s"}
    caps = {unit: getattr(budget, name) for name, unit in units.items()}
    return ", ".join(f"{cap:,} {unit}" for unit, cap in caps.items() if cap is not None)


def _naming(manifest: Manifest) -> Callable[[str], str]:
    """Puts tags that people can read in place of the bare ids of a condition."""
    names = {
        str(item.id): Labeling.SEM.tag(item.id, item.class_name)
        for item in manifest.initial.objects
    }
    return lambda text: re.sub(r"\b\d+\b", lambda found: names.get(found[0], found[0]), text)


def _data_url(name: str, frames: Callable[[str], bytes]) -> str | None:
    match = _FRAME_NAME.fullmatch(name)
    if match is None:
        return None
    try:
        data = frames(name)
    except (OSError, LookupError):
        return None
    return f"data:{_MEDIA_TYPE[match[1]]};base64,{base64.b64encode(data).decode('ascii')}"


def _csp_hash(text: str) -> str:
    """A source expression that allows exactly this inline text."""
    digest = hashlib.sha256(text.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode('ascii')}'"


def _text(name: str) -> str:
    folder = resources.files(__package__) / "templates"
    return (folder / name).read_text(encoding="utf-8")


@cache
def _environment() -> Environment:
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    environment = Environment(
        loader=FunctionLoader(_text),
        undefined=StrictUndefined,
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(
        place=_place, degrees=_degrees, seconds=_seconds, thousands=_thousands, dollars=_dollars
    )
    return environment


def _place(point: Vec3, digits: int = 2) -> str:
    # Rounding first turns -0.001 into 0.00, never -0.00.
    p = point.rounded(digits)
    return f"({p.x:.{digits}f}, {p.y:.{digits}f}, {p.z:.{digits}f})"


def _degrees(angle_rad: float) -> str:
    return f"{round(math.degrees(angle_rad)) % 360}°"


def _seconds(value: float) -> str:
    if value < 1:
        return f"{value * 1000:.0f} ms"
    return f"{value:.1f} s" if value < 120 else f"{value // 60:.0f} min {value % 60:.0f} s"


def _thousands(value: int) -> str:
    return f"{value:,}"


def _dollars(value: float) -> str:
    return f"${value:.2f}" if value >= 1 else f"${value:.4f}"
