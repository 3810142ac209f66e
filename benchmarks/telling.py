"""A played episode in lines, for a reader who is to say why it failed.

What was asked, each call with what is true of it and what came back, what of the task was in view,
what the player concluded, and how it ended. Looks and walks in a row are told together.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from benchmarks.labelled import Labelled

from adamo_vh.benchmark.tasks import task as find_task
from adamo_vh.episode.result import EpisodeResult
from adamo_vh.perception import Labeling
from adamo_vh.record.trajectory import Acted, Ended, Observed, read_trajectory

_ROAMING = ("Look", "Walk")


def told(episode: Labelled, result: EpisodeResult, folder: Path) -> Iterator[str]:
    """An episode in lines.

    Args:
        episode: Which one.
        result: What came of it.
        folder: Its run folder.
    """
    yield f"\n### {episode.name} {episode.code}"
    yield f"  {result.instruction}"
    teller = _Teller(episode, {item.id: item.class_name for item in result.final.objects})
    for event in read_trajectory(folder).events:
        match event:
            case Observed():
                teller.look(event)
            case Acted(name=name) if name in _ROAMING:
                teller.roam(event)
            case Acted():
                yield from teller.between()
                yield from teller.act(event)
            case Ended():
                yield from teller.between()
                yield f'  ended: {event.reason} {event.why} "{event.answer}"'
            case _:
                pass
    for condition in result.conditions:
        yield f"  {'met ' if condition.satisfied else 'OPEN'} {condition.text}"
    for thing in result.world():
        if thing.id in teller.asked:
            place, at = "in the hand" if thing.held else f"on {thing.support}", thing.position
            where = f"({at.x:.2f}, {at.y:.2f}, {at.z:.2f})"
            yield f"  {thing.class_name}_{thing.id} {place}, {where}"
    yield from (f"  besides: {violation}" for violation in result.violations)


class _Teller:
    """Gathers looks and walks until something else happens."""

    def __init__(self, episode: Labelled, names: Mapping[int, str]) -> None:
        self.asked = sorted(find_task(episode.task).objects)
        self._names, self._episode = names, episode
        self._labeling = Labeling(episode.labeling)
        self._roamed: list[Acted] = []
        self._views: list[Observed] = []

    def look(self, view: Observed) -> None:
        self._views.append(view)

    def roam(self, act: Acted) -> None:
        self._roamed.append(act)

    def between(self) -> Iterator[str]:
        """What was walked, looked at and seen since the last other call."""
        if self._roamed:
            kinds = Counter(act.name for act in self._roamed)
            calls = ", ".join(f"{name} {number}" for name, number in kinds.items())
            yield f"  {self._roamed[0].step}..{self._roamed[-1].step} {calls}"
            notes = Counter(filter(None, map(self._note, self._roamed)))
            yield from (f"      {number} x {note}" for note, number in notes.items())
            odd = Counter(act.feedback.text for act in self._roamed if act.feedback.code != "ok")
            yield from (
                f"      -> {text}" for text in odd if not text.startswith("Done") and len(odd) < 4
            )
        if self._views:
            sizes: dict[int, list[int]] = {number: [] for number in self.asked}
            for view in self._views:
                for item in view.objects:
                    number = self._labeling.resolve(item.tag, self._names)
                    if number is not None and number in sizes:
                        sizes[number].append(item.pixels)
            seen = ", ".join(
                f"{self._names.get(number, '?')}_{number} "
                + (f"in {len(px)} (to {max(px)} px)" if px else "NOT")
                for number, px in sizes.items()
            )
            yield f"      {len(self._views)} views, last {self._views[-1].frame[:6]}: {seen}"
        self._roamed, self._views = [], []

    def act(self, act: Acted) -> Iterator[str]:
        """One other call."""
        arguments = dict(act.arguments or {})
        values = ", ".join(map(str, arguments.values()))
        truth = ""
        if self._labeling is Labeling.OPAQ:
            number = self._labeling.resolve(str(arguments.get("object", "")), self._names)
            truth = f" = {self._names.get(number, '?')}" if number is not None else ""
        yield f"  {act.step} {act.name}({values}){truth} -> {act.feedback.text}"
        if note := self._note(act):
            yield f"      {note}"

    def _note(self, act: Acted) -> str:
        """What the player concluded; the lots of `random` conclude nothing."""
        reply: Mapping[str, Any] = self._episode.replies[
            min(act.step, len(self._episode.replies)) - 1
        ]
        found = re.search(r"Conclusion: (.*?) Next:", str(reply.get("note", "")))
        return found[1] if found and "any valid call" not in found[1] else ""
