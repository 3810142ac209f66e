"""A diagnosis as data: the paper's class, a fine code, and what shows it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from pydantic import TypeAdapter, ValidationError

from adamo_vh.errors import FileError, RecordError
from adamo_vh.files import read_json

DIAGNOSIS = "diagnosis.json"
"""Name of its file in a run folder."""


class FailureClass(StrEnum):
    """The paper's three failure modes, and protocol failures apart from them."""

    PERCEPTUAL = "perceptual"
    """The wrong object or place, or one that was never found."""
    EXECUTION = "execution"
    """The right intent, but refused, corrected, misplaced or ended too early."""
    REASONING = "reasoning"
    """Wrong order, something that was not asked, a goal that was forgotten, a loop."""
    PROTOCOL = "protocol"
    """No valid call came."""


class Code(StrEnum):
    """What exactly went wrong."""

    WRONG_OBJECT = "wrong_object"
    WRONG_ANCHOR = "wrong_anchor"
    NEVER_FOUND = "never_found"
    NOT_RECOGNISED = "not_recognised"
    UNKNOWN_TAG = "unknown_tag"

    REFUSED = "refused"
    WRONG_SUPPORT = "wrong_support"
    TOO_FAR = "too_far"
    OUTSIDE_AREA = "outside_area"
    NOT_RELEASED = "not_released"
    FALSE_CLAIM = "false_claim"
    GAVE_UP = "gave_up"
    RAN_OUT = "ran_out"
    UNSOUND_PLACE = "unsound_place"

    WRONG_ORDER = "wrong_order"
    WRONG_ROLE = "wrong_role"
    EXTRA_GOAL = "extra_goal"
    PUT_BACK = "put_back"
    GOAL_FORGOTTEN = "goal_forgotten"
    LOOP = "loop"
    NO_PROGRESS = "no_progress"

    UNREADABLE = "unreadable"
    EMPTY = "empty"
    CUT_OFF = "cut_off"
    FILTERED = "filtered"
    UNKNOWN_TOOL = "unknown_tool"
    BAD_ARGUMENTS = "bad_arguments"
    NO_CALL = "no_call"

    @property
    def failure_class(self) -> FailureClass:
        """The class that it belongs to."""
        return next(kind for kind, codes in CODES.items() if self in codes)

    @property
    def meaning(self) -> str:
        """What it means, in a sentence."""
        return CODES[self.failure_class][self]


CODES: Mapping[FailureClass, Mapping[Code, str]] = MappingProxyType(
    {
        FailureClass.PERCEPTUAL: {
            Code.WRONG_OBJECT: "Another object was taken in place of the one that was asked for.",
            Code.WRONG_ANCHOR: "It was put beside another object than the one that was named.",
            Code.NEVER_FOUND: "The object was in no view that the agent got.",
            Code.NOT_RECOGNISED: "The object was in view, and the agent did not know it for it.",
            Code.UNKNOWN_TAG: "The agent named an object that does not exist.",
        },
        FailureClass.EXECUTION: {
            Code.REFUSED: "The right thing was tried and refused, and not mended.",
            Code.WRONG_SUPPORT: "It was put on another surface than the one that was asked for.",
            Code.TOO_FAR: "It was put on the right surface, too far from what was named.",
            Code.OUTSIDE_AREA: "It was put on the floor, outside the area that was asked for.",
            Code.NOT_RELEASED: "It was taken and never put down.",
            Code.FALSE_CLAIM: "The agent ended too early and said that all was done.",
            Code.GAVE_UP: "The agent ended too early, and did not say that all was done.",
            Code.RAN_OUT: "A limit ended the episode while it was still on its way.",
            Code.UNSOUND_PLACE: "All was done, but something overlaps or floats.",
        },
        FailureClass.REASONING: {
            Code.WRONG_ORDER: "Steps came in an order in which they cannot be done, or not asked.",
            Code.WRONG_ROLE: "What was to stay was moved, in place of what was to be moved.",
            Code.EXTRA_GOAL: "Something was done that was not asked.",
            Code.PUT_BACK: "It was done, and then put back where it came from.",
            Code.GOAL_FORGOTTEN: "A part of the instruction was never named nor tried.",
            Code.LOOP: "The same steps were done over and over.",
            Code.NO_PROGRESS: "The agent knew the object, and went on without getting closer.",
        },
        FailureClass.PROTOCOL: {
            Code.UNREADABLE: "Replies could not be read as a call or an answer.",
            Code.EMPTY: "Replies were empty.",
            Code.CUT_OFF: "Replies were cut off before their end.",
            Code.FILTERED: "Replies were refused by a filter of the provider.",
            Code.UNKNOWN_TOOL: "Calls named a tool that does not exist.",
            Code.BAD_ARGUMENTS: "Calls had arguments that are none.",
            Code.NO_CALL: "No call ever came, only text.",
        },
    }
)
"""Every code with its class and its meaning."""


@dataclass(frozen=True, slots=True)
class Evidence:
    """One fact that shows it."""

    step: int
    """After which step; 0 is the start."""
    text: str
    frame: str = ""
    """File name of a picture in `frames/`; empty if none shows it."""
    box_px: tuple[int, int, int, int] | None = None
    """What to look at in the picture: left, top, right, bottom."""


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """Why an episode failed; or that it did not, or that nobody can say."""

    class_: FailureClass | None
    """None if nothing failed, or if nothing was scored."""
    code: Code | None
    summary: str
    """In a few sentences: what was asked, what happened, where it went wrong."""
    evidence: tuple[Evidence, ...] = ()
    """In the order in which it is told: what went wrong first, then what shows it."""
    distance: tuple[int, ...] = ()
    """Least number of calls to done, at the start and after each step."""
    left_path: int | None = None
    """First step after which more was left to do than before; None if there was none."""

    def json(self) -> dict[str, Any]:
        """As plain data, as the file and the command line give it."""
        data: dict[str, Any] = _codec().dump_python(self, mode="json")
        return {"class": data.pop("class_"), **data}


@cache
def _codec() -> TypeAdapter[Diagnosis]:
    return TypeAdapter(Diagnosis)


def read_diagnosis(data: Mapping[str, Any]) -> Diagnosis:
    """The diagnosis that `Diagnosis.json` gave.

    Raises:
        RecordError: The data is none.
    """
    try:
        return _codec().validate_python({**data, "class_": data.get("class")})
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "data"
        raise RecordError(f"A diagnosis cannot be read: {where}: {first['msg']}") from None


def load_diagnosis(folder: Path) -> Diagnosis | None:
    """The diagnosis that is kept in a run folder; None if none was made.

    Raises:
        RecordError: The file is damaged.
    """
    path = folder / DIAGNOSIS
    if not path.exists():
        return None
    try:
        data = read_json(path)
    except FileError as error:
        raise RecordError(str(error)) from None
    if not isinstance(data, dict):
        raise RecordError(f"{path} is damaged: it is no JSON object.")
    return read_diagnosis(data)
