"""Figures: those that come with the package, and own ones from a file.

An own figure changes the looks alone; the body that is scored is the same for all. What a run was
played with is known by the digest of its file, and a copy of it lies in the run folder.
"""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

from adamo_vh.engine import World
from adamo_vh.episode.result import Manifest
from adamo_vh.errors import FileError, RecordError
from adamo_vh.files import check_place, write_whole
from adamo_vh.readable import readable
from adamo_vh.record.run_folder import FIGURE
from adamo_vh.session.lending import LentWorld

if TYPE_CHECKING:
    from adamo_vh.runtime.human.own.conformance import Conformance
    from adamo_vh.runtime.human.own.showing import Picture


def figure_names() -> tuple[str, ...]:
    """Who the virtual human can be; the first is the default."""
    from adamo_vh.runtime.human.looks import VARIANTS

    return VARIANTS


def is_own(who: str) -> bool:
    """Whether a figure is named by its file."""
    from adamo_vh.runtime.human.looks import is_own as named_by_file

    return named_by_file(who)


def figure_glb(who: str) -> bytes:
    """A figure as a skinned GLB with its clips; kept in the cache like a scene.

    Args:
        who: A name, or the file of an own figure, which is fitted to our skeleton.

    Raises:
        ConfigError: No figure has this name.
        FileError: An own figure cannot be used.
    """
    from adamo_vh.runtime import human
    from adamo_vh.runtime.assets.bake import cached
    from adamo_vh.runtime.human.clips import clips
    from adamo_vh.runtime.human.glb import figure_glb as written
    from adamo_vh.runtime.human.looks import load_figure

    figure = load_figure(who)
    digest = sha256(figure_digest(who).encode())
    for path in sorted(Path(human.__path__[0]).rglob("*")):
        if path.suffix == ".py" or path.stem == who:
            digest.update(path.read_bytes())
    name = f"figure_{'own' if is_own(who) else who}_{digest.hexdigest()[:24]}.glb"
    return cached(name, lambda: written(figure, clips()))


def write_figure(file: Path, who: str) -> str:
    """Write a figure as a skinned GLB with its clips; what it has, in words.

    Raises:
        ConfigError: No figure has this name.
        FileError: It cannot be written there.
    """
    from adamo_vh.runtime.human.clips import clips
    from adamo_vh.runtime.human.glb import write_glb
    from adamo_vh.runtime.human.looks import load_figure

    check_place(file.parent)
    figure, motions = load_figure(who), clips()
    write_glb(file, figure, motions)
    names = ", ".join(clip.name for clip in motions)
    return f"{figure.triangle_count} triangles, clips {names}"


def check_figure(file: Path) -> Conformance:
    """What of an own figure can be used, and what is missing.

    Raises:
        FileError: Nothing can be used: it is no humanoid, damaged or too large; names the fix.
    """
    from adamo_vh.runtime.human.own.reading import own_figure

    return own_figure(file).report


def draw_figure(who: str) -> Picture:
    """(H, W, 3) a figure standing, walking, reaching and holding, on one sheet.

    Raises:
        ConfigError: No figure has this name.
        FileError: An own figure cannot be used.
        RenderingError: There is no OpenGL.
    """
    from adamo_vh.runtime.graphics import check_process, load_mujoco
    from adamo_vh.runtime.human.looks import load_figure
    from adamo_vh.runtime.human.own.showing import sheet

    check_process()
    load_mujoco()
    return sheet(load_figure(who))


def figure_digest(who: str) -> str:
    """SHA-256 of the file of an own figure; empty for one that comes with the package.

    Raises:
        FileError: The file cannot be read.
    """
    if not is_own(who):
        return ""
    from adamo_vh.runtime.human.own.reading import content_of

    return sha256(content_of(Path(who))).hexdigest()


def digest_in(world: World) -> str:
    """As `figure_digest`, of the figure that an engine was made with; empty in one of others.

    What another engine calls its figure is no path of ours.
    """
    from adamo_vh.runtime.builtin import BuiltinEngine

    made = world.lender.world if isinstance(world, LentWorld) else world
    return made.world.figure.sha256 if isinstance(made, BuiltinEngine) else ""


def keep_figure(folder: Path, manifest: Manifest) -> None:
    """Put the file of an own figure into the run folder.

    Raises:
        RecordError: It was changed since the engine was made.
        FileError: It cannot be read or written.
    """
    if not manifest.figure_sha256:
        return
    from adamo_vh.runtime.human.own.reading import content_of

    content = content_of(Path(manifest.config.figure))
    if sha256(content).hexdigest() != manifest.figure_sha256:
        raise RecordError(
            f"{readable(manifest.config.figure)} is not the figure any more that the engine was "
            "made with; put it back, or begin again with a new engine."
        )
    write_whole(folder / FIGURE, content)


@dataclass(frozen=True, slots=True)
class RecordedFigure:
    """Who plays when a run is executed again."""

    who: str
    """A figure that is here."""
    lacks: str = ""
    """Why it is not the one that was recorded, and what helps; empty if it is."""


def recorded_figure(folder: Path, manifest: Manifest, *, elsewhere: bool = True) -> RecordedFigure:
    """The figure of a run: the copy in its folder, or the file it was made of, if unchanged.

    Args:
        folder: The run folder.
        manifest: Its manifest.
        elsewhere: Whether a file outside the folder may be read.
    """
    who = manifest.config.figure
    if not is_own(who):
        return RecordedFigure(who)
    changed = False
    for path in (folder / FIGURE, *([Path(who)] if elsewhere else [])):
        if manifest.figure_sha256 and path.is_file():
            try:
                if figure_digest(str(path)) == manifest.figure_sha256:
                    return RecordedFigure(str(path))
            except FileError:
                pass
            changed = True
    stand_in = figure_names()[0]
    return RecordedFigure(
        stand_in,
        f"{folder / FIGURE} {'was changed' if changed else 'is missing'}: {stand_in} stands in for "
        f"the figure {readable(Path(who).name)[:80]}, and pictures differ. Put back the file with "
        f"SHA-256 {manifest.figure_sha256[:16] or 'unknown'}.",
    )
