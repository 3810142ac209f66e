"""A run as one HTML file that needs no server: page, meshes, pictures and track in it."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from adamo_vh.adapters.exports.form import Form
from adamo_vh.adapters.exports.recorded import Episode
from adamo_vh.errors import AdamoError, ConfigError
from adamo_vh.files import data_url, write_whole
from adamo_vh.record.run_folder import FRAMES
from adamo_vh.record.trajectory import frame_type
from adamo_vh.session.builtin import scene_glb
from adamo_vh.session.figures import figure_glb
from adamo_vh.studio.files import PAGE
from adamo_vh.studio.library import Run, figure_of, scene_of
from adamo_vh.studio.messages import Message, Places
from adamo_vh.studio.tracks import Track, track_of

ELEMENT = "adamo-track"
"""Id of the element that holds the track, as JSON."""
_MESH = "model/gltf-binary"
_LINK = re.compile(
    r'<(?:link|script)\b[^>]*?(?:href|src)="\./(assets/[\w.-]+)"[^>]*>(?:</script>)?'
)
_POLICY = re.compile(r'<meta http-equiv="Content-Security-Policy"[^>]*>\s*')


def write_pages(episodes: Iterable[Episode], folder: Path, form: Form) -> int:
    """Write each episode as a page of its own.

    Args:
        episodes: What is exported.
        folder: Takes `NAME.html` of each.
        form: Plays no part.

    Returns:
        How many episodes were written.

    Raises:
        ConfigError: The page is not built.
    """
    count = 0
    for episode in episodes:
        with episode.tolerated():
            track = track_of(episode.folder, episode.name, _inline(episode.folder), Places())
            page = one_page(whole(track, Run(episode.name, episode.folder, 0.0)))
            write_whole(folder / f"{episode.name.replace('/', '-')}.html", page.encode())
            count += 1
    return count


def _inline(folder: Path) -> Any:
    """Gives the pictures of a run as addresses that hold them; empty for one that is missing."""

    def href(name: str) -> str:
        kind, file = frame_type(name), folder / FRAMES / name
        if not kind or file.is_symlink() or not file.is_file():
            return ""
        return data_url(kind, file.read_bytes())

    return href


def whole(track: Track, run: Run) -> Mapping[str, Any]:
    """A track with the meshes that it needs in it, where they can be had."""
    hello: Message = track.hello
    if hello["body"] is not None:
        try:
            scene = data_url(_MESH, scene_glb(*scene_of(run)))
            figure = data_url(_MESH, figure_glb(figure_of(run)))
        except AdamoError:
            scene = figure = ""
        hello = {
            **hello,
            "scene": {**hello["scene"], "glb": scene},
            "figure": {**hello["figure"], "glb": figure},
        }
    return {"hello": hello, "messages": track.messages}


def one_page(told: Mapping[str, Any], folder: Path = PAGE) -> str:
    """The built page with a track in it.

    Args:
        told: Greeting and messages.
        folder: The built page.

    Raises:
        ConfigError: The page is not built.
    """
    index = folder / "index.html"
    if not index.is_file():
        raise ConfigError("The page is not built: run npm ci && npm run build in web/.")
    html = _POLICY.sub("", index.read_text(encoding="utf-8"))
    links = {found[1]: found[0] for found in _LINK.finditer(html)}
    files = {name: (folder / name).read_text(encoding="utf-8") for name in links}
    entry = next((name for name, link in links.items() if 'type="module"' in link), "")
    if not entry:
        raise ConfigError("The page is built otherwise than expected: it has no script.")
    # Modules alone: the other script asks a server for what is all in here.
    scripts = {name: text for name, text in files.items() if "module" in links[name]}
    styles = "\n".join(text for name, text in files.items() if name.endswith(".css"))
    modules = {_bare(name): _module(text, scripts) for name, text in scripts.items()}
    main = modules.pop(_bare(entry))
    urls = {name: data_url("text/javascript", text.encode()) for name, text in modules.items()}
    imports = _safe(json.dumps({"imports": urls}))
    data = _safe(json.dumps(told, separators=(",", ":"), ensure_ascii=False))
    main = main.replace("</script", "<\\/script").replace("<!--", "<\\!--")
    styles = styles.replace("</style", "<\\/style")
    head = f'<style>{styles}</style>\n<script type="importmap">{imports}</script>\n'
    body = (
        f'<script type="application/json" id="{ELEMENT}">{data}</script>\n'
        f'<script type="module">{main}</script>\n'
    )
    html = _LINK.sub("", html)
    # Not by a pattern: what is put in may hold anything.
    opening, found, rest = html.partition("<head>")
    html = f"{opening}{found}\n{_policy(imports, main)}{rest}"
    html = _before(html, "</head>", head)
    return _before(html, "</body>", body)


def _before(html: str, mark: str, text: str) -> str:
    before, found, after = html.partition(mark)
    return before + text + found + after


def _bare(name: str) -> str:
    return f"adamo/{Path(name).name}"


def _module(text: str, scripts: Mapping[str, str]) -> str:
    """A script that imports the others by names, which no address can spoil."""
    for other in scripts:
        file = re.escape(Path(other).name)
        text = re.sub(rf"""(["'`])\./{file}\1""", rf"\1{_bare(other)}\1", text)
    return text


def _safe(text: str) -> str:
    """JSON that cannot end the element that it stands in."""
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def _policy(*scripts: str) -> str:
    """What the page may do: run its own scripts, and fetch nothing from anywhere."""
    hashes = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
        for text in scripts
    )
    rules = (
        f"default-src 'none'; script-src {hashes} data:; style-src 'unsafe-inline'; "
        "img-src data: blob:; connect-src data: blob:; worker-src blob:; base-uri 'none'; "
        "form-action 'none'"
    )
    return f'<meta http-equiv="Content-Security-Policy" content="{rules}">'
