"""The Action Server in the same process as the engine."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, ClassVar

from pydantic import ConfigDict, TypeAdapter, ValidationError

from adamo_vh.action import Action, Code, Feedback, Outcome, action_name
from adamo_vh.action_server.frame_cache import FrameCache, view_key
from adamo_vh.action_server.frame_check import frame_fault
from adamo_vh.action_server.protocol import ActionResult, Sighting
from adamo_vh.action_server.tools import PAPER_TOOLS, Tool
from adamo_vh.engine import Body, SceneInfo, World, acting_body
from adamo_vh.errors import AdamoError, EngineError, InvalidActionError
from adamo_vh.geometry import Vec3
from adamo_vh.observation import AgentState, Frame, Observation, Percept
from adamo_vh.perception import PerceptionConfig, agent_state, perceive
from adamo_vh.perception.closeup import closeup_of, seen_corners
from adamo_vh.perception.contact_sheet import MAX_CELLS, contact_sheet
from adamo_vh.perception.overlay import encoded
from adamo_vh.perception.reference_points import only
from adamo_vh.perception.visibility import VisibleObject, visible_objects

if TYPE_CHECKING:
    from PIL.Image import Image

_WALL_M = 0.05
"""A place this close to a wall is on it."""

Turn = Callable[[], AbstractContextManager[float]]
"""Gives the engine to one caller for a while, and the seconds that this was waited for."""
PAPER_REFRESH = frozenset({"Look"})
"""The paper's refresh rule: a new view at the start and after Look only (Sec. 3.1)."""


def at_once() -> AbstractContextManager[float]:
    """The turn of an engine that nobody else uses."""
    return nullcontext(0.0)


