"""Speech in the studio: what a visitor says becomes text, and what she says becomes sound."""

from __future__ import annotations

import asyncio
import secrets
import threading
from collections import OrderedDict
from collections.abc import Callable
from typing import Annotated, Any, Generic, TypeVar

from fastapi import APIRouter, Body, Request, Response

from adamo_vh.errors import ConfigError
from adamo_vh.service.hosting import NoSessionError
from adamo_vh.speech.hearing import Heard, Recognizer
from adamo_vh.speech.sound import Sound
from adamo_vh.speech.speaking import Spoken, Voice

MOST_WAV_BYTES = 8_000_000
"""Forty seconds at 96,000 samples a second, or four minutes as speech is sent."""
_KEPT = 16
"""Utterances whose sound can still be fetched."""


_NO_EARS = "This studio does not hear: adamo-vh speech fetch tiny.en, then start it again."
_NO_VOICE = (
    "This studio does not speak: adamo-vh speech fetch en_US-ljspeech-medium, then start it again."
)
_T = TypeVar("_T")


class _Loaded(Generic[_T]):
    """Something that takes long to load: once, when it is needed first."""

    def __init__(self, make: Callable[[], _T] | None, lacking: str) -> None:
        self._make, self._lacking = make, lacking
        self._made: _T | None = None
        self._lock = threading.Lock()

    @property
    def is_there(self) -> bool:
        """Whether it can be had."""
        return self._make is not None

    def get(self) -> _T:
        """It.

        Raises:
            ConfigError: There is none, or it cannot be loaded.
        """
        if self._make is None:
            raise ConfigError(self._lacking)
        with self._lock:
            if self._made is None:
                self._made = self._make()
            return self._made


class Talk:
    """Ears and a voice of the server, each loaded when it is needed first; from any threads."""

    def __init__(
        self,
        ears: Callable[[], Recognizer] | None = None,
        voice: Callable[[], Voice] | None = None,
    ) -> None:
        """Begin without loading anything.

        Args:
            ears: Makes what hears; nobody is heard without.
            voice: Makes what speaks; nobody speaks without.
        """
        self._ears = _Loaded(ears, _NO_EARS)
        self._voice = _Loaded(voice, _NO_VOICE)
        self._said: OrderedDict[str, Spoken] = OrderedDict()
        self._lock = threading.Lock()

    def told(self) -> dict[str, bool]:
        """What can be done, for the page."""
        return {"hears": self._ears.is_there, "speaks": self._voice.is_there}

    def warm(self) -> None:
        """Load what there is, so that the first word is not waited for."""
        if self._ears.is_there:
            self._ears.get()
        if self._voice.is_there:
            self._voice.get()

    def hear(self, wav: bytes) -> Heard:
        """What is said in a WAV file.

        Raises:
            ConfigError: It is none, or nobody can hear here.
        """
        return self._ears.get().hear(Sound.of_wav(wav))

    def speak(self, text: str) -> tuple[str, Spoken]:
        """Say a text; its sound can be fetched by the name for a while.

        Raises:
            ConfigError: There is nothing to say, or nobody can speak here.
        """
        spoken, name = self._voice.get().speak(text), secrets.token_urlsafe(12)
        with self._lock:
            self._said[name] = spoken
            while len(self._said) > _KEPT:
                self._said.popitem(last=False)
        return name, spoken

    def sound(self, name: str) -> bytes:
        """The sound of what was said, as a WAV file.

        Raises:
            NoSessionError: Nothing was said under this name, or it is long ago.
        """
        with self._lock:
            spoken = self._said.get(name)
        if spoken is None:
            raise NoSessionError("There is no such sound, or it was said long ago.")
        return spoken.sound.wav()


def talk_routes(talk: Talk, prefix: str) -> APIRouter:
    """The routes of speech.

    Args:
        talk: Ears and voice.
        prefix: Under which they are.
    """
    router = APIRouter(prefix=prefix, include_in_schema=False)

    @router.post("/hear")
    async def hear(request: Request) -> dict[str, Any]:
        heard = await asyncio.to_thread(talk.hear, await request.body())
        return {"text": heard.text, "seconds": round(heard.seconds, 3)}

    @router.post("/speak")
    async def speak(text: Annotated[str, Body(embed=True, max_length=20_000)]) -> dict[str, Any]:
        name, spoken = await asyncio.to_thread(talk.speak, text)
        phonemes = [[p.symbol, round(p.start_s, 3), round(p.end_s, 3)] for p in spoken.phonemes]
        return {
            "sound": f"{prefix}/said/{name}.wav",
            "seconds": round(spoken.sound.seconds, 3),
            "phonemes": phonemes,
        }

    @router.get("/said/{name}.wav")
    async def said(name: str) -> Response:
        sound = await asyncio.to_thread(talk.sound, name)
        return Response(sound, 200, {"cache-control": "no-store"}, "audio/wav")

    return router
