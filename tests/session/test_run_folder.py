"""Who may write a run folder: one process at a time, and the next is told who it is."""

from __future__ import annotations

import json
import multiprocessing
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

import adamo_vh
from adamo_vh.action import ToolSchema
from adamo_vh.errors import FileError, FolderInUseError, ProviderError, RecordError
from adamo_vh.inference.messages import AIMessage, Message, ToolCall
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.record.run_folder import EVENTS, LOCK, MANIFEST, RESULT, FolderLock, reserve
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.record.writer import TrajectoryWriter
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session.session import Session

SMALL = (320, 180)
LOOK = AIMessage("I look.", (ToolCall("c1", "Look", {"x": 0.5, "y": -1.0, "z": 0.8}),))


def everything(folder: Path) -> dict[str, bytes]:
    """What a run folder holds, but for the lock."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name != LOCK
    }


def run(folder: Path, engine: BuiltinEngine, looks: int = 1) -> None:
    script = folder.with_suffix(".json")
    script.write_text(json.dumps([{"tool": "Look", "args": LOOK.calls[0].arguments}] * looks))
    adamo_vh.run_episode(
        "Look",
        model=f"scripted:{script}",
        resolution=SMALL,
        out=folder,
        engine=engine,
        record=True,
    )


def test_a_second_writer_is_told_who_holds_the_folder(tmp_path: Path) -> None:
    with FolderLock(tmp_path):
        with pytest.raises(FolderInUseError, match=rf"process {os.getpid()} on .* \(since "):
            FolderLock(tmp_path)
        with pytest.raises(FolderInUseError):
            TrajectoryWriter(tmp_path)
    FolderLock(tmp_path).close()


def test_the_lock_dies_with_its_process(tmp_path: Path) -> None:
    code = (
        "import sys, time; from pathlib import Path;"
        "from adamo_vh.record.run_folder import FolderLock;"
        "lock = FolderLock(Path(sys.argv[1])); print('held', flush=True); time.sleep(60)"
    )
    holder = subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path)], stdout=subprocess.PIPE, text=True
    )
    assert holder.stdout is not None
    assert holder.stdout.readline() == "held\n"
    with pytest.raises(FolderInUseError, match=f"process {holder.pid} "):
        FolderLock(tmp_path)
    holder.send_signal(signal.SIGKILL)
    holder.wait()
    FolderLock(tmp_path).close()


def test_a_forked_child_does_not_keep_the_lock(tmp_path: Path) -> None:
    context = multiprocessing.get_context("fork")
    release = context.Event()
    with FolderLock(tmp_path):
        child = context.Process(target=release.wait)
        child.start()
    FolderLock(tmp_path).close()
    release.set()
    child.join()


def test_of_two_writers_in_one_moment_one_gets_the_folder(tmp_path: Path) -> None:
    got: list[int] = []
    barrier = threading.Barrier(4)

    def write(who: int) -> None:
        for number in range(25):
            barrier.wait()
            try:
                TrajectoryWriter(tmp_path / str(number)).close()
            except RecordError:
                continue
            got.append(number)

    threads = [threading.Thread(target=write, args=(who,)) for who in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(got) == list(range(25))


def test_names_are_given_to_one_alone(tmp_path: Path) -> None:
    names: list[Path] = []

    def take() -> None:
        names.extend(reserve(tmp_path / "runs", "same") for _ in range(10))

    threads = [threading.Thread(target=take) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(set(names)) == 40
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="cannot be written"):
        reserve(tmp_path / "file", "run")


def test_a_folder_that_cannot_be_written_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for out in (tmp_path / "file", tmp_path / ("x" * 300), Path("/proc/nothing")):
        with pytest.raises(FileError, match="cannot be written: "):
            FolderLock(out)


class Waiting:
    """A model that keeps an episode going until it is told to end."""

    info = ModelInfo("waiting", ModelKind.SCRIPTED)

    def __init__(self) -> None:
        self.asked, self.go = threading.Event(), threading.Event()

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        self.asked.set()
        self.go.wait(60)
        return Reply(AIMessage("Done."))


def test_a_run_that_is_still_going_is_not_resumed(tmp_path: Path, engine: BuiltinEngine) -> None:
    model = Waiting()
    tried: list[BaseException] = []

    def second() -> None:
        model.asked.wait(60)
        for attempt in (adamo_vh.resume_episode, Session.resume):
            try:
                attempt(tmp_path)
            except FolderInUseError as error:
                tried.append(error)
        model.go.set()

    thread = threading.Thread(target=second)
    thread.start()
    result = adamo_vh.run_episode(
        "Look", model=model, resolution=SMALL, out=tmp_path, engine=engine
    )
    thread.join()
    assert len(tried) == 2
    assert result.termination is TerminationReason.ANSWERED
    assert [e.type for e in read_trajectory(tmp_path).events] == [
        "started", "observed", "thought", "ended",
    ]  # fmt: skip


@pytest.mark.parametrize("kept", ["nothing", "manifest", "empty events"])
def test_killed_between_its_first_files_a_run_says_what_to_do(
    kept: str, tmp_path: Path, engine: BuiltinEngine
) -> None:
    folder, whole = tmp_path / "run", tmp_path / "whole"
    folder.mkdir()
    run(whole, engine)
    if kept == "nothing":
        (folder / LOCK).write_text("")
        run(folder, engine)
    elif kept == "manifest":
        shutil.copy(whole / MANIFEST, folder)
        with pytest.raises(RecordError, match=r"go on with it: adamo-vh run --resume"):
            run(folder, engine)
        assert adamo_vh.resume_episode(folder).steps == 1
    else:
        (folder / EVENTS).write_text("")
        with pytest.raises(RecordError, match=r"left before anything was recorded; delete it"):
            run(folder, engine)
        with pytest.raises(RecordError, match=r"left before anything was recorded; delete it"):
            adamo_vh.resume_episode(folder)
        assert everything(folder) == {EVENTS: b""}


def test_a_resume_that_fails_changes_nothing(tmp_path: Path, engine: BuiltinEngine) -> None:
    """The end is on record, its result is missing, and the world comes out otherwise."""
    run(tmp_path, engine, looks=2)
    (tmp_path / RESULT).unlink()
    lines = (tmp_path / EVENTS).read_text().splitlines(keepends=True)
    first = next(i for i, line in enumerate(lines) if '"type":"acted"' in line)
    act = json.loads(lines[first])
    act["state_hash"] = "0" * 64
    lines[first] = json.dumps(act, separators=(",", ":")) + "\n"
    (tmp_path / EVENTS).write_text("".join(lines) + '{"half":')
    before = everything(tmp_path)
    for attempt in (adamo_vh.resume_episode, Session.resume):
        with pytest.raises(RecordError) as caught:
            attempt(tmp_path)
        assert f"First difference in line {first + 1}" in str(caught.value)
        assert "000000000000 was recorded" in str(caught.value)
        assert everything(tmp_path) == before


@pytest.mark.parametrize("number", [0, 99, -1])
def test_a_record_of_another_format_is_not_touched(
    number: int, tmp_path: Path, engine: BuiltinEngine
) -> None:
    run(tmp_path, engine)
    manifest: dict[str, Any] = json.loads((tmp_path / MANIFEST).read_text())
    (tmp_path / MANIFEST).write_text(json.dumps({**manifest, "format": number}))
    (tmp_path / RESULT).unlink()
    before = everything(tmp_path)
    for attempt in (adamo_vh.resume_episode, adamo_vh.replay_episode, Session.resume):
        with pytest.raises(RecordError, match=f"has format {number}"):
            attempt(tmp_path)
    assert everything(tmp_path) == before


class Failing(ScriptedModel):
    """A provider that is down at one call."""

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        reply = super().complete(messages, tools, sampling)
        if not reply.message.calls:
            raise ProviderError("503")
        return reply


def test_an_episode_that_broke_goes_on_from_there(tmp_path: Path, engine: BuiltinEngine) -> None:
    run_model = Failing("scripted", (LOOK,))
    broken = adamo_vh.run_episode(
        "Look", model=run_model, resolution=SMALL, out=tmp_path, engine=engine
    )
    assert broken.termination is TerminationReason.BROKEN
    still = adamo_vh.resume_episode(tmp_path, model=Failing("scripted", ()))
    assert still.termination is TerminationReason.BROKEN
    after = adamo_vh.resume_episode(tmp_path, model=ScriptedModel("scripted", ()))
    assert (after.termination, after.steps) == (TerminationReason.ANSWERED, 1)
    assert [e.type for e in read_trajectory(tmp_path).events].count("ended") == 1
    assert adamo_vh.replay_episode(tmp_path).mismatches == ()
    with pytest.raises(RecordError, match="has ended"):
        adamo_vh.resume_episode(tmp_path)


def test_two_commands_in_one_second_get_a_folder_each(tmp_path: Path, bare_scene: str) -> None:
    script = tmp_path / "said.json"
    script.write_text('[{"note": "Nothing to do."}]')
    command = [sys.executable, "-m", "adamo_vh", "run", "Wait", "--scene", bare_scene]
    command += ["--resolution", "160x90", "--model", f"scripted:{script}"]
    time.sleep(1 - time.time() % 1)
    runs = [
        subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        for _ in range(2)
    ]
    for one in runs:
        _, complaint = one.communicate()
        assert one.returncode == 0, complaint
    folders = [path for path in (tmp_path / "runs").iterdir() if not path.is_symlink()]
    assert len(folders) == 2
    assert (tmp_path / "runs" / "latest").resolve() in [folder.resolve() for folder in folders]
