"""`adamo-vh studio`: the page on which one sees, talks to and replays a mind in a body."""

from __future__ import annotations

import threading
import webbrowser
from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar
from urllib.parse import quote

from adamo_vh.cli.episode import RUNS
from adamo_vh.cli.listening import NEW, key_of, names_of, told_to_stop
from adamo_vh.cli.terminal import say
from adamo_vh.errors import ConfigError
from adamo_vh.extras import extra
from adamo_vh.record.run_folder import EVENTS, MANIFEST
from adamo_vh.serving.admission import Rules
from adamo_vh.study.store import is_study

if TYPE_CHECKING:
    from adamo_vh.studio.talk import Talk

_T = TypeVar("_T")
NONE = "none"
"""In place of ears or a voice: there are none."""


def studio(
    runs: Sequence[Path],
    address: str,
    port: int,
    out: Path | None,
    *,
    token: str,
    hosts: Sequence[str],
    models: Sequence[str],
    scenes: Sequence[Path],
    figures: Sequence[Path],
    most_rooms: int,
    resolution: str,
    ears: str,
    voice: str,
    opens: bool,
) -> None:
    """Serve the studio until the process is told to stop; every record is whole then.

    Args:
        runs: Run folders, studies, or folders of runs to look at; the runs folder, if none.
        address: Where to listen.
        port: The port; 0 for a free one.
        out: Where run folders of rooms go.
        token: What visitors bring; empty for none.
        hosts: Further names under which this machine may be asked.
        models: Models that may be chosen beside those that are on offer.
        scenes: Scene files that may be chosen.
        figures: Own figures that may be chosen.
        most_rooms: So many rooms are open at once.
        resolution: Of the pictures that a mind is shown.
        ears: What hears; empty for what was fetched, `NONE` for nothing.
        voice: What speaks, likewise.
        opens: Whether the page is opened in a browser.

    Raises:
        ConfigError: A setting is wrong, the port is taken, or the extra `serve` is missing.
    """
    with extra("serve", "The studio"):
        from adamo_vh.service.app import FACES, MAX_BODY_BYTES, serving
        from adamo_vh.studio.face import AT, CONTENT_TYPES, Studio, studio_face
    from adamo_vh.service.hosting import Host, Terms
    from adamo_vh.session.figures import check_figure
    from adamo_vh.studio.editing import Editor
    from adamo_vh.studio.library import Library
    from adamo_vh.studio.meshes import Meshes
    from adamo_vh.studio.offer import Offer
    from adamo_vh.studio.rooms import Rooms, RoomTerms

    for folder in runs:
        _check(folder)
    for file in figures:
        check_figure(file)
    key = key_of(token, "--token")
    rules = Rules(
        MAX_BODY_BYTES,
        content_types=CONTENT_TYPES,
        token=key,
        hosts=names_of(address, hosts),
        browsed=AT,
    )
    parent = out or RUNS
    offer = Offer(models, scenes, figures)
    rooms = Rooms(parent, offer, RoomTerms(most=most_rooms, resolution=resolution))
    editor = Editor(parent / "scenes", offer)
    library = Library([*(runs or ()), parent])
    shown = Studio(offer, library, rooms, Meshes(), editor, _talk(ears, voice))
    stop = told_to_stop()
    host = Host(parent / f"served-{datetime.now(UTC):%Y%m%d-%H%M%S}", Terms())
    faces = (*FACES, studio_face(shown))
    try:
        with serving(host, address=address, port=port, rules=rules, faces=faces) as url:
            page = f"{url}{AT}/" + (f"?token={quote(key)}" if key else "")
            say(f"studio  {page}")
            if token == NEW:
                say(f"token   {key}")
            say(f"records {parent}")
            say("stop    Ctrl+C")
            if opens:
                webbrowser.open(page)
            threading.Thread(target=shown.warm, daemon=True).start()
            stop.wait()
    finally:
        shown.close()
        host.close_all()
    say("stopped; every record is whole")


def _talk(ears: str, voice: str) -> Talk:
    """Ears and voice as they were named, or as they were fetched; a wrong name is told now.

    Raises:
        ConfigError: A model was not fetched, or a package or program is missing.
    """
    from adamo_vh.speech.models import MODELS, recognizer
    from adamo_vh.speech.models import voice as speaks
    from adamo_vh.studio.talk import Talk

    here = {model.kind: model.name for model in reversed(MODELS) if model.is_here}
    hears_by = here.get("hears", NONE) if find_spec("faster_whisper") else NONE
    says_by = here.get("speaks", NONE) if find_spec("pipersynth") else NONE
    return Talk(_loader(ears, hears_by, recognizer), _loader(voice, says_by, speaks))


def _loader(named: str, fetched: str, load: Callable[[str], _T]) -> Callable[[], _T] | None:
    """Loads what was named, now, or what was fetched, later; None if there is nothing to load."""
    name = named or fetched
    if name == NONE:
        return None
    if named:
        loaded = load(name)
        return lambda: loaded
    return lambda: load(name)


def _check(folder: Path) -> None:
    """Make sure that there is something to look at.

    Raises:
        ConfigError: There is not.
    """
    if not folder.is_dir():
        raise ConfigError(
            f"{folder} is no folder; name a run folder, a study, or a folder of runs."
        )
    has_runs = any(
        (child / MANIFEST).is_file() or is_study(child) for child in folder.iterdir()
        if child.is_dir()
    )  # fmt: skip
    if not ((folder / MANIFEST).is_file() or is_study(folder) or has_runs):
        raise ConfigError(
            f"{folder} holds no run ({MANIFEST} and {EVENTS}), no study and no folder with either."
        )
