"""Speech in the studio: sound goes in and comes out over HTTP, within bounds."""

from __future__ import annotations

import json
import urllib.error
import urllib.request
from typing import Any

import numpy as np
import pytest

from adamo_vh.speech.hearing import Heard
from adamo_vh.speech.sound import Sound
from adamo_vh.speech.speaking import Spoken, speakable, spread
from adamo_vh.studio.talk import MOST_WAV_BYTES, Talk

RATE, LETTER = 16_000, 640


class Tones:
    """Speaks a tone for each letter, and understands them."""

    def speak(self, text: str) -> Spoken:
        said = speakable(text)
        times = np.arange(LETTER) / RATE
        tones = [np.sin(2 * np.pi * (400 + 25 * ord(letter)) * times) for letter in said]
        sound = Sound((0.5 * np.concatenate(tones)).astype(np.float32), RATE)
        return Spoken(said, sound, spread(list(said), sound))

    def hear(self, sound: Sound) -> Heard:
        letters = sound.at(RATE).samples[: len(sound.samples) // LETTER * LETTER]
        if not len(letters) or np.abs(letters).max() < 0.01:
            return Heard("", 0.0)
        loudest = np.abs(np.fft.rfft(letters.reshape(-1, LETTER))).argmax(axis=1)
        text = "".join(chr(round((k * RATE / LETTER - 400) / 25)) for k in loudest)
        return Heard(text, 0.0)


@pytest.fixture(scope="module")
def talking(serve: Any) -> Any:
    return serve(talk=Talk(Tones, Tones))


def send(served: Any, data: bytes, kind: str = "audio/wav") -> tuple[int, Any]:
    asked = urllib.request.Request(
        f"{served.url}/studio/api/hear", data, {"content-type": kind}, method="POST"
    )
    try:
        with urllib.request.urlopen(asked, timeout=60) as answer:
            return answer.status, json.loads(answer.read())
    except urllib.error.HTTPError as error:
        return error.code, json.loads(error.read())


def test_what_she_says_can_be_fetched_and_is_understood(talking: Any) -> None:
    status, _, body = talking.get(
        "/studio/api/speak", "POST", {"text": "The plate is on the floor."}
    )
    assert status == 200, body
    told = json.loads(body)
    assert told["phonemes"][-1][2] <= told["seconds"]
    status, headers, sound = talking.get(told["sound"])
    assert status == 200 and headers["content-type"] == "audio/wav"
    assert Sound.of_wav(sound).seconds == pytest.approx(told["seconds"], abs=0.001)
    assert send(talking, sound) == (200, {"text": "The plate is on the floor.", "seconds": 0.0})


def test_silence_is_no_word(talking: Any) -> None:
    silence = Sound(np.zeros(RATE, np.float32), RATE)
    assert send(talking, silence.wav())[1]["text"] == ""


def test_what_is_no_speech_is_refused(talking: Any) -> None:
    status, told = send(talking, b"RIFF not a sound")
    assert status == 400 and "WAV" in told["error"]["message"]
    assert send(talking, b"{}", "text/plain")[0] == 415
    assert send(talking, b"\0" * (MOST_WAV_BYTES + 1))[0] == 413
    assert talking.get("/studio/api/speak", "POST", {"text": "..."})[0] == 400
    assert talking.get("/studio/api/speak", "POST", {"words": 3})[0] == 422
    assert talking.get("/studio/api/said/nothing.wav")[0] == 404


def test_old_sounds_are_let_go(talking: Any) -> None:
    first = json.loads(talking.get("/studio/api/speak", "POST", {"text": "one"})[2])["sound"]
    for number in range(20):
        talking.studio.talk.speak(f"number {number}")
    assert talking.get(first)[0] == 404


def test_a_studio_without_ears_and_voice_says_what_to_do(served: Any) -> None:
    offer = json.loads(served.get("/studio/api/offer")[2])
    assert offer["speech"] == {"hears": False, "speaks": False}
    status, told = send(served, Sound(np.zeros(RATE, np.float32), RATE).wav())
    assert status == 400 and "adamo-vh speech fetch tiny.en" in told["error"]["message"]
    status, _, body = served.get("/studio/api/speak", "POST", {"text": "Hello"})
    assert status == 400 and b"adamo-vh speech fetch en_US" in body


def test_a_wrong_ear_is_told_before_anything_is_served() -> None:
    from typer.testing import CliRunner

    from adamo_vh.cli.app import app

    result = CliRunner().invoke(app, ["studio", "--ears", "nobody", "--port", "0"])
    assert result.exit_code != 0
    assert "no model 'nobody'" in str(result.exception) + result.output
