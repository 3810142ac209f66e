"""`adamo-vh figure`: the virtual human for other engines, and characters of others for ours."""

from __future__ import annotations

import io
from dataclasses import asdict
from pathlib import Path

from adamo_vh.cli.terminal import put_json, say
from adamo_vh.errors import ConfigError
from adamo_vh.files import check_place, write_whole


def export(file: Path, who: str) -> None:
    """Write a skinned GLB with its clips.

    Raises:
        ConfigError: The file is named like another format, or nobody is called so.
    """
    from adamo_vh.session.figures import write_figure

    if file.suffix.lower() != ".glb":
        raise ConfigError(f"{file}: a figure is written as GLB; name it {file.stem or 'x'}.glb.")
    say(f"{file}: {who}, {write_figure(file, who)}")


def check(file: Path, out: Path | None, *, as_json: bool) -> None:
    """Say what of an own figure is used and what it lacks.

    Args:
        file: The figure.
        out: Picture to draw, PNG.
        as_json: Print JSON.

    Raises:
        ConfigError: A file is named like another format.
        FileError: Nothing of it can be used.
    """
    from PIL import Image

    from adamo_vh.session.figures import check_figure, draw_figure, is_own

    if not is_own(str(file)):
        raise ConfigError(f"{file}: a figure of your own is a GLB or VRM; name it .glb or .vrm.")
    if out is not None:
        if out.suffix.lower() != ".png":
            raise ConfigError(f"--out {out}: the picture is a PNG; name it {out.stem or 'x'}.png.")
        check_place(out.parent)
    report = check_figure(file)
    if out is not None:
        content = io.BytesIO()
        Image.fromarray(draw_figure(str(file))).save(content, "png")
        write_whole(out, content.getvalue())
    if as_json:
        drawn = {} if out is None else {"picture": str(out)}
        put_json({**asdict(report), "warnings": report.warnings, **drawn})
        return
    for line in report.lines():
        say(line)
    if out is not None:
        say(f"picture    {out}")
    say(f"usable: --figure {file}")
