"""`adamo-vh doctor`: what works on this machine, and how to fix what does not."""

from __future__ import annotations

import json
import os
import platform
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from importlib.metadata import version

import typer
from rich.console import Console

from adamo_vh.errors import AdamoError

_KEYS = ("OPENAI_API_KEY", "ANTHROPIC_API_KEY", "GOOGLE_API_KEY", "OPENROUTER_API_KEY")
_PACKAGES = ("adamo-vh", "mujoco", "numpy", "pillow", "opencv-python-headless", "pydantic-ai-slim")


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
    console = Console()
    for finding in _findings():
        findings.append(finding)
        if not as_json:
            mark = "[green]ok  [/green]" if finding.ok else "[red]FAIL[/red]"
            console.print(f"{mark} [bold]{finding.check}[/bold]", end=" ")
            console.print(finding.found, markup=False, highlight=False, soft_wrap=True)
            if finding.fix:
                console.print(f"     fix: {finding.fix}", markup=False, highlight=False)
    if as_json:
        typer.echo(json.dumps({"findings": [asdict(f) for f in findings]}))
    if not all(finding.ok for finding in findings):
        raise typer.Exit(1)


def _findings() -> Iterator[Finding]:
    yield Finding("versions", True, _versions())
    yield _guarded("cache", _cache, "set ADAMO_VH_CACHE_DIR to a folder that can be written")
    yield _guarded("graphics", _graphics, "apt-get install libegl1 libopengl0 libgl1-mesa-dri")
    yield _guarded("test frame", _test_frame, "see the line above; then run adamo-vh doctor again")
    yield _way_to_models()
    set_keys = [key for key in _KEYS if os.environ.get(key)]
    yield Finding("keys", True, f"set: {', '.join(set_keys) or 'none (the baseline needs none)'}")


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


def _cache() -> str:
    from adamo_vh.session.builtin import asset_folder

    folder = asset_folder()
    folder.mkdir(parents=True, exist_ok=True)
    probe = folder / f".probe-{os.getpid()}"
    probe.write_bytes(b"")
    probe.unlink()
    files = [path for path in folder.rglob("*") if path.is_file()]
    megabytes = sum(path.stat().st_size for path in files) / 1e6
    return f"{folder}: {len(files)} files, {megabytes:.1f} MB"


def _graphics() -> str:
    from adamo_vh.session.builtin import graphics_name

    return f"off-screen OpenGL through {graphics_name()}"


def _test_frame() -> str:
    from adamo_vh.session.builtin import check_machine

    return check_machine()
