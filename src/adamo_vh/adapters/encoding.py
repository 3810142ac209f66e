"""Pictures into a film: in a thread of its own, by OpenCV or by an ffmpeg on this machine.

WebM with VP8 and AVI with Motion JPEG can be written by the FFmpeg (LGPL) inside OpenCV, so that no
GPL library is needed. MP4 with H.264 is written by the program `ffmpeg`, where somebody installed
it, and WebM then too, which is quicker.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path
from queue import Queue

import numpy as np
from numpy.typing import NDArray

from adamo_vh.errors import ConfigError
from adamo_vh.files import make_folder, naming, write_whole

CODECS = {".webm": "VP80", ".avi": "MJPG"}
ENDINGS = (*CODECS, ".mp4")
_ENCODERS = {
    ".mp4": (
        ("libx264", ("-preset", "veryfast", "-crf", "21", "-movflags", "+faststart")),
        ("libopenh264", ("-b:v", "3M", "-movflags", "+faststart")),
    ),
    ".webm": (("libvpx", ("-deadline", "realtime", "-cpu-used", "8", "-b:v", "3M")),),
}
"""What a program ffmpeg encodes with, the first that it has."""
_AHEAD = 12
"""So many pictures may wait to be encoded; then whoever draws them waits too."""
_Picture = NDArray[np.uint8]


class Film:
    """A film that is being written."""

    def __init__(self, path: Path, size_px: tuple[int, int], rate: float) -> None:
        """Begin it.

        Args:
            path: Of the film; its ending says how it is encoded.
            size_px: Width and height.
            rate: Pictures a second.

        Raises:
            ConfigError: The name has another ending, the file cannot be written, or nothing here
                can encode it; names the fix.
        """
        if path.suffix not in ENDINGS:
            raise ConfigError(f"{path}: films end in {', '.join(ENDINGS[:-1])} or {ENDINGS[-1]}.")
        is_new = not path.exists()
        # Encoders say no more than that they cannot; and that not in one line.
        with naming("written", make_folder(path.parent) / path.name):
            path.touch()
        self.path, self._rate = path, rate
        self.count = 0
        """Pictures so far."""
        try:
            self._put, self._end = _encoder(path, size_px, rate)
        except ConfigError:
            if is_new:
                path.unlink()
            raise
        self._waiting: Queue[tuple[_Picture, int] | None] = Queue(_AHEAD)
        self._fault: Exception | None = None
        self._thread = threading.Thread(target=self._work, name="adamo-vh-film", daemon=True)
        self._thread.start()
        self._cues: list[tuple[int, str]] = []

    @property
    def seconds(self) -> float:
        """How long it is so far."""
        return self.count / self._rate

    def write(self, picture: _Picture, times: int = 1) -> None:
        """Add a picture, (H, W, 3) in the order blue, green, red, that stands for some pictures.

        Raises:
            ConfigError: The film cannot be written on.
        """
        self._check()
        self._waiting.put((picture.copy(), times))
        self.count += times

    def caption(self, text: str) -> None:
        """What a player may show as a subtitle from now on."""
        if not self._cues or self._cues[-1][1] != text:
            self._cues.append((self.count, text))

    def close(self) -> None:
        """Finish it, and write its subtitles beside it.

        Raises:
            ConfigError: It could not be written whole.
        """
        self._waiting.put(None)
        self._thread.join()
        try:
            self._end()
        except (OSError, subprocess.SubprocessError) as error:
            self._fault = self._fault or error
        write_whole(self.path.with_suffix(".vtt"), subtitles(self._timed()).encode())
        self._check()

    def _timed(self) -> Iterator[tuple[float, float, str]]:
        ends = [*(begin for begin, _ in self._cues), self.count][1:]
        for (begin, text), end in zip(self._cues, ends, strict=True):
            if text and end > begin:
                yield begin / self._rate, end / self._rate, text

    def _work(self) -> None:
        while (waiting := self._waiting.get()) is not None:
            picture, times = waiting
            if self._fault is None:
                try:
                    for _ in range(times):
                        self._put(picture)
                except (OSError, ValueError) as error:
                    self._fault = error

    def _check(self) -> None:
        if self._fault is not None:
            raise ConfigError(
                f"{self.path}: the film cannot be written on ({self._fault}); is the disk full?"
            )


def subtitles(cues: Iterator[tuple[float, float, str]]) -> str:
    """Timed text as WebVTT.

    Args:
        cues: Begin and end in seconds, and what is shown.
    """
    blocks = ["WEBVTT"]
    for begin, end, text in cues:
        # An empty line would end the cue, and "-->" would begin another.
        lines = [line.strip() for line in text.replace("-->", "→").splitlines() if line.strip()]
        plain = "\n".join(lines).replace("&", "&amp;").replace("<", "&lt;")
        blocks.append(f"{_clock(begin)} --> {_clock(end)}\n{plain}")
    return "\n\n".join(blocks) + "\n"


def _clock(seconds: float) -> str:
    whole = round(seconds * 1000)
    return (
        f"{whole // 3600000:02}:{whole // 60000 % 60:02}:{whole // 1000 % 60:02}.{whole % 1000:03}"
    )


_Encoder = tuple[Callable[[_Picture], object], Callable[[], object]]
"""What takes a picture, and what ends the film."""


def _by_opencv(path: Path, size_px: tuple[int, int], rate: float) -> _Encoder:
    os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")
    import cv2

    code = cv2.VideoWriter.fourcc(*CODECS[path.suffix])
    with _quiet():
        writer = cv2.VideoWriter(str(path), code, rate, size_px)
    if not writer.isOpened():
        raise ConfigError(f"{path}: cannot be written as a film.")
    return writer.write, writer.release


@contextmanager
def _quiet() -> Iterator[None]:
    """OpenCV's codecs speak past Python to the terminal about tags that are as they should be."""
    try:
        kept = os.dup(2)
    except OSError:
        yield
        return
    with open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(kept, 2)
            os.close(kept)


