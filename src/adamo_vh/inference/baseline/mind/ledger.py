"""The line in brackets at the end of a note: what could not be read back from the messages.

Only what is new goes into it, in short codes, e.g. ``[#3 v j0:57+ f1:8=62,37=41]``: the third own
turn; its call is a step round the room; the job of goal 0 on object 57 is done; 8 and 37 fit goal 1
by 62 and 41 %. All lines together are the memory. Now and then a line holds all of it (``#3!``), so
that nothing is lost when older messages leave the prompt.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.mind.choosing import thing_of
from adamo_vh.inference.baseline.mind.memory import Job, Memory, Search, Slot, Status, Thing
from adamo_vh.inference.baseline.sight.kinds import prototypes

_LINE = re.compile(r"\[#(\d{1,4})(!?)((?: [^\s\[\]]+)*)\]")
_STATUS = {Status.TODO: "", Status.DONE: "+", Status.FAILED: "-"}
_STATUS_OF = {sign: status for status, sign in _STATUS.items()}
_JOB = re.compile(r"(\S+?)([+-]?)(?:/(\d+))?")
_FIT_KIND = {"f": "goal", "p": "place"}
_KEPT_FITS = 6
_LEAST_FIT = 0.08


@dataclass(slots=True)
class Entry:
    """One line, read."""

    number: int = 0
    """Of the own turn, from 1; 0 if there was no line."""
    whole: bool = False
    """Whether it holds all that is known."""
    codes: list[str] = field(default_factory=list)

    @property
    def searches(self) -> list[Search]:
        """What each call of the turn did for the search."""
        found = next((c[1:] for c in self.codes if re.fullmatch(r"q[vwla.]+", c)), "")
        return [Search("" if letter == "." else letter) for letter in found]


def read(note: str) -> Entry:
    """The last line in a note."""
    lines = _LINE.findall(note)
    if not lines:
        return Entry()
    number, whole, codes = lines[-1]
    return Entry(int(number), bool(whole), codes.split())


def apply(entry: Entry, memory: Memory, names: dict[str, str], told: Collection[str] = ()) -> None:
    """Bring a memory up to what a line says.

    Args:
        entry: The line.
        memory: Is changed.
        names: Tags by their short forms; those that the line introduces are added.
        told: Tags whose places are known better than the line knows them.
    """
    for code in entry.codes:
        head, colon, rest = code.partition(":")
        if not colon:
            _apply_count(head, memory, names)
        elif head == "t":
            _apply_things(rest, memory, names, told)
        elif head == "s":
            for tag, value in _pairs(rest, names):
                memory.seen_m[tag] = int(value) / 10
        elif head == "k":
            _apply_kinds(rest, memory, names)
        elif head == "i":
            memory.inspected.update(names.get(short, short) for short in rest.split(","))
        elif match := re.fullmatch(r"([jfp])(\d{1,3})", head):
            kind, goal = match.group(1), int(match.group(2))
            if kind == "j":
                _apply_jobs(goal, rest, memory, names)
            else:
                fits = memory.fits.setdefault((_FIT_KIND[kind], goal), {})
                fits.update({tag: int(value) / 100 for tag, value in _pairs(rest, names)})


def _apply_count(code: str, memory: Memory, names: Mapping[str, str]) -> None:
    if code.startswith("h"):
        memory.hand = names.get(code[1:], code[1:])
    elif match := re.fullmatch(r"([vca])(\d{1,4})", code):
        name = {"v": "views", "c": "visits", "a": "aside"}[match.group(1)]
        setattr(memory, name, int(match.group(2)))


def _apply_jobs(goal: int, text: str, memory: Memory, names: Mapping[str, str]) -> None:
    for word in text.split(","):
        if match := _JOB.fullmatch(word):
            short, sign, tries = match.groups()
            tag = names.get(short, short)
            memory.set_job(Job(goal, tag, _STATUS_OF[sign], int(tries or 0)))


def things_noted(notes: Iterable[str]) -> dict[str, Thing]:
    """All things that notes tell the places of, as the latest of them tell."""
    memory, names = Memory(), dict[str, str]()
    for note in notes:
        apply(read(note), memory, names)
    return memory.things


def _apply_things(text: str, memory: Memory, names: dict[str, str], told: Collection[str]) -> None:
    for word in text.split(";"):
        tag, _, numbers = word.rpartition("=")
        if tag and re.fullmatch(r"(-?\d{1,6},){3}\d{1,8}(\.\d)?", numbers):
            x, y, z, volume = numbers.split(",")
            names.setdefault(short_of(tag), tag)
            position = Vec3(int(x) / 1000, int(y) / 1000, int(z) / 1000)
            if tag not in told:
                memory.things[tag] = thing_of(tag, position, float(volume))


def _apply_kinds(text: str, memory: Memory, names: Mapping[str, str]) -> None:
    kinds = dict(zip(_letters().values(), _letters(), strict=True))
    for tag, letter in _pairs(text, names, "[a-z]"):
        if letter in kinds:
            memory.kinds[tag] = kinds[letter]


def _letters() -> dict[str, str]:
    """A letter for each class."""
    return {name: chr(ord("a") + index) for index, name in enumerate(prototypes())}


def _pairs(
    text: str, names: Mapping[str, str], value: str = r"\d{1,4}"
) -> Iterable[tuple[str, str]]:
    for word in text.split(","):
        if match := re.fullmatch(rf"(\S+)=({value})", word):
            yield names.get(match.group(1), match.group(1)), match.group(2)


def short_of(tag: str) -> str:
    """The number of a tag, which names the object as well; other tags as they are."""
    number = tag.rsplit("_", 1)[-1]
    return number if number.isdigit() else tag


def write(
    memory: Memory,
    before: Memory,
    lasting: Collection[str],
    groups: Collection[int],
    distances: Collection[str],
    head: Entry,
) -> str:
    """The line that tells a reader of ``before`` what ``memory`` has more.

    Args:
        memory: What is known.
        before: What the other messages of the next prompt tell; empty for a whole line.
        lasting: Tags whose places the next prompt tells.
        groups: Goals that compare many things, so that all fits count.
        distances: Tags of which it counts from how near they were seen.
        head: Number, and the search codes of the calls.
    """
    parts = [f"#{head.number}{'!' if head.whole else ''}", *head.codes]
    if head.whole:
        counts = (("v", memory.views), ("c", memory.visits), ("a", memory.aside))
        parts += [f"{letter}{count}" for letter, count in counts if count]
        parts += [f"h{short_of(memory.hand)}"] if memory.hand else []
    parts += _things(memory, lasting)
    parts += _jobs(memory, before)
    parts += _fits(memory, before, groups)
    parts += _joined("s", {t: round(memory.seen_m[t] * 10) for t in distances})
    kinds = {t: _letters()[k] for t, k in memory.kinds.items() if before.kinds.get(t) != k}
    parts += _joined("k", kinds)
    if close := sorted(memory.inspected - before.inspected):
        parts.append("i:" + ",".join(map(short_of, close)))
    return f"[{' '.join(parts)}]"


def _things(memory: Memory, lasting: Collection[str]) -> list[str]:
    places = [_place(thing) for tag, thing in memory.things.items() if tag not in lasting]
    return ["t:" + ";".join(places)] if places else []


def _place(thing: Thing) -> str:
    p = thing.position
    millimetres = ",".join(str(round(v * 1000)) for v in (p.x, p.y, p.z))
    return f"{thing.tag}={millimetres},{thing.volume_cm3:.1f}"


def _jobs(memory: Memory, before: Memory) -> list[str]:
    known = set(before.jobs)
    by_goal: dict[int, list[str]] = {}
    for job in memory.jobs:
        if job not in known:
            tries = f"/{job.tries}" if job.tries else ""
            word = f"{short_of(job.tag)}{_STATUS[job.status]}{tries}"
            by_goal.setdefault(job.goal, []).append(word)
    return [f"j{goal}:{','.join(words)}" for goal, words in by_goal.items()]


def _fits(memory: Memory, before: Memory, groups: Collection[int]) -> list[str]:
    parts: list[str] = []
    for slot in sorted(memory.fits):
        kind, goal = slot
        kept = _kept_fits(memory, slot, goal in groups)
        old = before.fits.get(slot, {})
        changed = {
            tag: round(fit * 100)
            for tag, fit in memory.fits[slot].items()
            if round(old.get(tag, 0.0) * 100) != round(fit * 100)
            and (tag in kept or old.get(tag, 0.0) >= _LEAST_FIT)
        }
        parts += _joined(f"{kind[0].replace('g', 'f')}{goal}", changed)
    return parts


def _kept_fits(memory: Memory, slot: Slot, is_group: bool) -> set[str]:
    """The fits that still matter: those of the chosen, or of all who may be chosen."""
    kind, goal = slot
    best = sorted(memory.fits[slot].items(), key=lambda item: (-item[1], item[0]))
    likely = [tag for tag, fit in best if fit >= _LEAST_FIT]
    chosen = {job.tag for job in memory.jobs if job.goal == goal}
    if not chosen:
        return set(likely if is_group else likely[:_KEPT_FITS])
    if kind == "goal":
        return chosen
    return set([tag for tag in likely if tag not in chosen][:1])


def _joined(head: str, values: Mapping[str, object]) -> list[str]:
    pairs = [f"{short_of(tag)}={value}" for tag, value in values.items()]
    return [f"{head}:{','.join(pairs)}"] if pairs else []
