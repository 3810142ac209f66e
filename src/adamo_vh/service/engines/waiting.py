"""Open the door for one engine, and have a world in it: for a single episode or a check."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from adamo_vh.service.engines.door import PATH, EngineDoor
from adamo_vh.service.engines.line import ANSWER_S
from adamo_vh.service.engines.page import PAGE, page_folder
from adamo_vh.service.engines.reading import MAX_BINARY
from adamo_vh.service.engines.remote import RemoteWorld
from adamo_vh.serving.admission import TOKEN_VARIABLE, Rules
from adamo_vh.serving.edge import Edge
from adamo_vh.serving.loopback import listen
from adamo_vh.serving.rate import Rate
from adamo_vh.serving.running import running

PORT = 8020
WAIT_S = 600.0


@contextmanager
def dialled_in(
    scene: str,
    figure: str = "",
    *,
    port: int = PORT,
    wait_s: float = WAIT_S,
    answer_s: float = ANSWER_S,
    tell: Callable[[str], None] = print,
) -> Iterator[RemoteWorld]:
    """Wait for an engine on this machine, and have a world in it while the block runs.

    Args:
        scene: Which scene it is to load.
        figure: Who the virtual human is; "" if it does not matter.
        port: Where to wait; 0 for a free port.
        wait_s: How long, seconds.
        answer_s: How long the engine may take for an answer, seconds.
        tell: Is told the address, and who came.

    Raises:
        ConfigError: The port is taken, or the page is missing.
        EngineError: No engine dialled in, or it failed, or does not have the scene.
    """
    token = os.environ.get(TOKEN_VARIABLE, "")
    # An engine only answers what it is asked: that is its rate.
    rules = Rules(1000, token=token, rate=Rate(per_s=0), max_message_bytes=MAX_BINARY)
    page = page_folder(os.environ.get(PAGE, ""))
    opened = listen("127.0.0.1", port)
    door = EngineDoor(answer_s, page=page)
    with opened, running(Edge(door, rules), opened, "adamo-engines", max_message_bytes=MAX_BINARY):
        address = f"ws://127.0.0.1:{opened.getsockname()[1]}{PATH}"
        tell(f"waiting for an engine at {address}{' (with the token)' if token else ''}")
        if page is not None:
            tell(f"or open {address.replace('ws:', 'http:').removesuffix(PATH)} in a browser")
        line = door.take(wait_s)
        tell(f"{line.name} dialled in")
        for sentence in line.hello.abilities.lacking():
            tell(f"note: {sentence}")
        world = RemoteWorld(line, scene, figure)
        try:
            yield world
        finally:
            line.hang_up("The episode has ended.")
