"""One scored episode for a program: started with an address and an instruction, and no more."""

from __future__ import annotations

import json
import os
import re
import secrets
import shlex
import socket
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mcp.server import Server

from adamo_vh.episode.result import EpisodeResult
from adamo_vh.errors import ConfigError
from adamo_vh.files import cache_folder, make_folder, write_whole
from adamo_vh.inference.model import Isolation
from adamo_vh.inference.redaction import redacted
from adamo_vh.record.trajectory import Observer
from adamo_vh.service.agent.box import HOME, INNER_PORT, Box, box_problem, found_program
from adamo_vh.service.agent.program import Finished, run_program
from adamo_vh.service.mcp.episodes import Episodes, Watch
from adamo_vh.service.mcp.offer import Offer
from adamo_vh.service.mcp.server import create_server
from adamo_vh.service.mcp.transports import PATH, serve_http, serve_socket
from adamo_vh.session.outside import OutsideEpisode
from adamo_vh.session.pooling import Engines

FOLDER, RECORD = "agent", "agent.json"
"""In the run folder: what the program wrote, and how it was run."""
ISOLATIONS = ("auto", "bwrap", "none")
_SOCKET = "mcp.sock"
_PLACE = re.compile(r"\{(url|token|instruction|episode)\}")
_SYSTEM_PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"


@dataclass(frozen=True, slots=True)
class Program:
    """A program that is to play."""

    command: str
    """As typed: words as a shell reads them, with {url}, {token}, {instruction} and {episode}."""
    isolation: str = "auto"
    """"bwrap", "none", or "auto" for the first of them that works."""
    passed: tuple[str, ...] = ()
    """Names of environment variables that it gets beside its own."""
    shown: tuple[Path, ...] = ()
    """Files and folders that it may read in its box."""
    grace_s: float = 10.0
    """Seconds that it may go on when its episode has ended."""

    @property
    def name(self) -> str:
        """What it is called in the record."""
        return Path(_words(self.command)[0]).name


def play_program(
    program: Program,
    settings: Mapping[str, Any],
    folder: Path,
    *,
    watch: Watch = lambda line: None,
    observers: Sequence[Observer] = (),
    engines: Engines | None = None,
) -> EpisodeResult:
    """Let a program play one episode, and score it.

    It ends with the program's answer, or at a limit. If the program ends before, with exit code 0,
    it is scored as it stands; with another one something broke, and the episode is unscored.

    Args:
        program: Who plays.
        settings: How the episode is set up, as for `EpisodeConfig.of`, with task or instruction.
        folder: A new run folder.
        watch: Is told what happens.
        observers: Are told of every event.
        engines: Where it is played; an engine is made for it by default.

    Raises:
        ConfigError: A setting is wrong, there is no such program, or no box and it must have one.
    """
    isolation, lacks = _isolation(program.isolation)
    words = _words(program.command)
    words[0] = found_program(words[0])
    if lacking := [name for name in program.passed if name not in os.environ]:
        raise ConfigError(f"--agent-env {lacking[0]}: there is no such variable; set it first.")
    for path in program.shown:
        if not path.exists():
            raise ConfigError(f"--agent-bind {path}: there is no such file or folder.")
    offer = Offer(settings, fixed=folder.absolute(), player=program.name, isolation=isolation)
    if lacks:
        # Not before it is sure that there will be a run.
        watch(f"not isolated: {lacks}. The run will be marked, and never ranked.")
    with Episodes(offer, engines=engines, observers=observers) as episodes:
        episode = episodes.find(episodes.fixed, program.name)
        assert episode is not None  # It begins here.
        episode.view()
        with ExitStack() as stack:
            server = create_server(episodes, watch)
            launch = stack.enter_context(_launched(server, episode, program, words, offer))
            kept = folder / FOLDER
            make_folder(kept)
            finished = launch.run(kept, episode, program.grace_s)
        _end(episode, finished)
        _write(kept, program, finished, isolation)
        return episode.result()


@dataclass(frozen=True, slots=True)
class _Launch:
    """A program that is ready to be started."""

    command: Sequence[str]
    environment: Mapping[str, str]
    work: Path

    def run(self, kept: Path, episode: OutsideEpisode, grace_s: float) -> Finished:
        """Run it to its end, or some time after that of its episode."""
        return run_program(
            self.command, self.environment, self.work, kept, lambda: episode.ended, grace_s
        )


