"""Engines that dial in: a 3D engine in another process, or elsewhere, carries the world."""

from adamo_vh.service.engines.door import EngineDoor
from adamo_vh.service.engines.line import EngineLine
from adamo_vh.service.engines.remote import RemoteWorld

__all__ = ["EngineDoor", "EngineLine", "RemoteWorld"]
