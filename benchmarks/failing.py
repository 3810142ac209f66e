"""Players that fail in one known way each: the oracle, with one thing gone wrong.

A way is a generator over a `Player`: it yields calls, texts and broken replies. What it does wrong
is decided here, from the truth, and never read by the diagnosis.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from adamo_vh.action import Drop, Look, Pick, ToolSchema, Walk, action_name
from adamo_vh.analysis.diagnosis import Code
from adamo_vh.benchmark.conditions import Aim, Holds, InArea, Near, OnFloor
from adamo_vh.benchmark.oracle import Oracle
from adamo_vh.benchmark.spots import floor_spots, near_spots
from adamo_vh.benchmark.tasks import Task
from adamo_vh.benchmark.taxonomy import Ref
from adamo_vh.engine import FLOOR, World, WorldState, acting_body
from adamo_vh.geometry import Vec3
from adamo_vh.inference.messages import AIMessage, Message, ToolCall
from adamo_vh.inference.model import Ending, ModelInfo, ModelKind, Reply, Sampling
from adamo_vh.observation import Frame
from adamo_vh.perception import Labeling
from adamo_vh.record.trajectory import Event, Observed

Call = tuple[str, dict[str, Any]]
Said = Look | Walk | Pick | Drop | Call | str | Reply
DONE = ("Done.", "All is done as you asked.", "The task is complete.", "I have finished the task.")
STOPS = ("I stop here.", "I cannot do this.", "I could not finish it.", "I give up.")
LOST = ("I cannot find it.", "There is no such object here.", "I could not find what you mean.")


class Player:
    """Knows the truth, and plays what a way tells it to."""

    def __init__(self, way: Way, task: Task, world: World, labeling: Labeling, seed: int) -> None:
        """Sit down; the world is the one in which the episode is about to be played.

        Args:
            way: How to fail.
            task: What is asked.
            world: The truth.
            labeling: How things are called.
            seed: Of what is left open: which object, which place, which words.
        """
        self.task, self.world, self.labeling = task, world, labeling
        self.lots = random.Random(f"{way.name} {task.id} {labeling} {world.scene.full_name} {seed}")
        self.seen: set[int] = set()
        self.goals = tuple(goal for goal in task.conditions if isinstance(goal, Aim))
        self._name = way.name
        self._talk = self.lots.choice(("silent", "plain", "naming"))
        self._said = way.play(self)
        self._count = 0

    @property
    def info(self) -> ModelInfo:
        """A scripted player."""
        return ModelInfo(f"failing:{self._name}", ModelKind.SCRIPTED)

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """See what the agent sees."""
        if isinstance(event, Observed):
            names = self.world.object_names
            found = (self.labeling.resolve(item.tag, names) for item in event.objects)
            self.seen.update(number for number in found if number is not None)

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Say what comes next; the messages play no part."""
        said = next(self._said, "I have nothing more to say.")
        if isinstance(said, Reply):
            return said
        if isinstance(said, str):
            return Reply(AIMessage(said))
        call = said if isinstance(said, tuple) else (action_name(type(said)), asdict(said))
        self._count += 1
        note = {"silent": "", "plain": f"Next: {call[0]}."}.get(
            self._talk, f"I have looked at the view. Next: {call[0]} {call[1].get('object', '')}"
        )
        return Reply(AIMessage(note, (ToolCall(f"call_{self._count}", *call),)))

    # --- what ways are made of --------------------------------------------------------------

    @property
    def state(self) -> WorldState:
        """The truth now."""
        return self.world.state()

    def tag(self, object_id: int) -> str:
        """What an object is called."""
        return self.labeling.tag(object_id, self.world.object_names[object_id])

    def pursue(self, goals: Sequence[Aim]) -> Iterator[Said]:
        """Play the oracle to its end."""
        oracle = Oracle(goals, self.tag, acting_body(self.world).info)
        while (action := oracle.next_action(self.state, self.seen)) is not None:
            yield action

    def until_held(self, condition: Aim) -> Iterator[Said]:
        """Play the oracle until the object of a condition is in the hand."""
        yield from self.pursue([Holds(condition.id)])

    def until_drop(self, condition: Aim) -> Iterator[Said]:
        """The same; a condition that is met already is left alone."""
        if not condition.satisfied(self.state):
            yield from self.until_held(condition)

    def put(self, object_id: int, point: Vec3) -> Drop:
        """Put something down at a point."""
        return Drop(self.tag(object_id), point.x, point.y, point.z)

    def strangers(self) -> list[int]:
        """Objects that the task says nothing of."""
        return sorted(set(self.world.object_names) - self.task.objects)

    def lookalike(self, object_id: int) -> int:
        """The stranger that is most like an object: of its class, or of its size."""
        state, names = self.state, self.world.object_names
        size = sorted(state.object(object_id).box.size.array())

        def unlike(other: int) -> tuple[bool, float]:
            edges = zip(size, sorted(state.object(other).box.size.array()), strict=True)
            return names[other] != names[object_id], sum(abs(a - b) for a, b in edges)

        return min(self.strangers(), key=unlike)

    def floor(self, object_id: int) -> Vec3:
        """An open place on the floor, in reach."""
        state, info = self.state, acting_body(self.world).info
        spots = floor_spots(state, state.object(object_id), [state.body.position], info)
        return next(spot for spot in spots if not self.in_an_area(spot))

    def in_an_area(self, spot: Vec3) -> bool:
        """Whether a place is in or close to a named area."""
        return any(
            area.x_min - 0.3 <= spot.x <= area.x_max + 0.3
            and area.y_min - 0.3 <= spot.y <= area.y_max + 0.3
            for area in self.world.scene.areas
        )

    def somewhere(self, height_m: float) -> Vec3:
        """Any point of the room."""
        scene = self.world.scene
        x = self.lots.uniform(scene.x_min + 0.5, scene.x_max - 0.5)
        y = self.lots.uniform(scene.y_min + 0.5, scene.y_max - 0.5)
        return Vec3(x, y, height_m).rounded(2)

    def any_goal(self, *kinds: type) -> int:
        """Number of a goal of some kinds."""
        return self.lots.choice(
            [i for i, goal in enumerate(self.goals) if not kinds or isinstance(goal, kinds)]
        )

    def others(self, number: int) -> list[Aim]:
        """All goals but one."""
        return [goal for i, goal in enumerate(self.goals) if i != number]

    def done(self) -> str:
        """A claim of success; it may name everything."""
        return self.lots.choice((*DONE, f"Done: {self.task.prompt}."))


