"""What a report is made of: the episodes of one or several studies, grouped and named once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property

from adamo_vh.analysis.cells import (
    CellRow,
    MeanRow,
    Setting,
    cells,
    in_order,
    means,
    natural,
    setting_of,
)
from adamo_vh.analysis.outcome import Outcome
from adamo_vh.benchmark.tasks import Task, builtin_tasks
from adamo_vh.report.study.table import Chip

STUDY_AXIS = "study"
"""The axis by which several studies are told apart."""
_MOST_CHIPS = 90
_LONGEST = 30

Place = tuple[Setting, str, str]
"""A setting, a scene and a labeling."""


@dataclass(frozen=True, slots=True)
class Source:
    """One study that is reported."""

    name: str
    """Told to people, and unlike those of the others."""
    outcomes: tuple[Outcome, ...]
    planned: int
    """Episodes that it is to have."""
    damaged: Mapping[str, str] = field(default_factory=dict)
    """What is wrong with records that cannot be read, by the key of their episode."""
    distances: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    """Calls that were left to do at the start and after each step, by key: of failed episodes."""
    pages: Mapping[str, str] = field(default_factory=dict)
    """Where an episode's page is, as a link, by key."""


@dataclass(frozen=True)
class Material:
    """The episodes of a report, and everything that several sections ask of them."""

    title: str
    sources: tuple[Source, ...]
    outcomes: tuple[Outcome, ...]
    """Of all studies; several are told apart by the axis `STUDY_AXIS`."""
    distances: Mapping[str, tuple[int, ...]]
    pages: Mapping[str, str]

    @classmethod
    def of(cls, title: str, sources: Sequence[Source]) -> Material:
        """Put studies side by side.

        Args:
            title: Of the report.
            sources: At least one.
        """
        several = len(sources) > 1
        outcomes: list[Outcome] = []
        distances: dict[str, tuple[int, ...]] = {}
        pages: dict[str, str] = {}
        for source in sources:
            lead = f"{source.name}: " if several else ""
            for outcome in source.outcomes:
                axes = {STUDY_AXIS: source.name, **outcome.axes} if several else outcome.axes
                outcomes.append(replace(outcome, key=lead + outcome.key, axes=axes))
            distances |= {lead + key: found for key, found in source.distances.items()}
            pages |= {lead + key: link for key, link in source.pages.items()}
        return cls(title, tuple(sources), in_order(outcomes), distances, pages)

    @cached_property
    def cells(self) -> tuple[CellRow, ...]:
        """The figures of every cell."""
        return cells(self.outcomes)

    @cached_property
    def means(self) -> tuple[MeanRow, ...]:
        """The figures of every setting, and by scene, labeling and family."""
        return means(self.outcomes)

    @cached_property
    def settings(self) -> tuple[Setting, ...]:
        """What is never averaged over, in order."""
        return tuple(dict.fromkeys(row.setting for row in self.cells))

    @cached_property
    def scenes(self) -> tuple[str, ...]:
        """Scenes that were played in."""
        return _distinct(outcome.scene for outcome in self.outcomes)

    @cached_property
    def labelings(self) -> tuple[str, ...]:
        """Labelings that were used."""
        return _distinct(outcome.labeling for outcome in self.outcomes)

    @cached_property
    def tasks(self) -> tuple[str, ...]:
        """Tasks that were set."""
        return _distinct(outcome.task for outcome in self.outcomes)

    @cached_property
    def by_cell(self) -> Mapping[tuple[Setting, str, str, str], tuple[Outcome, ...]]:
        """The episodes of each cell, by setting, scene, labeling and task."""
        found: dict[tuple[Setting, str, str, str], list[Outcome]] = {}
        for o in self.outcomes:
            found.setdefault((setting_of(o), o.scene, o.labeling, o.task), []).append(o)
        return {key: tuple(group) for key, group in found.items()}

    @cached_property
    def _names(self) -> Mapping[Setting, str]:
        return names(self.settings)

    def name(self, setting: Setting) -> str:
        """A setting in as few words as tell it apart from the others."""
        return self._names[setting]

    def tone(self, setting: Setting) -> int:
        """The number of its colour."""
        return self.settings.index(setting)

    def episodes(self, setting: Setting) -> tuple[Outcome, ...]:
        """All episodes of a setting."""
        return tuple(o for o in self.outcomes if setting_of(o) == setting)

    def mean(self, setting: Setting, **where: str) -> MeanRow | None:
        """The mean of a setting: over all, or of a scene, labeling or family."""
        for row in self.means:
            if row.setting == setting and dict(zip(row.by, row.values, strict=True)) == where:
                return row
        return None

    def cell(self, setting: Setting, scene: str, labeling: str, task: str) -> CellRow | None:
        """One cell; None if it was not played."""
        return self._cells_by_place.get((setting, scene, labeling, task))

    @cached_property
    def _cells_by_place(self) -> Mapping[tuple[Setting, str, str, str], CellRow]:
        return {(row.setting, row.scene, row.labeling, row.task): row for row in self.cells}

    def short(self, labeling: str, scene: str) -> str:
        """A labeling and a scene in the name of a file: in words, or else by their numbers."""
        words = f"{labeling}-{scene}"
        if words.isascii() and words.replace("-", "").isalnum() and len(words) < _LONGEST:
            return words.lower()
        return f"{self.labelings.index(labeling)}-{self.scenes.index(scene)}"

    def link(self, setting: Setting, scene: str = "", labeling: str = "", task: str = "") -> str:
        """Where on the page the episodes of a setting, or of a part of it, are listed."""
        return f"#{self.anchor(setting, scene, labeling, task)}"

    def anchor(self, setting: Setting, scene: str = "", labeling: str = "", task: str = "") -> str:
        """The name of that place; as exact as scene, labeling and task are all told."""
        name = f"e{self.tone(setting)}"
        if not (scene and labeling):
            return name
        name += f"-{self.labelings.index(labeling)}-{self.scenes.index(scene)}"
        return f"{name}-{self.tasks.index(task)}" if task else name

    def chips(self, outcomes: Iterable[Outcome]) -> tuple[tuple[Chip, ...], int]:
        """Marks for some episodes, and how many have none because there are too many."""
        found = tuple(outcomes)
        shown = tuple(
            Chip(_told(one), one.completion, self.pages.get(one.key, ""))
            for one in found[:_MOST_CHIPS]
        )
        return shown, len(found) - len(shown)


