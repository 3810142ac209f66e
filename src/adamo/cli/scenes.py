"""`adamo scenes`, `adamo scenes check` and `adamo scenes show`."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import typer
from rich.console import Console
from rich.table import Table

from adamo.runtime.builtin import BuiltinEngine
from adamo.runtime.scenes import Scene, load_scene, scene_names


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
        typer.echo(json.dumps({"scenes": rows}))
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
    from adamo.runtime.scenes.inspection import Severity, inspect_scene

    scene = load_scene(file)
    engine = BuiltinEngine(scene)
    findings = inspect_scene(scene, engine)
    pictures = _draw(scene, engine, out or Path(f"scene-{scene.name}"), ("top", "start"))
    engine.close()
    ok = all(finding.severity is not Severity.ERROR for finding in findings)
    if as_json:
        rows = [asdict(finding) for finding in findings]
        paths = [str(path) for path in pictures]
        found = {"scene": scene.name, "ok": ok, "findings": rows, "pictures": paths}
        typer.echo(json.dumps(found))
    else:
        for finding in findings:
            typer.echo(f"{finding.severity}: {finding.where}: {finding.problem}; {finding.fix}")
        typer.echo(f"{scene.name}: {'sound' if ok else 'not sound'}")
        for path in pictures:
            typer.echo(path)
    if not ok:
        raise typer.Exit(1)


def show(file: str, out: Path | None) -> None:
    """Draw a scene from above, from the start and from each corner."""
    scene = load_scene(file)
    engine = BuiltinEngine(scene)
    for path in _draw(scene, engine, out or Path(f"scene-{scene.name}"), None):
        typer.echo(path)
    engine.close()


def _draw(
    scene: Scene, engine: BuiltinEngine, folder: Path, names: tuple[str, ...] | None
) -> list[Path]:
    from PIL import Image

    from adamo.runtime.scenes.inspection import cameras

    folder.mkdir(parents=True, exist_ok=True)
    views = {name: engine.view(camera).rgb for name, camera in cameras(scene, engine).items()}
    views["start"] = engine.capture(1920, 1080).rgb
    written = []
    for name, picture in views.items():
        if names is None or name in names:
            path = folder / f"{name}.png"
            Image.fromarray(picture).save(path)
            written.append(path)
    return written