@dataclass(frozen=True, slots=True)
class Way:
    """One way to fail."""

    name: str
    code: Code
    play: Callable[[Player], Iterator[Said]]
    fits: Callable[[Task, Labeling], bool]
    """Tasks and labelings in which it is possible."""
    max_steps: int = 60


WAYS: list[Way] = []
Play = Callable[[Player], Iterator[Said]]
Fits = Callable[[Task, Labeling], bool]


def _any(task: Task, labeling: Labeling) -> bool:
    return True


def _placing(task: Task, labeling: Labeling) -> bool:
    return not any(isinstance(goal, Holds) for goal in task.conditions)


def _of(*kinds: type) -> Fits:
    return lambda task, _: any(isinstance(goal, kinds) for goal in task.conditions)


def _several(task: Task, labeling: Labeling) -> bool:
    return len(task.conditions) > 1 and Ref.GROUP_SIMPLE not in task.units


def _group(task: Task, labeling: Labeling) -> bool:
    return Ref.GROUP_SIMPLE in task.units


def _by_looks(task: Task, labeling: Labeling) -> bool:
    looks = {Ref.COLOR, Ref.SHAPE, Ref.PATTERN, Ref.SUPER_EXTREMUM}
    if len(task.conditions) > 1:
        return False
    return bool(looks & set(task.units)) or (labeling is Labeling.OPAQ and Ref.ID not in task.units)


def way(code: Code, fits: Fits = _any, max_steps: int = 60) -> Callable[[Play], Play]:
    """Register a way to fail."""

    def register(play: Play) -> Play:
        WAYS.append(Way(play.__name__, code, play, fits, max_steps))
        return play

    return register


