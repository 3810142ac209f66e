"""Files are written whole, and read with limits: anybody may have written them."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.errors import FileError
from adamo_vh.files import (
    CACHE_DIR,
    append_line,
    cache_folder,
    check_place,
    parse_json,
    parse_toml,
    read_json,
    read_text,
    read_toml,
    write_whole,
)

BOMBS = {
    "dotted key": ".".join("a" * 50_000) + " = 1",
    "quoted dotted key": ".".join(['"a"'] * 50_000) + " = 1",
    "spaced dotted key": " . ".join("a" * 50_000) + " = 1",
    "dotted table": "[" + ".".join("a" * 50_000) + "]",
    "dotted key in an inline table": "x = {" + ".".join("a" * 50_000) + " = 1}",
    "deep arrays": "x = " + "[" * 5_000 + "]" * 5_000,
    "deep inline tables": "x = " + "{x = " * 5_000 + "1" + "}" * 5_000,
    "deep over lines": "x = " + "[ # [\n" * 5_000 + "]" * 5_000,
    "long integer": "x = " + "1" * 5_000,
    "long integer in an array": "x = [1, " + "9" * 5_000 + "]",
    "long hexadecimal": "x = 0x" + "f" * 500_000,
    "long float": "x = 1." + "0" * 500_000,
}


@pytest.mark.parametrize("name", BOMBS)
def test_a_toml_bomb_costs_nothing(name: str) -> None:
    started = time.process_time()
    with pytest.raises(FileError, match=r"^evil\.toml: line \d+: .*make it shorter") as caught:
        parse_toml(BOMBS[name], "evil.toml")
    assert time.process_time() - started < 1.0
    assert len(str(caught.value)) < 120


def test_a_dotted_key_takes_no_memory(tmp_path: Path) -> None:
    path = tmp_path / "evil.toml"
    path.write_text(".".join("a" * 50_000) + " = 1")

    def little() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (600_000_000, 600_000_000))

    code = "import sys; from adamo_vh.files import read_toml; read_toml(sys.argv[1])"
    run = subprocess.run(
        [sys.executable, "-c", code, path],
        preexec_fn=little,
        capture_output=True,
        text=True,
        check=False,
    )
    assert "FileError" in run.stderr and "MemoryError" not in run.stderr


@pytest.mark.parametrize(
    "text",
    [
        'x = "' + "\\\\" * 200_000 + '"',
        'x = """' + '\\"""' * 100_000,
        "\n" * 300_000,
        "'''" * 90_000,
    ],
)
def test_the_scan_is_linear(text: str) -> None:
    started = time.process_time()
    with suppress(FileError):
        parse_toml(text, "x")
    assert time.process_time() - started < 10.0


KEYS = st.text(st.sampled_from("ab-_1"), min_size=1, max_size=5)
TEXTS = st.text(st.sampled_from("ab.[]{}#=\"' \\,é"), max_size=30)


@given(st.dictionaries(KEYS, st.one_of(TEXTS, st.integers(), st.lists(TEXTS, max_size=4))))
def test_what_is_meant_is_read_as_tomllib_reads_it(table: dict[str, object]) -> None:
    # A JSON value is a TOML value here, but for the characters that TOML strings must escape.
    text = "".join(
        f'{key} = {json.dumps(value)} # it\'s "fine" [[[\n' for key, value in table.items()
    )
    assert parse_toml(text, "good.toml") == table


def test_every_form_of_text_is_passed_over() -> None:
    dots = "." * 50
    forms = (f"a = '{dots}'", f'b = "{dots}\\""', f"c = '''{dots}'\n{dots}'''")
    text = "\n".join((*forms, f'd = """{dots}"\\""""'))
    assert set(parse_toml(text, "x")) == {"a", "b", "c", "d"}
    assert parse_toml('x = """a""""', "x") == {"x": 'a"'}


@pytest.mark.parametrize("start", [b"", b"\xef\xbb\xbf"])
def test_a_byte_order_mark_does_not_matter(tmp_path: Path, start: bytes) -> None:
    (tmp_path / "x.toml").write_bytes(start + b"x = 1\r\n")
    (tmp_path / "x.json").write_bytes(start + b'{"x": 1}')
    assert read_toml(tmp_path / "x.toml") == {"x": 1}
    assert read_json(tmp_path / "x.json") == {"x": 1}


def test_another_encoding_is_named_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "x.toml"
    path.write_bytes("a = 1\nname = 'café'".encode("latin-1"))
    with pytest.raises(FileError, match=r"x\.toml, line 2: not UTF-8 text; save the file as UTF-8"):
        read_text(path)
    path.write_bytes("a = 1".encode("utf-16"))
    with pytest.raises(FileError, match="not UTF-8"):
        read_text(path)


def test_what_cannot_be_read_says_why(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"none\.toml cannot be read: No such file"):
        read_toml(tmp_path / "none.toml")
    with pytest.raises(FileError, match="It is a folder; name a file"):
        read_toml(tmp_path)
    with pytest.raises(FileError, match="Choose a shorter name") as caught:
        read_toml(tmp_path / ("x" * 300))
    assert len(str(caught.value)) < 400
    with pytest.raises(FileError, match="cannot be read: embedded null byte"):
        read_toml("a\0b.toml")
    with pytest.raises(FileError, match="larger than"):
        read_text("/dev/zero")


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("[" * 100_000, "brackets inside each other"),
        ("[" * 70 + "]" * 70, "brackets inside each other"),
        ('{"a":' * 5_000 + "1" + "}" * 5_000, "brackets inside each other"),
        ("9" * 5_000, "a number of 5000 digits"),
        ("[1e999]", "beyond all numbers"),
        ("NaN", "NaN is no JSON number"),
        ('{"a": 1, "a": 2}', "'a' stands twice"),
        ("{", "not valid JSON"),
        ("", "not valid JSON"),
    ],
)
def test_a_json_bomb_is_one_line(tmp_path: Path, text: str, problem: str) -> None:
    path = tmp_path / "x.json"
    path.write_text(text)
    with pytest.raises(FileError, match=problem) as caught:
        read_json(path)
    assert "\n" not in str(caught.value)


def test_a_lone_surrogate_becomes_a_question_mark(tmp_path: Path) -> None:
    path = tmp_path / "x.json"
    path.write_text(r'["\ud800", {"\udfff": "\ud83d\ude00"}]')
    assert read_json(path) == ["?", {"?": "😀"}]


def test_a_file_is_there_whole_or_as_before(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "x.json"
    assert write_whole(path, b"one") == path
    write_whole(path, b"two", durable=True)
    assert path.read_bytes() == b"two"
    assert os.listdir(path.parent) == ["x.json"]
    assert path.stat().st_mode & 0o777 == 0o666 & ~_umask(), "readable by whom a file is readable"


def test_what_cannot_be_written_leaves_nothing_behind(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"")
    (tmp_path / "folder").mkdir()
    with pytest.raises(FileError, match="A file stands where a folder must be"):
        write_whole(tmp_path / "file" / "x.json", b"")
    with pytest.raises(FileError, match="It is a folder"):
        write_whole(tmp_path / "folder", b"")
    with pytest.raises(FileError, match="Choose a shorter name"):
        write_whole(tmp_path / ("x" * 300), b"")
    with pytest.raises(FileError, match="cannot be written"):
        write_whole(Path("/proc/none/x.json"), b"")
    assert sorted(os.listdir(tmp_path)) == ["file", "folder"]


FULL = """
import resource, signal, sys
from pathlib import Path
from adamo_vh.errors import FileError
from adamo_vh.files import append_line, write_whole
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))
lines, whole = Path(sys.argv[1]) / "lines", Path(sys.argv[1]) / "whole"
for call in (lambda: append_line(lines, b"x" * 200), lambda: write_whole(whole, b"x" * 200)):
    try:
        call()
    except FileError as error:
        print(error)
