"""How an episode is set up: every setting once, parsed and checked before anything starts."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypedDict, TypeVar, Unpack

from adamo_vh.benchmark.tasks import Task, builtin_tasks, check_id
from adamo_vh.benchmark.tasks import task as find_task
from adamo_vh.cognition.budget import Budget
from adamo_vh.cognition.profile import PAPER, Profile
from adamo_vh.cognition.profile import profile as find_profile
from adamo_vh.engine import MOST_VARIATIONS
from adamo_vh.errors import ConfigError
from adamo_vh.inference.model import Sampling
from adamo_vh.perception import Labeling, Tagger, TextForm
from adamo_vh.record.termination import Limits

_E = TypeVar("_E", Labeling, TextForm)


class Settings(TypedDict, total=False):
    """The settings as people write them; what they mean stands at `EpisodeConfig`."""

    task: str | Task | None
    """Id of a built-in task, path of a task file, or a task."""
    scene: str
    figure: str
    labeling: str | Tagger
    """"sem", "opaq", or an own one, which is handed to the session beside this."""
    tool_calls: str
    profile: str | Profile
    switches: Mapping[str, Any] | None
    """Single switches of the profile, set otherwise."""
    seed: int
    variation: int
    k: int
    grid: int
    resolution: str | tuple[int, int]
    """Width and height in pixels, or WIDTHxHEIGHT."""
    text_form: str | TextForm
    added_tools: Sequence[str]
    sampling: Sampling | None
    limits: Limits | None
    budget: Budget | None


class AllSettings(Settings, total=False):
    """The settings with the model, where it is named by its URI."""

    model: str


@dataclass(frozen=True, slots=True)
class EpisodeConfig:
    """Everything that decides how an episode goes; the defaults are the paper's baseline."""

    instruction: str
    """What the agent is told."""
    task: str | None = None
    """Id of the task that the instruction comes from; decides the checker."""
    scene: str = "s1"
    """Built-in scene or path of a scene file."""
    figure: str = "mara"
    """Who the virtual human is; seen in frames where the body is in view."""
    labeling: Labeling = Labeling.SEM
    model: str = "baseline"
    """Model URI."""
    tool_calls: str = "auto"
    """How a remote model is asked for its calls: "auto", "native", "schema" or "react"."""
    profile: Profile = PAPER
    seed: int = 0
    """Of every draw that a model or noise makes."""
    variation: int = 0
    """Of the scene's layout; 0 is the scene as it is."""
    k: int = 50
    """Steps in the short-term memory."""
    grid: int = 6
    """Reference points along each side of the frame."""
    resolution: tuple[int, int] = (1920, 1080)
    """Width and height of the frames in pixels."""
    text_form: TextForm = TextForm.FULL
    added_tools: tuple[str, ...] = ()
    """Further tools, by the names under which other packages offer them."""
    sampling: Sampling = field(default=Sampling())
    limits: Limits = field(default=Limits())
    budget: Budget = field(default=Budget())
    own_task: Task | None = None
    """The task, if it is no built-in one: so the record holds all that it is scored by."""

    def __post_init__(self) -> None:
        """Refuse what no episode can be played with."""
        if not (isinstance(self.instruction, str) and self.instruction.strip()):
            raise ConfigError("The instruction is empty; say what to do, or name a --task.")
        width, height = (_whole("resolution", size) for size in self.resolution)
        if not (64 <= width <= 7680 and 64 <= height <= 4320):
            raise ConfigError(f"resolution {width}x{height}: use 64x64 up to 7680x4320.")
        if not 0 <= _whole("grid", self.grid) <= 20:
            raise ConfigError(f"grid is {self.grid}: use 0 to 20 reference points a side.")
        if _whole("k", self.k) < 1:
            raise ConfigError(f"k is {self.k}: the memory keeps at least 1 step.")
        if _whole("seed", self.seed) < 0:
            raise ConfigError(f"seed is {self.seed}: use a whole number from 0.")
        if not 0 <= _whole("variation", self.variation) <= MOST_VARIATIONS:
            raise ConfigError(
                f"variation is {self.variation}: use 0, the scene as it is, up to "
                f"{MOST_VARIATIONS}."
            )
        sampling = self.sampling
        for name, most in (("temperature", 2.0), ("top_p", 1.0)):
            value = getattr(sampling, name)
            if not (math.isfinite(value) and 0 <= value <= most):
                raise ConfigError(f"{name} is {value}: use 0 to {most:g}.")
        if _whole("max_tokens", sampling.max_tokens) < 1:
            raise ConfigError(f"max_tokens is {sampling.max_tokens}: use a whole number from 1.")

    @property
    def scored_task(self) -> Task | None:
        """What is scored; None for a free instruction.

        Raises:
            ConfigError: There is no such task.
        """
        if self.own_task is not None or self.task is None:
            return self.own_task
        return find_task(self.task)

    @classmethod
    def of(cls, instruction: str | None = None, **settings: Unpack[AllSettings]) -> EpisodeConfig:
        """Settings as people write them.

        Args:
            instruction: What the agent is told; the task's prompt if left out.
            **settings: By the names of the fields. Texts are read ("opaq", "lean", "960x540"),
                and `switches` change single switches of the profile.

        Raises:
            ConfigError: A setting is unknown or wrong; says what can be used.
        """
        known = AllSettings.__annotations__
        if unknown := sorted(settings.keys() - known.keys()):
            raise ConfigError(f"There is no setting {unknown[0]!r}. Settings: {', '.join(known)}.")
        read: dict[str, Any] = {k: v for k, v in settings.items() if v is not None}
        task = read.pop("task", None)
        if isinstance(task, str):
            task = find_task(task)
        read["added_tools"] = tuple(read.get("added_tools", ()))
        read["profile"] = _profile(read.get("profile", PAPER), read.pop("switches", None))
        labeling = read.pop("labeling", Labeling.SEM)
        if isinstance(labeling, str):
            read["labeling"] = _member(Labeling, labeling, "labeling")
        read["text_form"] = _member(TextForm, read.get("text_form", TextForm.FULL), "text form")
        if isinstance(read.get("resolution"), str):
            read["resolution"] = read_resolution(read["resolution"])
        if task is not None:
            if instruction is not None:
                raise ConfigError("Give an instruction or a task, not both.")
            check_id(task)
            own = None if task in builtin_tasks() else task
            return cls(task.prompt, task=task.id, own_task=own, **read)
        if instruction is None:
            raise ConfigError("Say what to do, or name a task (T1 to T15, or a task file).")
        return cls(instruction, **read)


def read_resolution(text: str) -> tuple[int, int]:
    """WIDTHxHEIGHT as two integers.

    Raises:
        ConfigError: The text has another form.
    """
    match = re.fullmatch(r"([0-9]{1,5})x([0-9]{1,5})", text.strip().lower())
    if match is None:
        raise ConfigError(f"resolution {text!r}: write WIDTHxHEIGHT, for example 1920x1080.")
    return int(match[1]), int(match[2])


def _profile(profile: str | Profile, switches: Mapping[str, Any] | None) -> Profile:
    if isinstance(profile, str):
        return find_profile(profile, switches)
    return replace(profile, **(switches or {}))


def _member(kind: type[_E], value: str, what: str) -> _E:
    """A member of an enumeration by its value, in any case."""
    try:
        return kind(value.lower())
    except ValueError:
        offer = ", ".join(kind)
        raise ConfigError(f"There is no {what} {value!r}. Use one of {offer}.") from None


def _whole(name: str, value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise ConfigError(f"{name} is {value!r}: use a whole number.")
    return value