# --- perceptual ---------------------------------------------------------------------------------


@way(Code.WRONG_OBJECT)
def takes_a_lookalike(p: Player) -> Iterator[Said]:
    """One object is mistaken for another of its class or size; all else is right."""
    number = p.any_goal()
    goals = list(p.goals)
    goals[number] = replace(goals[number], id=p.lookalike(goals[number].id))
    yield from p.pursue(goals)
    yield p.done()


@way(Code.WRONG_OBJECT)
def takes_anything(p: Player) -> Iterator[Said]:
    """Every object is some other one."""
    strangers = p.lots.sample(p.strangers(), len(p.goals))
    goals = [replace(goal, id=x) for goal, x in zip(p.goals, strangers, strict=True)]
    yield from p.pursue(goals)
    yield p.done()


@way(Code.WRONG_OBJECT, _placing)
def takes_another_and_keeps_it(p: Player) -> Iterator[Said]:
    """The wrong object is taken, and nothing more comes of it."""
    yield from p.pursue([Holds(p.lots.choice(p.strangers()))])
    yield p.lots.choice((*DONE, *STOPS))


@way(Code.WRONG_ANCHOR, _of(Near))
def puts_it_beside_another(p: Player) -> Iterator[Said]:
    """The right object goes to the wrong neighbour."""
    number = p.any_goal(Near)
    goals = list(p.goals)
    near, state = goals[number], p.state
    assert isinstance(near, Near)
    center = state.object(near.anchor).box.center
    far = [
        x
        for x in p.strangers()
        if state.object(x).box.center.horizontal_distance(center) > 0.8
        and near_spots(state, state.object(near.id), state.object(x))
    ]
    goals[number] = replace(near, anchor=p.lots.choice(far))
    yield from p.pursue(goals)
    yield p.done()


@way(Code.NEVER_FOUND, _group)
def never_looks_round(p: Player) -> Iterator[Said]:
    """Does what can be done with what is in the first view."""
    yield from p.pursue([goal for goal in p.goals if goal.id in p.seen])
    yield p.lots.choice(LOST)


@way(Code.NEVER_FOUND, _group)
def looks_in_the_wrong_places(p: Player) -> Iterator[Said]:
    """The same, after looking where nothing is."""
    yield from p.pursue([goal for goal in p.goals if goal.id in p.seen])
    for height in (2.9, 3.0):
        point = p.somewhere(height)
        yield Look(point.x, point.y, point.z)
    yield p.lots.choice(LOST)


@way(Code.NOT_RECOGNISED, _by_looks)
def does_not_know_it(p: Player) -> Iterator[Said]:
    """Has it in view, looks on, and gives up."""
    for height in (0.8, 1.0, 0.5):
        point = p.somewhere(height)
        yield Look(point.x, point.y, point.z)
    yield p.lots.choice(LOST)


@way(Code.NOT_RECOGNISED, _group)
def misses_some_of_the_group(p: Player) -> Iterator[Said]:
    """Does most of a group, and takes that for all."""
    here = [goal for goal in p.goals if goal.id in p.seen]
    missed = p.lots.sample(here, p.lots.choice((1, 2)))
    yield from p.pursue([goal for goal in p.goals if goal not in missed])
    yield p.lots.choice(DONE)


@way(Code.UNKNOWN_TAG)
def names_what_is_not_there(p: Player) -> Iterator[Said]:
    """Picks an object that does not exist, a few times."""
    tag = "Vase_99" if p.labeling is Labeling.SEM else "99"
    for _ in range(p.lots.choice((2, 5))):
        yield Pick(tag)
    yield p.lots.choice(STOPS)


# --- execution ----------------------------------------------------------------------------------


