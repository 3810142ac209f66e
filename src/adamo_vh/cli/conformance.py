"""`adamo-vh conformance`: look an engine over, and say what to mend."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import typer
from rich.console import Console
from rich.table import Table

from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import complain, put_json, say
from adamo_vh.engine import World
from adamo_vh.errors import ConfigError
from adamo_vh.files import write_whole
from adamo_vh.service.conformance import Conformance, Finding, Verdict, conform
from adamo_vh.service.conformance.page import as_json, page, summary

_COLOURS = {Verdict.PASSED: "green", Verdict.FAILED: "red"}


def examine(target: str, scene: str, only: Sequence[str], html: Path | None, *, json: bool) -> None:
    """Look an engine over; exit 1 if it does not conform.

    Raises:
        ConfigError: There is no such engine or check.
        EngineError: No engine dialled in, or it is none at all.
    """
    tell = complain if json else say
    with _engine(target, scene, tell) as world:
        report = conform(world, only, timed=not only, watch=lambda item: _tell(item, quiet=json))
    if html is not None:
        write_whole(html, page(report).encode())
    if json:
        put_json(as_json(report))
    else:
        _show(report)
        if html is not None:
            say(html)
    if not report.conforms:
        raise typer.Exit(Exit.NO)


@contextmanager
def _engine(target: str, scene: str, tell: Any) -> Iterator[World]:
    if target.startswith(("ws://", "wss://")):
        from adamo_vh.service.engines.waiting import dialled_in

        with dialled_in(scene, port=_port(target), tell=tell) as remote:
            yield remote
        return
    world = _made(target, scene)
    try:
        yield world
    finally:
        world.close()


def _port(url: str) -> int:
    """The port of the address at which engines are waited for."""
    try:
        parts = urlsplit(url)
        port, path = parts.port, parts.path
    except ValueError:
        port, path = None, ""
    if port is None or path != "/engine" or parts.scheme != "ws":
        raise ConfigError(f"{url} is no address for engines; write ws://127.0.0.1:8020/engine.")
    return port


def _made(target: str, scene: str) -> World:
    """An engine in this process: the built-in one, or what a module makes."""
    from adamo_vh.session.bodies import create_engine

    if target == "built-in":
        return create_engine(scene)
    module_name, _, name = target.partition(":")
    if not name:
        raise ConfigError(
            f"{target!r}: write built-in, MODULE:NAME of a function of a scene's name, or the "
            "address at which an engine is to dial in: ws://127.0.0.1:8020/engine."
        )
    sys.path.insert(0, "")
    try:
        maker = getattr(importlib.import_module(module_name), name)
        made: World = maker(scene)
    except Exception as error:
        # Somebody else's code, whatever it raises.
        raise ConfigError(f"{target} gives no engine: {type(error).__name__}: {error}") from error
    finally:
        sys.path.remove("")
    return made


def _tell(item: Finding, *, quiet: bool) -> None:
    if not quiet:
        say(f"{item.verdict:<9} {item.name}", _COLOURS.get(item.verdict, "yellow"))


def _show(report: Conformance) -> None:
    faults = [item for item in report.findings if item.verdict is not Verdict.PASSED]
    if faults:
        table = Table("check", "verdict", "expected", "found", "how to mend", show_lines=True)
        for item in faults:
            mend = item.mend if item.verdict is Verdict.FAILED else ""
            table.add_row(item.name, item.verdict, item.expected, item.found, mend)
        Console().print(table)
    for taken in report.latencies:
        say(f"{taken.median_ms:8.1f} ms  {taken.call}")
    say(summary(report))
