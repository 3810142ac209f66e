"""What happens to a world without its body: objects moved, taken and brought, lights changed."""

from __future__ import annotations

from adamo_vh.engine import LightChanged, ObjectAdded, ObjectMoved, ObjectTaken, WorldEvent
from adamo_vh.errors import EngineError
from adamo_vh.geometry import Solid, Vec3
from adamo_vh.runtime import physics
from adamo_vh.runtime.builtin_body import BuiltinBody
from adamo_vh.runtime.navigation import BODY_HEIGHT_M, BODY_RADIUS_M
from adamo_vh.runtime.placement import MAX_CORRECTION_M, free_spots
from adamo_vh.runtime.world import CompiledWorld, WorldObject, light_colour

_AWAY = Vec3(0.0, 0.0, -40.0)
"""Where an object is kept that is out of the room: beyond what is drawn, touching nothing."""


class Happenings:
    """Carries events out on a compiled world."""

    def __init__(self, world: CompiledWorld, body: BuiltinBody) -> None:
        """Take hold of a world.

        Args:
            world: Is changed by events.
            body: Stands in it; what it holds is its own.
        """
        self._world = world
        self._body = body
        self.lights = world.brightness
        """How bright the lights are now."""
        model = world.model
        self._touch = {
            item.id: (
                int(model.geom_contype[item.geoms[0]]),
                int(model.geom_conaffinity[item.geoms[0]]),
            )
            for item in world.objects.values()
        }
        """Collision bits of every object."""

    def apply(self, event: WorldEvent) -> None:
        """Carry an event out, and let everything come to rest.

        Raises:
            EngineError: It cannot be done; nothing changed.
        """
        match event:
            case ObjectMoved(object_id=object_id, point=point):
                self._put(self._free(object_id), point)
            case ObjectTaken(object_id=object_id):
                item = self._free(object_id)
                self._set_absent(self._world.absent | {item.id})
                physics.put_down(self._world, item.id, _AWAY, self._body.stance.held)
            case ObjectAdded(object_id=object_id, point=point):
                if object_id not in self._world.absent:
                    raise EngineError(
                        f"Object {object_id} cannot be added: this engine can only bring back "
                        "objects of the scene that were taken before."
                    )
                self._put(self._world.objects[object_id], point)
            case LightChanged(light=light, diffuse=diffuse):
                if not 0 <= light < len(self.lights) or not 0.0 <= diffuse <= 1.0:
                    raise EngineError(
                        f"Light {light} cannot be set to {diffuse:g}: the scene has lights 0 to "
                        f"{len(self.lights) - 1}, each from 0 to 1."
                    )
                before, after = self.lights[:light], self.lights[light + 1 :]
                self._set_lights((*before, diffuse, *after))

    def undo(self, absent: frozenset[int], lights: tuple[float, ...]) -> None:
        """Have other objects out of the room and other lights; poses are set elsewhere."""
        self._set_absent(absent)
        self._set_lights(lights)

    def _free(self, object_id: int) -> WorldObject:
        """An object that is in the room and in no hand."""
        item = self._world.objects.get(object_id)
        if item is None or object_id in self._world.absent:
            raise EngineError(f"There is no object {object_id} in the room.")
        if object_id == self._body.stance.held:
            raise EngineError(f"Object {object_id} is in the hand: it cannot be moved or taken.")
        return item

    def _put(self, item: WorldObject, point: Vec3) -> None:
        """Put an object at the free place nearest to a point, not where the body stands."""
        at, room = self._body.stance.position, self._world.room
        size = BODY_RADIUS_M, BODY_RADIUS_M
        body = Solid(at.x, at.y, *size, 0.0, 0.0, BODY_HEIGHT_M)
        shape = Solid.around(self._world.box(item.id))
        obstacles = [*self._body.obstacles(item.id), body]
        for spot in free_spots(point, shape, self._world.surfaces, obstacles):
            if spot.center.z + (shape.z_max - shape.z_min) / 2 < room.height_m:
                self._set_absent(self._world.absent - {item.id})
                physics.put_down(self._world, item.id, spot.center, self._body.stance.held)
                return
        raise EngineError(f"No free place within {MAX_CORRECTION_M:g} m of {point}.")

    def _set_absent(self, absent: frozenset[int] | set[int]) -> None:
        world = self._world
        for item in world.objects.values():
            physics.set_touch(world, item, (0, 0) if item.id in absent else self._touch[item.id])
        world.absent.clear()
        world.absent.update(absent)

    def _set_lights(self, lights: tuple[float, ...]) -> None:
        for number, diffuse in enumerate(lights):
            self._world.model.light_diffuse[number] = light_colour(diffuse)
        self.lights = lights
