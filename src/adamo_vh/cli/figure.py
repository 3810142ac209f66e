"""`adamo-vh figure`: the virtual human for other engines."""

from __future__ import annotations

from pathlib import Path

import typer


def export(file: Path, who: str) -> None:
    """Write a skinned GLB with its clips."""
    from adamo_vh.runtime.human.clips import clips
    from adamo_vh.runtime.human.glb import write_glb
    from adamo_vh.runtime.human.looks import load_figure

    figure, motions = load_figure(who), clips()
    file.parent.mkdir(parents=True, exist_ok=True)
    write_glb(file, figure, motions)
    names = ", ".join(clip.name for clip in motions)
    typer.echo(f"{file}: {who}, {figure.triangle_count} triangles, clips {names}")
