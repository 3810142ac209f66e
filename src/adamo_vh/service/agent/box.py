"""The box in which a program plays: bubblewrap, with nothing in it but what it needs to run.

It sees the system's programs, its own program, an empty working folder, and the loopback of a
network of its own, in which nothing answers but the MCP server. Files it does not see are files
that were not named, not files that were named and hidden; the package, the cache and the runs are
hidden too, wherever something that was named contains them.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path

import adamo_vh
from adamo_vh.errors import ConfigError

HOME, INNER_PORT = "/agent", 8020
"""The working folder inside, and the port at which the MCP server is reached there."""
_SOCKETS = "/run/adamo"
_SYSTEM = ("bin", "sbin", "lib", "lib32", "lib64", "libx32")
_ETC = (
    "alternatives ca-certificates ca-certificates.conf group host.conf hosts ld.so.cache "
    "ld.so.conf ld.so.conf.d localtime mime.types nsswitch.conf passwd pki protocols services ssl"
)
_SURE = ("--unshare-all", "--die-with-parent", "--new-session", "--cap-drop", "ALL")


@cache
def box_problem() -> str:
    """Why there is no box on this machine; empty if there is one."""
    found = shutil.which("bwrap")
    if found is None:
        return "bubblewrap is not installed (Debian: apt-get install bubblewrap)"
    trial = [found, "--ro-bind", "/", "/", *_SURE, "--dev", "/dev", "--proc", "/proc", "true"]
    try:
        done = subprocess.run(trial, capture_output=True, text=True, timeout=20, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"bubblewrap does not run: {error}"
    if done.returncode:
        said = " ".join(done.stderr.split())[:200]
        return f"bubblewrap cannot make a box here ({said or f'exit code {done.returncode}'})"
    return ""


@dataclass(frozen=True, slots=True)
class Box:
    """What a program sees."""

    work: Path
    """Its working folder, empty and its own."""
    sockets: Path
    """Folder of the sockets that it may reach."""
    hidden: tuple[Path, ...]
    """What it must not see, beside the package itself."""
    shown: tuple[Path, ...] = ()
    """Files and folders that it may read, beside its own program."""

    def command(self, program: Sequence[str], ports: Mapping[int, str]) -> list[str]:
        """The command that runs a program in the box.

        Args:
            program: The program, with whole paths, and its arguments.
            ports: Names of sockets in `sockets`, by the port at which the program reaches each.
        """
        seen = [*_prefixes(Path(sys.executable)), *_prefixes(Path(program[0])), *self.shown]
        relay = resources.files(__package__).joinpath("relay.py").read_text(encoding="utf-8")
        pairs = [f"{port}={_SOCKETS}/{name}" for port, name in ports.items()]
        return [
            shutil.which("bwrap") or "bwrap",
            *_SURE,
            *_system(),
            *(word for path in dict.fromkeys(seen) for word in _read_only(path)),
            *(word for path in self._masked(seen) for word in ("--tmpfs", str(path))),
            *("--bind", str(self.work), HOME, "--chdir", HOME),
            *("--ro-bind", str(self.sockets), _SOCKETS),
            "--",
            *(os.path.realpath(sys.executable), "-I", "-c", relay),
            *(*pairs, "--", *program),
        ]

    def _masked(self, seen: Sequence[Path]) -> Iterator[Path]:
        """Folders within what is seen that must not be."""
        package = Path(adamo_vh.__file__).parent
        known = dict.fromkeys(path.resolve() for path in (package, *self.hidden))
        shown = [Path("/usr"), *(path.resolve() for path in seen)]
        for path in known:
            if path.is_dir() and any(path.is_relative_to(one) for one in shown):
                yield path


def found_program(word: str) -> str:
    """The whole path of a program.

    Args:
        word: A name on the path, or a path.

    Raises:
        ConfigError: There is none.
    """
    found = shutil.which(word)
    if found is None:
        raise ConfigError(f"--agent-cmd: there is no program {word!r}; give its whole path.")
    return os.path.abspath(found)


def _system() -> list[str]:
    """The system's programs and the few settings that they need."""
    words = ["--ro-bind", "/usr", "/usr"]
    for name in _SYSTEM:
        path = Path("/", name)
        if path.is_symlink():
            words += ["--symlink", os.readlink(path), str(path)]
        elif path.is_dir():
            words += ["--ro-bind", str(path), str(path)]
    for name in _ETC.split():
        words += ["--ro-bind-try", f"/etc/{name}", f"/etc/{name}"]
    return [*words, "--dev", "/dev", "--proc", "/proc", "--tmpfs", "/tmp"]


def _read_only(path: Path) -> tuple[str, ...]:
    return ("--ro-bind", str(path), str(path))


def _prefixes(program: Path) -> Iterator[Path]:
    """What a program outside the system's folders takes to run: its installation, or its file."""
    for path in dict.fromkeys((program, Path(os.path.realpath(program)))):
        if path.is_relative_to("/usr") or str(path.parent) in ("/bin", "/sbin"):
            continue
        root = path.parent.parent
        owned = (Path("/"), Path.home(), Path.home() / ".local")
        is_installed = path.parent.name == "bin" and (root / "lib").is_dir() and root not in owned
        yield root if is_installed else path
