"""How long a body's answer takes through each face of the service, beside that of one in process.

    python -m benchmarks.wire [--rounds 60] [--resolution 1920x1080] [--json]

Each round asks every face for the same view once, in turn, so that a busy machine is as busy for
all. `observe` is answered with the last view and its picture again: what it takes over one in
process is the wire alone. `look` draws a new picture each time. Times are medians in milliseconds.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

import httpx
from anyio.from_thread import start_blocking_portal
from mcp import Client
from websockets.sync.client import connect

import adamo_vh
from adamo_vh.action_server.wire import Act, Create, Observe
from adamo_vh.record.termination import Limits
from adamo_vh.service.app import serving
from adamo_vh.service.hosting import Host, Terms

Ask = Callable[[Mapping[str, Any] | None], None]
"""Asks one face: a look at a point, or with None for the view again."""
IN_PROCESS = "in process"
AIMS_MS = {"websocket": 3.0, "http": 10.0, "mcp": 20.0}
"""What a face may take over the answer in process."""


def in_process(host: Host) -> Ask:
    """Ask the session itself, with its record and its lock."""
    hosted = host.create(Create(instruction="Look around."))

    def ask(point: Mapping[str, Any] | None) -> None:
        hosted.perform(Observe() if point is None else Act("Look", dict(point)))

    return ask


@contextmanager
def over_http(url: str) -> Iterator[Ask]:
    """Two requests: the answer, and its picture by the link in it."""
    with httpx.Client(base_url=url, timeout=60) as client:
        made = client.post("/v1/sessions", json={"instruction": "Look around."}).json()
        here = f"/v1/sessions/{made['session']}"

        def ask(point: Mapping[str, Any] | None) -> None:
            if point is None:
                answer = client.get(f"{here}/view").json()
            else:
                body = {"name": "Look", "arguments": point}
                answer = client.post(f"{here}/act", json=body).json()
            client.get(answer["view"]["picture"]["href"]).raise_for_status()

        yield ask


@contextmanager
def over_websocket(url: str) -> Iterator[Ask]:
    """One message there, two back: the answer and its picture."""
    address = url.replace("http", "ws") + "/v1/session"
    with connect(address, max_size=None, compression=None) as wire:

        def told(**message: Any) -> None:
            wire.send(json.dumps(message))
            json.loads(wire.recv())
            assert isinstance(wire.recv(), bytes)

        told(type="create", instruction="Look around.")

        def ask(point: Mapping[str, Any] | None) -> None:
            if point is None:
                told(type="observe")
            else:
                told(type="act", name="Look", arguments=point)

        yield ask


@contextmanager
def by_client(url: str) -> Iterator[Ask]:
    """The Python client, which also reads the answer back into an observation."""
    with adamo_vh.connect(url, instruction="Look around.") as body:

        def ask(point: Mapping[str, Any] | None) -> None:
            if point is None:
                body.observe()
            else:
                body.call("Look", point)

        yield ask


@contextmanager
def over_mcp(url: str) -> Iterator[Ask]:
    """One call of a tool of the official client; the picture comes in its result."""
    with start_blocking_portal() as portal, ExitStack() as stack:
        client = stack.enter_context(portal.wrap_async_context_manager(Client(f"{url}/mcp")))

        def call(tool: str, given: Mapping[str, Any]) -> Any:
            return portal.call(client.call_tool, tool, dict(given)).content

        told = call("new_episode", {"instruction": "Look around."})[0].text
        episode = told.partition("id of your episode is ")[2].partition(". ")[0]

        def ask(point: Mapping[str, Any] | None) -> None:
            name, given = ("observe", {}) if point is None else ("Look", point)
            kinds = {block.type for block in call(name, {"episode": episode, **given})}
            assert kinds == {"text", "image", "resource_link"}

        yield ask


FACES = {"http": over_http, "websocket": over_websocket, "client": by_client, "mcp": over_mcp}
"""Every face that is timed, by its name; a further one is one line."""


def timed(rounds: int, resolution: str) -> dict[str, dict[str, float]]:
    """Medians in milliseconds, by what is asked and by face."""
    times: dict[str, dict[str, list[float]]] = {"observe": {}, "look": {}}
    terms = Terms(resolution=resolution, limits=Limits(10**6, 1e9, max_repeats=0))
    with ExitStack() as stack:
        host = Host(Path(stack.enter_context(TemporaryDirectory())), terms)
        stack.callback(host.close_all)
        url = stack.enter_context(serving(host))
        asks = {IN_PROCESS: in_process(host)}
        asks |= {name: stack.enter_context(face(url)) for name, face in FACES.items()}
        for number in range(-3, rounds):  # The first ones warm up.
            for kind in ("look", "observe"):
                for place, (name, ask) in enumerate(asks.items()):
                    # Never the same point twice: nothing may come out of a cache.
                    x, z = 0.5 + 0.01 * (number % 50), 0.8 + 0.001 * number + 0.0001 * place
                    begun = time.perf_counter()
                    ask({"x": x, "y": -1.0, "z": z} if kind == "look" else None)
                    if number >= 0:
                        took = time.perf_counter() - begun
                        times[kind].setdefault(name, []).append(took * 1e3)
    return {
        kind: {name: median(taken) for name, taken in faces.items()}
        for kind, faces in times.items()
    }


def main() -> None:
    """Parse the command line, time, print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--rounds", type=int, default=60)
    parser.add_argument("--resolution", default="1920x1080")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    found = timed(options.rounds, options.resolution)
    if options.json:
        print(json.dumps(found, indent=1))
        return
    print(f"{'':12s} {'observe':>9s} {'over':>8s} {'aim':>6s} {'look':>9s} {'ratio':>7s}")
    here = found["observe"][IN_PROCESS], found["look"][IN_PROCESS]
    for name, took in found["observe"].items():
        aim = AIMS_MS.get(name)
        look = found["look"][name]
        shown = f"{aim:6.0f}" if aim else " " * 6
        print(
            f"{name:12s} {took:6.2f} ms {took - here[0]:5.2f} ms {shown} "
            f"{look:6.1f} ms {look / here[1]:7.3f}"
        )


if __name__ == "__main__":
    main()
