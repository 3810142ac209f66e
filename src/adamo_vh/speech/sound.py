"""Sound as numbers, and as a WAV file."""

from __future__ import annotations

import io
import wave
from dataclasses import dataclass
from math import gcd
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.errors import ConfigError

MOST_SECONDS = 120.0
"""Longer sounds are no utterance."""
_WIDTHS: dict[int, np.dtype[Any]] = {1: np.dtype("u1"), 2: np.dtype("<i2"), 4: np.dtype("<i4")}


@dataclass(frozen=True, slots=True, eq=False)
class Sound:
    """One channel of sound."""

    samples: NDArray[np.float32]
    """(N,) from -1 to 1."""
    rate_hz: int

    @property
    def seconds(self) -> float:
        """How long it is."""
        return len(self.samples) / self.rate_hz

    @classmethod
    def of_wav(cls, data: bytes) -> Sound:
        """Read a WAV file of whole numbers; several channels become one.

        Args:
            data: The file; may come from anybody.

        Raises:
            ConfigError: It is no such file, or longer than an utterance.
        """
        try:
            with wave.open(io.BytesIO(data)) as file:
                count, rate, width = file.getnframes(), file.getframerate(), file.getsampwidth()
                channels = file.getnchannels()
                if rate < 4_000 or rate > 200_000 or width not in _WIDTHS:
                    raise ConfigError(
                        f"The sound has {rate} samples a second of {width} bytes each; use a WAV "
                        "file with 16 bits and 16000 a second."
                    )
                if count > MOST_SECONDS * rate:
                    raise ConfigError(f"The sound is longer than {MOST_SECONDS:.0f} s.")
                raw = file.readframes(count)
        except (wave.Error, EOFError, OSError, RuntimeError, ValueError) as error:
            why = str(error) or "its head is damaged"
            raise ConfigError(
                f"The sound cannot be read ({why}); use a WAV file with 16 bits a sample."
            ) from None
        whole = len(raw) - len(raw) % (width * channels)
        values = np.frombuffer(raw[:whole], _WIDTHS[width]).astype(np.float32)
        # A byte counts from 0; wider numbers have a sign.
        values = values / 128.0 - 1.0 if width == 1 else values / float(2 ** (8 * width - 1))
        return cls(values.reshape(-1, channels).mean(axis=1, dtype=np.float32), rate)

    def wav(self) -> bytes:
        """As a WAV file, 16 bits."""
        file = io.BytesIO()
        with wave.open(file, "wb") as out:
            out.setnchannels(1)
            out.setsampwidth(2)
            out.setframerate(self.rate_hz)
            whole = np.rint(np.clip(self.samples, -1.0, 1.0) * 32767).astype("<i2")
            out.writeframes(whole.tobytes())
        return file.getvalue()

    def at(self, rate_hz: int) -> Sound:
        """The same sound with other samples a second."""
        if rate_hz == self.rate_hz:
            return self
        from scipy.signal import resample_poly

        common = gcd(rate_hz, self.rate_hz)
        samples = resample_poly(self.samples, rate_hz // common, self.rate_hz // common)
        return Sound(samples.astype(np.float32), rate_hz)
