"""Export recorded episodes: the one table of formats, and the folder that takes them whole."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import cast
from uuid import uuid4

from adamo_vh.adapters.exports.form import Form
from adamo_vh.adapters.exports.recorded import Choice, Episode, recorded
from adamo_vh.errors import ConfigError, RecordError
from adamo_vh.files import make_folder, naming

Write = Callable[[Iterable[Episode], Path, Form], int]
"""Writes episodes into a folder; how many they were."""

FORMATS: Mapping[str, str] = {
    "sft": "sft.write_sft",
    "parquet": "parquet.write_parquet",
    "atif": "atif.write_atif",
    "inspect": "inspect_log.write_inspect",
    "rerun": "rrd.write_rrd",
}
"""What writes each format, within this package."""


@dataclass(frozen=True, slots=True)
class Exported:
    """What was written."""

    folder: Path
    episodes: int
    problems: tuple[str, ...]
    """A line for each episode of a study that could not be read and was left out."""


def export(
    runs: Sequence[str | Path],
    to: str,
    out: str | Path,
    *,
    choice: Choice | None = None,
    form: Form | None = None,
    others: Mapping[str, Callable[[], Write]] | None = None,
) -> Exported:
    """Write recorded episodes in the format of another tool; the folder appears when all is there.

    Args:
        runs: Run folders, or folders of studies, of which the scored episodes are taken.
        to: "sft", "parquet", "atif", "inspect" or "rerun".
        out: A new folder.
        choice: Which episodes are wanted; all by default.
        form: How they are written.
        others: Further formats by name, each with what loads its writer.

    Raises:
        ConfigError: The format is unknown, lacks its extra, or the folder is in use.
        RecordError: A run folder is damaged, or there is nothing to export.
        FileError: The folder cannot be written.
    """
    folder = Path(out)
    loads: dict[str, Callable[[], Write]] = {name: partial(_writer, name) for name in FORMATS}
    loads.update(others or {})
    if to.lower() not in loads:
        raise ConfigError(f"There is no format {to!r}. Use one of {', '.join(loads)}.")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise ConfigError(f"{folder} already holds something; name a new folder for the export.")
    write, told = loads[to.lower()](), form or Form()
    problems: list[str] = []
    episodes = recorded(map(Path, runs), choice, problems)
    count = _whole(folder, lambda half: write(episodes, half, told))
    return Exported(folder, count, tuple(problems))


def _writer(to: str) -> Write:
    """What writes one of the formats."""
    module, name = FORMATS[to].split(".")
    return cast(Write, getattr(import_module(f"{__package__}.{module}"), name))


def _whole(folder: Path, write: Callable[[Path], int]) -> int:
    """Write beside a folder and rename: nobody meets half an export."""
    half = make_folder(folder.parent / f".{folder.name}.{uuid4().hex[:8]}.part")
    try:
        count = write(half)
        if not count:
            raise RecordError(
                "There is no episode to export: none has ended with a score, or the filters "
                "leave none over."
            )
        with naming("written", folder):
            if folder.exists():
                folder.rmdir()
            half.rename(folder)
    except BaseException:
        shutil.rmtree(half, ignore_errors=True)
        raise
    return count
