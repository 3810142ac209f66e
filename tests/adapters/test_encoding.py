"""Films are written in a thread of their own, with subtitles beside them, and say what is wrong."""

from __future__ import annotations

import stat
from pathlib import Path

import numpy as np
import pytest

from adamo_vh.adapters import encoding
from adamo_vh.adapters.encoding import Film, ffmpeg, subtitles
from adamo_vh.errors import ConfigError

SIZE = (320, 180)


def picture(number: int) -> np.ndarray:
    """A bar that goes to the right."""
    found = np.full((SIZE[1], SIZE[0], 3), 30, np.uint8)
    found[:, 10 * number : 10 * number + 20] = (40, 180, 220)
    return found


def played(path: Path) -> list[np.ndarray]:
    import cv2

    film = cv2.VideoCapture(str(path))
    found: list[np.ndarray] = []
    while True:
        read, shown = film.read()
        if not read:
            return found
        found.append(shown)


@pytest.mark.parametrize("ending", [".webm", ".avi", ".mp4"])
def test_pictures_come_in_order_and_none_is_lost(tmp_path, ending, capfd):
    if ending == ".mp4" and ffmpeg() is None:
        pytest.skip("no ffmpeg here")
    film = Film(tmp_path / f"film{ending}", SIZE, 15.0)
    canvas = picture(0)
    for number in range(20):
        canvas[:] = picture(number)  # The film keeps a copy: the next picture changes it.
        film.write(canvas, 2 if number == 19 else 1)
    assert film.seconds == pytest.approx(21 / 15)
    film.close()
    shown = played(film.path)
    assert len(shown) == 21
    bars = [np.flatnonzero(p[90, :, 2] > 120).mean() for p in shown]
    assert np.allclose(bars[:20], [10 * n + 9.5 for n in range(20)], atol=4)
    told = capfd.readouterr()
    assert told.out == told.err == ""


def test_subtitles_are_beside_the_film_and_timed(tmp_path):
    film = Film(tmp_path / "film.avi", SIZE, 10.0)
    for number, text in enumerate(
        ["Hello", "Hello", "Note: a < b & c --> d\n\nCall: Look", "", "x"]
    ):
        film.caption(text)
        film.write(picture(number))
    film.close()
    told = (tmp_path / "film.vtt").read_text(encoding="utf-8")
    assert told.split("\n\n") == [
        "WEBVTT",
        "00:00:00.000 --> 00:00:00.200\nHello",
        "00:00:00.200 --> 00:00:00.300\nNote: a &lt; b &amp; c → d\nCall: Look",
        "00:00:00.400 --> 00:00:00.500\nx\n",
    ]


def test_the_clock_of_subtitles_knows_hours():
    told = subtitles(iter([(3725.5, 3726.0, "late")]))
    assert "01:02:05.500 --> 01:02:06.000" in told


def test_unknown_endings_and_places_are_refused_in_one_line(tmp_path):
    with pytest.raises(ConfigError, match=r"\.webm, \.avi or \.mp4"):
        Film(tmp_path / "film.gif", SIZE, 15.0)
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(Exception, match="file") as caught:
        Film(tmp_path / "file" / "film.avi", SIZE, 15.0)
    assert "\n" not in str(caught.value)


def test_without_ffmpeg_an_mp4_names_what_helps(tmp_path, monkeypatch):
    monkeypatch.setattr(encoding, "ffmpeg", lambda: None)
    with pytest.raises(ConfigError, match=r"apt-get install ffmpeg.*webm"):
        Film(tmp_path / "film.mp4", SIZE, 15.0)
    assert not list(tmp_path.iterdir())
    older = tmp_path / "film.mp4"
    older.write_bytes(b"an older film")
    with pytest.raises(ConfigError):
        Film(older, (64, 48), 15)
    assert older.read_bytes() == b"an older film"


def test_an_encoder_that_breaks_off_is_an_error_and_no_hang(tmp_path, monkeypatch):
    program = tmp_path / "ffmpeg"
    program.write_text(
        "#!/bin/sh\n"
        'case "$*" in *-encoders*) echo " V..... libx264 x"; exit 0;; esac\n'
        "head -c 1000 >/dev/null; echo 'No space left on device' >&2; exit 1\n"
    )
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setattr(encoding, "ffmpeg", lambda: str(program))
    film = Film(tmp_path / "film.mp4", SIZE, 15.0)
    with pytest.raises(ConfigError, match=r"film\.mp4: the film cannot be written on"):  # noqa: PT012
        for number in range(40):
            film.write(picture(number % 20))
        film.close()
