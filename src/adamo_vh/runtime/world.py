"""From a scene to a compiled MuJoCo world, and the plain tables that the rest reads."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from adamo_vh.engine import FLOOR, FurnitureOutline, WorldSurface
from adamo_vh.geometry import Array, Box, Quaternion, Solid, Vec3
from adamo_vh.heap import give_back
from adamo_vh.observation import NOTHING
from adamo_vh.runtime.assets.asset import Asset, Collider
from adamo_vh.runtime.embodiment import FOV_Y_RAD
from adamo_vh.runtime.human.looks import Figure
from adamo_vh.runtime.scenes.scene import Furniture, Light, PlacedObject, Room, Scene
from adamo_vh.runtime.solids import outline

if TYPE_CHECKING:
    import mujoco

TIME_STEP_S = 0.002
ROOM = "room"
"""Body that carries floor, walls and ceiling."""


_LONG_EDGE_M = 0.012


@dataclass(frozen=True, slots=True)
class WorldObject:
    """Where an interactable object is found in the model."""

    id: int
    class_name: str
    size: Vec3
    body: int
    qpos: int
    """First of its 7 position coordinates."""
    qvel: int
    """First of its 6 velocity coordinates."""
    geoms: tuple[int, ...]
    """Those that collide."""


@dataclass(frozen=True, slots=True)
class CompiledWorld:
    """A compiled world."""

    name: str
    """Of the scene, with its variation."""
    model: mujoco.MjModel
    data: mujoco.MjData
    room: Room
    objects: dict[int, WorldObject]
    surfaces: tuple[WorldSurface, ...]
    solids: tuple[Solid, ...]
    """What static furniture occupies, collider by collider."""
    furniture_of_body: dict[int, str]
    furniture: tuple[FurnitureOutline, ...]
    object_of_geom: NDArray[np.int16]
    brightness: tuple[float, ...]
    """How bright the scene has its lights."""
    figure: Figure
    """Who stands in it."""
    absent: set[int] = field(default_factory=set)
    """Ids of the objects that are out of the room."""

    def present(self) -> Iterator[WorldObject]:
        """Every object that is in the room, by ascending id."""
        return (item for item in self.objects.values() if item.id not in self.absent)

    def box_of(self, object_id: int | None) -> Box | None:
        """The box of an object now; None for none."""
        return None if object_id is None else self.box(object_id)

    def box(self, object_id: int) -> Box:
        """The box of an object now."""
        item = self.objects[object_id]
        q = self.data.qpos[item.qpos : item.qpos + 7]
        turn = Quaternion(*(float(v) for v in q[3:7]))
        return Box(Vec3.of(q[:3]), item.size, turn)

    def surface(self, object_id: int) -> Array:
        """(N, 3) corners of what is drawn of an object, and places on its long edges.

        From its middle, turned as it is now.
        """
        from adamo_vh.runtime.assets.mujoco_parts import VISUAL_GROUP

        model, item = self.model, self.objects[object_id]
        parts = []
        for geom in np.flatnonzero(self.model.geom_bodyid == item.body):
            mesh = int(model.geom_dataid[geom])
            if mesh < 0 or model.geom_group[geom] != VISUAL_GROUP:
                continue
            first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
            turn = Quaternion(*model.geom_quat[geom].tolist()).matrix()
            corners = model.mesh_vert[first : first + count]
            face, faces = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
            ends = corners[model.mesh_face[face : face + faces][:, [0, 1, 1, 2, 2, 0]]]
            a, b = ends.reshape(-1, 2, 3).transpose(1, 0, 2)
            long = np.linalg.norm(b - a, axis=1) > _LONG_EDGE_M
            on_edges = [a[long] + share * (b - a)[long] for share in np.linspace(0.125, 0.875, 7)]
            parts.append(np.concatenate([corners, *on_edges]) @ turn.T + model.geom_pos[geom])
        turn = self.box(object_id).orientation.matrix()
        return np.asarray(np.concatenate(parts) @ turn.T)


def scene_assets(scene: Scene) -> dict[str, Asset]:
    """Every asset that a scene names, loaded once."""
    from adamo_vh.runtime.assets.bake import load_asset

    names = {item.asset for item in scene.furniture} | {item.asset for item in scene.objects}
    return {name: load_asset(name) for name in sorted(names)}


def build_world(
    scene: Scene, figure: Figure, assets: Mapping[str, Asset] | None = None
) -> CompiledWorld:
    """Compile a scene with a person in it.

    Args:
        scene: What is where.
        figure: The person.
        assets: Every asset that the scene names; are loaded if not given.

    Raises:
        SceneError: An object lies on a level that its furniture does not have.
    """
    import mujoco

    from adamo_vh.runtime.assets.mujoco_parts import add_asset
    from adamo_vh.runtime.human.skin_mujoco import add_human

    if assets is None:
        assets = scene_assets(scene)
    spec = _empty_spec(scene.ambient)
    shell = load_room(scene)
    walls = spec.worldbody.add_body(name=ROOM)
    add_asset(spec, walls, shell, ROOM)
    _cast_no_shadow(walls)
    surfaces, solids = _furnish(spec, scene, assets)
    for item in scene.objects:
        _add_object(spec, item, assets[item.asset], surfaces)
    for light in scene.lights:
        _add_light(spec, light)
    add_human(spec, figure)
    model = spec.compile()
    del spec
    # Compiling took some 60 MB.
    give_back()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    placed = sorted(scene.objects, key=lambda item: item.id)
    objects = {item.id: _locate(model, item.id, assets[item.asset]) for item in placed}
    object_of_geom = np.full(model.ngeom, NOTHING, np.int16)
    for world_object in objects.values():
        object_of_geom[model.geom_bodyid == world_object.body] = world_object.id
    furniture_of_body = {model.body(p.name).id: p.name for p in scene.furniture}
    return CompiledWorld(
        scene.full_name,
        model,
        data,
        scene.room,
        objects,
        tuple(surfaces),
        tuple(solids),
        furniture_of_body,
        tuple(_seen_from_above(piece, assets[piece.asset]) for piece in scene.furniture),
        object_of_geom,
        tuple(light.diffuse for light in scene.lights),
        figure,
    )


def _furnish(
    spec: mujoco.MjSpec, scene: Scene, assets: Mapping[str, Asset]
) -> tuple[list[WorldSurface], list[Solid]]:
    """Put the furniture in.

    Returns:
        What carries things, the floor first, and what the furniture occupies.
    """
    from adamo_vh.runtime.assets.mujoco_parts import add_asset

    room = scene.room
    surfaces = [
        WorldSurface(
            FLOOR,
            Vec3((room.x_min + room.x_max) / 2, (room.y_min + room.y_max) / 2, 0.0),
            (room.x_max - room.x_min) / 2,
            (room.y_max - room.y_min) / 2,
            0.0,
        )
    ]
    solids: list[Solid] = []
    for piece in scene.furniture:
        asset = assets[piece.asset]
        yaw = math.radians(piece.yaw_deg)
        body = spec.worldbody.add_body(
            name=piece.name, pos=[*piece.position, 0.0], quat=Quaternion.from_yaw(yaw).array()
        )
        add_asset(spec, body, asset, piece.name, shadow_light=_seen_by(piece, scene.lights))
        if not asset.colliders:
            _cast_no_shadow(body)
        surfaces += furniture_surfaces(piece, asset)
        solids += furniture_solids(piece, asset)
    return surfaces, solids


def _seen_by(piece: Furniture, lights: Sequence[Light]) -> Sequence[float] | None:
    """Where the light that casts shadows is, in the frame of a piece of furniture."""
    for light in lights:
        if light.shadow:
            offset = np.array(light.position) - [*piece.position, 0.0]
            return tuple(offset @ Quaternion.from_yaw(math.radians(piece.yaw_deg)).matrix())
    return None


def _cast_no_shadow(body: mujoco.MjsBody) -> None:
    """Keep a flat thing out of the shadow map, where it would only shade itself, in speckles."""
    for geom in body.geoms:
        geom.castshadow = False


def load_room(scene: Scene) -> Asset:
    """The room's shell for a scene."""
    from adamo_vh.runtime.assets.bake import load_built
    from adamo_vh.runtime.assets.room import room

    shell = scene.room
    extent = (shell.x_min, shell.x_max, shell.y_min, shell.y_max, shell.height_m)
    name = "_".join(["room", *(f"{value:.4f}" for value in extent)])
    return load_built(name, lambda: room(*extent))


