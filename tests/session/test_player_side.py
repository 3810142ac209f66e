"""The verdict is the harness's: no score, diagnosis or state of the world reaches the player.

Everything that a model can see is walked: in this process every message, tool, result, file and
environment variable at the moment of each call, and on the wire every request with its headers.
"""

from __future__ import annotations

import dataclasses
import io
import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from PIL import Image
from tests.fake_provider import FakeProvider, call, completion

from adamo_vh.action import ToolSchema
from adamo_vh.analysis.diagnosis.finding import DIAGNOSIS, Code, FailureClass
from adamo_vh.episode.result import EpisodeResult
from adamo_vh.episode.sealing import sealed_digest
from adamo_vh.inference.messages import Message
from adamo_vh.inference.model import Model, Reply, Sampling
from adamo_vh.inference.players.random import RandomModel
from adamo_vh.inference.players.wrapper import Ask, Wrapped
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.retry import RetryPolicy
from adamo_vh.record.run_folder import EVENTS, RESULT
from adamo_vh.record.termination import Limits
from adamo_vh.record.trajectory import Acted, Happened, Observed, Started, read_trajectory
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.session.explaining import explain_run
from adamo_vh.session.minds import model_of
from adamo_vh.session.runs import run_episode

VERDICTS = {"completion", "strict", "satisfied", "violation", "unscored", "state_hash", "digest"}
VERDICTS |= {str(code) for code in Code if "_" in code}
VERDICTS |= {"perceptual", "protocol failure", "false_claim"}


