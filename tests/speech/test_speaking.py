"""What is said, and when each of its sounds is."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.errors import ConfigError
from adamo_vh.speech.models import MODELS, known, recognizer, voice
from adamo_vh.speech.sound import Sound
from adamo_vh.speech.speaking import MOST_LETTERS, speakable, spread


def voiced(before_s: float, loud_s: float, after_s: float) -> Sound:
    rate = 8_000
    parts = [np.zeros(int(before_s * rate)), np.ones(int(loud_s * rate)) * 0.4]
    return Sound(np.concatenate([*parts, np.zeros(int(after_s * rate))]).astype(np.float32), rate)


@given(st.lists(st.sampled_from(["a", "t", "ʃ", " ", "ˈ", "ə", "."]), max_size=30))
def test_phonemes_fill_what_is_audible_in_order(symbols: list[str]) -> None:
    found = spread(symbols, voiced(0.2, 0.6, 0.3))
    if not found:
        assert set(symbols) <= {"ˈ"}
        return
    assert found[0].start_s == pytest.approx(0.2, abs=0.001)
    assert found[-1].end_s == pytest.approx(0.8, abs=0.001)
    assert all(one.start_s < one.end_s for one in found)
    assert all(a.end_s == b.start_s for a, b in itertools.pairwise(found))
    assert [one.symbol for one in found if one.symbol] == [s for s in symbols if s in "atʃə"]


def test_a_vowel_lasts_longer_than_a_consonant() -> None:
    vowel, consonant = spread(["a", "t"], voiced(0.0, 0.5, 0.0))
    assert vowel.end_s - vowel.start_s > consonant.end_s - consonant.start_s


def test_silence_has_no_phonemes() -> None:
    assert spread(["a"], Sound(np.zeros(100, np.float32), 8_000)) == ()


def test_what_is_said_is_one_line_of_words() -> None:
    assert speakable("The plate\n is \x1b[31mon the floor.") == "The plate is [31mon the floor."
    assert len(speakable("word " * 400)) <= MOST_LETTERS + 1
    for nothing in ("", " \n", "...", "\x00"):
        with pytest.raises(ConfigError, match="nothing to say"):
            speakable(nothing)


def test_a_model_that_is_not_here_is_told_with_its_size_and_license(
    monkeypatch: pytest.MonkeyPatch, tmp_path: object
) -> None:
    monkeypatch.setenv("ADAMO_VH_DATA_DIR", str(tmp_path))
    with pytest.raises(ConfigError, match=r"75 MB, MIT\): adamo-vh speech fetch tiny\.en"):
        recognizer()
    with pytest.raises(ConfigError, match=r"63 MB, public domain.*fetch en_US-ljspeech-medium"):
        voice()
    with pytest.raises(ConfigError, match=r"tiny\.en hears; what speaks: en_US"):
        voice("tiny.en")
    with pytest.raises(ConfigError, match=r"no model 'nobody'\. Models: tiny\.en"):
        voice("nobody")


def test_every_model_names_what_a_user_must_know() -> None:
    assert len({model.name for model in MODELS}) == len(MODELS)
    for model in MODELS:
        assert known(model.name) is model
        assert model.megabytes > 0 and model.license and model.source.count("/") == 1
