"""How often somebody who knows people, and not ours, finds a person in our films.

Looks at films with `@vladmandic/human`, which Node runs; its package brings the models. The first
time npm gets it, 60 MB packed, into the cache folder; after that nothing is fetched::

    python benchmarks/recognise.py                       # films of two figures, made now
    python benchmarks/recognise.py old.webm new.webm     # films that there are
    python benchmarks/recognise.py --source ../old       # made by another checkout

One network looks for a person as for any other object, another for a face. Found is what it is
sure of by one half or more; `--sure` takes another share. The eyes' picture in the corner of a film
shows nobody, at most her hands and clothes: it tells how much is found by mistake. (The package's
network for the joints of a body is left out: it finds one in every picture, of nobody too.)
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from adamo_vh.files import cache_folder

_HERE = Path(__file__).with_suffix("")
FILMS: Mapping[str, tuple[str, str]] = {"mara": ("T4", "s1"), "jonas": ("T4", "s2")}
"""Task and scene of the film of each figure."""
VIEWS = {"room": (slice(0, 720), slice(0, 832)), "her eyes": (slice(0, 252), slice(832, 1280))}
"""Rows and columns of a film."""
FOUND = ("person", "face")


def main(arguments: Sequence[str] | None = None) -> None:
    """Make films if none are given, look at them, print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("films", nargs="*", type=Path, help="films; made now if none is given")
    parser.add_argument("--source", type=Path, help="checkout that makes them; this one if not")
    parser.add_argument("--every", type=float, default=0.5, help="seconds between two pictures")
    parser.add_argument("--sure", type=float, default=0.5, help="least certainty, 0.2 to 1")
    options = parser.parse_args(arguments)
    packages = installed()
    with tempfile.TemporaryDirectory() as folder:
        films = options.films or made(Path(folder), options.source or _HERE.parent.parent)
        print(f"| film | view | pictures | {' | '.join(FOUND)} |", f"|{'---|' * 5}", sep="\n")
        for film in films:
            pictures = Path(folder) / "pictures"
            taken(film, pictures, options.every)
            for view, rows in looked(packages, pictures).items():
                shares = [
                    sum(row[what] >= options.sure for row in rows) / len(rows) for what in FOUND
                ]
                told = " | ".join(f"{share:.2f}" for share in shares)
                print(f"| {film.stem} | {view} | {len(rows)} | {told} |", flush=True)
            shutil.rmtree(pictures)


def installed() -> Path:
    """The folder with the packages of `recognise/package-lock.json`; npm puts them there once."""
    lock = (_HERE / "package-lock.json").read_bytes()
    folder = cache_folder() / f"recognise_{hashlib.sha256(lock).hexdigest()[:16]}"
    if shutil.which("node") is None:
        raise SystemExit("Node is missing: install Node 20 or newer, with npm (nodejs.org).")
    if folder.is_dir():
        return folder
    if (npm := shutil.which("npm")) is None:
        raise SystemExit("npm is missing, which gets @vladmandic/human once: install it with Node.")
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent) as around:
        # Renamed when it is whole: what was cut short is no packages.
        begun = Path(around) / "packages"
        begun.mkdir()
        for name in ("package.json", "package-lock.json"):
            shutil.copy(_HERE / name, begun)
        command = [npm, "ci", "--ignore-scripts", "--no-audit", "--no-fund"]
        done = subprocess.run(command, cwd=begun, check=False, capture_output=True, text=True)
        if done.returncode != 0:
            why = (done.stderr.strip().splitlines() or ["it says nothing"])[0]
            raise SystemExit(f"npm could not get @vladmandic/human ({why}); try again online.")
        begun.rename(folder)
    return folder


def made(folder: Path, source: Path) -> list[Path]:
    """One film of each figure, by a checkout."""
    films = []
    for figure, (task, scene) in FILMS.items():
        film = folder / f"{figure}.webm"
        command = [sys.executable, "-m", "adamo_vh", "run", "--task", task, "--scene", scene]
        command += ["--model", "baseline", "--figure", figure, "--resolution", "480x270"]
        command += ["--video", str(film), "--out", str(folder / f"run_{figure}")]
        environment = {**os.environ, "PYTHONPATH": str(source.resolve() / "src")}
        subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL)
        films.append(film)
    return films


def taken(film: Path, folder: Path, every_s: float) -> None:
    """Write pictures of a film as `look.mjs` reads them, each view for itself."""
    import cv2

    folder.mkdir()
    reel = cv2.VideoCapture(str(film))
    step = max(1, round(every_s * reel.get(cv2.CAP_PROP_FPS)))
    count = 0
    while reel.grab():
        if count % step == 0:
            picture = cv2.cvtColor(reel.retrieve()[1], cv2.COLOR_BGR2RGB)
            for view, (rows, columns) in VIEWS.items():
                part = picture[rows, columns]
                name = f"{view}_{count:06d}_{part.shape[1]}x{part.shape[0]}.rgb"
                (folder / name).write_bytes(part.tobytes())
        count += 1
    if count == 0:
        raise SystemExit(f"{film} cannot be read as a film.")


def looked(packages: Path, folder: Path) -> dict[str, list[Mapping[str, float]]]:
    """How sure it was of what it found in each picture, by view."""
    found: dict[str, list[Mapping[str, float]]] = {view: [] for view in VIEWS}
    for line in _lines(["node", str(_HERE / "look.mjs"), str(packages), str(folder)]):
        row = json.loads(line)
        found[row["name"].rpartition("_")[0]].append(row)
    return found


def _lines(command: list[str]) -> Iterator[str]:
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"Node could not look at the pictures:\n{done.stderr[-2000:]}")
    return (line for line in done.stdout.splitlines() if line.startswith("{"))


if __name__ == "__main__":
    main()