class LocalActionServer:
    """Executes actions in a world. Implements `ActionServer` and `ToolContext`."""

    def __init__(
        self,
        world: World,
        *,
        perception: PerceptionConfig | None = None,
        resolution: tuple[int, int] = (1920, 1080),
        tools: Sequence[Tool] = PAPER_TOOLS,
        refresh_after: frozenset[str] = PAPER_REFRESH,
        turn: Turn = at_once,
        frames: FrameCache | None = None,
    ) -> None:
        """Serve one episode.

        Args:
            world: Already reset; its acting body carries the actions out.
            perception: Labeling, grid and picture settings.
            resolution: Width and height of the frames in pixels.
            tools: The primitives on offer.
            refresh_after: Names of the actions that are followed by a new view.
            turn: How an engine that others use too is had for the length of one answer.
            frames: Keeps views, so that what was drawn before is not drawn again.
        """
        self._world = world
        self._body = acting_body(world)
        self._perception = perception or PerceptionConfig()
        self._resolution = resolution
        self._tools = {tool.action_type: tool for tool in tools}
        self._refresh_after = refresh_after
        self._turn = turn
        self._frames = frames
        self._in_action = False
        self._names = world.object_names
        self._seen: set[int] = set()
        self._shown: list[Frame] = []

    @property
    def actions(self) -> tuple[type, ...]:
        """The action types on offer."""
        return tuple(self._tools)

    @property
    def body(self) -> Body:
        """What acts and senses."""
        return self._body

    @property
    def scene(self) -> SceneInfo:
        """The room's public facts."""
        return self._world.scene

    @property
    def seen(self) -> frozenset[int]:
        """Ids of the objects that were listed in a view so far."""
        return frozenset(self._seen)

    def tag(self, object_id: int) -> str:
        """The tag of an object under the labeling in use."""
        return self._perception.labeling.tag(object_id, self._names[object_id])

    def seen_object(self, tag: str) -> int:
        """The object that a tag means, if it was in a view before.

        Unknown and unseen tags read the same, so that guessing reveals nothing.

        Raises:
            InvalidActionError: No object with this tag was seen so far.
        """
        object_id = self._perception.labeling.resolve(tag, self._names)
        if object_id is None or object_id not in self._seen:
            code = Code.UNKNOWN_TAG if object_id is None else Code.NOT_SEEN
            raise InvalidActionError(code, f"no object tagged {tag!r} was seen so far.")
        return object_id

    def observe(self) -> Sighting:
        """The view from where the body stands now; what it lists counts as seen."""
        with self._serving("observe") as waited_s:
            return Sighting(self._view(), self.state_hash(), self.save(), waited_s)

    def _see(self) -> Percept:
        """What the eyes see now.

        Raises:
            EngineError: The picture cannot be one of the world: nothing may be scored on it.
        """
        percept = self._body.see(*self._resolution)
        if fault := frame_fault(percept, self._world.state(), self._body):
            raise EngineError(f"The engine drew a wrong picture: {fault}. Make a new engine.")
        return percept

    def _view(self) -> Observation:
        observation = self._drawn() if self._frames is None else self._kept(self._frames)
        for item in observation.objects:
            object_id = self._perception.labeling.resolve(item.tag, self._names)
            if object_id is not None:
                self._seen.add(object_id)
        return observation

    def _kept(self, frames: FrameCache) -> Observation:
        # A moment of an action, seen by who watches it, is in no snapshot.
        told = not self._in_action
        key = view_key(self._world, self._resolution, self._perception) if told else b""
        return frames.view(key, self._drawn)

    def _drawn(self) -> Observation:
        raycast = only(self._is_anchor, self._body.rays)
        return perceive(self._see(), raycast, self._perception, self._names)

    def _is_anchor(self, point: Vec3) -> bool:
        """Whether a place can be a reference point: in the room, not behind its window."""
        margin_m = _WALL_M if self._perception.points_on_walls else -_WALL_M
        below = point.z <= self._perception.points_below_m
        return below and self.scene.is_within_walls(point, margin_m)

    def show_closeup(self, object_id: int) -> bool:
        """Show an object close up with the next result.

        Returns:
            False if it is neither in view now nor in the hand.
        """
        view, listed = self._in_view()
        boxes = {item.id: item.box_px for item in listed}
        felt = view.body.held_box
        if view.body.held == object_id and felt is not None:
            # One can always look at one's own hand, and feels how large the thing in it is.
            points = felt.corners()
        elif object_id in boxes:
            points = seen_corners(view, boxes[object_id])
        else:
            return False
        self._show(closeup_of(view, object_id, self.tag(object_id), points, self._body.closeup))
        return True

    def show_sheet(self) -> tuple[str, ...]:
        """Show all objects in view on one sheet with the next result; their tags, in order."""
        view, listed = self._in_view()
        items = [(item.id, self.tag(item.id), item.box_px) for item in listed[:MAX_CELLS]]
        if items:
            self._show(contact_sheet(view, items, self._body.closeup))
        return tuple(tag for _, tag, _ in items)

    def _in_view(self) -> tuple[Percept, Sequence[VisibleObject]]:
        """What the eyes see now, and what of it is large enough to be listed."""
        percept = self._see()
        return percept, visible_objects(percept, self._perception.min_pixels)

    def _show(self, picture: Image) -> None:
        config = self._perception
        self._shown.append(encoded(picture, config.image_format, config.jpeg_quality))

    def execute(self, action: Action) -> ActionResult:
        """Carry out one action of a type on offer; what the agent did wrong becomes feedback."""
        name = action_name(type(action))
        self._shown = []
        with self._serving(name) as waited_s:
            try:
                self._in_action = True
                feedback = self._tools[type(action)].execute(self, action)
            except InvalidActionError as error:
                feedback = Feedback.of_error(error)
            finally:
                self._in_action = False
            grants = name in self._refresh_after and feedback.outcome is not Outcome.REFUSED
            return self._result(feedback, self._view() if grants else None, waited_s)

    def refuse(self, error: InvalidActionError) -> ActionResult:
        """Answer a call that is no valid action: nothing changes."""
        self._shown = []
        with self._serving("refuse") as waited_s:
            return self._result(Feedback.of_error(error), None, waited_s)

    def _result(
        self, feedback: Feedback, view: Observation | None, waited_s: float
    ) -> ActionResult:
        hashed, saved, pictures = self.state_hash(), self.save(), tuple(self._shown)
        return ActionResult(feedback, self.agent(), view, hashed, saved, pictures, waited_s)

    def agent(self) -> AgentState:
        """The body now, in the agent's words."""
        return agent_state(self._body.state(), self._perception.labeling, self._names)

    def say(self, text: str) -> None:
        """Deliver the final answer through the body."""
        with self._serving("say"):
            self._body.say(text)

    def state_hash(self) -> str:
        """Digest of the world now."""
        return self._world.state().hash()

    def save(self) -> str:
        """World, body and what was seen so far, as text."""
        saved = _Saved(self._world.snapshot(), tuple(sorted(self._seen)))
        return _codec().dump_json(saved).decode()

    def load(self, saved: str) -> str:
        """Go back to what `save` gave; the digest of the world then.

        Raises:
            EngineError: The text is damaged or belongs to another scene.
        """
        try:
            kept = _codec().validate_json(saved)
        except ValidationError as error:
            raise EngineError(f"The saved state is damaged: {error.errors()[0]['msg']}") from None
        if unknown := set(kept.seen) - set(self._names):
            raise EngineError(
                f"The saved state is damaged: the scene has no object {min(unknown)}."
            )
        with self._serving("load"):
            self._world.restore(kept.engine)
            self._seen = set(kept.seen)
            return self.state_hash()

    @contextmanager
    def _serving(self, what: str) -> Iterator[float]:
        """Have the engine for one answer; gives the seconds that this was waited for.

        What an engine or a tool from outside does wrong meanwhile is said in a sentence.
        """
        try:
            with self._turn() as waited_s:
                yield waited_s
        except AdamoError:
            raise
        except Exception as fault:
            raise EngineError(
                f"The engine or a tool failed in {what}: {type(fault).__name__}: {fault}"
            ) from fault


@dataclass(frozen=True, slots=True)
class _Saved:
    __pydantic_config__: ClassVar[ConfigDict] = ConfigDict(
        ser_json_bytes="base64", val_json_bytes="base64"
    )

    engine: bytes
    seen: tuple[int, ...]


@cache
def _codec() -> TypeAdapter[_Saved]:
    return TypeAdapter(_Saved)