@cache
def builtin_task(name: str) -> Task | None:
    """One of the paper's tasks; None for any other."""
    return next((task for task in builtin_tasks() if task.id == name), None)


def names(settings: Sequence[Setting]) -> dict[Setting, str]:
    """Settings in as few words as tell them apart."""
    axes = _distinct(name for setting in settings for name, _ in setting.axes)
    varied = [axis for axis in axes if len({dict(s.axes).get(axis) for s in settings}) > 1]
    last = {axis: axis.rpartition(".")[2] for axis in varied}
    words = last if len({*last.values()}) == len(last) else {axis: axis for axis in varied}
    several_profiles = len({setting.profile for setting in settings}) > 1
    called, with_study = {}, {}
    for setting in settings:
        values = dict(setting.axes)
        parts = [setting.model]
        parts += [setting.profile] if several_profiles else []
        parts += [f"{words[a]}={values[a]}" for a in varied if a != STUDY_AXIS and a in values]
        called[setting] = ", ".join(parts)
        with_study[setting] = ", ".join([values.get(STUDY_AXIS, ""), *parts])
    return called if len(set(called.values())) == len(called) else with_study


def _told(outcome: Outcome) -> str:
    """What came of an episode, in a line."""
    came = "unscored" if outcome.completion is None else f"completion {outcome.completion:.2f}"
    why = outcome.diagnosis_code.replace("_", " ")
    return f"{outcome.key}: {came}{', ' if why else ''}{why}"


def _distinct(values: Iterable[str]) -> tuple[str, ...]:
    return tuple(sorted(set(values), key=natural))


def shown_scene(scene: str) -> str:
    """A scene as the paper writes it."""
    return scene.upper() if scene in ("s1", "s2") else scene


def shown_labeling(labeling: str) -> str:
    """A labeling as the paper writes it."""
    return labeling.upper()
