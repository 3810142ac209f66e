"""Text to speech, with the moment of every phoneme for lips that follow."""

from __future__ import annotations

import subprocess
import tempfile
import threading
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from shutil import which
from typing import Any, Protocol

import numpy as np

from adamo_vh.errors import ConfigError
from adamo_vh.extras import extra
from adamo_vh.readable import readable
from adamo_vh.speech.sound import Sound

MOST_LETTERS = 600
"""Of one utterance: about 40 seconds."""
_QUIET = 0.02
"""Share of the loudest sample below which a voice is silent."""
_VOWELS = frozenset("aeiouyɑæɐɔəɚɛɜɝɪʊʌɒʉøœ")
_MARKS = "ˈˌː^$_‖|"
_LONG, _SHORT, _PAUSE = 1.6, 1.0, 2.0
_PROGRAM_S = 30.0


@dataclass(frozen=True, slots=True)
class Phoneme:
    """A speech sound within an utterance."""

    symbol: str
    """In the International Phonetic Alphabet; empty for a pause."""
    start_s: float
    end_s: float


@dataclass(frozen=True, slots=True)
class Spoken:
    """An utterance."""

    text: str
    sound: Sound
    phonemes: tuple[Phoneme, ...]
    """In order. The voices tell which phonemes they say, not when: times are estimated from what is
    audible and the usual lengths of vowels and consonants. None of a voice that tells neither."""


class Voice(Protocol):
    """Says a text; may be asked from any threads."""

    def speak(self, text: str) -> Spoken:
        """Say a text.

        Raises:
            ConfigError: There is nothing in it to say, or the voice failed.
        """
        ...


class Piper:
    """A voice of Piper's kind, run by pipersynth; phonemes come from the program espeak-ng."""

    def __init__(self, file: Path) -> None:
        """Load a voice.

        Args:
            file: NAME.onnx, with NAME.onnx.json beside it.

        Raises:
            ConfigError: The extra `speech`, or the program espeak-ng, is missing.
        """
        with extra("speech", "Speaking"):
            from pipersynth import PiperVoice
        if which("espeak-ng") is None:
            raise ConfigError(
                "Voices of Piper's kind need the program espeak-ng (Debian: apt-get install "
                "espeak-ng); or use another voice: --voice flite."
            )
        self._voice: Any = PiperVoice.from_local(file)
        self._lock = threading.Lock()

    def speak(self, text: str) -> Spoken:
        """Say a text."""
        from pipersynth import PiperSynthError, SynthesisRequest

        said = speakable(text)
        try:
            with self._lock, warnings.catch_warnings():
                # It says that it asks espeak-ng as a program, which is what we want.
                warnings.simplefilter("ignore")
                made = self._voice.synthesize(SynthesisRequest("said", said, "en-us"))
        except PiperSynthError as error:
            raise ConfigError(f"The voice cannot say {said[:60]!r}: {error}") from None
        sound = Sound(np.asarray(made.audio, np.float32), int(made.sample_rate))
        return Spoken(said, sound, spread(made.metadata.get("phonemes", ()), sound))


class Flite:
    """The program flite, which has its voices within; it tells no phonemes."""

    def __init__(self, name: str = "slt") -> None:
        """Look for the program.

        Args:
            name: One of its voices: slt, rms, kal, awb.

        Raises:
            ConfigError: It is missing.
        """
        program = which("flite")
        if program is None:
            raise ConfigError("The program flite is missing (Debian: apt-get install flite).")
        self._program, self._name = program, name

    def speak(self, text: str) -> Spoken:
        """Say a text."""
        said = speakable(text)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "said.wav"
            command = [self._program, "-voice", self._name, "-t", said, "-o", str(file)]
            try:
                subprocess.run(command, check=True, capture_output=True, timeout=_PROGRAM_S)
            except subprocess.SubprocessError:
                raise ConfigError(f"flite has no voice {self._name!r}, or it failed.") from None
            return Spoken(said, Sound.of_wav(file.read_bytes()), ())


def speakable(text: str) -> str:
    """A text as it may be said: one line, and no longer than an utterance.

    Raises:
        ConfigError: There is nothing in it to say.
    """
    said = " ".join(readable(text).split())
    if not any(letter.isalnum() for letter in said):
        raise ConfigError("There is nothing to say.")
    if len(said) <= MOST_LETTERS:
        return said
    return said[:MOST_LETTERS].rsplit(" ", 1)[0] + "."


def spread(symbols: Sequence[str], sound: Sound) -> tuple[Phoneme, ...]:
    """Phonemes over the audible part of a sound, vowels longer than consonants.

    Args:
        symbols: In order; marks of stress and length belong to the one before or after.
        sound: In which they are said.
    """
    loud = np.flatnonzero(np.abs(sound.samples) > _QUIET * np.abs(sound.samples).max(initial=0.0))
    told = [symbol for symbol in symbols if symbol.strip(_MARKS)]
    if not len(loud) or not told:
        return ()
    start, end = loud[0] / sound.rate_hz, (loud[-1] + 1) / sound.rate_hz
    weights = np.array([_weight(symbol) for symbol in told])
    edges = start + (end - start) * np.concatenate([[0.0], np.cumsum(weights) / weights.sum()])
    return tuple(
        Phoneme(symbol if symbol.isalpha() else "", float(a), float(b))
        for symbol, a, b in zip(told, edges, edges[1:], strict=False)
    )


def _weight(symbol: str) -> float:
    if not symbol.isalpha():
        return _SHORT / 2 if symbol.isspace() else _PAUSE
    return _LONG if symbol[0] in _VOWELS else _SHORT
