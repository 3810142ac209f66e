"""Episodes that were played elsewhere: put, whole or not at all, where the study can take them.

The place is a folder that all machines see, or a URL of any store that fsspec knows. In a folder an
episode is its run folder; at a URL it is one archive of it, because stores have no folders.
"""

from __future__ import annotations

import io
import shutil
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any
from uuid import uuid4

from adamo_vh.errors import ConfigError, FileError
from adamo_vh.files import make_folder, naming
from adamo_vh.record.run_folder import LOCK
from adamo_vh.study.store import EPISODES


def is_url(place: str) -> bool:
    """Whether a place is no folder."""
    return "://" in place


def check_place(place: str) -> None:
    """Make sure that a place can be reached, before anything is played.

    Args:
        place: A folder, which is made if it is missing, or a URL.

    Raises:
        ConfigError: fsspec, or what it needs for this kind of URL, is missing.
        FileError: It cannot be reached.
    """
    if is_url(place):
        with _store(place) as (files, path):
            files.makedirs(path, exist_ok=True)
    else:
        make_folder(Path(place))


def publish(run: Path, place: str, key: str) -> None:
    """Put an episode where the study can take it; what is there of it is replaced.

    Args:
        run: Its run folder on this machine.
        place: Folder or URL.
        key: The episode's.

    Raises:
        FileError: It cannot be written; what was there is as it was.
    """
    if not is_url(place):
        copy_whole(run, Path(place) / EPISODES / key)
        return
    packed = io.BytesIO()
    with naming("read", run), zipfile.ZipFile(packed, "w") as archive:
        for file in sorted(run.rglob("*")):
            if file.name != LOCK:
                archive.write(file, file.relative_to(run))
    with _store(f"{place.rstrip('/')}/{EPISODES}/{key}.zip") as (files, path):
        files.makedirs(path.rpartition("/")[0], exist_ok=True)
        half = f"{path}.{uuid4().hex[:12]}.part"
        files.pipe_file(half, packed.getvalue())
        if files.exists(path):
            files.rm(path)
        files.mv(half, path)


def collect(place: str, key: str, there: Path) -> bool:
    """Take an episode that was published; whether there was one.

    Args:
        place: Folder or URL.
        key: The episode's.
        there: Its run folder on this machine; what is there is replaced. Nothing is done if that is
            the place itself.

    Raises:
        FileError: It cannot be read, or not be written here.
    """
    if not is_url(place):
        run = Path(place) / EPISODES / key
        if not run.is_dir():
            return False
        if run.resolve() != there.resolve():
            copy_whole(run, there)
        return True
    with _store(f"{place.rstrip('/')}/{EPISODES}/{key}.zip") as (files, path):
        if not files.exists(path):
            return False
        data = files.cat_file(path)
    with _whole(there) as half:
        make_folder(half)
        try:
            # Unlike a tar, a zip has no links, and none of its names leads out of the folder.
            with zipfile.ZipFile(io.BytesIO(data)) as archive:
                archive.extractall(half)
        except zipfile.BadZipFile as error:
            raise FileError(
                f"{place}: the archive of {key} is damaged ({error}); delete it, and give the same "
                "command again."
            ) from error
    return True


def copy_whole(run: Path, there: Path) -> None:
    """Copy a run folder, whole or not at all; what is there is replaced.

    Raises:
        FileError: It cannot be read or written.
    """
    with _whole(there) as half:
        shutil.copytree(run, half, ignore=shutil.ignore_patterns(LOCK))


@contextmanager
def _whole(there: Path) -> Iterator[Path]:
    """A folder to fill, which then takes the place of another in one move."""
    make_folder(there.parent)
    half = there.parent / f".{uuid4().hex[:12]}.part"
    with naming("written", there):
        try:
            yield half
            if there.exists():
                shutil.rmtree(there)
            half.replace(there)
        except BaseException:
            shutil.rmtree(half, ignore_errors=True)
            raise


@contextmanager
def _store(url: str) -> Iterator[tuple[Any, str]]:
    """The store of a URL, and the path in it; its faults become ours."""
    try:
        import fsspec
    except ImportError:
        raise ConfigError(
            f'{url} needs the extra "cluster": pip install "adamo-vh[cluster]"'
        ) from None
    try:
        yield fsspec.core.url_to_fs(url)
    except FileError:
        raise
    except (ImportError, ValueError) as error:
        raise ConfigError(f"{url} cannot be used: {error}.") from error
    except Exception as error:
        # Every kind of store has errors of its own.
        said = str(error).splitlines() or [type(error).__name__]
        raise FileError(
            f"{url} cannot be used: {said[0]}. Check the URL and its credentials; the same command "
            "goes on."
        ) from error


def forget(run: Path) -> None:
    """Remove a run folder that is safe elsewhere."""
    with suppress(OSError):
        shutil.rmtree(run)
