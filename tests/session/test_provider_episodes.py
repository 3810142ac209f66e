"""A whole episode on every wire: the agent, the body and a model behind a real socket."""

from __future__ import annotations

import pytest
from tests.dialects import DIALECTS, INPUT, OUTPUT, Dialect, uri
from tests.fake_provider import FakeProvider
from tests.talk import NAMES, QUICK

import adamo_vh
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import Trajectory
from adamo_vh.runtime.builtin import BuiltinEngine


@pytest.mark.parametrize("dialect", DIALECTS, ids=NAMES)
def test_t1_is_finished_on_every_wire(dialect: Dialect, engine: BuiltinEngine) -> None:
    answers = [
        dialect.error(503, "warming up"),
        dialect.answer("I look for 34.", [("c1", "Look", {"x": 0, "y": -1, "z": 0.8})], "sig-1"),
        dialect.answer("It is there.", [("c2", "Pick", {"object": "34"})], "sig-2"),
        dialect.answer("I hold object 34."),
    ]
    trajectory = Trajectory()
    with (
        FakeProvider(answers) as server,
        ProviderModel(uri(dialect, server), QUICK) as model,
    ):
        result = adamo_vh.run_episode(
            task="T1",
            model=model,
            engine=engine,
            resolution=(640, 360),
            observers=[trajectory],
            limits=Limits(max_steps=5),
        )
    assert (result.completion, result.strict) == (1.0, 1.0)
    assert result.termination is TerminationReason.ANSWERED
    assert result.answer == "I hold object 34."
    assert result.tokens == 3 * (INPUT + OUTPUT)
    assert [thought.reply.requests for thought in trajectory.thoughts] == [2, 1, 1]
    last = [*dialect.read(server.requests[-1])]
    assert [p.id for p in last if p.kind == "call"] == ["c1", "c2"]
    assert [p.id for p in last if p.kind == "result"] == ["c1", "c2"]
    assert [p.text for p in last if p.kind == "thinking"] == ["sig-1", "sig-2"]
    assert sum(p.kind == "image" for p in last) == 2