"""


def test_a_full_disk_leaves_what_was_whole(tmp_path: Path) -> None:
    """A limit on the size of files stops a write in its middle, as a full disk does."""
    append_line(tmp_path / "lines", b"one")
    write_whole(tmp_path / "whole", b"one")
    run = subprocess.run(
        [sys.executable, "-c", FULL, tmp_path], capture_output=True, text=True, check=True
    )
    assert run.stdout.count("cannot be written: File too large") == 2, run.stdout
    assert (tmp_path / "lines").read_bytes() == b"one\n"
    assert (tmp_path / "whole").read_bytes() == b"one"
    assert sorted(os.listdir(tmp_path)) == ["lines", "whole"]


def test_the_cache_lies_where_the_environment_says(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv(CACHE_DIR, str(tmp_path))
    assert cache_folder() == tmp_path
    monkeypatch.setenv(CACHE_DIR, "")
    assert cache_folder().name == "adamo-vh"


def _umask() -> int:
    now = os.umask(0)
    os.umask(now)
    return now


def test_json_from_anywhere_is_read_as_strictly_as_a_file() -> None:
    assert parse_json('{"a": [1, 2.5, null, true, "\\u00e9"]}') == {"a": [1, 2.5, None, True, "é"]}
    assert parse_json('"\\ud800"') == "?"
    for text, told in (
        ("{", "line 1"),
        ("NaN", "no JSON number"),
        ("1e999", "beyond all numbers"),
        ('{"a": 1, "a": 2}', "stands twice"),
        ("[" * 70 + "]" * 70, "open fewer"),
        ("1" * 101, "a number of 101 digits"),
    ):
        with pytest.raises(ValueError, match=told):
            parse_json(text)


def test_a_place_is_looked_at_before_the_work_that_is_to_fill_it(tmp_path: Path) -> None:
    check_place(tmp_path)
    check_place(tmp_path / "a" / "b")
    assert os.listdir(tmp_path) == [], "nothing is made"
    (tmp_path / "file").touch()
    (tmp_path / "loop").symlink_to("loop")
    for wrong in ("file", "file/below", "file/below/it", "x" * 300, f"{'x' * 300}/y", "loop/y"):
        with pytest.raises(FileError, match="cannot be written"):
            check_place(tmp_path / wrong)
