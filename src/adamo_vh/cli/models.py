"""`adamo-vh models check`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from datetime import datetime

import typer

from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import marked, put_json, say
from adamo_vh.errors import ModelConfigError, ModelError
from adamo_vh.inference.model import Rung
from adamo_vh.inference.registry import create_local_model, probe_and_save
from adamo_vh.inference.remote.capabilities import (
    Capabilities,
    Support,
    ToolSupport,
    load_capabilities,
)
from adamo_vh.session.minds import model_of

_SIGHT_FIX = "it is shown none (pictures=none) and has the symbolic text alone"
_OWN_SIGHT_FIX = f"start llama-server with --mmproj FILE; else {_SIGHT_FIX}"
_ONE_PICTURE_FIX = "none is needed, it is shown the newest alone (pictures=1) and no close-ups"
_TOOLS_FIX = "none is needed, it is asked another way"
_OWN_TOOLS_FIX = (
    "start llama-server with --jinja, vLLM with --enable-auto-tool-choice --tool-call-parser NAME; "
    "if it still makes none, it is asked another way"
)
_SCHEMA_FIX = "use a server that knows response_format json_schema: llama-server, vLLM, Ollama"

_UNKNOWN = "unknown: the question was not answered; it will be asked again"

_SIGHT = {
    Support.YES: "sees them",
    Support.NO: "accepted, but not seen: it named other colours than those shown",
    Support.REFUSED: "the server refuses them",
    Support.UNTESTED: "not tested: that takes sight and native tool calls",
    Support.UNKNOWN: _UNKNOWN,
}
_TOOLS = {
    ToolSupport.NATIVE: "native",
    ToolSupport.LEAKED: "written into the text, where they are recognised",
    ToolSupport.NONE: "none came, although a tool was on offer and asked for",
    ToolSupport.REFUSED: "the server refuses tools",
    ToolSupport.UNKNOWN: _UNKNOWN,
}
_SCHEMA = {
    Support.YES: "obeyed",
    Support.NO: "accepted, but not obeyed",
    Support.REFUSED: "the server refuses it",
    Support.UNTESTED: "not tested",
    Support.UNKNOWN: _UNKNOWN,
}
_WAY = {
    Rung.NATIVE: "native: through the tool calls of its API",
    Rung.LEAKED: "leaked: with tools on offer, reading its calls from the text",
    Rung.SCHEMA: "schema: no tools, each answer one JSON step held to a schema",
    Rung.REACT: "react: no tools, each answer the lines Thought, Action and Action Input",
}
_NO_WAY = "not known yet: ask again, or choose with --tool-calls native, schema or react"


@dataclass(frozen=True, slots=True)
class _Line:
    """One line of the table."""

    mark: str
    what: str
    found: str
    fix: str = ""


def check(uri: str, *, refresh: bool, as_json: bool) -> None:
    """Say what a model can do and how it will be asked; exit 1 if it cannot be reached."""
    local = model_of(uri) if uri.startswith("replay:") else create_local_model(uri)
    if local is not None:
        _show_local(uri, local.info.kind, as_json=as_json)
        return
    known = None if refresh else load_capabilities(uri)
    try:
        cached = known is not None and known.is_complete
        found = known if known and cached else probe_and_save(uri, known=known)
    except ModelConfigError:
        raise
    except ModelError as error:
        _show_unreached(uri, str(error), as_json=as_json)
        raise typer.Exit(Exit.NO) from None
    if as_json:
        put_json({"reachable": True, "cached": cached, **asdict(found)})
        return
    _show([*_lines(found)])
    _show_cost(found, cached=cached)


def _lines(found: Capabilities) -> Iterator[_Line]:
    own = "@http" in found.uri
    yield _Line("ok", "reachable", found.uri)
    sight_fix = _OWN_SIGHT_FIX if own else _SIGHT_FIX
    yield _sight("pictures", found.pictures, sight_fix)
    yield _sight("several pictures", found.several_pictures, _ONE_PICTURE_FIX)
    yield _sight("pictures in results", found.result_pictures)
    native = found.tools is ToolSupport.NATIVE
    tools_fix = _OWN_TOOLS_FIX if own else _TOOLS_FIX
    fix = "" if native or found.tools is ToolSupport.UNKNOWN else tools_fix
    yield _Line(_mark(found.tools, native), "tool calls", _TOOLS[found.tools], fix)
    obeyed = found.schema is Support.YES
    # Only a model without tool calls has use for a schema.
    fix = _SCHEMA_FIX if found.rung is Rung.REACT else ""
    yield _Line(_mark(found.schema, obeyed), "JSON schema", _SCHEMA[found.schema], fix)
    refused = ", ".join(found.refused)
    parameters = f"refuses {refused}; requests go without" if refused else "takes all that are sent"
    yield _Line("no" if refused else "ok", "parameters", parameters)
    for why in found.unanswered:
        yield _Line("?", "not answered", why)
    yield _Line("=>", "asked", _WAY[found.rung] if found.rung else _NO_WAY)


def _sight(what: str, support: Support, fix: str = "") -> _Line:
    mark = _mark(support, support is Support.YES)
    return _Line(mark, what, _SIGHT[support], fix if mark == "no" else "")


def _mark(found: Support | ToolSupport, good: bool) -> str:
    if found in (Support.UNTESTED, Support.UNKNOWN):
        return "--" if found == Support.UNTESTED else "?"
    return "ok" if good else "no"


_COLOURS = {"ok": "green", "no": "yellow", "?": "yellow", "--": "dim", "FAIL": "red", "=>": "bold"}


def _show(lines: list[_Line]) -> None:
    for line in lines:
        marked(line.mark, _COLOURS[line.mark], f"{line.what:<19}", line.found, line.fix)


def _show_cost(found: Capabilities, *, cached: bool) -> None:
    when = datetime.fromisoformat(found.when).strftime("%Y-%m-%d %H:%M UTC")
    again = "; --refresh asks again" if cached else ""
    say(
        f"     {found.requests} requests, {found.usage.total_tokens} tokens, "
        f"{found.seconds:.1f} s on {when}{again}"
    )


def _show_unreached(uri: str, error: str, *, as_json: bool) -> None:
    if as_json:
        put_json({"reachable": False, "uri": uri, "error": error})
    else:
        _show([_Line("FAIL", "reachable", error)])


def _show_local(uri: str, kind: str, *, as_json: bool) -> None:
    if as_json:
        put_json({"reachable": True, "uri": uri, "kind": kind})
    else:
        _show([_Line("ok", "reachable", f"{uri} ({kind}) needs no server: nothing to check")])
