"""`adamo-vh figure`: the virtual human for other engines."""

from __future__ import annotations

from pathlib import Path

from adamo_vh.cli.terminal import say
from adamo_vh.errors import ConfigError


def export(file: Path, who: str) -> None:
    """Write a skinned GLB with its clips.

    Raises:
        ConfigError: The file is named like another format, or nobody is called so.
    """
    from adamo_vh.runtime.human.clips import clips
    from adamo_vh.runtime.human.glb import write_glb
    from adamo_vh.runtime.human.looks import load_figure

    if file.suffix.lower() != ".glb":
        raise ConfigError(f"{file}: a figure is written as GLB; name it {file.stem or 'x'}.glb.")
    figure, motions = load_figure(who), clips()
    write_glb(file, figure, motions)
    names = ", ".join(clip.name for clip in motions)
    say(f"{file}: {who}, {figure.triangle_count} triangles, clips {names}")
