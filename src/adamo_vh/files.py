"""Files: written whole or not at all, read with limits, because anybody may have written them.

Every fault is a `FileError` whose one line names the file, what is wrong with it and the fix.
"""

from __future__ import annotations

import base64
import errno
import json
import os
import re
import stat
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO, NoReturn
from uuid import uuid4

from adamo_vh.errors import FileError
from adamo_vh.readable import encodable, readable

CACHE_DIR = "ADAMO_VH_CACHE_DIR"
"""Environment variable: the folder of everything that can be made again."""
DATA_DIR = "ADAMO_VH_DATA_DIR"
"""Environment variable: the folder of what was fetched once."""

_MAX_BYTES = 1_000_000
_DEEPEST_TOML, _DEEPEST_JSON = 20, 60
"""Brackets inside each other; what is meant has five."""
_LONGEST = 100
"""Letters of a bare word or number."""
_DOTS = 8
"""Dots of a key. tomllib takes gigabytes for ten thousand."""

_FIXES = {
    errno.ENOSPC: "Free some room on the disk, or name a folder on another.",
    errno.EDQUOT: "Free some room on the disk, or name a folder on another.",
    errno.EACCES: "Name a place that you may use, or change its permissions.",
    errno.EPERM: "Name a place that you may use, or change its permissions.",
    errno.EROFS: "Name a folder that can be written.",
    errno.ENAMETOOLONG: "Choose a shorter name.",
    errno.ENOTDIR: "A file stands where a folder must be; name another folder.",
    errno.EEXIST: "A file stands where a folder must be; name another folder.",
    errno.EISDIR: "It is a folder; name a file.",
    errno.ELOOP: "It is a link to itself; name another place.",
}


def cannot(doing: str, path: str | Path, error: OSError | ValueError) -> FileError:
    """The error that says what cannot be done with a file, why, and what helps.

    Args:
        doing: "read" or "written".
        path: The file or folder.
        error: What the system said. A name with a NUL raises ValueError.
    """
    number = (error.errno if isinstance(error, OSError) else None) or 0
    reason = (error.strerror if isinstance(error, OSError) else None) or str(error)
    shown = readable(str(path))
    shown = shown if len(shown) <= 2 * _LONGEST else f"{shown[:_LONGEST]}..."
    return FileError(
        f"{shown} cannot be {doing}: {reason}. {_FIXES.get(number, 'Check the path.')}"
    )


@contextmanager
def naming(doing: str, path: str | Path) -> Iterator[None]:
    """Turn the system's errors into ones that name the file and the fix.

    Raises:
        FileError: The system refused.
    """
    try:
        yield
    except OSError as error:
        raise cannot(doing, path, error) from error


def make_folder(path: Path) -> Path:
    """Make a folder and those above it, where they are missing.

    Raises:
        FileError: It cannot be made.
    """
    with naming("written", path):
        path.mkdir(parents=True, exist_ok=True)
    return path


def check_place(path: Path) -> None:
    """See, before the work that is to fill it, whether a folder can be made or written to.

    Raises:
        FileError: It cannot; nothing was made.
    """
    with naming("written", path):
        for place in (path, *path.parents):
            with suppress(FileNotFoundError):
                if not stat.S_ISDIR(place.stat().st_mode):
                    raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
                if not os.access(place, os.W_OK):
                    raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
                return


def write_whole(path: Path, data: bytes, *, durable: bool = False) -> Path:
    """Write beside the file and rename: a reader, and a kill, never meet half a file.

    Args:
        path: Its folder is made if it is missing.
        data: The whole content.
        durable: Wait until the disk has it, so that it outlives a power cut as well as a kill.

    Raises:
        FileError: It cannot be written; what stood there is as it was.
    """
    half = path.with_name(f".{uuid4().hex[:12]}.part")
    with naming("written", path):
        try:
            with _new(half) as file:
                file.write(data)
                if durable:
                    file.flush()
                    os.fsync(file.fileno())
            half.replace(path)
        except BaseException:
            with suppress(OSError):
                half.unlink()
            raise
        if durable:
            _sync_folder(path.parent)
    return path


def _new(path: Path) -> BinaryIO:
    """A new file, open; the folder is mostly there."""
    try:
        return path.open("xb")
    except FileNotFoundError:
        make_folder(path.parent)
        return path.open("xb")


def _sync_folder(folder: Path) -> None:
    """Make a rename last; a file system that cannot do it is no fault."""
    with suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def append_line(path: Path, line: bytes) -> None:
    """Add a line to a file, whole or not at all.

    Args:
        path: Is made if it is missing.
        line: Without its end.

    Raises:
        FileError: It cannot be written; the file holds whole lines as before.
    """
    with naming("written", path):
        file = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o666)
        try:
            before = os.fstat(file).st_size
            try:
                rest = memoryview(line + b"\n")
                while rest:
                    rest = rest[os.write(file, rest) :]
            except BaseException:
                with suppress(OSError):
                    os.ftruncate(file, before)
                raise
        finally:
            os.close(file)


def read_text(path: str | Path, *, max_bytes: int = _MAX_BYTES) -> str:
    """Read a text file: UTF-8, with or without a byte order mark.

    Args:
        path: The file.
        max_bytes: No more than this is read.

    Raises:
        FileError: It cannot be read, is too large, or is no such text.
    """
    try:
        with Path(path).open("rb") as file:
            data = file.read(max_bytes + 1)
    except (OSError, ValueError) as error:
        raise cannot("read", path, error) from error
    if len(data) > max_bytes:
        raise FileError(f"{path} is larger than {max_bytes / 1e6:g} MB; it is not such a file.")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise FileError(f"{path}, line {line}: not UTF-8 text; save the file as UTF-8.") from None