@way(Code.TOO_FAR, _of(Near))
def puts_it_too_far_away(p: Player) -> Iterator[Said]:
    """Aims a good way past the anchor, on its surface."""
    number = p.any_goal(Near)
    for i, goal in enumerate(p.goals):
        if i != number:
            yield from p.pursue([goal])
            continue
        assert isinstance(goal, Near)
        yield from p.until_held(goal)
        state = p.state
        anchor = state.object(goal.anchor)
        others = [o for o in state.objects if o.support == anchor.support]
        ends = [o.box.center for o in others if o.id not in goal.objects]
        # Along the surface, towards the other things on it.
        center = anchor.box.center
        spots = [
            center + (end - center) * (away / end.horizontal_distance(center))
            for end in ends
            for away in (0.42, 0.5, 0.58)
            if end.horizontal_distance(center) > away
        ]
        spots = [Vec3(s.x, s.y, anchor.box.bottom_z).rounded(2) for s in spots]
        if spots:
            yield p.put(goal.id, p.lots.choice(spots))
        else:  # Nothing on this surface is far enough.
            yield from p.pursue([goal])
    yield p.done()


@way(Code.WRONG_SUPPORT, _placing)
def puts_it_on_another_surface(p: Player) -> Iterator[Said]:
    """On the floor in place of the table, or on a table in place of the floor."""
    number = p.any_goal()
    for i, goal in enumerate(p.goals):
        if i != number:
            yield from p.pursue([goal])
            continue
        yield from p.until_held(goal)
        yield p.put(goal.id, _elsewhere(p, goal))
    yield p.done()


def _elsewhere(p: Player, goal: Aim) -> Vec3:
    """A place on a surface that is not asked for."""
    if isinstance(goal, Near):
        return p.floor(goal.id)
    state = p.state
    held = state.object(goal.id)
    above = [o for o in state.objects if o.support not in (None, FLOOR) and o.box.bottom_z < 1.0]
    spots = [spot for o in above for spot in near_spots(state, held, o)[:5]]
    return p.lots.choice(spots)


@way(Code.OUTSIDE_AREA, _of(InArea))
def puts_it_outside_the_area(p: Player) -> Iterator[Said]:
    """On the floor, and not in the corner."""
    for goal in p.goals:
        yield from p.until_held(goal)
        yield p.put(goal.id, p.floor(goal.id))
    yield p.done()


@way(Code.NOT_RELEASED, _placing)
def holds_on_to_it(p: Player) -> Iterator[Said]:
    """Takes the last thing and never puts it down."""
    yield from p.pursue(p.goals[:-1])
    yield from p.until_held(p.goals[-1])
    yield p.lots.choice((*DONE, *STOPS))


@way(Code.NOT_RELEASED, _several)
def never_puts_the_first_one_down(p: Player) -> Iterator[Said]:
    """Takes the first thing, and tries to take the next with a full hand."""
    if isinstance(p.goals[0], Holds):
        return
    yield from p.until_held(p.goals[0])
    for goal in p.goals[1:]:
        yield Pick(p.tag(goal.id))
    yield p.lots.choice((*DONE, *STOPS))


@way(Code.FALSE_CLAIM)
def claims_success_at_once(p: Player) -> Iterator[Said]:
    """Looks once, and says that all is done."""
    if p.lots.random() < 0.5:
        center = p.state.object(p.goals[0].id).box.center
        yield Look(*(round(v, 2) for v in (center.x, center.y, center.z)))
    yield p.done()


@way(Code.FALSE_CLAIM, _several)
def claims_the_rest(p: Player) -> Iterator[Said]:
    """Does the first thing, and claims all of them by name."""
    yield from p.pursue(p.goals[:1])
    things = " and ".join(p.tag(goal.id) for goal in p.goals)
    yield (
        f"Done: objects {things} are where you want them."
        if p.labeling is Labeling.SEM
        else (
            "Done: "
            + " and ".join(f"object {goal.id}" for goal in p.goals)
            + " are in their places."
        )
    )


@way(Code.GAVE_UP)
def stops_without_a_claim(p: Player) -> Iterator[Said]:
    """Looks at the thing, and stops."""
    if p.lots.random() < 0.7:
        center = p.state.object(p.goals[0].id).box.center
        yield Look(*(round(v, 2) for v in (center.x, center.y, center.z)))
    yield p.lots.choice(STOPS[:2])


