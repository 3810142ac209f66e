"""A film of an episode: a camera that follows the figure, what its eyes see, what it thinks.

Asking for the moments between two states changes nothing about the episode.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.adapters.encoding import Film
from adamo_vh.adapters.tripod import Tripod
from adamo_vh.observation import Frame
from adamo_vh.record.trajectory import Acted, Ended, Event, Observed, Started, Thought
from adamo_vh.record.turn import Wish
from adamo_vh.session.filming import FilmSet

WIDTH, HEIGHT = 1280, 720
_ROOM_PX = (832, 720)
_EYES_PX = (448, 252)
_PAUSE_S = 1.2
"""How long a thought stands before the body moves."""
_INK, _PAPER, _CALL = (236, 232, 224), (24, 24, 27), (150, 190, 250)
_COLOURS = {"done": (142, 206, 142), "corrected": (232, 200, 110), "refused": (236, 128, 118)}

_Line = tuple[str, str, tuple[int, int, int]]
"""Label, words and colour of a subtitle."""


class VideoRecorder:
    """Films an episode. Observes the agent's events, and the moments of the engine's actions."""

    def __init__(self, path: Path, film_set: FilmSet) -> None:
        """Begin to film.

        Args:
            path: Of the film: .webm (VP8), .mp4 (H.264) or .avi (Motion JPEG).
            film_set: The engine whose episode is filmed.

        Raises:
            ConfigError: The name has another ending, or the film cannot be written.
        """
        self._film = Film(path, (WIDTH, HEIGHT), FilmSet.moments_per_s)
        self._canvas = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
        """The picture, in the order blue, green, red."""
        self._count = 0
        self._standing_s = 0.0
        self._set = film_set
        self._tripod = Tripod(film_set, _ROOM_PX)
        self._text: list[_Line] = []
        self._wishes: Sequence[Wish] = ()
        """The calls of the turn, from the one that is being carried out."""
        self._drawn: tuple[tuple[_Line, ...], NDArray[np.uint8]] | None = None
        film_set.watch(self._moment)

    def notify(self, event: Event, frame: Frame | None = None) -> None:
        """Change the subtitles; pause where there is something to read."""
        match event:
            case Started():
                self._text = [("Instruction", event.instruction, _INK)]
            case Observed(step=0):
                self._pause(_PAUSE_S)
            case Thought() if event.turn.wishes and not event.reply.unreadable:
                self._wishes = event.turn.wishes
                note = next((w.note for w in self._wishes if w.note.strip()), "")
                note = (event.reply.message.text.strip() or note).split("Memory:")[0]
                calls = self._next()
                label = f"Step {event.step + 1}" if calls else "Finish"
                self._text = [self._text[0], (label, note, _INK), *calls]
                self._pause(_PAUSE_S)
            case Acted():
                colour = _COLOURS[event.feedback.outcome]
                # Of a call that was doubted, the close-up is all that happened.
                done = _caption(event.name, event.arguments, "")
                self._text = [*self._text[:2], done, ("Feedback", event.feedback.text, colour)]
                self._pause(_PAUSE_S / 2)
                # The next call of the same turn may be about to be carried out.
                self._wishes = self._wishes[1:]
                self._text = [*self._text[:2], *self._next()]
            case Ended():
                end = event.answer or f"(none: {event.reason.value.replace('_', ' ')})"
                self._text = [self._text[0], ("Answer", end, _COLOURS["done"])]
                self._pause(2 * _PAUSE_S)
            case _:
                pass

    def close(self) -> None:
        """Finish the film."""
        self._set.watch(None)
        self._film.close()

    def _next(self) -> list[_Line]:
        """The call that comes next; Finish is none, its answer is shown at the end."""
        return [
            _caption(wish.call.name, wish.arguments, wish.call.raw)
            for wish in self._wishes[:1]
            if not wish.is_finish
        ]

    def _pause(self, seconds: float) -> None:
        """Stand, breathe and blink while the text can be read; drawn at a third of the rate."""
        for _ in range(0, round(seconds * FilmSet.moments_per_s), 3):
            self._standing_s += 3 / FilmSet.moments_per_s
            with self._set.idling(self._standing_s):
                self._moment(times=3)

    def _moment(self, times: int = 1) -> None:
        """Add one picture. The eyes' is small and drawn every other time."""
        room = self._set.picture(self._tripod.camera())
        self._canvas[:, : _ROOM_PX[0]] = room[:, :, ::-1]
        if self._count % 2 == 0:
            eyes = self._set.eyes(*_EYES_PX)
            self._canvas[: _EYES_PX[1], _ROOM_PX[0] :] = eyes[:, :, ::-1]
        self._count += 1
        text = self._subtitles(WIDTH - _ROOM_PX[0], HEIGHT - _EYES_PX[1])
        self._canvas[_EYES_PX[1] :, _ROOM_PX[0] :] = text[:, :, ::-1]
        self._film.caption(_spoken(self._text))
        self._film.write(self._canvas, times)

    def _subtitles(self, width: int, height: int) -> NDArray[np.uint8]:
        from PIL import Image, ImageDraw, ImageFont

        key = tuple(self._text)
        if self._drawn is not None and self._drawn[0] == key:
            return self._drawn[1]
        picture = Image.new("RGB", (width, height), _PAPER)
        draw = ImageDraw.Draw(picture)
        heading, text = ImageFont.load_default(13), ImageFont.load_default(17)
        y = 16
        for label, words, colour in self._text:
            draw.text((18, y), label.upper(), (140, 138, 132), heading)
            y += 19
            for line in _wrapped(words, text, width - 36)[:9]:
                draw.text((18, y), line, colour, text)
                y += 22
            y += 12
        self._drawn = (key, np.asarray(picture))
        return self._drawn[1]


def _spoken(lines: Sequence[_Line]) -> str:
    """What is to be read at a moment, as a subtitle for players: all but the instruction."""
    return "\n".join(f"{label}: {words}" for label, words, _ in lines[1:] or lines)


def _caption(name: str, arguments: Mapping[str, Any] | None, raw: str) -> _Line:
    """A call as a subtitle."""
    return "Call", f"{name} {raw if arguments is None else json.dumps(arguments)}", _CALL


def _wrapped(words: str, font: Any, width: int) -> list[str]:
    """Lines that fit."""
    lines = [""]
    for word in words.split():
        longer = f"{lines[-1]} {word}".strip()
        if font.getlength(longer) <= width or not lines[-1]:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines
