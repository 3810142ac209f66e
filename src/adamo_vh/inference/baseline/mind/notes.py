"""What a note carries over to the next turn, in words: what the messages will not tell again.

A note ends with a sentence in brackets, e.g. ``(Memory, step 3: wish 1: Plate_57 done; wish 2
means 8 (62 %), 37 (41 %))``. Only what is new is said. Now and then a note says
all of it, so that nothing is lost when older messages leave the prompt.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.mind.choosing import thing_of
from adamo_vh.inference.baseline.mind.memory import Job, Memory, Search, Slot, Stand, Status, Thing

_LINE = re.compile(r"\(Memory, step (\d{1,4})(, all)?(?:: (.*))?\)[ \t]*$", re.MULTILINE)
_STATUS = {Status.TODO: "to do", Status.DONE: "done", Status.FAILED: "given up"}
_STATUS_OF = {words: status for status, words in _STATUS.items()}
_SEARCH = {
    Search.NONE: "the wish",
    Search.ROUND: "looking round",
    Search.APPROACH: "going nearer",
    Search.NEARER: "looking closer",
    Search.ASIDE: "freeing the hand",
    Search.ACT: "what was asked",
}
_SEARCH_OF = {words: search for search, words in _SEARCH.items()}
_SLOT = {
    "goal": "wish",
    "place": "the place of wish",
    "second": "the second place of wish",
    "question": "question",
    "seat": "the place of question",
    "quality": "what is said in question",
    "act": "act",
    "if": "condition",
}
_SLOT_OF = {words: kind for kind, words in _SLOT.items()}
_COUNTS = {"views": "looked round", "visits": "went nearer", "aside": "freed the hand",
           "acts": "did what was asked"}  # fmt: skip
_NUMBER = r"-?\d+(?:\.\d+)?"
_POINT = rf"\(({_NUMBER}), ({_NUMBER}), ({_NUMBER})\)"
_PLACE = re.compile(rf"(\S+) {_POINT} ({_NUMBER}) cm3")
_FROM = re.compile(rf"(\S+) {_POINT}")
_STAND = re.compile(rf"{_POINT} facing ({_NUMBER}) deg")
_JOB = re.compile(r"(\S+) (to do|done|given up)(?: after (\d+) tries)?")
_KEPT_FITS = 6
_LEAST_FIT = 0.08
_FITS = re.compile(r"(.+) (\d{1,3}) means (.+)")
_FIT = re.compile(r"(\S+) \((\d{1,3}) %\)")


@dataclass(slots=True)
class Entry:
    """The memory of one note, read."""

    number: int = 0
    """Of the own turn, from 1; 0 if there was none."""
    whole: bool = False
    """Whether it holds all that is known."""
    items: list[str] = field(default_factory=list)

    @property
    def searches(self) -> list[Search]:
        """What each call of the turn did for the search."""
        words = next((i[7:] for i in self.items if i.startswith("called ")), "")
        return [_SEARCH_OF.get(w.strip(), Search.NONE) for w in words.split(",") if w]


def read(note: str) -> Entry:
    """What a note carries."""
    found = _LINE.findall(note[-20000:])
    if not found:
        return Entry()
    number, whole, items = found[-1]
    return Entry(int(number), bool(whole), items.split("; ") if items else [])


def apply(entry: Entry, memory: Memory, told: Collection[str] = ()) -> None:
    """Bring a memory up to what a note says.

    Args:
        entry: Of the note.
        memory: Is changed.
        told: Tags whose places are known better than the note knows them.
    """
    for item in entry.items:
        head, _, rest = item.partition(": ")
        if head == "places":
            _apply_places(rest, memory, told)
        elif fits := _FITS.fullmatch(item):
            _apply_fits(fits[1], int(fits[2]) - 1, fits[3], memory)
        elif found := re.fullmatch(r"wish (\d{1,3})", head):
            for tag, status, tries in _JOB.findall(rest):
                job = Job(int(found[1]) - 1, tag, _STATUS_OF[status], int(tries or 0))
                memory.set_job(job)
        elif rest:
            _apply_words(head, rest, memory)
        else:
            _apply_count(head, memory)


def _apply_count(item: str, memory: Memory) -> None:
    if found := re.fullmatch(r"(.+?) (\d{1,4}) times?", item):
        for name, words in _COUNTS.items():
            if words == found[1]:
                setattr(memory, name, int(found[2]))
    elif item.startswith("hand "):
        memory.hand = item[5:]
    elif item in ("the condition holds", "the condition does not hold"):
        memory.decided = item.endswith("holds")
    elif found := _STAND.search(item):
        stand = Stand(_vec(found.groups()[:3]), math.radians(float(found[4])))
        if item.startswith("began at"):
            memory.began = stand
            memory.home = memory.home or stand
        elif item.startswith("first stood at"):
            memory.home = stand


def _apply_words(head: str, rest: str, memory: Memory) -> None:
    if head == "close-ups":
        memory.inspected.update(rest.split(", "))
    elif head == "came from":
        for tag, *numbers in _FROM.findall(rest):
            memory.came_from[tag] = _vec(numbers)
    elif head == "seen from m":
        for tag, metres in re.findall(rf"([^\s,]+) ({_NUMBER})", rest):
            memory.seen_m[tag] = float(metres)
    else:
        kept = {"taken for": memory.kinds, "looks": memory.looks, "rests": memory.rests}.get(head)
        if kept is not None:
            for words in rest.split(", "):
                tag, _, value = words.partition(" ")
                kept[tag] = value


def _vec(numbers: Iterable[str]) -> Vec3:
    return Vec3.of([float(n) for n in numbers])


def _apply_places(text: str, memory: Memory, told: Collection[str]) -> None:
    for tag, x, y, z, volume in _PLACE.findall(text):
        if tag not in told:
            memory.things[tag] = thing_of(tag, _vec((x, y, z)), float(volume))


def _apply_fits(slot: str, index: int, words: str, memory: Memory) -> None:
    if slot in _SLOT_OF:
        fits = memory.fits.setdefault((_SLOT_OF[slot], index), {})
        fits.update({tag: int(value) / 100 for tag, value in _FIT.findall(words)})


def things_noted(notes: Iterable[str]) -> dict[str, Thing]:
    """All things that notes tell the places of, as the latest of them tell."""
    memory = Memory()
    for note in notes:
        for item in read(note).items:
            head, _, rest = item.partition(": ")
            if head == "places":
                _apply_places(rest, memory, ())
    return memory.things


def write(
    memory: Memory,
    before: Memory,
    places: Collection[str],
    groups: Collection[Slot],
    distances: Collection[str],
    head: Entry,
) -> str:
    """The sentence that tells a reader of ``before`` what ``memory`` has more.

    Args:
        memory: What is known.
        before: What the other messages of the next prompt tell; empty to say all.
        places: Tags whose places must be told.
        groups: Slots that compare many things, so that all fits count.
        distances: Tags of which it counts from how near they were seen.
        head: Number, and what the calls are for.
    """
    parts = list(head.items)
    if head.whole:
        parts += _all(memory)
    elif memory.began and before.began != memory.began:
        parts.append(f"began at {_stand(memory.began)}")
    if memory.decided is not None and (head.whole or before.decided is None):
        parts.append(f"the condition {'holds' if memory.decided else 'does not hold'}")
    known = [memory.things[tag] for tag in sorted(places) if tag in memory.things]
    parts += _joined("places", [f"{t.tag} {_exact(t.position)} {t.volume_cm3:.1f} cm3"
                                for t in known])  # fmt: skip
    parts += _jobs(memory, before)
    parts += _fits(memory, before, groups)
    parts += _joined("seen from m", [f"{t} {memory.seen_m[t]:.1f}" for t in distances])
    for name, kept, old in (
        ("taken for", memory.kinds, before.kinds),
        ("looks", memory.looks, before.looks),
    ):
        parts += _joined(name, [f"{t} {value}" for t, value in kept.items() if old.get(t) != value])
    parts += _joined("close-ups", sorted(memory.inspected - before.inspected))
    words = f": {'; '.join(parts)}" if parts else ""
    return f"(Memory, step {head.number}{', all' if head.whole else ''}{words})"


def called(moves: Iterable[Search]) -> list[str]:
    """What the calls of a turn are for; nothing if all of them are for the wish."""
    words = [_SEARCH[search] for search in moves]
    return [f"called {', '.join(words)}"] if set(words) != {_SEARCH[Search.NONE]} else []


def _all(memory: Memory) -> list[str]:
    parts = []
    for name, words in _COUNTS.items():
        if count := getattr(memory, name):
            parts.append(f"{words} {count} time{'s' if count > 1 else ''}")
    parts += [f"hand {memory.hand}"] if memory.hand else []
    parts += [f"began at {_stand(memory.began)}"] if memory.began else []
    if memory.home and memory.home != memory.began:
        parts.append(f"first stood at {_stand(memory.home)}")
    parts += _joined("rests", [f"{tag} {on}" for tag, on in memory.rests.items()])
    origins = [f"{tag} {_exact(place)}" for tag, place in memory.came_from.items()]
    return parts + _joined("came from", origins)


def _stand(stand: Stand) -> str:
    return f"{stand.position} facing {round(math.degrees(stand.heading_rad)) % 360} deg"


def _exact(p: Vec3) -> str:
    return f"({p.x:.3f}, {p.y:.3f}, {p.z:.3f})"


def _jobs(memory: Memory, before: Memory) -> list[str]:
    known = set(before.jobs)
    by_goal: dict[int, list[str]] = {}
    for job in memory.jobs:
        if job not in known:
            tries = f" after {job.tries} tries" if job.tries else ""
            by_goal.setdefault(job.goal, []).append(f"{job.tag} {_STATUS[job.status]}{tries}")
    return [f"wish {goal + 1}: {', '.join(words)}" for goal, words in by_goal.items()]


def _fits(memory: Memory, before: Memory, groups: Collection[Slot]) -> list[str]:
    parts: list[str] = []
    for slot in sorted(memory.fits):
        kind, index = slot
        kept = _kept_fits(memory, slot, slot in groups)
        old = before.fits.get(slot, {})
        changed = [
            f"{tag} ({round(fit * 100)} %)"
            for tag, fit in sorted(memory.fits[slot].items(), key=lambda item: -item[1])
            if round(old.get(tag, 0.0) * 100) != round(fit * 100)
            and (tag in kept or old.get(tag, 0.0) >= _LEAST_FIT)
        ]
        parts += [f"{_SLOT[kind]} {index + 1} means {', '.join(changed)}"] if changed else []
    return parts


def _kept_fits(memory: Memory, slot: Slot, is_group: bool) -> set[str]:
    """The fits that still matter: those of the chosen, or of all who may be chosen."""
    kind, goal = slot
    best = sorted(memory.fits[slot].items(), key=lambda item: (-item[1], item[0]))
    likely = [tag for tag, fit in best if fit >= _LEAST_FIT]
    if kind not in ("goal", "place", "second"):
        return set(likely if is_group else likely[:_KEPT_FITS])
    chosen = {job.tag for job in memory.jobs if job.goal == goal}
    if not chosen:
        return set(likely if is_group else likely[:_KEPT_FITS])
    if kind == "goal":
        return chosen
    return set([tag for tag in likely if tag not in chosen][:1])


def _joined(head: str, words: Collection[str] | Mapping[str, object]) -> list[str]:
    return [f"{head}: {', '.join(words)}"] if words else []