@way(Code.REFUSED, _placing)
def drops_it_outside_the_room(p: Player) -> Iterator[Said]:
    """The right thing to a point that is far outside, again and again."""
    number = p.any_goal()
    yield from p.pursue(p.goals[:number])
    yield from p.until_held(p.goals[number])
    for _ in range(p.lots.choice((1, 3, 6))):
        yield p.put(p.goals[number].id, Vec3(40.0, -25.0, 0.0))
    yield p.lots.choice((*DONE, *STOPS))


@way(Code.REFUSED)
def looks_outside_the_room(p: Player) -> Iterator[Said]:
    """Coordinates in another unit, from the first call on."""
    for i in range(8):
        yield Look(120.0 + i, -85.0, 78.0)
    yield p.lots.choice(STOPS)


@way(Code.REFUSED, _placing)
def drops_it_in_the_air(p: Player) -> Iterator[Said]:
    """Where nothing carries it, and where no hand reaches."""
    yield from p.until_held(p.goals[0])
    for i in range(4):
        yield p.put(p.goals[0].id, Vec3(-1.5, -1.0, 2.6 + 0.1 * i))
    yield p.lots.choice((*DONE, *STOPS))


@way(Code.RAN_OUT, _several, max_steps=5)
def is_too_slow(p: Player) -> Iterator[Said]:
    """Looks at everything before it takes it; the steps do not suffice."""
    for goal in p.goals:
        for action in p.pursue([goal]):
            center = p.state.object(goal.id).box.center
            yield Look(*(round(v, 2) for v in (center.x, center.y, center.z)))
            yield action


# --- reasoning ----------------------------------------------------------------------------------


@way(Code.GOAL_FORGOTTEN, _several)
def forgets_the_last_goal(p: Player) -> Iterator[Said]:
    """Does all but the last thing."""
    yield from p.pursue(p.goals[:-1])
    yield p.lots.choice(DONE)


@way(Code.GOAL_FORGOTTEN, _several)
def skips_the_first_goal(p: Player) -> Iterator[Said]:
    """Begins with the second thing."""
    yield from p.pursue(p.goals[1:])
    yield p.lots.choice(DONE)


@way(Code.WRONG_ORDER, _placing)
def drops_before_it_picks(p: Player) -> Iterator[Said]:
    """Puts down what it does not hold, and then takes it."""
    goal = p.goals[0]
    yield p.put(goal.id, p.floor(goal.id))
    yield from p.until_held(goal)
    yield p.lots.choice(DONE)


@way(Code.WRONG_ORDER, _several)
def picks_all_before_it_drops(p: Player) -> Iterator[Said]:
    """Takes the second thing while it holds the first."""
    first, *rest = p.goals
    yield from p.until_held(first)
    for goal in rest:
        yield Pick(p.tag(goal.id))
    yield from p.pursue([first])
    for goal in rest:
        yield p.put(goal.id, p.floor(goal.id))
    yield p.lots.choice(DONE)


@way(Code.EXTRA_GOAL, _of(Holds))
def puts_down_what_it_was_to_hold(p: Player) -> Iterator[Said]:
    """Takes it, and puts it on the floor, which nobody asked for."""
    yield from p.pursue(p.goals)
    yield p.put(p.goals[0].id, p.floor(p.goals[0].id))
    yield p.done()


@way(Code.EXTRA_GOAL, _of(Near))
def takes_the_anchor_away(p: Player) -> Iterator[Said]:
    """Does all, and then moves the anchor."""
    yield from p.pursue(p.goals)
    number = p.any_goal(Near)
    near = p.goals[number]
    assert isinstance(near, Near)
    yield Pick(p.tag(near.anchor))
    yield p.put(near.anchor, p.floor(near.anchor))
    yield p.done()


@way(Code.EXTRA_GOAL)
def moves_one_more_thing(p: Player) -> Iterator[Said]:
    """Does all, and moves something that nobody spoke of; in a task of the hand, before that."""
    extra: list[Aim] = [OnFloor(p.lots.choice(p.strangers()))]
    goals = [*extra, *p.goals] if isinstance(p.goals[-1], Holds) else [*p.goals, *extra]
    yield from p.pursue(goals)
    yield p.done()


