"""Speech to text."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from adamo_vh.extras import extra
from adamo_vh.speech.sound import Sound

_RATE_HZ = 16_000
_LEAST_S = 0.2
"""Less is no word."""


@dataclass(frozen=True, slots=True)
class Heard:
    """What was understood."""

    text: str
    """Empty if nobody spoke."""
    seconds: float
    """How long it took to understand it."""


class Recognizer(Protocol):
    """Understands speech; may be asked from any threads."""

    def hear(self, sound: Sound) -> Heard:
        """What is said in a sound; empty where nobody speaks."""
        ...


class Whisper:
    """Whisper through faster-whisper, on the CPU; silence is found by the Silero model in it."""

    def __init__(self, folder: Path, hints: str = "") -> None:
        """Load a model.

        Args:
            folder: A Whisper model in the form of CTranslate2, see `adamo_vh.speech.models`.
            hints: Words that are likely, such as the names of what is in the room.

        Raises:
            ConfigError: The extra `speech` is missing.
        """
        with extra("speech", "Hearing"):
            from faster_whisper import WhisperModel
        self._model: Any = WhisperModel(
            str(folder), device="cpu", compute_type="int8", local_files_only=True
        )
        self._hints = hints
        self._lock = threading.Lock()

    def hear(self, sound: Sound) -> Heard:
        """What is said in a sound."""
        began = time.monotonic()
        if sound.seconds < _LEAST_S:
            return Heard("", 0.0)
        with self._lock:
            parts, _ = self._model.transcribe(
                sound.at(_RATE_HZ).samples,
                language="en",
                beam_size=1,
                vad_filter=True,
                without_timestamps=True,
                condition_on_previous_text=False,
                hotwords=self._hints or None,
            )
            text = " ".join(part.text.strip() for part in parts)
        return Heard(text.strip(), time.monotonic() - began)
