"""What a file says about who made it and what may be done with it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from adamo_vh.readable import readable
from adamo_vh.runtime.human.own.fields import Document

_FIELDS = [
    "title",
    "name",
    "version",
    "author",
    "authors",
    "copyrightInformation",
    "contactInformation",
    "references",
    "licenseName",
    "licenseUrl",
    "otherLicenseUrl",
    "otherPermissionUrl",
    "license",
    "source",
    "allowedUserName",
    "avatarPermission",
    "commercialUssageName",
    "commercialUsage",
    "violentUssageName",
    "sexualUssageName",
    "allowExcessivelyViolentUsage",
    "allowExcessivelySexualUsage",
    "allowPoliticalOrReligiousUsage",
    "allowAntisocialOrHateUsage",
    "creditNotation",
    "allowRedistribution",
    "modification",
]
"""Of VRM 0.x (`Ussage` is how it spells it), of VRM 1.0, and of what Sketchfab adds."""
_LONGEST = 200


def licence_of(document: Document) -> dict[str, str]:
    """Fields by their names in the file, as it has them."""
    found: dict[str, str] = {}
    newer, older = (document.extensions.get(key) for key in ("VRMC_vrm", "VRM"))
    for told in (
        newer.get("meta") if isinstance(newer, dict) else None,
        older.get("meta") if isinstance(older, dict) else None,
        document.asset.extras,
    ):
        if isinstance(told, Mapping):
            found |= {key: text for key in _FIELDS if (text := _text(told.get(key)))}
    if document.asset.copyright:
        found["copyright"] = readable(document.asset.copyright)[:_LONGEST]
    return found


def _text(value: Any) -> str:
    if isinstance(value, list):
        return ", ".join(_text(one) for one in value[:10])
    if isinstance(value, bool | str | int | float):
        return readable(str(value))[:_LONGEST]
    return ""
