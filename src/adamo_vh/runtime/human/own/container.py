"""Take a GLB apart: its JSON, checked, and its bytes."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from pydantic import ValidationError

from adamo_vh.readable import readable
from adamo_vh.runtime.human.own.faults import AGAIN, Broken
from adamo_vh.runtime.human.own.fields import Document

MOST_BYTES = 100_000_000
"""A larger file is not read."""
_MOST_JSON = 10_000_000
_JSON, _BIN = b"JSON", b"BIN\0"
_UNREADABLE = {
    "KHR_draco_mesh_compression": "Export it without Draco compression.",
    "EXT_meshopt_compression": "Export it without meshopt compression.",
    "KHR_texture_basisu": "Export its textures as PNG or JPEG.",
}
"""What cannot be read, and what helps."""
_KNOWN = frozenset(
    {
        "KHR_materials_unlit",
        "KHR_materials_pbrSpecularGlossiness",
        "KHR_mesh_quantization",
        "KHR_texture_transform",
        "EXT_texture_webp",
        "VRM",
        "VRMC_vrm",
        "VRMC_materials_mtoon",
        "VRMC_springBone",
        "VRMC_node_constraint",
    }
)
_OTHERS = {
    b"Kayd": "It is an FBX file",
    b"PK\3\4": "It is a packed archive",
    b"{": "It is a .gltf, whose parts lie in other files",
    b"ply": "It is a PLY file without bones",
    b"BLEN": "It is a Blender file",
}


@dataclass(frozen=True, slots=True, eq=False)
class Container:
    """A file in parts."""

    document: Document
    content: bytes
    """The buffer that comes with the file."""


def opened(content: bytes) -> Container:
    """Take a GLB or VRM apart.

    Raises:
        Broken: It is none, too large, or rests on what cannot be read.
    """
    text, binary = _chunks(content)
    try:
        document = Document.model_validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = ".".join(str(part) for part in first["loc"][:6]) or "its JSON"
        what = readable(str(first["msg"]))[:120]
        raise Broken(f"{readable(where)[:80]} is wrong ({what}). {AGAIN}") from None
    for name in document.required:
        if name in _UNREADABLE:
            raise Broken(f"it needs {name}, which is not read here. {_UNREADABLE[name]}")
        if name not in _KNOWN and not name.startswith("KHR_materials_"):
            raise Broken(f"it needs {readable(name)[:60]}, which is not read. Export it without.")
    if any(buffer.uri is not None for buffer in document.buffers):
        raise Broken(
            "it keeps its data in another file, and none is fetched. Export it as one binary file "
            "(.glb or .vrm)."
        )
    if len(document.buffers) > 1:
        raise Broken(f"it has {len(document.buffers)} buffers, and a GLB holds one. {AGAIN}")
    if document.buffers and document.buffers[0].length > len(binary):
        raise Broken(
            f"it ends early: {document.buffers[0].length} bytes are announced and "
            f"{len(binary)} are there. Copy or export it again."
        )
    return Container(document, binary)


def _chunks(content: bytes) -> tuple[bytes, bytes]:
    """The JSON and the buffer of a GLB."""
    if len(content) > MOST_BYTES:
        raise Broken(
            f"it has more than {MOST_BYTES // 1_000_000} MB. Export it with smaller textures."
        )
    if content[:4] != b"glTF":
        told = next((what for mark, what in _OTHERS.items() if content.startswith(mark)), "")
        raise Broken(
            f"it is no GLB. {told + ': convert it' if told else 'Export the character'}, "
            "for instance in Blender, as glTF Binary (.glb)."
        )
    if len(content) < 20:
        raise Broken("it ends early. Copy or export it again.")
    version, total = struct.unpack_from("<II", content, 4)
    if version != 2:
        raise Broken(f"it is glTF version {version}. Export it as glTF 2.0.")
    if total > len(content):
        raise Broken(f"it ends early: {len(content)} of {total} bytes. Copy or export it again.")
    found: dict[bytes, bytes] = {}
    at = 12
    while at + 8 <= total and len(found) < 8:
        length, kind = struct.unpack_from("<I4s", content, at)
        if at + 8 + length > total:
            raise Broken("it ends early. Copy or export it again.")
        if kind == _JSON and length > _MOST_JSON:
            raise Broken(f"its JSON has more than {_MOST_JSON // 1_000_000} MB. {AGAIN}")
        found.setdefault(kind, content[at + 8 : at + 8 + length])
        at += 8 + length
    if _JSON not in found:
        raise Broken(f"it has no JSON. {AGAIN}")
    return found[_JSON], found.get(_BIN, b"")
