"""Whatever a model calls, in whatever order: the world stays sound and tells the truth."""

from __future__ import annotations

import io
import json
import re
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    invariant,
    rule,
    run_state_machine_as_test,
)
from PIL import Image

from adamo_vh.action import Outcome, parse
from adamo_vh.action_server import LocalActionServer, execute_call
from adamo_vh.action_server.soundness import state_faults, step_faults, view_faults
from adamo_vh.errors import InvalidActionError
from adamo_vh.perception import (
    ImageFormat,
    Labeling,
    PerceptionConfig,
    TextForm,
    agent_lines,
    object_lines,
)
from adamo_vh.perception.plates import tag_colour
from adamo_vh.perception.visibility import visible_objects
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.inspection.soundness import Soundness

RESOLUTION = (320, 180)
MARGIN_PX = 4
"""At this resolution the drawn box is within so many pixels of the tight one."""

# Near what a room of 6 by 8 m offers, and sometimes outside of it.
near_x = st.floats(-3.2, 3.2).map(lambda v: round(v, 2))
near_y = st.floats(-5.2, 3.2).map(lambda v: round(v, 2))
heights = st.sampled_from([0.0, 0.0, 0.46, 0.58, 0.78, 0.97, 1.35, 1.95]) | st.floats(-0.2, 3.4)
points = st.fixed_dictionaries({"x": near_x, "y": near_y, "z": heights})
wrong = st.one_of(
    st.none(), st.text(max_size=8), st.just(float("nan")), st.just(1e300), st.just([1.0]),
    st.just({"x": 1}), st.booleans(),
)  # fmt: skip
nonsense = st.tuples(
    st.sampled_from(["Look", "Walk", "Pick", "Drop", "look", "Fly", "", "Drop\n"]) | st.text(),
    st.none() | st.dictionaries(st.sampled_from(["x", "y", "z", "object", "why"]), wrong | near_x),
)
# The n-th object of the scene, written in one of the ways that models do.
things = st.integers(0, 18)
spellings = st.sampled_from(["{}", " {} ", '"{}"', "`{}`"])


@cache
def engine_of(scene: str) -> BuiltinEngine:
    """One engine of each scene for all examples of a worker."""
    return BuiltinEngine(scene)


