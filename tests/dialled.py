"""Engines that dial in over a real loopback socket, for tests."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from adamo_vh.abilities import Abilities
from adamo_vh.engine import World
from adamo_vh.service.engines.dialing import dial
from adamo_vh.service.engines.door import EngineDoor
from adamo_vh.service.engines.remote import RemoteWorld
from adamo_vh.serving.admission import Rules
from adamo_vh.serving.edge import Edge
from adamo_vh.serving.loopback import listen
from adamo_vh.serving.rate import Rate
from adamo_vh.serving.running import running


class Passing:
    """Hands everything on to an engine or a body but what a test replaces."""

    def __init__(self, real: Any, **replaced: Any) -> None:
        self._real = real
        self.__dict__.update(replaced)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._real, name)

    def close(self) -> None:
        """The real one stays open for the next test."""


def with_body(engine: Any, **replaced: Any) -> Any:
    """An engine whose body does some things otherwise."""
    return Passing(engine, bodies={"agent": Passing(engine.bodies["agent"], **replaced)})


@contextmanager
def open_door(
    answer_s: float = 20.0, token: str = "", page: Path | None = None
) -> Iterator[tuple[EngineDoor, str]]:
    """A door on a free port, and its address."""
    door, opened = EngineDoor(answer_s, page=page), listen("127.0.0.1", 0)
    rules = Rules(1000, token=token, rate=Rate(per_s=0), max_message_bytes=64_000_000)
    with opened, running(Edge(door, rules), opened, "door", max_message_bytes=64_000_000):
        yield door, f"ws://127.0.0.1:{opened.getsockname()[1]}/engine"


@contextmanager
def dialled(engine: World, able: Abilities | None = None) -> Iterator[RemoteWorld]:
    """The same engine, through the wire."""
    shared: Any = Passing(engine)
    with open_door() as (door, url):
        thread = threading.Thread(
            target=dial, args=(url, lambda *_: shared, "Built-in 1", able), daemon=True
        )
        thread.start()
        line = door.take(20.0)
        try:
            yield RemoteWorld(line, engine.scene.name)
        finally:
            line.hang_up("The test is over.")
            thread.join(10.0)
