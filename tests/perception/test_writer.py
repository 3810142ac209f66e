"""The text of the state, whole or as what changed; tags come from the labeling alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from adamo_vh.action import Outcome, Pick
from adamo_vh.action_server import LocalActionServer
from adamo_vh.geometry import Camera, Vec3
from adamo_vh.observation import AgentState, Frame, Observation, ObservedObject
from adamo_vh.perception import PerceptionConfig, TextForm
from adamo_vh.perception.writer import SymbolicState, Told, Wording, view_now
from adamo_vh.runtime.builtin import BuiltinEngine

GOLDEN = Path(__file__).parent / "golden"
PLATE = ObservedObject(
    "Plate_57", Vec3(0.326, -0.603, 0.795), 0.001875, (812, 500, 910, 560), 3000, "57"
)
AGENT = AgentState(Vec3(-2.0, -1.0, 0.0), 0.0, Vec3(0.51, -1.25, 1.17), Vec3(-2.0, -1.0, 1.6))
CAMERA = Camera(Vec3(-2.0, -1.0, 1.6), 0.0, 0.0, 1.0, 64, 36)
VIEW = Observation(Frame(b"", "image/png", 64, 36), (PLATE,), (), AGENT, CAMERA)


def test_the_whole_state_is_as_agreed() -> None:
    told = SymbolicState(VIEW, Wording(TextForm.PAPER)).text(AGENT)
    assert told + "\n" == (GOLDEN / "symbolic_state.md").read_text(encoding="utf-8")


def test_few_words_name_objects_by_their_short_names() -> None:
    assert "In view: 57\n" in view_now(VIEW, Wording(terse=True))
    own = replace(VIEW, objects=(replace(PLATE, tag="the blue one", short=""),))
    assert "In view: the blue one\n" in view_now(own, Wording(terse=True))


def test_a_thing_is_told_once_until_it_moves() -> None:
    told = Told(Wording(terse=True))
    assert told.changes(VIEW, AGENT).startswith("New in view:\n- Plate_57 (0.33,-0.60,0.80)")
    assert told.changes(VIEW, AGENT) == ""
    moved = replace(VIEW, objects=(replace(PLATE, position=Vec3(-0.001, 0.0, -0.0)),))
    assert told.changes(moved, AGENT) == "Moved:\n- Plate_57 (0.00,0.00,0.00), 1875 cm3"


@dataclass(frozen=True)
class Letters:
    """A labeling from outside: letters that tell nothing."""

    described: str = "A tag is a letter."

    def tag(self, object_id: int, class_name: str) -> str:
        return f"<{chr(ord('A') + object_id % 26)}{object_id // 26}>"

    short = tag

    def resolve(self, text: str, known: Mapping[int, str]) -> int | None:
        return next((i for i, name in known.items() if self.tag(i, name) == text), None)


def test_a_labeling_from_outside_makes_and_reads_all_tags(engine: BuiltinEngine) -> None:
    config = PerceptionConfig(labeling=Letters())
    server = LocalActionServer(engine, perception=config, resolution=(640, 360))
    tags = [item.tag for item in server.observe().observation.objects]
    assert tags
    assert all(tag.startswith("<") for tag in tags)
    assert "In view: " + ", ".join(tags) in view_now(server._view(), Wording(terse=True))
    result = server.execute(Pick(Letters().tag(57, "Plate")))
    assert result.feedback.outcome is Outcome.DONE
    assert "<F2> is in your hand" in result.feedback.text
    assert server.execute(Pick("57")).feedback.outcome is Outcome.REFUSED
