"""`adamo-vh scenes`, `adamo-vh scenes check` and `adamo-vh scenes show`."""

from __future__ import annotations

import io
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import typer
from rich.console import Console
from rich.table import Table

from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import put_json, say
from adamo_vh.errors import SceneError
from adamo_vh.files import write_whole
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.scenes import Scene, load_scene, scene_names

if TYPE_CHECKING:
    from adamo_vh.runtime.inspection.finding import SceneFinding


def list_scenes(*, as_json: bool) -> None:
    """Print the scenes that come with the package."""
    found = [load_scene(name) for name in scene_names()]
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
    from adamo_vh.runtime.inspection.finding import Severity

    name, findings, pictures = _inspected(file, out)
    ok = all(finding.severity is not Severity.ERROR for finding in findings)
    if as_json:
        rows = [asdict(finding) for finding in findings]
        paths = [str(path) for path in pictures]
        put_json({"scene": name, "ok": ok, "findings": rows, "pictures": paths})
    else:
        for finding in findings:
            told = (finding.problem, finding.fix) if finding.fix else (finding.problem,)
            say(f"{finding.severity}: {finding.where}: {'; '.join(told)}")
        say(f"{name}: {'sound' if ok else 'not sound'}")
        for path in pictures:
            say(path)
    if not ok:
        raise typer.Exit(Exit.NO)


def _inspected(file: str, out: Path | None) -> tuple[str, tuple[SceneFinding, ...], list[Path]]:
    """Name, findings and pictures; what cannot be simulated gets no pictures."""
    from adamo_vh.runtime.inspection.arrangement import inspect_arrangement
    from adamo_vh.runtime.inspection.checks import inspect_scene

    try:
        scene = load_scene(file)
        findings = inspect_arrangement(scene)
        if any(finding.blocks for finding in findings):
            return scene.name, findings, []
        engine = BuiltinEngine(scene)
    except SceneError as fault:
        if not Path(file).is_file():
            raise
        return Path(file).stem, _as_findings(fault), []
    try:
        folder = out or Path(f"scene-{scene.name}")
        findings = inspect_scene(scene, engine)
        return scene.name, findings, _draw(scene, engine, folder, ("top", "start"))
    finally:
        engine.close()


def _as_findings(fault: SceneError) -> tuple[SceneFinding, ...]:
    """Everything that is wrong with a file that cannot be read as a scene."""
    from adamo_vh.runtime.inspection.finding import bounded, error

    found = (error(where, problem, "", blocks=True) for where, problem in fault.faults)
    return tuple(bounded(found))


def show(file: str, out: Path | None) -> None:
    """Draw a scene from above, from the start and from each corner."""
    scene = load_scene(file)
    engine = BuiltinEngine(scene)
    for path in _draw(scene, engine, out or Path(f"scene-{scene.name}"), None):
        say(path)
    engine.close()


def _draw(
    scene: Scene, engine: BuiltinEngine, folder: Path, names: tuple[str, ...] | None
) -> list[Path]:
    from PIL import Image

    from adamo_vh.runtime.inspection.checks import cameras

    engine.reset(0)
    chosen = cameras(scene, engine)
    written = []
    for name in names or (*chosen, "start"):
        outside = chosen.get(name)
        view = engine.view(outside) if outside else engine.capture(1920, 1080)
        path = folder / f"{name}.png"
        picture = io.BytesIO()
        Image.fromarray(view.rgb).save(picture, "png")
        written.append(write_whole(path, picture.getvalue()))
    return written
