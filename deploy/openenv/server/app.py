"""Serve ADAMO as an OpenEnv environment, at the root of a server of its own.

Settings come from the environment: ADAMO_VH_TOKEN (needed off the loopback), HOST, PORT, SPACE_HOST
(the name under which a Space is reached), ADAMO_VH_SESSIONS and ADAMO_VH_RESOLUTION.
"""

from __future__ import annotations

import os
import signal
import tempfile
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from adamo_vh.service.app import MAX_BODY_BYTES, Face, serving
from adamo_vh.service.hosting import Host, Terms
from adamo_vh.service.openenv.face import add_at_root
from adamo_vh.serving.admission import Rules

FACES = (Face("openenv", add_at_root),)


def terms(settings: Mapping[str, str]) -> Terms:
    """What is offered."""
    return Terms(
        resolution=settings.get("ADAMO_VH_RESOLUTION", "640x360"),
        most_sessions=int(settings.get("ADAMO_VH_SESSIONS", "16")),
    )


def rules(settings: Mapping[str, str]) -> Rules:
    """Who may come in."""
    names = tuple(filter(None, [settings.get("SPACE_HOST", "")]))
    return Rules(MAX_BODY_BYTES, token=settings.get("ADAMO_VH_TOKEN", ""), hosts=names)


@contextmanager
def running(settings: Mapping[str, str]) -> Iterator[str]:
    """Serve while the block runs; gives the address."""
    out = Path(settings.get("ADAMO_VH_RUNS") or tempfile.mkdtemp(prefix="adamo-vh-runs-"))
    host = Host(out, terms(settings))
    try:
        with serving(
            host,
            address=settings.get("HOST", "0.0.0.0"),
            port=int(settings.get("PORT", "8000")),
            rules=rules(settings),
            faces=FACES,
        ) as url:
            yield url
    finally:
        host.close_all()


def main() -> None:
    """Serve until the process is told to stop."""
    stop = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: stop.set())
    with running(os.environ):
        stop.wait()


if __name__ == "__main__":
    main()
