"""The episode page: one HTML file that shows a whole episode and opens without a network.

Notes, answers and feedback are what an untrusted model said: everything is made readable and
escaped, and the page forbids itself every script but its own.
"""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeVar

from markupsafe import Markup

from adamo_vh.analysis.diagnosis.finding import Diagnosis, load_diagnosis
from adamo_vh.cognition.budget import Budget
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import (
    EpisodeResult,
    Manifest,
    read_manifest,
    read_result,
)
from adamo_vh.errors import AdamoError, FileError, RecordError
from adamo_vh.files import data_url, write_whole
from adamo_vh.perception import Labeling
from adamo_vh.record.run_folder import FRAMES
from adamo_vh.record.trajectory import Ended, Trajectory, frame_type, read_trajectory
from adamo_vh.report.exchanges import exchanges
from adamo_vh.report.failure import facts
from adamo_vh.report.floor_plan import FloorPlan, floor_plan
from adamo_vh.report.summary import KINDS, Account, ending, verdict
from adamo_vh.report.templating import csp_hash, environment, template_text
from adamo_vh.report.timeline import ShownTurn, turns
from adamo_vh.report.whereabouts import followed

PAGE = "episode.html"
"""Name of the page in a run folder."""

_T = TypeVar("_T")


def write_page(folder: Path) -> Path:
    """Draw the page of a run folder, from its records alone; an old page is replaced.

    A damaged record costs what it held and no more: the page shows the rest, the score above all,
    and says in a line what is missing.

    Args:
        folder: The run folder; the episode may be unfinished.

    Returns:
        The page.

    Raises:
        RecordError: The folder holds no readable run.
        FileError: The page cannot be written.
    """
    missing: list[str] = []
    damaged: list[str] = []

    def miss(text: str) -> None:
        # A page is passed on; where it was made is nobody's business.
        line = text.replace(f"{folder}{os.sep}", "")
        missing.append(line.replace(str(folder), "The folder"))

    def read(part: Callable[[Path], _T], otherwise: Callable[[], _T]) -> _T:
        try:
            return part(folder)
        except (RecordError, FileError) as error:
            miss(str(error))
            return otherwise()

    result = read(read_result, lambda: None)
    manifest = read_manifest(folder) if result is None else read(read_manifest, lambda: None)
    trajectory = read(lambda path: read_trajectory(path, damaged), Trajectory)
    if damaged:
        more = f" ({len(damaged) - 1} more lines are)" if len(damaged) > 1 else ""
        miss(f"{damaged[0]}{more} The steps on it are left out.")
    page = render_page(
        manifest or _recovered(result),
        trajectory,
        result,
        lambda name: (folder / FRAMES / name).read_bytes(),
        missing,
        read(load_diagnosis, lambda: None),
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


def _recovered(result: EpisodeResult | None) -> Manifest:
    """A manifest of what a result tells, where the file is lost; its version is unknown."""
    assert result is not None
    config = EpisodeConfig(
        result.instruction, result.task, result.scene, labeling=result.labeling, seed=result.seed
    )
    model, kind, initial = result.model, result.model_kind, result.final
    return Manifest(config, model, kind, {}, "", initial, labeling=result.own_labeling)


def render_page(
    manifest: Manifest,
    trajectory: Trajectory,
    result: EpisodeResult | None,
    frames: Callable[[str], bytes],
    missing: Sequence[str] = (),
    diagnosis: Diagnosis | None = None,
) -> str:
    """Render the page of an episode.

    Args:
        manifest: How the episode was set up.
        trajectory: What happened.
        result: What came of it; None if it did not get that far.
        frames: Gives a recorded picture by its name. A picture that it fails to find (`OSError`,
            `LookupError`) is shown as missing.
        missing: What of the record could not be read, a line each.
        diagnosis: Why it failed; None if that was not asked.

    Returns:
        A complete HTML document without any reference to the outside.
    """
    config, initial = manifest.config, manifest.initial
    steps = turns(trajectory)
    asked = exchanges(steps, config.instruction, initial, config.labeling)
    ended = trajectory.ended or (_ended(result) if result and not steps else None)
    style = template_text("palette.css") + template_text("episode.css")
    script = template_text("episode.js")
    return (
        environment()
        .get_template("episode.html.j2")
        .render(
            config=config,
            labeling=manifest.labeling or config.labeling.value.upper(),
            manifest=manifest,
            events=trajectory,
            ended=ended,
            verdict=verdict(manifest, ended, result),
            result=result,
            missing=missing,
            account=Account.of(trajectory, result),
            turns=steps,
            exchanges=asked,
            caps=_caps(config.budget),
            ending=lambda ended: ending(config.limits, ended),
            kind=KINDS[manifest.model_kind],
            plan=_plan(manifest, trajectory, steps, result),
            named=_naming(manifest),
            diagnosis=diagnosis,
            facts=facts(diagnosis, steps, _checked(frames)) if diagnosis else (),
            crop=_jpeg_url,
            picture=lambda name: _data_url(name, frames),
            style=Markup(style),  # Ours, and named by its hash in the page's policy.
            script=Markup(script),
            style_hash=csp_hash(style),
            script_hash=csp_hash(script),
        )
    )


def _plan(
    manifest: Manifest,
    trajectory: Trajectory,
    steps: Sequence[ShownTurn],
    result: EpisodeResult | None,
) -> FloorPlan | None:
    """The map; None if nobody knows how the room was at the start."""
    if not manifest.versions:
        return None
    told = followed(trajectory.acts)
    return floor_plan(manifest.initial, steps, result.final if result else None, told)


def _ended(result: EpisodeResult) -> Ended:
    """How an episode ended whose events are lost."""
    seconds = result.model_s + result.world_s
    return Ended(
        result.steps, result.termination, result.answer, result.state_hash, seconds, result.why
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
    kind = frame_type(name)
    if not kind:
        return None
    try:
        data = frames(name)
    except (OSError, LookupError):
        return None
    return data_url(kind, data)


def _jpeg_url(data: bytes) -> str:
    return data_url("image/jpeg", data)


def _checked(frames: Callable[[str], bytes]) -> Callable[[str], bytes]:
    """The same pictures; a name that is none of a picture names nothing."""

    def frame(name: str) -> bytes:
        if not frame_type(name):
            raise LookupError(name)
        return frames(name)

    return frame
