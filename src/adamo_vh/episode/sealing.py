"""The result on disk: written with its seal, and signed where somebody answers for it."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from pydantic_core import from_json

from adamo_vh.episode.result import EpisodeResult, record_json, write_record
from adamo_vh.errors import FileError, RecordError
from adamo_vh.files import read_text, write_whole
from adamo_vh.record.digest import SEAL, seal_of
from adamo_vh.record.run_folder import RESULT
from adamo_vh.record.signing import Signer
from adamo_vh.record.trajectory import Trajectory

RUN = "result"
"""What a result's signature is for."""
_MOST_BYTES = 50_000_000


def write_result(folder: Path, result: EpisodeResult, recorded: Trajectory) -> EpisodeResult:
    """Write a result into its run folder, sealed with the files that it rests on.

    Args:
        folder: The run folder; everything else of the record stands in it.
        result: What came of the episode; a seal of before is replaced.
        recorded: Its events.

    Returns:
        The result with its seal, as it was written.

    Raises:
        FileError: It cannot be written.
    """
    # As it will be read back, to the last digit.
    plain = from_json(record_json(result))
    sealed = replace(result, seal=seal_of(folder, recorded, plain))
    write_record(folder, RESULT, sealed)
    return sealed


def read_plain(folder: Path) -> dict[str, Any]:
    """A result as the plain data that its file holds.

    Raises:
        RecordError: There is none, or the file is damaged.
    """
    try:
        told = json.loads(read_text(folder / RESULT, max_bytes=_MOST_BYTES))
    except FileError as error:
        raise RecordError(str(error)) from None
    except (ValueError, RecursionError):
        told = None
    if not isinstance(told, dict):
        raise RecordError(f"{folder / RESULT} is damaged; it is no JSON object.")
    return told


def sealed_digest(folder: Path) -> str:
    """The digest that a run is sealed with; empty if it has none."""
    seal = read_plain(folder).get(SEAL)
    return str(seal.get("digest", "")) if isinstance(seal, dict) else ""


def sign_run(folder: Path, signer: Signer) -> None:
    """Add a signature to a sealed result; one that it bears already is left.

    Raises:
        RecordError: There is no result, or it has no seal.
        FileError: It cannot be written.
    """
    told = read_plain(folder)
    seal = told.get(SEAL)
    if not isinstance(seal, dict) or "digest" not in seal:
        raise RecordError(f"{folder / RESULT} has no digest, and cannot be signed.")
    if seal.get("signature"):
        return
    seal["signature"] = asdict(signer.sign(RUN, str(seal["digest"])))
    text = json.dumps(told, indent=1, ensure_ascii=False)
    write_whole(folder / RESULT, text.encode("utf-8", "replace"), durable=True)
