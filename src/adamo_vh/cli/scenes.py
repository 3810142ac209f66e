"""`adamo-vh scenes`, and `check`, `show` and `vary` of it."""

from __future__ import annotations

import io
from dataclasses import asdict
from pathlib import Path

import typer
from rich.console import Console
from rich.table import Table

from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import complain, put_json, say
from adamo_vh.engine import MOST_VARIATIONS
from adamo_vh.errors import ConfigError, FileError
from adamo_vh.files import write_whole
from adamo_vh.session.builtin import (
    SceneReport,
    export,
    inspect_scene_file,
    known_scenes,
    light_of,
    read_scene,
    scene_pictures,
    write_scene,
)


def list_scenes(*, as_json: bool) -> None:
    """Print the scenes that come with the package."""
    found = known_scenes()
    if as_json:
        rows = [
            {
                "name": scene.name,
                "title": scene.title,
                "objects": len(scene.objects),
                "furniture": [piece.name for piece in scene.furniture],
                "areas": [area.name for area in scene.areas],
            }
            for scene in found
        ]
        put_json({"scenes": rows})
        return
    table = Table("scene", "title", "objects", "furniture", "areas")
    for scene in found:
        table.add_row(
            scene.name,
            scene.title,
            str(len(scene.objects)),
            ", ".join(piece.name for piece in scene.furniture),
            ", ".join(area.name for area in scene.areas),
        )
    Console().print(table)


def check(file: str, out: Path | None, *, as_json: bool) -> None:
    """Look a scene over, with pictures; exit 1 if something is wrong with it."""
    report = inspect_scene_file(file)
    try:
        pictures = _written(report, out)
    except FileError as error:
        complain(f"warning: no pictures: {error}")  # What was found is not lost for them.
        pictures = []
    if as_json:
        rows = [asdict(finding) for finding in report.findings]
        paths = [str(path) for path in pictures]
        put_json({"scene": report.name, "ok": report.is_sound, "findings": rows, "pictures": paths})
    else:
        for finding in report.findings:
            told = (finding.problem, finding.fix) if finding.fix else (finding.problem,)
            say(f"{finding.severity}: {finding.where}: {'; '.join(told)}")
        say(f"{report.name}: {'sound' if report.is_sound else 'not sound'}")
        for path in pictures:
            say(path)
    if not report.is_sound:
        raise typer.Exit(Exit.NO)


def show(file: str, out: Path | None) -> None:
    """Draw a scene from above, from the start and from each corner."""
    for path in _written(scene_pictures(read_scene(file)), out):
        say(path)


def vary(file: str, variation: int, out: Path | None, *, as_json: bool) -> None:
    """Say what is where in a variation, draw it, and write it as a scene file if asked to."""
    if out is not None and out.suffix != ".toml":
        raise ConfigError(f"--out {out}: a scene file ends with .toml; name it so.")
    if not 0 <= variation <= MOST_VARIATIONS:
        raise ConfigError(f"--variation {variation}: use 0 to {MOST_VARIATIONS}.")
    scene = read_scene(file, variation)
    added = {item.id for item in scene.objects} - {item.id for item in read_scene(file).objects}
    written = [] if out is None else [write_scene(scene, out)]
    written += _written(scene_pictures(scene), None)
    if as_json:
        data = {"scene": scene.name, "variation": scene.variation, "light": light_of(scene)}
        objects = [{**asdict(item), "added": item.id in added} for item in scene.objects]
        put_json({**data, "objects": objects, "written": [str(path) for path in written]})
        return
    say(f"{scene.full_name}, light {light_of(scene)}")
    for item in scene.objects:
        more = ", added" if item.id in added else ""
        say(f"{item.id:4d} {item.asset} on {item.on}, turned {item.yaw_deg:g} degrees{more}")
    for path in written:
        say(path)


def export_files(file: str, variation: int, out: Path) -> None:
    """Write a scene with its meshes for another engine."""
    written = export(file, variation, out)
    megabytes = sum(path.stat().st_size for path in written) / 1e6
    say(f"{written[0]} and {len(written) - 1} meshes, {megabytes:.1f} MB")


def _written(report: SceneReport, out: Path | None) -> list[Path]:
    """Write the pictures of a scene into a folder."""
    from PIL import Image

    folder = out or Path(f"scene-{report.name.replace(' ', '-')}")
    written = []
    for name, rgb in report.pictures.items():
        picture = io.BytesIO()
        Image.fromarray(rgb).save(picture, "png")
        written.append(write_whole(folder / f"{name}.png", picture.getvalue()))
    return written
