"""Sound goes through a WAV file and other rates unharmed; what is no sound is told so."""

from __future__ import annotations

import io
import wave

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.errors import ConfigError
from adamo_vh.speech.sound import Sound


def tone(hertz: float, seconds: float, rate: int) -> Sound:
    times = np.arange(round(seconds * rate)) / rate
    return Sound((0.5 * np.sin(2 * np.pi * hertz * times)).astype(np.float32), rate)


def test_a_sound_is_the_same_after_a_file() -> None:
    sound = tone(440.0, 0.3, 22_050)
    again = Sound.of_wav(sound.wav())
    assert again.rate_hz == sound.rate_hz and len(again.samples) == len(sound.samples)
    assert np.abs(again.samples - sound.samples).max() < 1e-4


@pytest.mark.parametrize("rate", [8_000, 16_000, 44_100, 48_000])
def test_another_rate_keeps_length_and_pitch(rate: int) -> None:
    sound = tone(440.0, 0.5, 22_050).at(rate)
    assert sound.seconds == pytest.approx(0.5, abs=0.001)
    loudest = np.abs(np.fft.rfft(sound.samples)).argmax() / sound.seconds
    assert loudest == pytest.approx(440.0, abs=3.0)


@pytest.mark.parametrize("width", [1, 2, 4])
def test_channels_become_one(width: int) -> None:
    file = io.BytesIO()
    with wave.open(file, "wb") as out:
        out.setnchannels(2)
        out.setsampwidth(width)
        out.setframerate(16_000)
        kind = np.dtype({1: "u1", 2: "<i2", 4: "<i4"}[width])
        top = 255 if width == 1 else 2 ** (8 * width - 1) - 1
        low = 128 if width == 1 else 0
        out.writeframes(np.array([[top, low]] * 800).astype(kind).tobytes())
    sound = Sound.of_wav(file.getvalue())
    assert len(sound.samples) == 800
    assert sound.samples == pytest.approx(0.5, abs=0.01)


@given(st.binary(max_size=200))
def test_what_is_no_sound_is_told_so(data: bytes) -> None:
    with pytest.raises(ConfigError, match="WAV"):
        Sound.of_wav(data)


@given(st.integers(0, 43), st.binary(min_size=1, max_size=8))
def test_a_damaged_head_is_told_or_read(place: int, put: bytes) -> None:
    data = bytearray(tone(440.0, 0.05, 16_000).wav())
    data[place : place + len(put)] = put
    try:
        sound = Sound.of_wav(bytes(data))
    except ConfigError:
        return
    assert np.isfinite(sound.samples).all()


def test_what_is_too_long_is_told_so() -> None:
    with pytest.raises(ConfigError, match="longer than 120 s"):
        Sound.of_wav(Sound(np.zeros(8_000 * 121, np.float32), 8_000).wav())