def texts_in(value: Any) -> Iterator[str]:
    """Every text within a value, names of members included; what pictures say beside pixels."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, bytes):
        with Image.open(io.BytesIO(value)) as picture:
            yield f"{picture.info} {dict(picture.getexif())}"
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        for member in dataclasses.fields(value):
            yield from texts_in(getattr(value, member.name))
    elif isinstance(value, Mapping):
        for key, inner in value.items():
            yield from texts_in(key)
            yield from texts_in(inner)
    elif isinstance(value, Sequence):
        for inner in value:
            yield from texts_in(inner)
    else:
        yield repr(value)


@dataclass
class Spy:
    """Takes down everything that a model in this process could look at when it is asked."""

    run: Path
    seen: list[str] = field(default_factory=list)
    """All texts of each request."""
    files: list[set[str]] = field(default_factory=list)
    variables: list[dict[str, str]] = field(default_factory=list)

    def around(
        self, ask: Ask, messages: Sequence[Message], tools: Sequence[ToolSchema], how: Sampling
    ) -> Reply:
        self.seen.append("\n".join(texts_in([messages, tools, how])))
        self.files.append({p.relative_to(self.run).as_posix() for p in self.run.rglob("*.json*")})
        self.variables.append(dict(os.environ))
        return ask(messages, tools, how)


def _secrets(run: Path, result: EpisodeResult) -> set[str]:
    """What only the harness may know of an episode."""
    events = read_trajectory(run).events
    hashes = {e.state_hash for e in events if isinstance(e, Started | Acted | Happened)}
    saved = {e.saved for e in events if isinstance(e, Started | Acted)}
    conditions = {condition.text for condition in result.conditions}
    assert hashes and saved and conditions
    return {
        *(digest[:12] for digest in hashes),
        *(text[:60] for text in saved),
        *conditions,
        sealed_digest(run)[:12],
        str(run),
    }


def assert_blind(seen: Sequence[str], run: Path, result: EpisodeResult) -> None:
    for secret in _secrets(run, result):
        assert [n for n, text in enumerate(seen) if secret in text] == [], secret
    for word in VERDICTS:
        assert [n for n, text in enumerate(seen) if word in text.lower()] == [], word


@pytest.mark.parametrize(
    ("player", "labeling", "profile"),
    [
        ("random", "opaq", "lean"),
        ("baseline", "sem", "paper"),
    ],
)
def test_a_model_sees_no_verdict_and_no_state(
    engine: BuiltinEngine,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    player: str,
    labeling: str,
    profile: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    run = tmp_path / "the-run-folder"
    spy = Spy(run)
    before = dict(os.environ)
    inner: Model = RandomModel(3) if player == "random" else model_of(player)
    result = run_episode(
        task="T8",
        model=Wrapped(inner, spy.around),
        engine=engine,
        labeling=labeling,
        profile=profile,
        resolution="160x90",
        grid=3,
        limits=Limits(max_steps=12),
        out=run,
    )
    explain_run(run, engine)
    assert len(spy.seen) == result.model_calls
    assert_blind(spy.seen, run, result)
    # The scores are made when all is over, and nothing is put where a process would look for it.
    assert all(not files & {RESULT, DIAGNOSIS} for files in spy.files)
    assert (run / RESULT).exists() and (run / DIAGNOSIS).exists() and (run / EVENTS).exists()
    for variables in spy.variables:
        added = [f"{k}={v}" for k, v in variables.items() if before.get(k) != v]
        assert_blind(added, run, result)
    assert [path.name for path in tmp_path.iterdir()] == [run.name]


@pytest.mark.parametrize("labeling", ["sem", "opaq"])
def test_a_model_is_told_of_nothing_that_it_has_not_seen(
    engine: BuiltinEngine, tmp_path: Path, labeling: str
) -> None:
    spy = Spy(tmp_path / "run")
    result = run_episode(
        task="T8",
        model=Wrapped(RandomModel(1), spy.around),
        engine=engine,
        labeling=labeling,
        resolution="160x90",
        grid=3,
        limits=Limits(max_steps=12),
        out=spy.run,
    )
    views = [e for e in read_trajectory(spy.run).events if isinstance(e, Observed)]
    tags = {item.tag for item in result.world()}
    unseen = tags - {item.tag for view in views for item in view.objects}
    assert unseen
    hidden = unseen
    if labeling == "opaq":
        # Tags are bare numbers, which anything may be; here no kind is ever told, seen or not.
        hidden = {item.class_name.lower() for item in result.world()} - {"glass", "plate"}
    for text in spy.seen:
        assert hidden & set(re.findall(r"[A-Za-z]\w*", text.lower() + text)) == set()


def test_a_model_behind_a_wire_is_sent_no_verdict_and_no_state(
    engine: BuiltinEngine, tmp_path: Path
) -> None:
    run = tmp_path / "the-run-folder"
    answers = [
        completion("I look.", [call("Look", {"x": 0, "y": -1, "z": 0.8})]),
        completion("I take it.", [call("Pick", {"object": "nothing"})]),
        completion("I walk.", [call("Walk", {"x": 90, "y": 0, "z": 0})]),
        completion("I have done it."),
    ]
    with FakeProvider(answers) as server:
        model = ProviderModel(server.uri(), RetryPolicy(max_tries=1, timeout_s=5.0))
        result = run_episode(
            task="T8", model=model, engine=engine, resolution="160x90", out=run, record=True
        )
        seen = [json.dumps(request) for request in server.requests]
        seen += [json.dumps(dict(headers)) for headers in server.headers]
    assert result.model_calls == 4 and result.completion == 0.0
    assert_blind(seen, run, result)


def test_the_walk_finds_what_is_hidden_anywhere(tmp_path: Path) -> None:
    picture = io.BytesIO()
    exif = Image.Exif()
    exif[270] = "completion 0.50"
    Image.new("RGB", (4, 4)).save(picture, "JPEG", exif=exif)
    hidden = [{"a": ("x", {"state_hash": 1})}, Sampling(), picture.getvalue()]
    found = "\n".join(texts_in(hidden))
    assert "state_hash" in found and "completion 0.50" in found and "temperature" not in found
    assert FailureClass.PERCEPTUAL in VERDICTS
