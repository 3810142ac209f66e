"""What happened in an episode, with the truth beside it: every state that was recorded."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from adamo_vh.action import Drop, Outcome, Pick, Walk, action_name
from adamo_vh.action_server import LocalActionServer
from adamo_vh.benchmark.distance import calls_left
from adamo_vh.benchmark.tasks import Task
from adamo_vh.engine import ObjectState, World, WorldState
from adamo_vh.episode.result import EpisodeResult, Manifest
from adamo_vh.geometry import Vec3
from adamo_vh.perception import PerceptionConfig, Tagger
from adamo_vh.record.trajectory import Acted, Ended, Observed, Started, Thought, Trajectory

PICK, DROP, WALK = action_name(Pick), action_name(Drop), action_name(Walk)
_LONGEST_QUOTE = 120


@dataclass(frozen=True, slots=True)
class Moment:
    """The world after a step; before any, at the start."""

    step: int
    act: Acted | None
    """What led to it; None at the start."""
    state: WorldState
    seen: frozenset[int]
    """Ids of the objects that were listed in a view so far."""
    left: int
    """Least number of calls to done."""

    @property
    def is_done(self) -> bool:
        """Whether the act was carried out, as asked or otherwise."""
        return self.act is not None and self.act.feedback.outcome is not Outcome.REFUSED

    def object(self, object_id: int) -> ObjectState | None:
        """An object then; None if it was not in the room."""
        return next((item for item in self.state.objects if item.id == object_id), None)


@dataclass(frozen=True, slots=True, eq=False)
class Story:
    """One episode, as the truth has it."""

    task: Task
    manifest: Manifest
    result: EpisodeResult
    moments: tuple[Moment, ...]
    """At least the start."""
    views: tuple[Observed, ...]
    thoughts: tuple[Thought, ...]
    ended: Ended
    tagger: Tagger
    world: World
    """Can be put back to any moment."""
    server: LocalActionServer
    saved: tuple[str, ...]
    """Of each moment."""

    @property
    def names(self) -> Mapping[int, str]:
        """Class of every object, by id."""
        return self.world.object_names

    @property
    def start(self) -> WorldState:
        """The world at the start."""
        return self.moments[0].state

    @property
    def final(self) -> WorldState:
        """The world at the end, also if something happened after the last step."""
        return self.result.final

    @property
    def last(self) -> int:
        """The last step."""
        return self.moments[-1].step

    @property
    def acts(self) -> list[Acted]:
        """All that was executed or refused."""
        return [moment.act for moment in self.moments if moment.act is not None]

    def put_back(self, moment: Moment) -> None:
        """Put the world back to a moment."""
        self.server.load(self.saved[self.moments.index(moment)])

    def name(self, object_id: int) -> str:
        """What people call an object: its tag, with its class where the tag does not tell it."""
        class_name = self.names.get(object_id, "object")
        tag = self.tagger.tag(object_id, class_name)
        return tag if class_name in tag else f"{tag} ({class_name})"

    def meant(self, act: Acted) -> int | None:
        """The object that a Pick or Drop names; None if it names none."""
        tag = (act.arguments or {}).get("object")
        known = isinstance(tag, str | int) and not isinstance(tag, bool)
        return self.tagger.resolve(str(tag), self.names) if known else None

    def listed(self, object_id: int) -> bool:
        """Whether an object was listed in any view."""
        return object_id in self.moments[-1].seen

    def held_at(self, object_id: int) -> list[int]:
        """Numbers of the moments at which an object was in the hand."""
        return [i for i, moment in enumerate(self.moments) if moment.state.body.held == object_id]

    def handled(self) -> list[tuple[int, int]]:
        """What was taken into the hand: moment and object, in order."""
        taken = []
        for i, moment in enumerate(self.moments[1:], start=1):
            held, before = moment.state.body.held, self.moments[i - 1].state.body.held
            if held is not None and held != before:
                taken.append((i, held))
        return taken

    def puttings(self, object_id: int) -> list[Putting]:
        """Where an object was put down, in order."""
        found = []
        for i in self.held_at(object_id):
            after = self.moments[i + 1] if i + 1 < len(self.moments) else None
            item = after.object(object_id) if after else None
            if after is None or after.act is None or item is None or item.held:
                continue
            found.append(Putting(i + 1, after.step, after.act, item))
        return found

    def said(self) -> str:
        """All that the agent wrote: notes, calls and the answer."""
        calls = (str(dict(act.arguments or {}).get("object", "")) for act in self.acts)
        notes = (thought.turn.note for thought in self.thoughts)
        return "\n".join((*notes, *(f"object {call}" for call in calls if call), self.ended.answer))

    def note(self, step: int) -> str:
        """What was said when a step was decided."""
        told = [thought for thought in self.thoughts if thought.step < step]
        return told[-1].turn.note if told else ""

    def names_object(self, text: str, object_id: int) -> bool:
        """Whether a text speaks of an object, by its tag, number or class."""
        return any(pattern.search(text) for pattern in self._patterns(object_id))

    def _patterns(self, object_id: int) -> Iterable[re.Pattern[str]]:
        class_name = self.names.get(object_id, "")
        tag = re.escape(self.tagger.tag(object_id, class_name))
        number = rf"(?:object|tag|tagged as|number|id)[\s#:]*{object_id}\b|#{object_id}\b"
        yield re.compile(rf"(?<![\w.,(-]){tag}(?![\w.]*\d)|{number}", re.IGNORECASE)
        if sum(other == class_name for other in self.names.values()) == 1:
            words = r"[\s_-]*".join(re.findall(r"[A-Z]?[a-z0-9]+|[A-Z]+", class_name))
            if words:
                yield re.compile(rf"\b{words}s?\b", re.IGNORECASE)

    def is_told_by_tag(self, object_id: int) -> bool:
        """Whether the instruction gives an object away to who reads tags, without seeing."""
        prompt, class_name = self.manifest.config.instruction, self.names.get(object_id, "")
        if re.search(rf"\b{object_id}\b", prompt):
            return True
        if class_name not in self.tagger.tag(object_id, class_name):
            return False
        return self.names_object(prompt, object_id)


@dataclass(frozen=True, slots=True)
class Putting:
    """An object was put down."""

    moment: int
    """Number of the moment after it."""
    step: int
    act: Acted
    item: ObjectState
    """The object where it came to rest."""

    @property
    def aim(self) -> Vec3 | None:
        """The point that was asked for."""
        values = [(self.act.arguments or {}).get(axis) for axis in "xyz"]
        try:
            return Vec3(*(float(value) for value in values))  # type: ignore[arg-type]
        except (TypeError, ValueError):
            return None


def story_of(
    manifest: Manifest,
    trajectory: Trajectory,
    result: EpisodeResult,
    world: World,
    task: Task,
    tagger: Tagger | None = None,
) -> Story | None:
    """Read the recorded states back through a world.

    Args:
        manifest: How the episode was set up.
        trajectory: What happened.
        result: What came of it.
        world: Of the same scene; is left in another state.
        task: What was asked.
        tagger: Makes and reads the tags; that of the settings by default.

    Returns:
        None if the episode has no first view or no end.

    Raises:
        EngineError: A saved state is damaged, or of another scene.
    """
    began = next((e for e in trajectory.events if isinstance(e, Started)), None)
    ended = trajectory.ended
    if began is None or not began.saved or ended is None:
        return None
    reads = tagger or manifest.config.labeling
    server = LocalActionServer(world, perception=PerceptionConfig(labeling=reads))
    steps: list[Acted | None] = [None, *trajectory.acts]
    saved = tuple(began.saved if act is None else act.saved for act in steps)
    views = tuple(e for e in trajectory.events if isinstance(e, Observed))
    moments: list[Moment] = []
    for act, kept in zip(steps, saved, strict=True):
        server.load(kept)
        step, state = act.step if act else 0, world.state()
        # A view that followed the save is of the same moment.
        tags = (item.tag for view in views if view.step <= step for item in view.objects)
        told = {reads.resolve(tag, world.object_names) for tag in tags}
        seen = server.seen.union(number for number in told if number is not None)
        past = [moment.state for moment in moments]
        left = calls_left(task.conditions, state, seen, past)
        moments.append(Moment(step, act, state, seen, left))
    return Story(
        task,
        manifest,
        result,
        tuple(moments),
        views,
        tuple(trajectory.thoughts),
        ended,
        reads,
        world,
        server,
        saved,
    )


def quoted(text: str) -> str:
    """A text of the agent, short enough to be quoted."""
    words = " ".join(text.split())
    return words if len(words) <= _LONGEST_QUOTE else f"{words[:_LONGEST_QUOTE].rstrip()} ..."


def call_text(act: Acted) -> str:
    """A call as it was made."""
    arguments = ", ".join(f"{key}={value}" for key, value in (act.arguments or {}).items())
    return f"{act.name}({arguments})"


def several(words: Sequence[str]) -> str:
    """A few words in a row: "a, b and c"."""
    if len(words) < 2:
        return "".join(words)
    return f"{', '.join(words[:-1])} and {words[-1]}"
