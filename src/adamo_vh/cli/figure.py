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
    from adamo_vh.session.builtin import write_figure

    if file.suffix.lower() != ".glb":
        raise ConfigError(f"{file}: a figure is written as GLB; name it {file.stem or 'x'}.glb.")
    say(f"{file}: {who}, {write_figure(file, who)}")
