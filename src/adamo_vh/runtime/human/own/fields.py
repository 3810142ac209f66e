"""The parts of a glTF file that are read, as typed models: anything else is passed over."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

Number = Annotated[int, Field(ge=0, le=2**31)]
"""The place of something in one of the file's lists, or a count."""
Matrix = Annotated[tuple[float, ...], Field(min_length=16, max_length=16)]
Vector = tuple[float, float, float]
Quad = tuple[float, float, float, float]
_MOST = 20_000
"""Entries of one list."""


class _Part(BaseModel):
    model_config = ConfigDict(extra="ignore", allow_inf_nan=False, frozen=True)


class Asset(_Part):
    """Who made the file."""

    version: str = "2.0"
    generator: str = ""
    copyright: str = ""
    extras: Any = None


class Node(_Part):
    """A place in the tree: a bone, a mesh, or nothing."""

    name: str = ""
    children: tuple[Number, ...] = Field(default=(), max_length=_MOST)
    mesh: Number | None = None
    skin: Number | None = None
    matrix: Matrix | None = None
    translation: Vector = (0.0, 0.0, 0.0)
    rotation: Quad = (0.0, 0.0, 0.0, 1.0)
    scale: Vector = (1.0, 1.0, 1.0)


class Primitive(_Part):
    """Triangles of one material."""

    attributes: dict[str, Number]
    indices: Number | None = None
    material: Number | None = None
    mode: int = 4
    targets: tuple[dict[str, Number], ...] = Field(default=(), max_length=2000)
    extensions: dict[str, Any] = {}
    extras: Any = None


class Mesh(_Part):
    """Some primitives with the same morph targets."""

    name: str = ""
    primitives: tuple[Primitive, ...] = Field(max_length=2000)
    extras: Any = None


class Skin(_Part):
    """Which nodes move a mesh."""

    joints: tuple[Number, ...] = Field(max_length=2000)
    inverse: Number | None = Field(default=None, alias="inverseBindMatrices")


class SparsePlaces(_Part):
    """Where the values of a sparse array go."""

    view: Number = Field(alias="bufferView")
    offset: Number = Field(default=0, alias="byteOffset")
    component: int = Field(alias="componentType")


class SparseValues(_Part):
    """The values of a sparse array."""

    view: Number = Field(alias="bufferView")
    offset: Number = Field(default=0, alias="byteOffset")


class Sparse(_Part):
    """Values that differ from what an array says otherwise."""

    count: Number
    indices: SparsePlaces
    values: SparseValues


class Accessor(_Part):
    """An array of numbers."""

    view: Number | None = Field(default=None, alias="bufferView")
    offset: Number = Field(default=0, alias="byteOffset")
    component: int = Field(alias="componentType")
    count: Number
    type: str
    normalized: bool = False
    sparse: Sparse | None = None


class View(_Part):
    """A part of a buffer."""

    buffer: Number
    offset: Number = Field(default=0, alias="byteOffset")
    length: Number = Field(alias="byteLength")
    stride: Number | None = Field(default=None, alias="byteStride")


class Buffer(_Part):
    """Bytes: in the file itself, as we read none from elsewhere."""

    uri: str | None = None
    length: Number = Field(alias="byteLength")


class Image(_Part):
    """A picture."""

    uri: str | None = None
    view: Number | None = Field(default=None, alias="bufferView")


class Texture(_Part):
    """A picture as it is used."""

    source: Number | None = None
    extensions: dict[str, Any] = {}


class TextureUse(_Part):
    """A texture on a material."""

    index: Number
    channel: Number = Field(default=0, alias="texCoord")
    extensions: dict[str, Any] = {}


class Roughness(_Part):
    """The usual kind of material."""

    factor: Quad = Field(default=(1.0, 1.0, 1.0, 1.0), alias="baseColorFactor")
    texture: TextureUse | None = Field(default=None, alias="baseColorTexture")
    roughness: float = Field(default=1.0, alias="roughnessFactor")


class Glossiness(_Part):
    """The older kind: KHR_materials_pbrSpecularGlossiness."""

    factor: Quad = Field(default=(1.0, 1.0, 1.0, 1.0), alias="diffuseFactor")
    texture: TextureUse | None = Field(default=None, alias="diffuseTexture")


DULL = Glossiness.model_validate({})
"""The older kind, if nothing is said."""


class Material(_Part):
    """How a surface looks."""

    name: str = ""
    metallic: Roughness = Field(
        default_factory=lambda: Roughness.model_validate({}), alias="pbrMetallicRoughness"
    )
    alpha: str = Field(default="OPAQUE", alias="alphaMode")
    cutoff: float = Field(default=0.5, alias="alphaCutoff")
    two_sided: bool = Field(default=False, alias="doubleSided")
    glow: tuple[float, float, float] = Field(default=(0.0, 0.0, 0.0), alias="emissiveFactor")
    glow_texture: TextureUse | None = Field(default=None, alias="emissiveTexture")
    extensions: dict[str, Any] = {}


PLAIN = Material.model_validate({})
"""What has no material."""


class Document(_Part):
    """A whole file."""

    asset: Asset = Asset()
    nodes: tuple[Node, ...] = Field(default=(), max_length=_MOST)
    meshes: tuple[Mesh, ...] = Field(default=(), max_length=_MOST)
    skins: tuple[Skin, ...] = Field(default=(), max_length=500)
    accessors: tuple[Accessor, ...] = Field(default=(), max_length=5 * _MOST)
    views: tuple[View, ...] = Field(default=(), max_length=5 * _MOST, alias="bufferViews")
    buffers: tuple[Buffer, ...] = Field(default=(), max_length=100)
    images: tuple[Image, ...] = Field(default=(), max_length=500)
    textures: tuple[Texture, ...] = Field(default=(), max_length=1000)
    materials: tuple[Material, ...] = Field(default=(), max_length=500)
    required: tuple[str, ...] = Field(default=(), max_length=100, alias="extensionsRequired")
    extensions: dict[str, Any] = {}
