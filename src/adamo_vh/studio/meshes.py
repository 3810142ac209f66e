"""Scenes and figures as meshes for the page, packed, and made once."""

from __future__ import annotations

import gzip
import hashlib
import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass

from adamo_vh.session.builtin import scene_glb
from adamo_vh.session.editing import asset_mesh
from adamo_vh.session.figures import figure_glb

_MOST = 60


@dataclass(frozen=True, slots=True)
class Packed:
    """A file as it is sent."""

    data: bytes
    """Packed with gzip."""
    etag: str

    @classmethod
    def of(cls, content: bytes) -> Packed:
        """Pack a file."""
        return cls(gzip.compress(content, 6), f'"{hashlib.sha256(content).hexdigest()[:24]}"')


class Meshes:
    """Keeps the meshes that were asked for last; may be used from any threads."""

    def __init__(self) -> None:
        """Begin with none."""
        self._kept: OrderedDict[tuple[str, ...], Packed] = OrderedDict()
        self._lock = threading.Lock()
        self._making: dict[tuple[str, ...], threading.Lock] = {}

    def scene(self, file: str, variation: int, version: str = "") -> Packed:
        """A scene.

        Args:
            file: Scene file or built-in name.
            variation: 0 is the scene as it stands.
            version: Of a file that may change.

        Raises:
            SceneError: The scene is unknown or wrong.
        """
        key = ("scene", file, str(variation), version)
        return self._once(key, lambda: scene_glb(file, variation))

    def figure(self, who: str, version: str = "") -> Packed:
        """A figure.

        Args:
            who: A name, or the file of an own figure.
            version: Of a file that may change.

        Raises:
            ConfigError: No figure has this name.
            FileError: An own figure cannot be used.
        """
        return self._once(("figure", who, version), lambda: figure_glb(who))

    def asset(self, name: str) -> Packed:
        """A piece of furniture or an object by itself.

        Raises:
            ConfigError: The catalog has none of this name.
        """
        return self._once(("asset", name), lambda: asset_mesh(name))

    def _once(self, key: tuple[str, ...], make: Callable[[], bytes]) -> Packed:
        with self._lock:
            making = self._making.setdefault(key, threading.Lock())
        with making:
            with self._lock:
                if (known := self._kept.get(key)) is not None:
                    self._kept.move_to_end(key)
                    return known
            packed = Packed.of(make())
            with self._lock:
                self._kept[key] = packed
                while len(self._kept) > _MOST:
                    self._kept.popitem(last=False)
                self._making.pop(key, None)
            return packed
