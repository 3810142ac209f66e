"""The action server: truthful feedback, strict observability, tools from outside."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from adamo_vh.action import Code, Drop, Feedback, Look, Outcome, Pick, Walk, tool_schema
from adamo_vh.action_server import PAPER_TOOLS, LocalActionServer, Tool, ToolContext
from adamo_vh.action_server.feedback import picked
from adamo_vh.engine import BodyReport
from adamo_vh.geometry import Vec3
from adamo_vh.perception import Labeling, PerceptionConfig
from adamo_vh.runtime.builtin import BuiltinEngine

SMALL = (960, 540)


@pytest.fixture
def server(engine: BuiltinEngine) -> LocalActionServer:
    made = LocalActionServer(engine, resolution=SMALL)
    made.observe()
    return made


def test_a_look_brings_a_new_view_and_nothing_else_does(server: LocalActionServer) -> None:
    assert server.execute(Look(0, -1, 0.8)).observation is not None
    assert server.execute(Walk(-1.5, -1, 0)).observation is None
    assert server.execute(Pick("Plate_57")).observation is None
    assert server.execute(Drop("Plate_57", -1.5, -2.5, 0)).observation is None
    assert server.execute(Look(9, 9, 9)).observation is None


def test_pick_and_drop_say_what_happened(server: LocalActionServer) -> None:
    picked = server.execute(Pick("Plate_57"))
    assert picked.feedback.text.startswith("Done: walked ")
    assert picked.feedback.text.endswith("Plate_57 is in your hand.")
    assert picked.agent.held == "Plate_57"
    dropped = server.execute(Drop("Plate_57", -1.5, -2.5, 0))
    assert dropped.feedback.text.endswith("Plate_57 rests at (-1.50, -2.50, 0.01) on the floor.")
    assert dropped.agent.held is None


def test_a_corrected_walk_never_reads_as_success(server: LocalActionServer) -> None:
    feedback = server.execute(Walk(0, -1, 0)).feedback
    assert feedback.outcome is Outcome.CORRECTED
    assert "not reachable; stopped at" in feedback.text


def test_a_corrected_drop_says_where_and_on_what(
    server: LocalActionServer, engine: BuiltinEngine
) -> None:
    server.execute(Pick("Glass_37"))
    feedback = server.execute(Drop("Glass_37", 0.326, -0.603, 0.8)).feedback
    rest = engine.state().object(37).box.center
    assert feedback.outcome is Outcome.CORRECTED
    assert f"Glass_37 rests at {rest} on the table" in feedback.text


@pytest.mark.parametrize(
    ("action", "code"),
    [
        (Pick("Unicorn_99"), Code.UNKNOWN_TAG),
        (Pick("Cup_57"), Code.UNKNOWN_TAG),
        (Look(0, -1, 12), Code.OUTSIDE_ROOM),
        (Walk(100, 0, 0), Code.OUTSIDE_ROOM),
        (Drop("Plate_57", 0, 0, 0), Code.HAND_EMPTY),
    ],
)
def test_refusals_change_nothing(server: LocalActionServer, action: Pick, code: Code) -> None:
    before = server.state_hash()
    result = server.execute(action)
    assert result.feedback.outcome is Outcome.REFUSED
    assert result.feedback.code == code
    assert result.state_hash == before


def test_what_is_out_of_reach_is_refused_with_the_nearest_place(
    server: LocalActionServer, engine: BuiltinEngine
) -> None:
    server.execute(Pick("Key_34"))
    before = server.state_hash()
    feedback = server.execute(Drop("Key_34", -0.05, -1.0, 2.6)).feedback
    assert feedback.code == Code.NO_FREE_SPOT
    report = BodyReport(Outcome.REFUSED, Code.UNREACHABLE, Vec3(1.0, 2.0, 0.0))
    assert picked(report, "Key_34").text == (
        "Refused: no place to stand has Key_34 within reach; the nearest is at (1.00, 2.00, 0.00)."
    )
    assert server.state_hash() == before


def test_one_object_in_the_hand(server: LocalActionServer) -> None:
    server.execute(Pick("Plate_57"))
    second = server.execute(Pick("Glass_37")).feedback
    assert second.text == "Refused: your hand already holds Plate_57; drop it first."
    other = server.execute(Drop("Glass_37", 0, 0, 0)).feedback
    assert other.code == Code.NOT_HELD


def test_what_was_not_seen_cannot_be_picked_and_reads_like_unknown(engine: BuiltinEngine) -> None:
    engine.body.look(Vec3(-2.9, -1.0, 1.5))
    server = LocalActionServer(engine, resolution=SMALL)
    assert server.observe().observation.objects == ()
    unseen = server.execute(Pick("Plate_57")).feedback
    unknown = server.execute(Pick("Plate_58")).feedback
    assert (unseen.code, unknown.code) == (Code.NOT_SEEN, Code.UNKNOWN_TAG)
    assert unseen.text.replace("57", "58") == unknown.text
    server.execute(Look(0, -1, 0.8))
    assert server.execute(Pick("Plate_57")).feedback.outcome is Outcome.DONE


def test_under_opaque_labels_no_class_is_told(engine: BuiltinEngine) -> None:
    config = PerceptionConfig(labeling=Labeling.OPAQ)
    server = LocalActionServer(engine, perception=config, resolution=SMALL)
    view = server.observe().observation
    assert all(item.tag.isdigit() for item in view.objects)
    result = server.execute(Pick("57"))
    assert result.agent.held == "57"
    assert "Plate" not in result.feedback.text
    assert server.execute(Pick("Plate_57")).feedback.code == Code.UNKNOWN_TAG


@dataclass(frozen=True, slots=True)
class Wave:
    """Wave with the free hand."""

    times: int


def wave(context: ToolContext, action: Wave) -> Feedback:
    held = context.body.state().held
    if held is not None:
        return Feedback(Outcome.REFUSED, "hand_full", f"Refused: {context.tag(held)} is in it.")
    context.body.say("(waves)" * action.times)
    return Feedback(Outcome.DONE, "ok", f"Done: waved {action.times} times.")


def test_a_tool_from_outside_is_a_dataclass_and_a_function(engine: BuiltinEngine) -> None:
    server = LocalActionServer(engine, resolution=SMALL, tools=(*PAPER_TOOLS, Tool(Wave, wave)))
    server.observe()
    assert tool_schema(Wave).description == "Wave with the free hand."
    assert server.actions == (Look, Walk, Pick, Drop, Wave)
    assert server.execute(Wave(2)).feedback.text == "Done: waved 2 times."
    assert engine.body.said == ["(waves)(waves)"]
    server.execute(Pick("Cup_45"))
    assert server.execute(Wave(1)).feedback.text == "Refused: Cup_45 is in it."
