"""Put an asset on a MuJoCo body: meshes and textures straight from memory, no files.

Visual meshes are drawn and never collide (geom group 1); collision primitives carry the mass, are
not drawn and stay visible to rays (geom group 3).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from adamo_vh.runtime.assets.asset import Asset, Collider, Material, Part

if TYPE_CHECKING:
    import mujoco

VISUAL_GROUP = 1
"""Geom group of what is drawn."""
COLLISION_GROUP = 3
"""Geom group of what collides; MuJoCo does not draw it by default."""

_FRICTION = (0.9, 0.01, 0.0005)
_COLLIDER_RGBA = (0.1, 0.8, 0.3, 0.3)


def add_asset(
    spec: mujoco.MjSpec,
    body: mujoco.MjsBody,
    asset: Asset,
    name: str,
    *,
    collide: bool = True,
    shadow_light: Sequence[float] | None = None,
) -> None:
    """Add an asset's meshes, textures, materials and geoms; the body's frame is the asset's.

    Args:
        spec: The model being built.
        body: Where the geoms go.
        asset: What to add.
        name: Prefix of everything added, unique in the model.
        collide: Add the collision primitives and with them the mass. Without, the body is a ghost.
        shadow_light: Where the light that casts shadows is, in the asset's frame; for what never
            moves. Closed parts then cast theirs from the sides that lie in shadow anyway, so that
            no lit side is speckled by its own shadow.
    """
    for i, part in enumerate(asset.parts):
        _add_part(spec, body, part, f"{name}/{i}_{part.material.name}", shadow_light)
    if not collide:
        return
    volumes = [volume_m3(collider) for collider in asset.colliders]
    for i, (collider, volume) in enumerate(zip(asset.colliders, volumes, strict=True)):
        mass_kg = asset.mass_kg * volume / sum(volumes)
        _add_collider(body, collider, mass_kg, f"{name}/collider{i}")


def volume_m3(collider: Collider) -> float:
    """Volume of a collision primitive."""
    a, b, c = collider.size
    match collider.shape:
        case "box":
            return 8 * a * b * c
        case "cylinder":
            return 2 * math.pi * a * a * b
        case "capsule":
            return math.pi * a * a * (2 * b + 4 / 3 * a)
        case "sphere":
            return 4 / 3 * math.pi * a**3
        case "ellipsoid":
            return 4 / 3 * math.pi * a * b * c
    raise ValueError(f"unknown collider shape {collider.shape!r}")


def _add_part(
    spec: mujoco.MjSpec,
    body: mujoco.MjsBody,
    part: Part,
    name: str,
    shadow_light: Sequence[float] | None,
) -> None:
    add_material(spec, part.material, name)
    casts = part.material.casts_shadow
    if shadow_light is None or not casts or not is_closed(part):
        _add_mesh(spec, body, part, _back_to_front(part), name, name, casts)
        return
    a, b, c = np.moveaxis(part.vertices[part.faces], 1, 0)
    unlit = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - np.array(shadow_light)) > 0
    for suffix, chosen in (("", ~unlit), ("/unlit", unlit)):
        if chosen.any():
            _add_mesh(spec, body, part, part.faces[chosen], name + suffix, name, bool(suffix))


def is_closed(part: Part) -> bool:
    """Whether a part's surface has no rim: every edge is shared by faces on both of its sides."""
    places = np.unique(np.round(part.vertices, 6), axis=0, return_inverse=True)[1].ravel()
    corners = places[part.faces].astype(np.int64)
    start, end = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    count = int(places.max()) + 1
    there, back = np.sort(start * count + end), np.sort(end * count + start)
    return bool((there == back).all())


def _add_mesh(
    spec: mujoco.MjSpec,
    body: mujoco.MjsBody,
    part: Part,
    faces: NDArray[np.int32],
    name: str,
    material: str,
    casts: bool,
) -> None:
    import mujoco

    used, places = np.unique(faces, return_inverse=True)
    mesh = spec.add_mesh(name=name)
    mesh.uservert = part.vertices[used].ravel()
    mesh.usernormal = part.normals[used].ravel()
    mesh.usertexcoord = part.uvs[used].ravel()
    mesh.userface = places.ravel()
    # Thin and open surfaces have no volume; a shell's inertia always exists. MuJoCo moves the mesh
    # to its principal axes and the geom back, so the vertices stay where they were.
    mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
    body.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_MESH,
        meshname=name,
        material=material,
        contype=0,
        conaffinity=0,
        group=VISUAL_GROUP,
        mass=0.0,
        castshadow=casts,
    )


def _back_to_front(part: Part) -> NDArray[np.int32]:
    """(M, 3) faces in drawing order: of glass, the inside before the outside.

    MuJoCo draws a mesh's faces in their order and with depth, so a wall that is drawn too early
    hides what should shine through it. From any side, inner walls lie behind outer ones.
    """
    if part.material.rgba[3] == 1.0:
        return part.faces
    a, b, c = np.moveaxis(part.vertices[part.faces], 1, 0)
    middle = (part.vertices.min(axis=0) + part.vertices.max(axis=0)) / 2
    outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), (a + b + c) / 3 - middle)
    return part.faces[np.argsort(outward > 0, kind="stable")]


def add_material(spec: mujoco.MjSpec, material: Material, name: str) -> None:
    """Add a material, with its texture if it has one, under a name that is unique in the model."""
    import mujoco

    made = spec.add_material(
        name=name,
        rgba=material.rgba,
        specular=material.specular,
        shininess=material.shininess,
        reflectance=material.reflectance,
        emission=material.emission,
    )
    if material.texture is None:
        return
    height, width, channels = material.texture.shape
    texture = spec.add_texture(
        name=name,
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        width=width,
        height=height,
        nchannel=channels,
    )
    # MuJoCo wants the bottom row first.
    texture.data = material.texture[::-1].tobytes()
    made.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = name


def _add_collider(body: mujoco.MjsBody, collider: Collider, mass_kg: float, name: str) -> None:
    import mujoco

    body.add_geom(
        name=name,
        type=getattr(mujoco.mjtGeom, f"mjGEOM_{collider.shape.upper()}"),
        size=collider.size,
        pos=collider.position,
        quat=collider.quaternion,
        group=COLLISION_GROUP,
        mass=mass_kg,
        condim=4,
        friction=_FRICTION,
        rgba=_COLLIDER_RGBA,
    )
