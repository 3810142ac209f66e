"""Every asset by name. A builder's module is imported when it is first called."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from importlib import import_module
from types import MappingProxyType
from typing import cast

from adamo_vh.runtime.assets.asset import Asset

Builder = Callable[[], Asset]

_PACKAGE = "adamo_vh.runtime.assets"


def _build(module: str, name: str) -> Asset:
    return cast(Builder, getattr(import_module(f"{_PACKAGE}.{module}"), name))()


def _builders(modules: Mapping[str, tuple[str, ...]]) -> Mapping[str, Builder]:
    """Asset name -> builder, from module -> functions named as their asset."""
    return MappingProxyType(
        {name: partial(_build, module, name) for module, names in modules.items() for name in names}
    )


OBJECTS: Mapping[str, Builder] = _builders(
    {
        "objects.hardware": ("lock_brass", "lock_steel", "key"),
        "objects.electric": ("flashlight", "battery_large", "battery_small"),
        "objects.workshop": ("tape", "screwdriver"),
        "objects.leisure": ("binoculars", "lighter"),
        "objects.containers": (
            "peanut_butter",
            "tomato_soup",
            "pills",
            "painkiller",
            "wine_bottle",
        ),
        "objects.tableware": ("glass", "cup", "plate", "indoor_plant"),
        "objects.produce": ("banana", "apple", "pumpkin"),
        "objects.play": ("rubber_duck", "toy_car"),
        "objects.household": (
            "teapot",
            "wooden_spoon",
            "scissors",
            "remote_control",
            "hammer",
        ),
    }
)
"""Interactable objects."""

FURNITURE: Mapping[str, Builder] = _builders(
    {
        "living.tables": ("dining_table", "chair", "coffee_table", "side_table", "console"),
        "living.seating": ("sofa",),
        "living.storage": ("tall_shelf", "sideboard"),
        "living.decor": (
            "basket",
            "curtains",
            "floor_lamp",
            "floor_vase",
            "pendant_lamp",
            "picture_hills",
            "picture_leaves",
            "picture_shapes",
            "rug",
        ),
    }
)
"""Things that objects stand on."""


def build(name: str) -> Asset:
    """Build an asset from scratch; `bake.load_asset` is the cached way.

    Args:
        name: A key of `OBJECTS` or `FURNITURE`.

    Raises:
        KeyError: If no asset has this name.
    """
    return (OBJECTS.get(name) or FURNITURE[name])()
