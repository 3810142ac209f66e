"""What pictures of the studio cost a browser: time to the first, frames and script, what is drawn.

Chromium is run without a screen and, unless `--gpu` is given, without a graphics card: a processor
draws. Run it on a machine with nothing else to do::

    python -m benchmarks.pictures
    python -m benchmarks.pictures --scene s2 --size 1280x720 --size 390x380 --quality full --gpu
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import tempfile
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from http import HTTPStatus
from pathlib import Path
from typing import Any

from benchmarks.studio import served
from websockets.sync.client import ClientConnection, connect

import adamo_vh

_ARGUMENTS = ("--headless=new", "--no-first-run", "--no-sandbox", "--remote-debugging-port=0")
_BY_PROCESSOR = ("--enable-unsafe-swiftshader", "--disable-gpu")
_WAIT_S = 120.0
_MB = 1e6
_FILL = """Object.assign(studio.seeing.root.style,
  {position: 'fixed', inset: '0', zIndex: '9', height: 'auto', maxHeight: 'none'})"""
"""Let the picture fill the window, so that the size is that of the picture."""
_WATCH = Path(__file__).with_name("pictures.js")


class Tab:
    """A tab of a browser that is told what to do through its debugging port."""

    def __init__(self, wire: ClientConnection) -> None:
        """Open an empty tab."""
        self._wire = wire
        self._serial = 0
        self._session = ""
        target = self.do("Target.createTarget", url="about:blank")["targetId"]
        attached = self.do("Target.attachToTarget", targetId=target, flatten=True)
        self._session = attached["sessionId"]

    def do(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Call a method of the protocol."""
        self._serial += 1
        told: dict[str, Any] = {"id": self._serial, "method": method, "params": parameters}
        if self._session:
            told["sessionId"] = self._session
        self._wire.send(json.dumps(told))
        while True:
            answer = json.loads(self._wire.recv(timeout=_WAIT_S))
            if answer.get("id") != self._serial:
                continue
            if "error" in answer:
                raise RuntimeError(f"{method}: {answer['error']['message']}")
            result: dict[str, Any] = answer["result"]
            return result

    def value(self, expression: str) -> Any:
        """What an expression comes to; promises are waited for."""
        asked = {"expression": expression, "awaitPromise": True, "returnByValue": True}
        answer = self.do("Runtime.evaluate", **asked)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"]["exception"]["description"])
        return answer["result"].get("value")


@contextmanager
def browser(program: str, arguments: tuple[str, ...]) -> Iterator[ClientConnection]:
    """A browser of its own, with an empty profile."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        command = [program, *_ARGUMENTS, *arguments, f"--user-data-dir={profile}"]
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
            try:
                assert process.stderr is not None
                for line in process.stderr:
                    if line.startswith("DevTools listening on "):
                        break
                else:
                    raise SystemExit(f"{program} did not start.")
                with connect(line.split()[-1], max_size=None) as wire:
                    yield wire
            finally:
                process.terminate()
                process.wait(30.0)


def prepare(url: str, run: str) -> None:
    """Let the server make what it makes once for all: the track of a run, and its meshes."""

    def get(address: str) -> tuple[int, bytes]:
        with urllib.request.urlopen(url + address) as answer:
            return answer.status, answer.read()

    while (answer := get(f"/studio/api/runs/{run}/track"))[0] != HTTPStatus.OK:
        time.sleep(0.5)
    hello = json.loads(answer[1])["hello"]
    for part in ("scene", "figure"):
        get(hello[part]["glb"])


def shown(tab: Tab) -> float:
    """Wait for the first picture; how long after the page was asked for it came, milliseconds."""
    end = time.monotonic() + _WAIT_S
    while not (first := tab.value("globalThis.studio?.seeing?.stage?.stats.firstMs")):
        if time.monotonic() > end:
            raise SystemExit(f"No picture within {_WAIT_S:.0f} s.")
        time.sleep(0.02)
    return float(first)


def measure_live(tab: Tab, url: str, scene: str) -> str:
    """Open a live room as the page does when it is asked for one, and say how long it takes."""
    tab.do("Page.navigate", url=f"{url}/studio/?debug")
    while not tab.value("document.querySelector('dialog select')"):
        time.sleep(0.1)
    tab.value(f"document.querySelector('#start-scene').value = {json.dumps(scene)}")
    began = time.monotonic()
    tab.value("document.querySelector('dialog form').requestSubmit()")
    shown(tab)
    whole = time.monotonic() - began
    return f"first picture {whole:.2f} s after a room was asked for"


def measure(tab: Tab, address: str, size: tuple[int, int], seconds: float) -> str:
    """Open a run, watch it, and say what it cost."""
    width, height = size
    screen = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
    tab.do("Emulation.setDeviceMetricsOverride", **screen)
    tab.do("Emulation.setScrollbarsHidden", hidden=True)
    tab.do("Page.navigate", url=address)
    first = shown(tab)
    tab.value(_FILL)
    watching = _WATCH.read_text(encoding="utf-8")
    rows = []
    for every_pixel in (False, True):
        seen = tab.value(f"({watching})({seconds}, {str(every_pixel).lower()})")
        gap = statistics.mean(seen["gaps"] or [float("nan")])
        script = statistics.mean(seen["script"] or [float("nan")])
        rows.append(f"{1000 / gap:.1f} frames/s at {seen['pixels']}, script {script:.1f} ms")
    return (
        f"first picture {first / 1000:.2f} s; {rows[0]}; with all pixels {rows[1]}; "
        f"{seen['calls']} draw calls, {seen['triangles']:,} triangles, "
        f"{seen['programs']} programs; "
        f"{seen['bytes'] / _MB:.1f} MB loaded; {seen['renderer']}"
    )


def main() -> None:
    """Measure every scene at every size."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scene", action="append", help="s1 and s2 if none is given")
    parser.add_argument("--size", action="append", help="of the picture; 1280x720 if none is given")
    parser.add_argument("--seconds", type=float, default=8.0, help="so long a run is watched")
    parser.add_argument("--quality", choices=("plain", "full"), help="how the room is drawn")
    parser.add_argument("--chromium", default="chromium", help="the program")
    parser.add_argument("--gpu", action="store_true", help="let a graphics card draw")
    asked = parser.parse_args()
    scenes = asked.scene or ["s1", "s2"]
    sizes = asked.size or ["1280x720"]
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            out = Path(folder) / scene
            adamo_vh.run_episode(task="T4", scene=scene, resolution=(320, 180), out=out)

        def watch(url: str) -> None:
            for scene in scenes:
                prepare(url, scene)
                for size in sizes:
                    with browser(asked.chromium, () if asked.gpu else _BY_PROCESSOR) as wire:
                        tab = Tab(wire)
                        quality = f"&quality={asked.quality}" if asked.quality else ""
                        address = f"{url}/studio/?debug{quality}#run={scene}"
                        width, height = map(int, size.split("x"))
                        told = measure(tab, address, (width, height), asked.seconds)
                        print(f"{scene} {size}: {told}", flush=True)
                with browser(asked.chromium, () if asked.gpu else _BY_PROCESSOR) as wire:
                    print(f"{scene} live: {measure_live(Tab(wire), url, scene)}", flush=True)

        served(watch, runs=Path(folder))


if __name__ == "__main__":
    main()
