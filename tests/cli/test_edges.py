"""Files and folders that cannot be used, in every command: one line, and nothing is lost."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

import pytest
from tests.cli.process import SMALL, adamo, script, walk

from adamo_vh.cli.exits import MEANING, Exit

LONG = "x" * 300


def one_line(done: object, code: int = 2) -> str:
    assert getattr(done, "code", None) == code, done
    lines = getattr(done, "err", "").splitlines()
    assert len(lines) == 1, lines
    return str(lines[0])


def test_a_folder_that_cannot_be_one_is_refused_before_anything_is_paid(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"")
    model = script(tmp_path, {"note": "x"})
    for place in ("file", "file/below", LONG, "/proc/none/run"):
        commands = [
            ("run", "--task", "T1", "--model", model, "--out", place),
            ("run", "hi", "--record", "--model", model, "--out", place),
            ("run", "hi", "--model", model, "--video", f"{place}/x.webm", "--out", "v"),
            ("run", "--resume", place),
            ("chat", "--out", place),
            ("chat", "--resume", place),
            ("replay", place),
            ("report", place),
            ("figure", f"{place}/x.glb"),
        ]
        for words, done in zip(commands, walk(commands, cwd=tmp_path), strict=True):
            assert one_line(done).startswith("adamo-vh: "), words


def test_what_was_found_is_told_though_no_picture_can_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"")
    done = adamo("scenes", "check", "s1", "--out", "file/x", cwd=tmp_path)
    assert done.code == 0
    assert "s1: sound" in done.out and "no pictures: " in done.err


def test_a_figure_is_not_written_under_the_name_of_another_format(tmp_path: Path) -> None:
    assert "name it ken.glb" in one_line(adamo("figure", "ken.fbx", cwd=tmp_path))
    assert os.listdir(tmp_path) == []


def test_a_score_is_printed_though_the_page_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "a" / "episode.html").mkdir(parents=True)
    model = script(tmp_path, {"note": "Take it.", "tool": "Pick", "args": {"object": "34"}})
    done = adamo("run", "--task", "T1", "--model", model, *SMALL, "--out", "a", cwd=tmp_path)
    assert done.code == 0, done.err
    assert "completion 1.00" in done.out
    assert "the page is not drawn" in done.err and "adamo-vh report a" in done.err


def test_a_score_is_printed_though_the_result_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "a" / "result.json").mkdir(parents=True)
    model = script(tmp_path, {"note": "Take it.", "tool": "Pick", "args": {"object": "34"}})
    done = adamo(
        "run", "--task", "T1", "--model", model, *SMALL, "--out", "a", "--json", cwd=tmp_path
    )
    assert done.code == 0, done.err
    assert json.loads(done.out)["completion"] == 1.0
    assert "the result is not written" in done.err


def test_a_script_and_a_scene_with_a_byte_order_mark_are_read(tmp_path: Path) -> None:
    (tmp_path / "x.json").write_bytes(b'\xef\xbb\xbf[{"note": "Nothing to do."}]')
    done = adamo("run", "hi", "--model", "scripted:x.json", *SMALL, "--out", "a", cwd=tmp_path)
    assert done.code == 0 and "Nothing to do." in done.out


def test_all_that_is_wrong_with_a_scene_file_is_told_at_once(tmp_path: Path) -> None:
    (tmp_path / "x.toml").write_text(
        'name = "x y\\u001b"\ntitle = 3\nwat = 1\nlights = []\n'
        '[room]\nasset = "plain"\nx_min = true\nx_max = "5"\ny_min = nan\ny_max = 1e9\n'
        '[[objects]]\nid = 1.5\nasset = "Plate"\non = 3\nposition = [1]\n'
    )
    done = adamo("scenes", "check", "x.toml", cwd=tmp_path)
    assert done.code == 1
    fields = [line.split(": ")[1] for line in done.out.splitlines() if line.startswith("error: ")]
    assert {"name", "title", "wat", "room.x_min", "room.x_max", "room.y_min", "room.y_max"} <= {
        *fields
    }
    assert {"room.height_m", "agent", "furniture", "lights", "objects[0].id"} <= {*fields}
    assert "room.x_min: must be a number, not true; write it without quotes" in done.out
    told = one_line(adamo("run", "hi", "--scene", "x.toml", cwd=tmp_path))
    assert "x.toml: name: " in told and "more: see adamo-vh scenes check" in told


@pytest.mark.parametrize("deep", ["[" * 5000, "1" * 5000, "{a." * 3000])
def test_a_hostile_scene_file_is_one_line(deep: str, tmp_path: Path) -> None:
    (tmp_path / "x.toml").write_text(f"name = {deep}")
    for words in (("run", "hi", "--scene", "x.toml"), ("serve-model", "--faults", "x.toml")):
        assert "x.toml: line 1: " in one_line(adamo(*words, cwd=tmp_path))
    assert adamo("scenes", "check", "x.toml", cwd=tmp_path).code == 1


@pytest.mark.parametrize(
    ("name", "value", "fix"),
    [
        ("MUJOCO_GL", "foo", "egl or osmesa"),
        ("MUJOCO_EGL_DEVICE_ID", "abc", "unset it"),
        ("MUJOCO_EGL_DEVICE_ID", "-1", "unset it"),
    ],
)
def test_a_trap_for_graphics_is_named_by_run_and_doctor(
    name: str, value: str, fix: str, tmp_path: Path
) -> None:
    told = one_line(
        adamo("run", "hi", "--out", "a", cwd=tmp_path, environment={name: value}), code=1
    )
    assert name in told and fix in told
    done = adamo("doctor", cwd=tmp_path, environment={name: value})
    assert done.code == 1
    assert f"FAIL graphics {name} is" in done.out and fix in done.out.splitlines()[-1]


def test_doctor_sees_what_else_would_fail(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    done = adamo("doctor", cwd=tmp_path, environment={"PYTHONIOENCODING": "latin-1"})
    assert done.code == 1
    assert "FAIL text" in done.out and "LC_ALL=C.UTF-8" in done.out
    monkeypatch.setenv("ADAMO_VH_CACHE_DIR", "/proc/x")
    done = adamo("doctor", cwd=tmp_path)
    assert done.code == 1
    assert "FAIL cache" in done.out and "ADAMO_VH_CACHE_DIR" in done.out


def test_the_cache_says_what_it_holds_and_clears_only_that(tmp_path: Path) -> None:
    cache = tmp_path / "cache"
    ours = ("assets/0123456789abcdef/Plate.npz", "models/0123456789abcdef.json")
    others = ("assets/mine.npz", "models/weights.gguf", "models/llama/x.json", "notes.txt")
    for name in (*ours, *others):
        (cache / name).parent.mkdir(parents=True, exist_ok=True)
        (cache / name).write_bytes(b"x" * 1000)
    shown = adamo("cache", cwd=tmp_path, environment={"ADAMO_VH_CACHE_DIR": str(cache)})
    assert str(cache) in shown.out and "assets       1 files" in shown.out
    cleared = adamo(
        "cache", "clear", "--json", cwd=tmp_path, environment={"ADAMO_VH_CACHE_DIR": str(cache)}
    )
    assert json.loads(cleared.out)["files"] == 2
    assert sorted(
        p.relative_to(cache).as_posix() for p in cache.rglob("*") if p.is_file()
    ) == sorted(others)
    shutil.rmtree(cache)
    assert (
        adamo("cache", "clear", cwd=tmp_path, environment={"ADAMO_VH_CACHE_DIR": str(cache)}).code
        == 0
    )


def test_the_version_and_the_completion_are_offered(tmp_path: Path) -> None:
    assert adamo("--version", cwd=tmp_path).out.startswith("adamo-vh 0.")
    # The shell is named, not found out: tests may run in one that has no completion.
    named = {"HOME": str(tmp_path), "_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1"}
    done = adamo("--show-completion", "bash", cwd=tmp_path, environment=named)
    assert done.code == 0 and "_COMPLETE" in done.out
    installed = adamo("--install-completion", "bash", cwd=tmp_path, environment=named)
    assert installed.code == 0, installed.all
    assert list(tmp_path.glob(".bash*"))


def test_the_exit_codes_are_in_the_help(tmp_path: Path) -> None:
    told = " ".join(adamo("--help", cwd=tmp_path).out.split())
    assert set(MEANING) == set(Exit)
    for code, meaning in MEANING.items():
        assert f"{code.value} {meaning}" in told


def test_python_without_docstrings_and_assertions_does_the_same(tmp_path: Path) -> None:
    model = script(tmp_path, {"note": "Take it.", "tool": "Pick", "args": {"object": "34"}})
    words = ("run", "--task", "T1", "--model", model, *SMALL, "--out", "a")
    done = adamo(*words, cwd=tmp_path, flags="-OO")
    assert done.code == 0, done.err
    assert "completion 1.00" in done.out


PAPER = ("--profile", "paper")
"""An answer is an answer, without a call of Finish."""
CHAT = b"\n\n  \n/help\n/nope\nTake the key\n\nquit\nnever heard\n"


@pytest.mark.parametrize("leave", [b"quit", b"exit", b"/quit", b"/exit", b"QUIT", b""])
def test_a_chat_is_left_in_the_usual_ways(leave: bytes, tmp_path: Path) -> None:
    done = adamo("chat", "--out", "a", cwd=tmp_path, said=b"\n" + leave)
    assert (done.code, done.err) == (0, "")
    assert "/quit or Ctrl+D leaves" in done.out
    assert not (tmp_path / "a").exists(), "nothing was said, so nothing is kept"


def test_a_chat_knows_its_own_commands_and_passes_the_rest_on(tmp_path: Path) -> None:
    model = script(tmp_path, {"note": "Which key?"})
    done = adamo("chat", *PAPER, "--model", model, "--out", "a", cwd=tmp_path, said=CHAT)
    assert done.code == 0, done.err
    assert "There is no /nope" in done.out and "stop what is being done" in done.out
    assert "agent       Which key?" in done.out
    assert "never heard" not in done.out
    assert done.out.splitlines()[-1].startswith("Kept in a; go on with: adamo-vh chat --resume a")


def test_a_chat_says_so_if_a_line_is_no_text(tmp_path: Path) -> None:
    model = script(tmp_path, {"note": "Yes."})
    done = adamo(
        "chat", *PAPER, "--model", model, "--out", "a", cwd=tmp_path, said=b"caf\xe9\nhi\n"
    )
    assert done.code == 2
    assert "not UTF-8 text and is left out" in done.out
    assert "agent       Yes." in done.out, "the next line is heard"