class WorldMachine(RuleBasedStateMachine):
    """Random calls to one world; subclasses name the scene."""

    scene: str

    def __init__(self) -> None:
        super().__init__()
        self.engine = engine_of(self.scene)
        self.engine.reset(0)
        self.sound = Soundness(self.engine._world)

    @initialize(labeling=st.sampled_from(Labeling), knows_all=st.booleans())
    def begin(self, labeling: Labeling, knows_all: bool) -> None:
        config = PerceptionConfig(labeling, image_format=ImageFormat.PNG)
        self.server = LocalActionServer(
            self.engine, perception=config, resolution=RESOLUTION, refresh_after=frozenset()
        )
        ids = sorted(self.engine.object_names)
        seen = ids if knows_all else ids[::2]
        self.server.load(json.dumps(json.loads(self.server.save()) | {"seen": seen}))

    # --- calls ------------------------------------------------------------------------------

    @rule(point=points)
    def look(self, point: dict[str, Any]) -> None:
        self.call("Look", point)

    @rule(point=points)
    def walk(self, point: dict[str, Any]) -> None:
        self.call("Walk", point)

    @rule(thing=things, spelling=spellings)
    def pick(self, thing: int, spelling: str) -> None:
        self.call("Pick", {"object": spelling.format(self.tag(thing))})

    @rule(thing=things, point=points)
    def drop_anything(self, thing: int, point: dict[str, Any]) -> None:
        self.call("Drop", {"object": self.tag(thing), **point})

    @rule(point=points, spelling=spellings)
    def drop(self, point: dict[str, Any], spelling: str) -> None:
        """Drop what is held; at its own place, if nothing is."""
        tag = self.server.agent().held or self.tag(0)
        self.call("Drop", {"object": spelling.format(tag), **point})

    @rule(thing=things, neighbour=things, dx=st.floats(-0.3, 0.3), dy=st.floats(-0.3, 0.3))
    def put_beside(self, thing: int, neighbour: int, dx: float, dy: float) -> None:
        """What most tasks ask for."""
        self.call("Pick", {"object": self.tag(thing)})
        center = self.engine.state().objects[neighbour].box.center
        point = {"x": center.x + dx, "y": center.y + dy, "z": center.z}
        self.call("Drop", {"object": self.server.agent().held or "", **point})

    @rule(call=nonsense)
    def call_nonsense(self, call: tuple[str, dict[str, Any] | None]) -> None:
        self.call(*call)

    @rule(point=points, thing=things)
    def the_same_call_again(self, point: dict[str, Any], thing: int) -> None:
        """From the same snapshot the same call gives the same world."""
        held = self.server.agent().held
        name = "Pick" if held is None else "Drop"
        arguments = {"object": self.tag(thing)} if held is None else {"object": held, **point}
        saved = self.server.save()
        first = execute_call(self.server, name, arguments)
        self.server.load(saved)
        assert self.call(name, arguments) == first.state_hash

    @rule()
    def observe(self) -> None:
        """Frame, list and text tell the same, and nothing that is not visible."""
        before = self.engine.state().hash()
        observation, percept = self.server.observe().observation, self.engine.capture(*RESOLUTION)
        state = self.engine.state()
        assert state.hash() == before
        ids = {self.server.tag(i): i for i in self.engine.object_names}
        assert not view_faults(percept, observation, ids, state)
        tags = [item.tag for item in observation.objects]
        assert [ids[tag] for tag in tags] == [item.id for item in visible_objects(percept, 20)]
        text = object_lines(observation.objects, TextForm.FULL)
        assert re.findall(r"^- (\S+):", text, re.MULTILINE) == tags
        held = state.body.held
        hand = "empty" if held is None else self.server.tag(held)
        assert f"- hand: {hand}" in agent_lines(observation.agent, TextForm.FULL)
        with Image.open(io.BytesIO(observation.frame.data)) as picture:
            frame = np.asarray(picture.convert("RGB"))
        assert frame.shape[1::-1] == RESOLUTION
        for item in observation.objects:
            left, top, right, bottom = item.box_px
            drawn = frame[
                max(0, top - MARGIN_PX) : bottom + MARGIN_PX,
                max(0, left - MARGIN_PX) : right + MARGIN_PX,
            ]
            assert (drawn == tag_colour(item.tag)).all(axis=-1).any(), item.tag

    # --- what holds -------------------------------------------------------------------------

    @invariant()
    def the_world_is_sound(self) -> None:
        state = self.engine.state()
        assert not [*state_faults(state), *self.sound.faults(state)]

    def call(self, name: str, arguments: dict[str, Any] | None) -> str:
        """Make a call and compare the feedback with what happened; the hash of the state then."""
        before = self.engine.state()
        result = execute_call(self.server, name, arguments)
        after = self.engine.state()
        assert result.state_hash == after.hash()
        assert result.agent == self.server.agent()
        try:
            action = parse(name, arguments, self.server.actions)
        except InvalidActionError:
            assert result.feedback.outcome is Outcome.REFUSED
            assert after.hash() == before.hash()
        else:
            assert not step_faults(before, after, action, result.feedback)
        assert not [*state_faults(after), *self.sound.faults(after)]
        return result.state_hash

    def tag(self, thing: int) -> str:
        ids = sorted(self.engine.object_names)
        return self.server.tag(ids[thing % len(ids)])


class TabletopMachine(WorldMachine):
    scene = "s1"


class LivingRoomMachine(WorldMachine):
    scene = "s2"


MACHINES = pytest.mark.parametrize(
    "machine", [TabletopMachine, LivingRoomMachine], ids=lambda m: m.scene
)
SHARED = settings(
    deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)


# Failures are not shrunk, which takes minutes: the examples are short and always the same.
QUICK = settings(
    SHARED,
    max_examples=3,
    stateful_step_count=20,
    derandomize=True,
    database=None,
    phases=[Phase.generate],
)


@MACHINES
def test_the_world_stays_sound(machine: type[WorldMachine]) -> None:
    run_state_machine_as_test(machine, settings=QUICK)


@pytest.mark.slow
@MACHINES
def test_the_world_stays_sound_for_long(machine: type[WorldMachine]) -> None:
    run_state_machine_as_test(
        machine, settings=settings(SHARED, max_examples=60, stateful_step_count=40, print_blob=True)
    )