def object_body(object_id: int) -> str:
    """Name of an object's body in the model."""
    return f"object_{object_id}"


def _empty_spec(ambient: float) -> mujoco.MjSpec:
    import mujoco

    spec = mujoco.MjSpec()
    spec.option.timestep = TIME_STEP_S
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.impratio = 10
    spec.stat.extent = 4.0
    spec.visual.map.znear = 0.01
    spec.visual.map.zfar = 5.0
    # The shadow map covers this part of a lamp's whole half space: 99 degrees.
    spec.visual.map.shadowscale = 0.55
    spec.visual.global_.fovy = math.degrees(FOV_Y_RAD)
    spec.visual.global_.offwidth = 1920
    spec.visual.global_.offheight = 1080
    spec.visual.headlight.ambient = [ambient, ambient * 0.535 / 0.54, ambient * 0.53 / 0.54]
    spec.visual.headlight.diffuse = [0.16, 0.16, 0.16]
    spec.visual.headlight.specular = [0.0, 0.0, 0.0]
    return spec


def _add_light(spec: mujoco.MjSpec, light: Light) -> None:
    import mujoco

    direction = np.array(light.target) - np.array(light.position)
    spec.worldbody.add_light(
        pos=light.position,
        dir=direction / np.linalg.norm(direction),
        type=mujoco.mjtLightType.mjLIGHT_SPOT,
        cutoff=90.0,
        exponent=0.6,
        diffuse=light_colour(light.diffuse),
        specular=[0.15, 0.15, 0.15],
        ambient=[0.0, 0.0, 0.0],
        castshadow=light.shadow,
    )


