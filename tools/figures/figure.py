"""One person put together: meshed, shaded, painted and bound."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from tools.figures import clothes, face, hair, paint
from tools.figures.binding import bind, bind_hands, rigid
from tools.figures.hands import hand
from tools.figures.meshing import (
    Mesh,
    daylight,
    largest,
    merged,
    polygonize,
    vertex_normals,
    without_hidden,
)
from tools.figures.shapes import Shape, both, grown, mirrored, union
from tools.figures.variant import Variant

from adamo_vh.geometry import Array
from adamo_vh.runtime.assets.asset import Material
from adamo_vh.runtime.human.looks import Figure, Garment

_TOP = ("pelvis", "spine", "chest", "neck", "clavicle", "upper_arm", "forearm", "thigh")
_HELD_BY = {
    "top": _TOP,
    "collar": _TOP,
    "trousers": ("pelvis", "spine", "thigh", "shin"),
    "shoes": ("foot", "toes"),
}
"""Joints that each piece of clothing may follow."""


def build_figure(variant: Variant) -> Figure:
    """Model a person; takes about a minute."""
    return _Sculptor(variant).figure()


@dataclass(frozen=True, eq=False)
class _Sculptor:
    v: Variant

    @cached_property
    def head(self) -> Shape:
        return face.head(self.v)

    @cached_property
    def hair(self) -> Shape:
        return hair.hair(self.v)

    @cached_property
    def hands(self) -> Shape:
        return mirrored(hand(self.v))

    @cached_property
    def top(self) -> Shape:
        return clothes.top(self.v)

    @cached_property
    def trousers(self) -> Shape:
        return clothes.trousers(self.v)

    @cached_property
    def everything(self) -> Shape:
        """All that throws shade on the clothes."""
        shoes = mirrored(union(0.0, clothes.shoe_upper(), clothes.shoe_sole()))
        return union(0.0, self.top, self.trousers, shoes, self.head, self.hair, self.hands)

    def figure(self) -> Figure:
        """All garments."""
        garments = (
            *self._head_garments(), self._hair(), self._hands(), self._top(), self._collar(),
            self._trousers(), self._shoes(),
        )  # fmt: skip
        return Figure(self.v.name, garments)

    def _head_garments(self) -> tuple[Garment, ...]:
        mesh = polygonize(self.head, (-0.13, -0.135, 1.34), (0.13, 0.135, 1.73), 0.0018, 9600, 3)
        mesh = without_hidden(mesh, grown(self.hair, 0.0), 0.006)
        mesh = without_hidden(mesh, union(0.0, self.top, clothes.collar(self.v)), 0.006)
        mesh, uvs = _unrolled(mesh)
        around = union(0.0, self.head, self.hair, self.top, clothes.collar(self.v))
        skin = paint.head_picture(self.v, self.head, around)
        head = _garment(
            "head", mesh, uvs, bind(mesh.vertices, ("neck", "head", "chest")), skin, 0.16, 0.25
        )
        eyes, eye_uvs = face.eyeballs()
        lids = face.lids()
        lid_colour = paint.palette([_darker(self.v.skin, 0.80)])
        return (
            head,
            _garment(
                "eyes",
                eyes,
                eye_uvs,
                rigid(len(eyes.vertices), "head"),
                paint.eye_picture(self.v),
                0.6,
                0.9,
            ),
            _plain("lids", lids, rigid(len(lids.vertices), "eyelids"), lid_colour, 0.9),
            self._brows(),
            self._lashes(),
        )

    def _brows(self) -> Garment:
        low, high = (0.03, 0.004, 1.605), (0.105, 0.065, 1.650)
        left = largest(polygonize(self._laid_brow(), low, high, 0.0011, 160, 2))
        mesh = merged(left, Mesh(left.vertices * [1, -1, 1], left.faces[:, ::-1]))
        picture = paint.palette([_darker(self.v.hair, 0.85)])
        return _plain("brows", mesh, rigid(len(mesh.vertices), "head"), picture, 0.8)

    def _laid_brow(self) -> Shape:
        """The brow pressed onto the skin: a thin layer where brow and face meet."""
        brow, skin = face.brows(self.v), self.head
        reach = 0.0022

        def distance(p: Array) -> Array:
            # Seen from the front the brow is a band; its depth is that of the skin.
            y, z = p[:, 1], p[:, 2]
            band = brow(np.column_stack([face.brow_depth(y), y, z]))
            return np.maximum(band, np.abs(skin(p)) - reach * np.clip(1 + band / -0.003, 0.35, 1.2))

        return distance

    def _lashes(self) -> Garment:
        mesh = face.lashes(self.v)
        picture = paint.palette([_darker(self.v.hair, 0.45)])
        return _plain("lashes", mesh, rigid(len(mesh.vertices), "eyelids"), picture, 0.7)

    def _hair(self) -> Garment:
        mesh = polygonize(self.hair, (-0.19, -0.15, 1.40), (0.13, 0.15, 1.78), 0.0028, 4500, 4)
        mesh = largest(without_hidden(mesh, self.head, 0.012))
        normals = mesh.normals()
        light = daylight(mesh.vertices, normals, union(0.0, self.hair, self.head))
        u = hair.strand(self.v, mesh.vertices) / 64.0 + 0.5
        uvs = np.column_stack([np.clip(u, 0.01, 0.99), _rows(light)])
        bound = rigid(len(mesh.vertices), "head")
        return _garment("hair", mesh, uvs, bound, paint.strands_picture(self.v), 0.25, 0.35)

    def _hands(self) -> Garment:
        low, high = (-0.03, 0.46, 0.78), (0.12, 0.68, 1.06)
        left = polygonize(hand(self.v), low, high, 0.0016, 1820, 3)
        sleeve = clothes.sleeve(self.v)
        left = without_hidden(left, sleeve, 0.004)
        mesh = merged(left, Mesh(left.vertices * [1, -1, 1], left.faces[:, ::-1]))
        light = daylight(mesh.vertices, mesh.normals(), union(0.0, self.hands, mirrored(sleeve)))
        uvs = np.column_stack([np.full(len(light), 0.5), _rows(light)])
        bound = bind_hands(mesh.vertices)
        return _garment(
            "hands", mesh, uvs, bound, paint.palette([self.v.skin], 0.7, 0.55), 0.12, 0.2
        )

    def _top(self) -> Garment:
        mesh = polygonize(self.top, (-0.17, -0.60, 0.86), (0.17, 0.60, 1.50), 0.0055, 4500, 2)
        mesh = without_hidden(mesh, union(0.0, self.trousers, grown(self.head, -0.006)), 0.012)
        trim = _trim_of_top(mesh.vertices)
        return self._cloth("top", mesh, [self.v.top, self.v.trim], trim)

    def _collar(self) -> Garment:
        shape = clothes.collar(self.v)
        mesh = polygonize(shape, (-0.12, -0.12, 1.37), (0.12, 0.12, 1.52), 0.0026, 900, 3)
        mesh = without_hidden(mesh, self.top, 0.008)
        return self._cloth("collar", mesh, [self.v.trim], None)

    def _trousers(self) -> Garment:
        low, high = (-0.17, -0.22, 0.03), (0.15, 0.22, 1.07)
        mesh = polygonize(self.trousers, low, high, 0.0060, 3400, 2)
        shoes = mirrored(clothes.shoe_upper())
        mesh = without_hidden(mesh, union(0.0, grown(self.top, -0.006), grown(shoes, -0.01)), 0.014)
        return self._cloth("trousers", mesh, [self.v.trousers], None)

    def _shoes(self) -> Garment:
        upper = polygonize(
            clothes.shoe_upper(), (-0.1, 0.03, -0.01), (0.22, 0.18, 0.13), 0.004, 600, 3
        )
        sole = polygonize(
            clothes.shoe_sole(), (-0.11, 0.03, -0.02), (0.23, 0.18, 0.06), 0.004, 300, 1
        )
        bars = polygonize(clothes.laces(), (0.0, 0.07, 0.05), (0.11, 0.14, 0.11), 0.0015, 280, 1)
        upper = without_hidden(upper, both(0.0, clothes.shoe_sole()), 0.006)
        left = merged(upper, sole, bars)
        part = np.repeat([1 / 6, 3 / 6, 5 / 6], [len(m.vertices) for m in (upper, sole, bars)])
        mesh = merged(left, Mesh(left.vertices * [1, -1, 1], left.faces[:, ::-1]))
        colours = [self.v.shoes, self.v.soles, _darker(self.v.shoes, 0.62)]
        return self._cloth("shoes", mesh, colours, np.tile(part, 2))

    def _cloth(
        self,
        name: str,
        mesh: Mesh,
        colours: Sequence[tuple[int, int, int]],
        across: Array | None,
    ) -> Garment:
        """Shade a garment by what surrounds it; `across` (N,) chooses the colour."""
        light = daylight(mesh.vertices, mesh.normals(), self.everything)
        u = np.full(len(light), 0.5) if across is None else across
        picture = paint.palette(list(colours))
        uvs = np.column_stack([u, _rows(light)])
        return _garment(name, mesh, uvs, bind(mesh.vertices, _HELD_BY[name]), picture, 0.06, 0.1)


def _trim_of_top(p: Array) -> Array:
    """(N,) texture coordinate: above 0.5 on the cuffs and the hem.

    It changes steadily with the distance from their edge, so that the edge is sharp in between the
    vertices too.
    """
    elbow, wrist = np.array(clothes.ELBOW), np.array(clothes.WRIST)
    q = np.column_stack([p[:, 0], np.abs(p[:, 1]), p[:, 2]]) - elbow
    along = q @ (wrist - elbow) / ((wrist - elbow) @ (wrist - elbow))
    cuff = np.where(np.abs(p[:, 1]) > 0.35, (along - 0.84) * np.linalg.norm(wrist - elbow), -1.0)
    hem = np.where(np.abs(p[:, 1]) < 0.25, 0.938 - p[:, 2], -1.0)
    return np.clip(0.5 + np.maximum(cuff, hem) / 0.2, 0.02, 0.98)


def _darker(colour: tuple[int, int, int], by: float) -> tuple[int, int, int]:
    r, g, b = (round(c * by) for c in colour)
    return r, g, b


def _rows(light: Array) -> Array:
    return np.clip(light, 0.02, 0.98)


def _unrolled(mesh: Mesh) -> tuple[Mesh, Array]:
    """Cut the head open at the back and give it texture coordinates."""
    uvs = paint.head_uv(mesh.vertices)
    corner_u = uvs[mesh.faces, 0]
    across = (corner_u.max(axis=1) - corner_u.min(axis=1)) > 0.5
    faces = mesh.faces.copy()
    moved = np.unique(faces[across][corner_u[across] < 0.5])
    twin = {int(old): len(mesh.vertices) + i for i, old in enumerate(moved)}
    for row in np.flatnonzero(across):
        faces[row] = [twin.get(int(i), int(i)) for i in faces[row]]
    uvs = np.concatenate([uvs, np.column_stack([np.ones(len(moved)), uvs[moved, 1]])])
    return Mesh(np.concatenate([mesh.vertices, mesh.vertices[moved]]), faces), uvs


def _plain(
    name: str,
    mesh: Mesh,
    bound: tuple[NDArray[np.uint8], Array],
    picture: paint.Picture,
    light: float,
) -> Garment:
    uvs = np.column_stack([np.full(len(mesh.vertices), 0.5), np.full(len(mesh.vertices), light)])
    return _garment(name, mesh, uvs, bound, picture, 0.05, 0.1)


def _garment(
    name: str,
    mesh: Mesh,
    uvs: Array,
    bound: tuple[NDArray[np.uint8], Array],
    picture: paint.Picture,
    specular: float,
    shininess: float,
) -> Garment:
    ids, weights = bound
    return Garment(
        name,
        mesh.vertices.astype(np.float32),
        vertex_normals(mesh.vertices, mesh.faces).astype(np.float32),
        np.clip(uvs, 0, 1).astype(np.float32),
        mesh.faces.astype(np.int32),
        ids.astype(np.uint8),
        weights.astype(np.float32),
        Material(name, (1, 1, 1, 1), picture, specular=specular, shininess=shininess),
    )
