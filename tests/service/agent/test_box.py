"""What a box shows and hides, as words of its command."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

import adamo_vh
from adamo_vh.errors import ConfigError
from adamo_vh.service.agent.box import HOME, Box, found_program


def _box(tmp_path: Path, *shown: Path) -> list[str]:
    box = Box(tmp_path / "work", tmp_path / "sockets", (tmp_path / "run",), shown)
    return box.command(["/usr/bin/env", "x"], {8020: "mcp.sock"})


def _after(words: list[str], option: str) -> list[str]:
    return [words[number + 1] for number, word in enumerate(words) if word == option]


def test_it_has_no_network_no_rights_and_ends_with_us(tmp_path: Path) -> None:
    words = _box(tmp_path)
    assert {"--unshare-all", "--die-with-parent", "--new-session"} <= {*words}
    assert "--share-net" not in words and _after(words, "--cap-drop") == ["ALL"]
    assert _after(words, "--bind") == [str(tmp_path / "work")] and _after(words, "--chdir") == [
        HOME
    ]
    assert words[-4:] == ["8020=/run/adamo/mcp.sock", "--", "/usr/bin/env", "x"]


def test_it_shows_the_system_and_what_runs_in_it(tmp_path: Path) -> None:
    read = _after(_box(tmp_path), "--ro-bind")
    assert "/usr" in read and str(tmp_path / "sockets") in read
    assert not {"/", "/etc", "/home", "/root", str(Path.home()), str(tmp_path)} & {*read}
    python = Path(os.path.realpath(sys.executable))
    assert any(python.is_relative_to(path) for path in read)


def test_a_file_in_somebodys_own_folder_is_shown_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    for folder in ("bin", "lib", "app/bin", "app/lib"):
        (tmp_path / folder).mkdir(parents=True)
    box = Box(tmp_path / "work", tmp_path / "sockets", ())
    for program, seen in (("bin/own", "bin/own"), ("app/bin/it", "app"), ("x/run", "x/run")):
        words = box.command([str(tmp_path / program)], {})
        assert str(tmp_path / seen) in _after(words, "--ro-bind")
        assert str(tmp_path) not in _after(words, "--ro-bind")


def test_what_is_named_does_not_show_what_is_hidden(tmp_path: Path) -> None:
    (tmp_path / "run").mkdir()
    package = Path(adamo_vh.__file__).parent
    assert str(tmp_path / "run") not in _box(tmp_path)
    words = _box(tmp_path, tmp_path, package.parent)
    assert {str(tmp_path / "run"), str(package)} <= {*_after(words, "--tmpfs")}
    # What hides comes after what shows.
    assert words.index(str(package)) > words.index(str(package.parent))


def test_a_program_is_found_or_told(tmp_path: Path) -> None:
    assert found_program("env") in ("/usr/bin/env", "/bin/env")
    with pytest.raises(ConfigError, match="there is no program"):
        found_program(str(tmp_path))
