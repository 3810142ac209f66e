"""The Multimodal Short-Term Memory (MSTM): one prompt out of instructions, state and history.

Paper, Sec. 3.1: (i) fixed instructions (system), (ii) the symbolic state, always the latest
(system), (iii) a rolling buffer of human, AI and tool messages. Here `k` counts steps: an AI
message, the answers to its calls, and the frame that followed, cut or kept together, so that no
tool result ever loses its call. By a switch it counts blocks as the original program does, where a
frame counts beside its step; a step that does not fit whole is left out. The first human message is
never dropped, nor is the instruction that is being carried out.

The memory keeps what happened as data; the prompt is a pure function of it and of the profile.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from adamo_vh.cognition.memory.protocol import Result
from adamo_vh.cognition.profile import (
    NEW_PICTURES,
    NO_PICTURES,
    PAPER,
    BufferUnit,
    Profile,
    StateText,
)
from adamo_vh.cognition.prompts import render
from adamo_vh.errors import ConfigError
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    Part,
    SystemMessage,
    TextPart,
    ToolMessage,
)
from adamo_vh.observation import AgentState, Frame, Observation
from adamo_vh.perception import TextForm
from adamo_vh.perception.writer import SymbolicState, Told, Wording, view_now


@dataclass(frozen=True, slots=True)
class Instruction:
    """What the user said, with the view at that moment; no view for a word in between."""

    text: str
    view: Observation | None
    agent: AgentState


@dataclass(frozen=True, slots=True)
class Exchange:
    """What the model said, and what came back for each of its calls."""

    message: AIMessage
    results: tuple[Result, ...] = ()


class ShortTermMemory:
    """What the model is shown in each turn."""

    def __init__(
        self,
        instructions: str,
        k: int = 50,
        profile: Profile | None = None,
        form: TextForm = TextForm.FULL,
    ) -> None:
        """Start empty.

        Args:
            instructions: The fixed system prompt.
            k: How many past steps to keep, or blocks if the profile counts those; at least 1. The
                last step is always kept.
            profile: Where state and pictures stand in the prompt; the paper's by default.
            form: Which fields the symbolic state has.
        """
        if k < 1:
            raise ConfigError(f"k is {k}; the memory keeps at least 1 step.")
        self._instructions = instructions
        self._profile = profile or PAPER
        self._wording = Wording(form, self._profile.terse, self._profile.has_pictures)
        self._pinned: list[Instruction] = []
        self._k = k
        self._entries: list[Instruction | Exchange] = []
        self._view: Observation | None = None
        self._agent: AgentState | None = None
        self._symbolic: SymbolicState | None = None
        """Of the view, once it was asked for."""
        self._state: str | None = None
        """The same as text, with the body now."""

    def instruct(self, text: str, view: Observation) -> None:
        """Remember an instruction and the view at that moment."""
        instruction = Instruction(text, view, view.agent)
        if not self._pinned:
            self._pinned = [instruction]
        else:
            self._pinned[1:] = [instruction]
            self._entries.append(instruction)
        self._stand(view, view.agent)

    def remark(self, text: str) -> None:
        """Remember a word to the model that is no instruction."""
        if self._agent is not None:
            self._entries.append(Instruction(text, None, self._agent))

    def add_step(self, message: AIMessage, *results: Result) -> None:
        """Remember what the model said and what came back."""
        self._entries.append(Exchange(message, results))
        self._cut()
        for result in results:
            self._stand(result.view or self._view, result.agent)

    def _stand(self, view: Observation | None, agent: AgentState) -> None:
        """Note what is seen and how the body stands now."""
        if view is not self._view:
            self._symbolic = None
        self._view, self._agent, self._state = view, agent, None

    def _cut(self) -> None:
        """Forget the oldest steps until no more than `k` are left."""
        steps = [i for i, entry in enumerate(self._entries) if isinstance(entry, Exchange)]
        kept = steps[-self._k :]
        if self._profile.buffer_unit is BufferUnit.BLOCK:
            while len(kept) > 1 and sum(map(self._blocks, self._entries[kept[0] :])) > self._k:
                del kept[0]
        if len(kept) < len(steps):
            # With a step goes what was said before it, and the word that it was answered with.
            del self._entries[: kept[0]]

    def _blocks(self, entry: Instruction | Exchange) -> int:
        """How many the original counts for an entry."""
        if isinstance(entry, Instruction):
            return 1
        if not self._profile.has_pictures or self._profile.pictures_in_results:
            return 1
        shown = (len(result.pictures) + (result.view is not None) for result in entry.results)
        return 1 + sum(shown)

    @property
    def state_text(self) -> str:
        """The whole symbolic state now; empty if the model is told none."""
        if self._view is None or self._agent is None or self._profile.state is StateText.NONE:
            return ""
        if self._state is None:
            self._symbolic = self._symbolic or SymbolicState(self._view, self._wording)
            self._state = self._symbolic.text(self._agent)
        return self._state

    def messages(self) -> list[Message]:
        """The whole prompt, oldest first."""
        prompt: list[Message] = [SystemMessage(self._instructions)]
        if self._profile.state is StateText.FIRST:
            prompt.append(SystemMessage(self.state_text))
        entries = self._kept()
        writer = _Writer(self._profile, self._wording, entries)
        for entry in entries:
            prompt.extend(writer.write(entry))
        if self._profile.state is StateText.LAST:
            prompt.append(HumanMessage((TextPart(self.state_text),)))
        return prompt

    def _kept(self) -> list[Instruction | Exchange]:
        """The entries of the prompt: the buffer, and the instructions that fell out of it."""
        buffer = self._entries
        fallen = [entry for entry in self._pinned if not any(entry is kept for kept in buffer)]
        return [*fallen, *buffer]


class _Writer:
    """Writes entries as messages, oldest first, for one prompt."""

    def __init__(
        self, profile: Profile, wording: Wording, entries: Sequence[Instruction | Exchange]
    ) -> None:
        self._profile = profile
        self._wording = wording
        self._told = Told(wording)
        # By identity: two views may look the same and still be two. The last 0 are all of them.
        views = [id(view) for view in _views(entries)]
        shown = [id(frame) for frame in _closeups(entries)]
        if profile.pictures == NEW_PICTURES:
            new = _since_last_action(entries)
            self._in_sight = {id(thing) for thing in (*_views(new), *_closeups(new))}
            self._told_now = set(views[-1:])
        else:
            # Without pictures, what is in view is text and stays where it was said.
            kept = 0 if profile.pictures == NO_PICTURES else profile.pictures
            self._in_sight = {*views[-kept:], *shown[-kept:]}
            self._told_now = self._in_sight

    def write(self, entry: Instruction | Exchange) -> Iterator[Message]:
        """The messages of an entry."""
        if isinstance(entry, Instruction):
            yield self._instruction(entry)
            return
        yield entry.message
        for number, result in enumerate(entry.results, start=1):
            yield self._result(result, is_last=number == len(entry.results))
        if self._profile.has_pictures and not self._profile.pictures_in_results:
            for result in entry.results:
                yield from self._frames(result)

    def _instruction(self, entry: Instruction) -> HumanMessage:
        if entry.view is None:
            return HumanMessage((TextPart(entry.text),))
        parts: list[Part] = [TextPart(entry.text)]
        if text := self._changes(entry.view, entry.agent):
            parts.append(TextPart(text))
        if self._profile.has_pictures:
            parts.append(self._picture(entry.view.frame, id(entry.view)))
        return HumanMessage(tuple(parts))

    def _result(self, result: Result, *, is_last: bool) -> ToolMessage:
        # Where the body stood between two calls of one turn is no news any more.
        changes = self._changes(result.view, result.agent) if is_last or result.view else ""
        text = f"{result.text}\n\n{changes}" if changes else result.text
        images: list[ImagePart] = []
        if self._profile.has_pictures and self._profile.pictures_in_results:
            found = [self._picture(frame, id(frame)) for frame in result.pictures]
            if result.view is not None:
                found.append(self._picture(result.view.frame, id(result.view)))
            images = [part for part in found if isinstance(part, ImagePart)]
            if not self._profile.terse:
                text += "".join(f"\n{part.text}" for part in found if isinstance(part, TextPart))
        return ToolMessage(result.call_id, result.name, text, tuple(images))

    def _frames(self, result: Result) -> Iterator[HumanMessage]:
        for frame in result.pictures:
            text = TextPart(render("picture", what=f"What {result.name} shows"))
            yield HumanMessage((text, self._picture(frame, id(frame))))
        if result.view is not None:
            text = TextPart(render("picture", what=f"New view after your {result.name}"))
            yield HumanMessage((text, self._picture(result.view.frame, id(result.view))))

    def _picture(self, frame: Frame, key: int) -> Part:
        if key not in self._in_sight:
            return TextPart(render("picture_left_out"))
        return ImagePart(frame.data, frame.media_type, frame.width_px, frame.height_px)

    def _changes(self, view: Observation | None, agent: AgentState) -> str:
        if self._profile.state is not StateText.CHANGES:
            return ""
        parts = [self._told.changes(view, agent)]
        if view is not None and id(view) in self._told_now:
            parts.append(view_now(view, self._wording))
        return "\n\n".join(part for part in parts if part)


def _since_last_action(
    entries: Sequence[Instruction | Exchange],
) -> Sequence[Instruction | Exchange]:
    """The last step in which anything was done, and what came after it."""
    for number, entry in reversed(list(enumerate(entries))):
        if isinstance(entry, Exchange) and any(result.outcome for result in entry.results):
            return entries[number:]
    return entries


def _views(entries: Sequence[Instruction | Exchange]) -> Iterator[Observation]:
    for entry in entries:
        parts = (entry,) if isinstance(entry, Instruction) else entry.results
        yield from (part.view for part in parts if part.view is not None)


def _closeups(entries: Sequence[Instruction | Exchange]) -> Iterator[Frame]:
    for entry in entries:
        if isinstance(entry, Exchange):
            yield from (frame for result in entry.results for frame in result.pictures)
