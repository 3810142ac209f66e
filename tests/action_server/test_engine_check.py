"""The built-in engine keeps the contract; one that does not is told what it lacks."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from adamo_vh.action import Outcome, Pick
from adamo_vh.action_server import LocalActionServer
from adamo_vh.action_server.engine_check import engine_faults
from adamo_vh.engine import BodyReport, WorldState
from adamo_vh.errors import EngineError
from adamo_vh.geometry import Vec3
from adamo_vh.observation import Percept
from adamo_vh.runtime.builtin import BuiltinEngine

SMALL = (320, 180)


class Passing:
    """Hands everything on to an engine or a body but what a test replaces."""

    def __init__(self, real: Any, **replaced: Any) -> None:
        self._real = real
        self.__dict__.update(replaced)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._real, name)


def with_body(engine: BuiltinEngine, **replaced: Any) -> Any:
    return Passing(engine, bodies={"agent": Passing(engine.body, **replaced)})


def test_the_built_in_engine_keeps_the_contract(engine: BuiltinEngine) -> None:
    before = engine.state()
    assert engine_faults(engine) == ()
    assert engine.state() == before


def test_what_is_no_engine_is_told_so() -> None:
    (fault,) = engine_faults(object())  # type: ignore[arg-type]
    assert "object is no engine: it lacks scene, object_names, bodies" in fault


def test_what_an_engine_does_wrong_is_told(engine: BuiltinEngine) -> None:
    def forgetful(_: bytes) -> None:
        pass

    def floating() -> WorldState:
        state = engine.state()
        return replace(state, body=replace(state.body, position=Vec3(0.0, 0.0, 0.1)))

    def boastful(point: Vec3) -> BodyReport:
        return BodyReport(Outcome.DONE, "ok", point)

    def unknown(_: Any) -> None:
        raise TypeError("what is an event?")

    assert any("restore" in f for f in engine_faults(Passing(engine, restore=forgetful)))
    assert any("floats" in f for f in engine_faults(Passing(engine, state=floating)))
    assert any("away from the wish" in f for f in engine_faults(with_body(engine, walk=boastful)))
    assert any(
        "TypeError, not EngineError" in f for f in engine_faults(Passing(engine, apply=unknown))
    )


def test_mistakes_of_an_engine_from_outside_are_a_sentence(engine: BuiltinEngine) -> None:
    def typo(*_: Any) -> Percept:
        return engine.body.seee()  # type: ignore[attr-defined, no-any-return]

    server = LocalActionServer(with_body(engine, see=typo, pick=typo), resolution=SMALL)
    with pytest.raises(EngineError, match="failed in observe: AttributeError"):
        server.observe()
    LocalActionServer(engine, resolution=SMALL)
    seen = LocalActionServer(with_body(engine, pick=typo), resolution=SMALL)
    seen.observe()
    with pytest.raises(EngineError, match="failed in Pick: AttributeError"):
        seen.execute(Pick("Plate_57"))


@pytest.mark.parametrize("code", ["too heavy", "no_free_spot", "", "ok", "unknown_tag"])
def test_an_engine_may_have_reasons_of_its_own(engine: BuiltinEngine, code: str) -> None:
    def refused(_: int) -> BodyReport:
        return BodyReport(Outcome.REFUSED, code)

    server = LocalActionServer(with_body(engine, pick=refused), resolution=SMALL)
    server.observe()
    feedback = server.execute(Pick("Plate_57")).feedback
    assert feedback.outcome is Outcome.REFUSED
    assert feedback.text.startswith("Refused: ")
    assert "within reach" not in feedback.text
    if code == "too heavy":
        assert feedback.text == "Refused: the body cannot do that (too heavy)."