@contextmanager
def _launched(
    server: Server[Any],
    episode: OutsideEpisode,
    program: Program,
    words: Sequence[str],
    offer: Offer,
) -> Iterator[_Launch]:
    """A program with the server that it will find; both end with the block."""
    assert offer.fixed is not None
    token = secrets.token_urlsafe(32)
    with ExitStack() as stack:
        place = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="adamo-agent-")))
        work = make_folder(place / "work")
        told = {"token": token, "instruction": episode.instruction, "episode": offer.fixed.name}
        words, files = _with_files(words)
        if offer.isolation == "none":
            told["url"] = stack.enter_context(serve_http(server, token=token))
            environment = _environment(told, program, os.environ.get("PATH", _SYSTEM_PATH), work)
            yield _Launch(_filled(words, told), environment, work)
            return
        sockets = make_folder(place / "sockets")
        stack.enter_context(serve_socket(server, _listening(sockets / _SOCKET), token=token))
        told["url"] = f"http://127.0.0.1:{INNER_PORT}{PATH}"
        path = f"{Path(words[0]).parent}:{_SYSTEM_PATH}"
        hidden = (offer.fixed, offer.root.absolute(), cache_folder().absolute())
        box = Box(work, sockets, hidden, (*files, *(p.absolute() for p in program.shown)))
        command = box.command(_filled(words, told), {INNER_PORT: _SOCKET})
        yield _Launch(command, _environment(told, program, path, Path(HOME)), work)


def _environment(
    told: Mapping[str, str], program: Program, path: str, home: Path
) -> dict[str, str]:
    """All variables that the program gets: none of the user's but those that are passed on."""
    return {
        "PATH": path,
        "HOME": str(home),
        "TMPDIR": "/tmp",
        "LANG": "C.UTF-8",
        "TERM": "dumb",
        "ADAMO_VH_MCP_URL": told["url"],
        "ADAMO_VH_MCP_TOKEN": told["token"],
        "ADAMO_VH_INSTRUCTION": told["instruction"],
        "ADAMO_VH_EPISODE": told["episode"],
        **{name: os.environ[name] for name in program.passed},
    }


def _end(episode: OutsideEpisode, finished: Finished) -> None:
    """End the episode of a program that did not end it itself."""
    if finished.code == 0:
        episode.hang_up("The program ended without a final answer.")
    elif finished.code is not None:
        episode.close(f"The program ended with exit code {finished.code}, in the middle.")


def _write(kept: Path, program: Program, finished: Finished, isolation: str) -> None:
    """Write down how the program was run, and take keys out of what it wrote."""
    for name in ("stdout.txt", "stderr.txt"):
        text = (kept / name).read_bytes().decode("utf-8", "replace")
        write_whole(kept / name, redacted(text).encode())
    record = {
        "command": redacted(program.command),
        "isolation": isolation,
        "exit_code": finished.code,
        "ended_by_us": finished.code is None,
        "seconds": round(finished.seconds, 3),
        "passed": [*program.passed],
        "shown": [str(path) for path in program.shown],
    }
    write_whole(kept / RECORD, json.dumps(record, indent=1).encode() + b"\n")


def _isolation(wished: str) -> tuple[Isolation, str]:
    """How the program will be kept from all but its body, and why not in a box as was wished.

    Raises:
        ConfigError: It must have a box, and there is none here.
    """
    if wished not in ISOLATIONS:
        raise ConfigError(f"--isolation {wished!r}: use {', '.join(ISOLATIONS)}.")
    problem = "" if wished == "none" else box_problem()
    if wished == "bwrap" and problem:
        raise ConfigError(f"--isolation bwrap: {problem}. Mend it, or use --isolation none.")
    return ("none" if wished == "none" or problem else "bwrap"), problem


def _words(command: str) -> list[str]:
    try:
        words = shlex.split(command)
    except ValueError as error:
        raise ConfigError(f"--agent-cmd {command!r} cannot be read: {error}.") from None
    if not words:
        raise ConfigError("--agent-cmd is empty; give a program and its arguments.")
    return words


def _with_files(words: Sequence[str]) -> tuple[list[str], tuple[Path, ...]]:
    """The words with whole paths for the files among them, and these files."""
    program, *arguments = words
    files = {word: Path(word).absolute() for word in arguments if Path(word).is_file()}
    return [program, *(str(files.get(word, word)) for word in arguments)], tuple(files.values())


def _filled(words: Sequence[str], told: Mapping[str, str]) -> list[str]:
    """The words with what stands in braces; what is filled in is not looked at again."""
    return [_PLACE.sub(lambda found: told[found[1]], word) for word in words]


def _listening(path: Path) -> socket.socket:
    opened = socket.socket(socket.AF_UNIX)
    opened.bind(str(path))
    opened.listen(128)
    return opened
