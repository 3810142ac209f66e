"""The engine's side as a program: dial in, and answer with any `World`. The reference for others.

dial("ws://127.0.0.1:8000/engine", lambda scene, figure: create_engine(scene), "Mine 1.0")
"""

from __future__ import annotations

import json
from typing import Any

from adamo_vh.abilities import Abilities
from adamo_vh.errors import ConfigError
from adamo_vh.service.engines.answering import Answerer, Open, hello_of
from adamo_vh.service.engines.reading import MAX_TEXT


def dial(url: str, opened: Open, name: str, able: Abilities | None = None, token: str = "") -> None:
    """Dial in, and answer until the other side hangs up.

    Args:
        url: Where ADAMO waits: ws://HOST:PORT/engine.
        opened: Makes the world of a scene and a figure.
        name: Of the engine, with its version.
        able: What it can do; all by default.
        token: What the server asks for; empty for none.

    Raises:
        ConfigError: Nobody waits there, or the server lets no engine in.
    """
    from websockets.exceptions import ConnectionClosed, WebSocketException
    from websockets.sync.client import connect

    headers = {"Authorization": f"Bearer {token}"} if token else {}
    answerer = Answerer(opened, able)
    try:
        socket = connect(
            url, additional_headers=headers, max_size=MAX_TEXT, compression=None, proxy=None
        )
    except (OSError, ValueError, WebSocketException) as error:
        raise ConfigError(f"{url} takes no engine: {error}. Is it served there?") from None
    try:
        with socket:
            socket.send(json.dumps(hello_of(name, able or Abilities())))
            for message in socket:
                request: dict[str, Any] = json.loads(message)
                answer, pictures = answerer.answer(request)
                socket.send(json.dumps(answer))
                for picture in pictures:
                    socket.send(picture)
    except ConnectionClosed:
        return
    finally:
        answerer.close()
