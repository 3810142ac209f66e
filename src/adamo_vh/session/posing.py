"""What a moving picture elsewhere needs of the built-in engine: every pose, at every moment.

Numbers, no pixels: whoever has the scene and the figure as meshes can draw what happens. Looking on
changes nothing about the episode, unless it is asked to stop an action where it is.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from adamo_vh.errors import ConfigError

if TYPE_CHECKING:
    from adamo_vh.engine import World
    from adamo_vh.geometry import Array
    from adamo_vh.runtime.builtin import BuiltinEngine

RATE_HZ = 30
"""How often an action is shown."""
_DIGITS = 4
_Numbers = tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Pose:
    """How figure and things stand at one moment: what changed since the pose before it."""

    body: _Numbers
    """Where it stands, x and y in metres, and its heading in radians."""
    pelvis: _Numbers
    """Place of the first joint in the frame of the body, metres."""
    joints: _Numbers
    """The turn of each joint relative to its parent, as quaternions x, y, z, w in a row."""
    eyes: _Numbers
    """How the eyes are turned in the head, radians to the left and down."""
    held: int | None
    """Id of the object in the hand."""
    things: dict[str, _Numbers] = field(default_factory=dict)
    """By id, objects that are elsewhere than before: place in metres, and x, y, z, w."""
    gone: tuple[int, ...] | None = None
    """Ids of the objects that are out of the room, if that changed."""
    lights: _Numbers | None = None
    """How bright the lights are, 0 to 1, if that changed."""

    def after(self, before: Pose) -> Pose:
        """This pose with what changed in one that is left out before it."""
        return Pose(
            self.body,
            self.pelvis,
            self.joints,
            self.eyes,
            self.held,
            before.things | self.things,
            before.gone if self.gone is None else self.gone,
            before.lights if self.lights is None else self.lights,
        )


@dataclass(slots=True)
class _Known:
    """What was told last."""

    figure: tuple[object, ...] = ()
    things: dict[str, _Numbers] = field(default_factory=dict)
    gone: tuple[int, ...] | None = None
    lights: _Numbers | None = None


class Posing:
    """An engine while its poses are told."""

    def __init__(self, world: World, moment: Callable[[], bool] | None = None) -> None:
        """Look at an engine.

        Args:
            world: The engine.
            moment: Is called at every shown moment of an action; returns False to stop it there.

        Raises:
            ConfigError: Another engine than the built-in one tells no poses.
        """
        from adamo_vh.runtime.builtin import BuiltinEngine

        if not isinstance(world, BuiltinEngine):
            raise ConfigError("Only the built-in engine tells the poses that a page draws.")
        self._engine: BuiltinEngine = world
        self._moment = moment or (lambda: True)
        self._known = _Known()
        self._since_s = world.stage.shown_s
        world.stage.watch(lambda _: self._moment(), RATE_HZ)

    @property
    def seconds(self) -> float:
        """Simulated seconds of motion since it was first looked at."""
        return self._engine.stage.shown_s - self._since_s

    def close(self) -> None:
        """Look on no longer."""
        self._engine.stage.watch(None)

    def pose(self) -> Pose | None:
        """The pose now, with what changed since it was last asked; None if nothing did."""
        known, engine = self._known, self._engine
        with engine.turns:
            figure = self._figure()
            things = self._things()
            gone = tuple(sorted(engine.world.absent))
            lights = _rounded(engine.world.model.light_diffuse[:, 0])
        moved = {name: at for name, at in things.items() if known.things.get(name) != at}
        is_same = figure == known.figure and not moved
        if is_same and (gone, lights) == (known.gone, known.lights):
            return None
        told = Pose(
            *figure,
            moved,
            None if gone == known.gone else gone,
            None if lights == known.lights else lights,
        )
        self._known = _Known(figure, things, gone, lights)
        return told

    def _figure(self) -> tuple[_Numbers, _Numbers, _Numbers, _Numbers, int | None]:
        from adamo_vh.runtime.human.rotations import quaternions
        from adamo_vh.runtime.human.skeleton import REST

        shown = self._engine.stage.shown(self._engine.body.stance)
        body, pose = shown.body, shown.pose
        at = body.position
        turns = quaternions(pose.rotations)[:, [1, 2, 3, 0]]
        return (
            _rounded([at.x, at.y, body.heading_rad]),
            _rounded(REST[0] + pose.pelvis_shift),
            _rounded(turns.ravel()),
            _rounded(list(shown.look_rad)),
            body.held,
        )

    def _things(self) -> dict[str, _Numbers]:
        world = self._engine.world
        found = {}
        for item in world.present():
            x, y, z, w, *turn = world.data.qpos[item.qpos : item.qpos + 7].tolist()
            found[str(item.id)] = _rounded([x, y, z, *turn, w])
        return found


def joint_names() -> tuple[str, ...]:
    """The joints of every figure as its GLB names them, in the order of a pose."""
    from adamo_vh.runtime.human.bone_names import BONES

    return BONES


def _rounded(values: Array | list[float]) -> _Numbers:
    return tuple(round(float(value), _DIGITS) + 0.0 for value in values)
