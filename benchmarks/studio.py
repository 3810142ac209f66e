"""What the studio costs: bytes to load, draw calls, poses a second, time to a first picture.

Run it on a machine with nothing else to do::

    python benchmarks/studio.py

The time to the first picture is the server's part: from opening a room to its greeting and first
pose on the WebSocket, with all that the page loads meanwhile.
"""

from __future__ import annotations

import json
import tempfile
import time
import urllib.request
from collections.abc import Callable
from pathlib import Path

from websockets.sync.client import connect

from adamo_vh.geometry import Vec3
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.human.looks import load_figure
from adamo_vh.runtime.scenes.glb import scene_glb
from adamo_vh.service.app import MAX_BODY_BYTES, serving
from adamo_vh.service.hosting import Host, Terms
from adamo_vh.serving.admission import Rules
from adamo_vh.session.builtin import read_scene
from adamo_vh.session.figures import figure_glb
from adamo_vh.session.posing import Posing
from adamo_vh.studio.editing import Editor
from adamo_vh.studio.face import CONTENT_TYPES, Studio, studio_face
from adamo_vh.studio.files import PAGE
from adamo_vh.studio.library import Library
from adamo_vh.studio.meshes import Meshes, Packed
from adamo_vh.studio.offer import Offer
from adamo_vh.studio.rooms import Rooms, RoomTerms
from adamo_vh.studio.talk import Talk

_MB = 1e6


def loaded() -> None:
    """Bytes that a page loads, packed, and what it is asked to draw."""
    page = sum(len(Packed.of(f.read_bytes()).data) for f in PAGE.rglob("*") if f.is_file())
    figure = load_figure("mara")
    person = len(Packed.of(figure_glb("mara")).data)
    for name in ("s1", "s2"):
        engine = BuiltinEngine(name)
        drawn = scene_glb(read_scene(name), engine.state().objects)
        engine.close()
        scene = len(Packed.of(drawn.content).data)
        calls, triangles = drawn.calls + len(figure.garments), drawn.triangles
        print(
            f"{name}: page {page / _MB:.2f} + scene {scene / _MB:.2f} + figure "
            f"{person / _MB:.2f} = {(page + scene + person) / _MB:.2f} MB packed; {calls} draw "
            f"calls, {triangles + figure.triangle_count:,} triangles without shadows"
        )


def poses() -> None:
    """Poses a second that the engine tells when nobody holds it back."""
    engine = BuiltinEngine("s1")
    told = 0

    def moment() -> bool:
        nonlocal told
        told += posing.pose() is not None
        return True

    posing = Posing(engine, moment)
    began = time.perf_counter()
    for x in (-1.0, 1.2, -1.5):
        engine.body.walk(Vec3(x, -1.5, 0.0))
    seconds = time.perf_counter() - began
    posing.close()
    engine.close()
    print(f"poses: {told / seconds:.0f} a second ({posing.seconds:.1f} simulated seconds)")


def first_picture(url: str, label: str) -> None:
    """Open a room and load what the page loads."""
    began = time.perf_counter()
    wish = json.dumps({"scene": "s1", "model": "baseline"}).encode()
    asked = urllib.request.Request(
        f"{url}/studio/api/rooms", wish, {"content-type": "application/json"}
    )
    room = json.loads(urllib.request.urlopen(asked).read())["room"]
    opened = time.perf_counter() - began
    live = f"{url.replace('http', 'ws', 1)}/studio/api/rooms/{room}/live?from=0"
    with connect(live, max_size=None) as wire:
        hello = json.loads(wire.recv())
        for address in (hello["scene"]["glb"], hello["figure"]["glb"]):
            get = urllib.request.Request(url + address, headers={"accept-encoding": "gzip"})
            urllib.request.urlopen(get).read()
        while json.loads(wire.recv())["type"] != "pose":
            pass
    whole = time.perf_counter() - began
    print(f"{label}: room open after {opened:.2f} s, all that a first picture needs {whole:.2f} s")
    delete = urllib.request.Request(f"{url}/studio/api/rooms/{room}", method="DELETE")
    urllib.request.urlopen(delete).close()


def served(
    measure: Callable[[str], None],
    runs: Path | None = None,
    talk: Talk | None = None,
    resolution: str = "640x360",
) -> None:
    """Measure at a studio on this machine, which shows some runs, and may hear and speak."""
    with tempfile.TemporaryDirectory() as folder:
        offer = Offer()
        out = Path(folder)
        rooms = Rooms(out, offer, RoomTerms(resolution=resolution))
        editor = Editor(out / "scenes", offer)
        library = Library([runs or out])
        studio = Studio(offer, library, rooms, Meshes(), editor, talk or Talk())
        host = Host(out / "served", Terms())
        rules = Rules(MAX_BODY_BYTES, content_types=CONTENT_TYPES)
        with serving(host, rules=rules, faces=(studio_face(studio),)) as url:
            measure(url)
        host.close_all()


def main() -> None:
    """Measure all."""
    loaded()
    poses()

    def rooms(url: str) -> None:
        first_picture(url, "first room")
        first_picture(url, "second room")

    served(rooms)


if __name__ == "__main__":
    main()
