"""`adamo-vh doctor`: what works on this machine, and how to fix what does not."""

from __future__ import annotations

import os
import platform
import shutil
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path

import typer

from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import marked, put_json, say
from adamo_vh.errors import AdamoError, ConfigError
from adamo_vh.files import CACHE_DIR, cache_folder, write_whole

_KEYS = ("OPENAI_API_KEY", "ANTHROPIC_API_KEY", "GOOGLE_API_KEY", "OPENROUTER_API_KEY")
_PACKAGES = ("adamo-vh", "mujoco", "numpy", "pillow", "opencv-python-headless", "pydantic-ai-slim")
_LEAST_GB = 0.5
"""Room that a first run may take: the cache, and a run of sixty steps."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One check."""

    check: str
    ok: bool
    found: str
    fix: str = ""


def examine(*, as_json: bool) -> None:
    """Run every check; exit 1 if one fails."""
    findings = []
    for finding in _findings():
        findings.append(finding)
        if not as_json:
            mark, colour = ("ok", "green") if finding.ok else ("FAIL", "red")
            marked(mark, colour, finding.check, finding.found, finding.fix)
    if as_json:
        put_json({"findings": [asdict(f) for f in findings]})
    failed = [finding for finding in findings if not finding.ok]
    if failed:
        if not as_json:
            first = failed[0]
            say(f"{len(failed)} of {len(findings)} checks failed. {first.check}: {first.found}")
        raise typer.Exit(Exit.NO)


def _findings() -> Iterator[Finding]:
    yield Finding("versions", True, _versions())
    yield _guarded("text", _text, "export LC_ALL=C.UTF-8 and unset PYTHONIOENCODING")
    yield _guarded("cache", _cache, f"set {CACHE_DIR} to a folder that can be written")
    yield _guarded("runs", _runs, "go to a folder that can be written, or always give --out")
    graphics = _guarded("graphics", _graphics, "")
    yield graphics
    if graphics.ok:
        yield _guarded("test frame", _test_frame, "unset LIBGL_* and GALLIUM_*, and try again")
    else:
        yield Finding("test frame", False, "not tried: no graphics", "see the line above")
    yield _way_to_models()
    yield _keys()


def _way_to_models() -> Finding:
    """Proxies, certificates and keys of the environment."""
    from adamo_vh.inference.remote.routes import environment_problems

    first, *more = environment_problems() or [""]
    return Finding("way to models", not first, "free" if not first else " ".join((first, *more)))


def _guarded(check: str, examine_it: Callable[[], str], fix: str) -> Finding:
    try:
        return Finding(check, True, examine_it())
    except (AdamoError, OSError, ImportError) as error:
        return Finding(check, False, str(error), fix)


def _versions() -> str:
    packages = ", ".join(f"{name} {version(name)}" for name in _PACKAGES)
    return f"Python {platform.python_version()} on {sys.platform}; {packages}"


def _text() -> str:
    """Whether any language can be printed, and files be named in it."""
    printed = (sys.stdout.encoding or "none").lower()
    named = sys.getfilesystemencoding().lower()
    found = f"printed as {printed}, files named in {named}"
    if {printed.replace("-", ""), named.replace("-", "")} != {"utf8"}:
        raise ConfigError(f"{found}: what it cannot say is printed as ?")
    return found


def _cache() -> str:
    _room(cache_folder())
    files = [path for path in cache_folder().rglob("*") if path.is_file()]
    megabytes = sum(path.stat().st_size for path in files) / 1e6
    return f"{cache_folder()}: {len(files)} files, {megabytes:.1f} MB"


def _runs() -> str:
    # Only where it is there: looking must not make a folder.
    folder = Path("runs") if Path("runs").exists() else Path()
    return f"{folder.absolute()}: {_room(folder):.0f} GB free"


def _room(folder: Path) -> float:
    """Make sure that a folder can be written and has room; how much, in GB."""
    probe = write_whole(folder / f".probe-{os.getpid()}", b"")
    probe.unlink()
    free_gb = shutil.disk_usage(folder).free / 1e9
    if free_gb < _LEAST_GB:
        raise ConfigError(f"{folder}: only {free_gb:.2f} GB free; a first run takes {_LEAST_GB} GB")
    return free_gb


def _graphics() -> str:
    from adamo_vh.session.builtin import graphics_name

    return f"off-screen OpenGL through {graphics_name()}"


def _test_frame() -> str:
    from adamo_vh.service.conformance import engine_faults
    from adamo_vh.session.builtin import check_machine

    return check_machine(lambda world: engine_faults(world, ("state", "capture", "pick", "again")))


def _keys() -> Finding:
    named = [key for key in _KEYS if os.environ.get(key)]
    return Finding("keys", True, f"set: {', '.join(named) or 'none (the baseline needs none)'}")