def read_toml(path: str | Path) -> dict[str, Any]:
    """Read a TOML file that anybody may have written.

    Raises:
        FileError: It cannot be read or is not valid TOML, or is so only to do harm.
    """
    return parse_toml(read_text(path), path)


def parse_toml(text: str, source: str | Path) -> dict[str, Any]:
    """Parse TOML that anybody may have written.

    Args:
        text: TOML.
        source: Its file, for messages.

    Raises:
        FileError: It is not valid TOML, or so only to do harm.
    """
    if problem := _bomb(text):
        raise FileError(f"{source}: {problem}")
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise FileError(f"{source} is not valid TOML: {readable(str(error))}.") from None


_TEXTS = {
    '"""': re.compile(r'(?:[^"\\]|\\.|"(?!""))*+"{3,5}', re.DOTALL),
    "'''": re.compile(r"(?:[^']|'(?!''))*+'{3,5}"),
    '"': re.compile(r'(?:[^"\\\n]|\\.)*+"'),
    "'": re.compile(r"[^'\n]*+'"),
    "#": re.compile(r"[^\n]*+"),
}
"""What opens a text or a comment, and all that belongs to it."""
_MARK = re.compile(r'"""|\'\'\'|["\'#\n,=\[\]{}]|\Z')


def _bomb(text: str) -> str:
    """What in a TOML text would take its reader minutes or gigabytes; empty if nothing.

    One pass over the text, without what stands in quotes and comments.
    """
    at = depth = dots = 0
    while found := _MARK.search(text, at):
        bare, mark, at = text[at : found.start()].strip(), found[0], found.end()
        dots += bare.count(".")
        depth += (mark in ("[", "{")) - (mark in ("]", "}"))
        problem = (
            (len(bare) > _LONGEST and f"a word or number of {len(bare)} letters")
            or (dots > _DOTS and f"a key with more than {_DOTS} dots")
            or (depth > _DEEPEST_TOML and f"more than {_DEEPEST_TOML} brackets inside each other")
        )
        if problem:
            return f"line {text.count(chr(10), 0, found.start()) + 1}: {problem}; make it shorter."
        if not mark:
            break
        if mark not in _TEXTS:
            dots = 0
        elif (whole := _TEXTS[mark].match(text, at)) is None:
            break  # It is no TOML, and tomllib says where.
        else:
            at = whole.end()
    return ""


def read_json(path: str | Path, *, max_bytes: int = _MAX_BYTES) -> Any:
    """Read a JSON file that anybody may have written.

    Lone surrogates, which no record could hold, become question marks.

    Raises:
        FileError: It cannot be read or is not strict JSON, or holds a key twice, a number beyond
            all use, or lists too deep inside each other.
    """
    text = read_text(path, max_bytes=max_bytes)
    try:
        return parse_json(text)
    except ValueError as error:
        raise FileError(f"{path} is not valid JSON: {readable(str(error))}.") from None


def parse_json(text: str) -> Any:
    """Read JSON that anybody may have written; see `read_json`.

    Raises:
        ValueError: It is not strict JSON, or holds what `read_json` refuses.
    """
    try:
        value = json.loads(
            text,
            parse_constant=_refuse,
            parse_int=_integer,
            parse_float=_finite,
            object_pairs_hook=_without_twins,
        )
        if _is_deeper(value, _DEEPEST_JSON):
            raise RecursionError
    except RecursionError:
        what = f"more than {_DEEPEST_JSON} brackets inside each other; open fewer"
        raise ValueError(what) from None
    return json.loads(encodable(json.dumps(value, ensure_ascii=False)))


def _refuse(constant: str) -> NoReturn:
    raise ValueError(f"{constant} is no JSON number")


def _integer(digits: str) -> int:
    if len(digits) > _LONGEST:
        raise ValueError(f"a number of {len(digits)} digits")
    return int(digits)


def _finite(digits: str) -> float:
    number = float(digits)
    if number in (float("inf"), float("-inf")):
        raise ValueError(f"{digits[:_LONGEST]} is beyond all numbers")
    return number


def _without_twins(members: list[tuple[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in members:
        if key in found:
            raise ValueError(f"{key[:_LONGEST]!r} stands twice in one object; keep one")
        found[key] = value
    return found


def _is_deeper(value: Any, levels: int) -> bool:
    if not isinstance(value, dict | list):
        return False
    inner = value.values() if isinstance(value, dict) else value
    return levels == 0 or any(_is_deeper(item, levels - 1) for item in inner)


def data_url(media_type: str, data: bytes) -> str:
    """A file as a URL that holds all of it."""
    return f"data:{media_type};base64,{base64.b64encode(data).decode('ascii')}"


def cache_folder() -> Path:
    """The folder of everything that can be made again, for this user on this machine."""
    return _own_folder(CACHE_DIR, "user_cache_dir")


def data_folder() -> Path:
    """The folder of what was fetched once, for this user on this machine."""
    return _own_folder(DATA_DIR, "user_data_dir")


def _own_folder(variable: str, usual: str) -> Path:
    """The folder that a variable names, or else the usual one, by its name in platformdirs."""
    if given := os.environ.get(variable, "").strip():
        return Path(given).expanduser()
    import platformdirs

    return Path(getattr(platformdirs, usual)("adamo-vh"))