def ffmpeg() -> str | None:
    """The program ffmpeg on this machine; None without one."""
    if found := shutil.which("ffmpeg"):
        return found
    with suppress(ImportError, RuntimeError):
        return str(import_module("imageio_ffmpeg").get_ffmpeg_exe())
    return None


def _encoder(path: Path, size_px: tuple[int, int], rate: float) -> _Encoder:
    """The quickest that there is: the program ffmpeg before OpenCV."""
    wanted, program = _ENCODERS.get(path.suffix, ()), ffmpeg()
    if wanted and program is not None:
        asked = [program, "-hide_banner", "-encoders"]
        listed = subprocess.run(asked, check=False, capture_output=True, text=True).stdout
        for name, options in wanted:
            if f" {name} " in listed:
                return _piped([program, name, *options], path, size_px, rate)
    if path.suffix in CODECS:
        return _by_opencv(path, size_px, rate)
    if program is not None:
        raise ConfigError(f"{path}: the ffmpeg here cannot encode H.264; name a .webm.")
    raise ConfigError(
        f"{path}: MP4 needs the program ffmpeg ('apt-get install ffmpeg' or 'pip install "
        f"imageio-ffmpeg'); or name a .webm."
    )


def _piped(encoder: Sequence[str], path: Path, size_px: tuple[int, int], rate: float) -> _Encoder:
    program, name, *options = encoder
    width, height = size_px
    raw = ("-f", "rawvideo", "-pix_fmt", "bgr24", "-s", f"{width}x{height}", "-r", f"{rate:g}")
    coded = ("-c:v", name, *options, "-pix_fmt", "yuv420p")
    command = [program, "-y", "-loglevel", "error", *raw, "-i", "-", *coded, str(path)]
    work = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    assert work.stdin is not None
    pipe = work.stdin

    def put(picture: _Picture) -> None:
        pipe.write(np.ascontiguousarray(picture).data)

    def end() -> None:
        with suppress(BrokenPipeError):
            pipe.close()
        told = work.stderr.read().decode(errors="replace").strip() if work.stderr else ""
        if work.wait() != 0:
            raise OSError(told.splitlines()[-1] if told else "ffmpeg failed")

    return put, end
