"""A film of an episode: a camera that follows the figure, what its eyes see, what it thinks.

WebM with VP8, written by the FFmpeg (LGPL) inside OpenCV, so that no GPL library is needed. Asking
for the moments between two states changes nothing about the episode.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adamo_vh.errors import ConfigError
from adamo_vh.files import make_folder, naming
from adamo_vh.geometry import Camera, Vec3
from adamo_vh.observation import BodyState, Frame
from adamo_vh.record.trajectory import Acted, Ended, Event, Observed, Started, Thought
from adamo_vh.record.turn import Wish
from adamo_vh.session.filming import FilmSet

WIDTH, HEIGHT = 1280, 720
_ROOM_PX = (832, 720)
_EYES_PX = (448, 252)
_PAUSE_S = 1.2
"""How long a thought stands before the body moves."""
_CODECS = {".webm": "VP80", ".avi": "MJPG"}
_DISTANCE_M, _CAMERA_Z_M, _WALL_M = 2.7, 1.75, 0.35
_FOV_RAD = math.radians(62.0)
_FOLLOW = 0.1
"""Share of the way to its ideal place that the camera goes in each frame."""
_INK, _PAPER, _CALL = (236, 232, 224), (24, 24, 27), (150, 190, 250)
_COLOURS = {"done": (142, 206, 142), "corrected": (232, 200, 110), "refused": (236, 128, 118)}

_Line = tuple[str, str, tuple[int, int, int]]
"""Label, words and colour of a subtitle."""


class VideoRecorder:
    """Films an episode. Observes the agent's events, and the moments of the engine's actions."""

    def __init__(self, path: Path, film_set: FilmSet) -> None:
        """Begin to film.

        Args:
            path: Of the film: .webm (VP8) or .avi (Motion JPEG).
            film_set: The engine whose episode is filmed.

        Raises:
            ConfigError: The name has another ending, or the file cannot be written.
        """
        os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
        import cv2

        if path.suffix not in _CODECS:
            raise ConfigError(f"{path}: films end in {' or '.join(_CODECS)}.")
        # OpenCV says no more than that it cannot; and that not in one line.
        with naming("written", make_folder(path.parent) / path.name):
            path.touch()
        code = cv2.VideoWriter.fourcc(*_CODECS[path.suffix])
        self._writer = cv2.VideoWriter(str(path), code, FilmSet.moments_per_s, (WIDTH, HEIGHT))
        if not self._writer.isOpened():
            raise ConfigError(f"{path}: cannot be written as a film.")
        self._canvas = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
        """The picture, in the order blue, green, red."""
        self._count = 0
        self._standing_s = 0.0
        self._set = film_set
        self._camera_at: Vec3 | None = None
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
        self._writer.release()

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
                self._moment()
            self._writer.write(self._canvas)
            self._writer.write(self._canvas)

    def _moment(self) -> None:
        """Add one picture. The eyes' is small and drawn every other time."""
        room = self._set.picture(self._follow(self._set.body()))
        self._canvas[:, : _ROOM_PX[0]] = room[:, :, ::-1]
        if self._count % 2 == 0:
            eyes = self._set.eyes(*_EYES_PX)
            self._canvas[: _EYES_PX[1], _ROOM_PX[0] :] = eyes[:, :, ::-1]
        self._count += 1
        text = self._subtitles(WIDTH - _ROOM_PX[0], HEIGHT - _EYES_PX[1])
        self._canvas[_EYES_PX[1] :, _ROOM_PX[0] :] = text[:, :, ::-1]
        self._writer.write(self._canvas)

    def _follow(self, body: BodyState) -> Camera:
        """A camera in front and to the side, inside the room, that moves softly."""
        scene, at = self._set.scene, body.position
        angle = body.heading_rad + math.radians(50.0)
        x = at.x + _DISTANCE_M * math.cos(angle)
        y = at.y + _DISTANCE_M * math.sin(angle)
        x = min(max(x, scene.x_min + _WALL_M), scene.x_max - _WALL_M)
        y = min(max(y, scene.y_min + _WALL_M), scene.y_max - _WALL_M)
        wish = Vec3(x, y, _CAMERA_Z_M)
        last = self._camera_at or wish
        self._camera_at = here = last + (wish - last) * _FOLLOW
        return Camera.towards(here, Vec3(at.x, at.y, 1.0), _FOV_RAD, _ROOM_PX)

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