def light_colour(diffuse: float) -> list[float]:
    """Red, green and blue of a light of some brightness: a little warm."""
    return [diffuse, diffuse * 0.98, diffuse * 0.94]


def furniture_surfaces(piece: Furniture, asset: Asset) -> list[WorldSurface]:
    """What a piece of furniture carries things on, placed in the world."""
    yaw = math.radians(piece.yaw_deg)
    turn = Quaternion.from_yaw(yaw).matrix()
    found = []
    for surface in asset.surfaces:
        center = turn @ np.array(surface.center) + [*piece.position, 0.0]
        several = len(asset.surfaces) > 1
        name = f"{piece.name}/{surface.name}" if several else piece.name
        found.append(WorldSurface(name, Vec3.of(center), *surface.half_size, yaw))
    return found


def _seen_from_above(piece: Furniture, asset: Asset) -> FurnitureOutline:
    vertices = np.concatenate([part.vertices for part in asset.parts]).astype(np.float64)
    turn = Quaternion.from_yaw(math.radians(piece.yaw_deg)).matrix()[:2, :2]
    corners = (outline(vertices[:, :2]) @ turn.T + piece.position).round(3) + 0.0
    heights = vertices[:, 2].round(3) + 0.0
    return FurnitureOutline(
        piece.name,
        tuple((float(x), float(y)) for x, y in corners),
        float(heights.min()),
        float(heights.max()),
        tuple(furniture_surfaces(piece, asset)),
    )


def furniture_solids(piece: Furniture, asset: Asset) -> list[Solid]:
    """What a piece of furniture occupies, collider by collider."""
    yaw = math.radians(piece.yaw_deg)
    return [_solid(collider, piece.position, yaw) for collider in asset.colliders]


def _solid(collider: Collider, position: tuple[float, float], yaw_rad: float) -> Solid:
    """A collider of a piece of furniture, placed in the world."""
    if collider.shape == "box":
        half = np.array(collider.size)
    elif collider.shape == "sphere":
        half = np.full(3, collider.size[0])
    elif collider.shape == "ellipsoid":
        half = np.array(collider.size)
    else:
        radius, length = collider.size[:2]
        length += radius if collider.shape == "capsule" else 0.0
        half = np.array([radius, radius, length])
    turn = Quaternion.from_yaw(yaw_rad)
    center = turn.matrix() @ np.array(collider.position) + [*position, 0.0]
    local = Box(Vec3(0, 0, 0), Vec3.of(2 * half), Quaternion(*collider.quaternion))
    flat = Solid.around(local)
    return Solid(
        float(center[0]),
        float(center[1]),
        flat.half_x,
        flat.half_y,
        flat.yaw_rad + yaw_rad,
        float(center[2]) + flat.z_min,
        float(center[2]) + flat.z_max,
    )


def _add_object(
    spec: mujoco.MjSpec, item: PlacedObject, asset: Asset, surfaces: list[WorldSurface]
) -> None:
    from adamo_vh.errors import SceneError
    from adamo_vh.runtime.assets.mujoco_parts import add_asset

    surface = next((s for s in surfaces if s.support == item.on), None)
    if surface is None:
        offer = ", ".join(s.support for s in surfaces)
        raise SceneError(f"object {item.id}: nothing can lie on {item.on!r}; one of {offer}")
    height = surface.center.z + asset.size[2] / 2 + 0.001
    body = spec.worldbody.add_body(
        name=object_body(item.id),
        pos=[*item.position, height],
        quat=Quaternion.from_yaw(math.radians(item.yaw_deg)).array(),
    )
    body.add_freejoint()
    add_asset(spec, body, asset, object_body(item.id))


def _locate(model: mujoco.MjModel, object_id: int, asset: Asset) -> WorldObject:
    body = model.body(object_body(object_id)).id
    joint = int(model.body_jntadr[body])
    geoms = tuple(
        int(g)
        for g in np.flatnonzero(model.geom_bodyid == body)
        if model.geom_contype[g] or model.geom_conaffinity[g]
    )
    return WorldObject(
        object_id,
        asset.class_name,
        Vec3(*asset.size),
        body,
        int(model.jnt_qposadr[joint]),
        int(model.jnt_dofadr[joint]),
        geoms,
    )