@way(Code.PUT_BACK, _placing)
def puts_it_back(p: Player) -> Iterator[Said]:
    """Does all, and brings one thing back to where it was."""
    start = p.state
    yield from p.pursue(p.goals)
    goal = p.goals[p.any_goal()]
    box = start.object(goal.id).box
    yield Pick(p.tag(goal.id))
    yield p.put(goal.id, Vec3(box.center.x, box.center.y, box.bottom_z))
    yield p.done()


@way(Code.LOOP)
def looks_to_and_fro(p: Player) -> Iterator[Said]:
    """Looks at two places in turn, for ever."""
    yield from _begin(p)
    one, two = p.somewhere(0.8), p.somewhere(1.0)
    while True:
        yield Look(one.x, one.y, one.z)
        yield Look(two.x, two.y, two.z)


@way(Code.LOOP)
def takes_and_puts_for_ever(p: Player) -> Iterator[Said]:
    """Takes the thing and puts it where it was, for ever."""
    goal, start = p.goals[0], p.state
    yield from p.until_held(goal)
    box = start.object(goal.id).box
    while True:
        yield p.put(goal.id, Vec3(box.center.x, box.center.y, box.bottom_z))
        yield Pick(p.tag(goal.id))


@way(Code.WRONG_ROLE, _of(Near))
def moves_the_anchor_instead(p: Player) -> Iterator[Said]:
    """Takes what was to stay."""
    number = p.any_goal(Near)
    near = p.goals[number]
    assert isinstance(near, Near)
    yield from p.pursue([OnFloor(near.anchor)])
    yield from p.pursue([goal for goal in p.others(number) if near.anchor not in goal.objects])
    yield p.done()


@way(Code.NO_PROGRESS, lambda task, _: Ref.ID in task.units and len(task.conditions) == 1, 25)
def walks_about(p: Player) -> Iterator[Said]:
    """Knows the thing by its number, and walks from place to place until the limit."""
    while True:
        point = p.somewhere(0.0)
        yield Walk(point.x, point.y, 0.0)


# --- protocol -----------------------------------------------------------------------------------


def _begin(p: Player) -> Iterator[Said]:
    """Perhaps a first right call."""
    if p.lots.random() < 0.5:
        for action in p.pursue(p.goals[:1]):
            yield action
            return


@way(Code.UNREADABLE)
def writes_broken_calls(p: Player) -> Iterator[Said]:
    """What is meant as a call cannot be read."""
    yield from _begin(p)
    while True:
        broken = AIMessage('{"tool": "Pick", "args": {"object": ')
        yield Reply(broken, ending=Ending.UNPARSED_CALL, unreadable="is no JSON object.")


@way(Code.EMPTY)
def says_nothing(p: Player) -> Iterator[Said]:
    """Empty replies."""
    yield from _begin(p)
    while True:
        yield ""


@way(Code.CUT_OFF)
def is_cut_off(p: Player) -> Iterator[Said]:
    """Every reply ends at the limit of tokens."""
    yield from _begin(p)
    while True:
        long = AIMessage("Let me think about this. The plate is " * 3)
        yield Reply(long, ending=Ending.CUT_OFF, unreadable="was cut off after 4000 tokens.")


@way(Code.UNKNOWN_TOOL)
def calls_other_tools(p: Player) -> Iterator[Said]:
    """Tools of another robot."""
    yield from _begin(p)
    for i in range(9):
        yield ("grasp_object", {"target": p.tag(p.goals[0].id), "try": i})
    yield p.lots.choice(STOPS)


@way(Code.BAD_ARGUMENTS)
def gives_other_arguments(p: Player) -> Iterator[Said]:
    """The right tool, with arguments of another one."""
    yield from _begin(p)
    for i in range(9):
        yield ("Look", {"target": p.tag(p.goals[0].id), "zoom": i})
    yield p.lots.choice(STOPS)


@way(Code.NO_CALL)
def only_writes(p: Player) -> Iterator[Said]:
    """Text that is neither a call nor an answer."""
    yield p.lots.choice(
        (
            "qwpoe zzxlk 00!! ,,,",
            "Pick(object) -> Drop(object)",
            "As a language model I would first look at the table.",
            "<|im_start|>assistant<|im_end|>",
        )
    )
