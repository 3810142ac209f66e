"""The baseline carries instructions out, step by step, from the messages alone."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.inference.baseline.room import TOOLS, Item, TextRoom, table_items

from adamo_vh.action import Drop, Look, Pick, Walk, parse
from adamo_vh.benchmark.tasks import TASKS
from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline import BaselineModel
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    Message,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.model import ModelKind, Sampling

PROMPT = {task.id: task.prompt for task in TASKS}


# Per task: what is held, what alone lies on the floor, what stands near what.
ENDS: dict[str, tuple[str, set[str], list[tuple[str, str]]]] = {
    "T1": ("34", set(), []),
    "T2": ("57", set(), []),
    "T3": ("4", set(), []),
    "T4": ("", {"57"}, []),
    "T5": ("", set(), [("4", "50")]),
    "T6": ("", {"34"}, []),
    "T7": ("", {"2"}, []),
    "T8": ("", {"37", "57"}, []),
    "T9": ("", set(), [("37", "57"), ("30", "3")]),
    "T10": ("", set(), [("37", "57"), ("21", "5")]),
    "T11": ("", set(), [("4", "50"), ("37", "57")]),
    "T12": ("", {"45", "8", "20"}, []),
    "T13": ("", set(), [("19", "50"), ("21", "5")]),
}


def check(task: str, room: TextRoom) -> bool:
    """Whether a task ended as it should in the text room."""
    held, floor, pairs = ENDS[task]
    tags = {tag.rsplit("_", 1)[-1]: tag for tag in room.items}
    return (
        (room.held or "").rsplit("_", 1)[-1] == held
        and room.on_floor() == floor
        and all(room.near(tags[one], tags[other]) for one, other in pairs)
    )


@pytest.mark.parametrize("task", ENDS)
@pytest.mark.parametrize("full", [True, False], ids=["full", "paper"])
def test_tasks_are_solved_from_the_text_alone(task, full):
    room = TextRoom(PROMPT[task], full=full).run()
    assert check(task, room), room.answer
    assert room.answer.startswith("Done:")


@pytest.mark.parametrize("k", [1, 2, 4])
@pytest.mark.parametrize("task", ["T6", "T9", "T12", "T14"])
def test_a_short_memory_changes_nothing(task, k):
    whole, cut = TextRoom(PROMPT[task]).run(), TextRoom(PROMPT[task], k=k).run()
    assert cut.calls == whole.calls
    assert cut.answer == whole.answer


@pytest.mark.parametrize("task", ["T1", "T9"])
def test_opaque_tags_are_enough_where_only_ids_count(task):
    items = table_items(opaque=True)
    text = PROMPT[task].replace("the plate", "object 57")
    assert check(task, TextRoom(text, items=items).run())


def test_the_same_messages_give_the_same_reply():
    room = TextRoom(PROMPT["T10"]).run()
    del room.steps[2:]
    first, again = (
        BaselineModel().complete(room.messages(), TOOLS, Sampling()).message for _ in range(2)
    )
    assert first == again
    assert first.calls


def test_notes_have_evidence_conclusion_and_next_step():
    room = TextRoom(PROMPT["T8"]).run()
    for step in room.steps:
        assert isinstance(step[0], AIMessage)
        for word in ("Evidence:", "Conclusion:", "Next:", "(Memory, step "):
            assert word in step[0].text


def test_it_looks_round_for_what_it_does_not_see():
    room = TextRoom("Pick the plate", heading_rad=3.1).run()
    assert room.held == "Plate_57"
    assert {name for name, _ in room.calls[:-1]} == {"Look"}


def test_it_remembers_what_it_saw_before_it_turned():
    items = table_items()
    items["Plant_99"] = Item("Cup_99", Vec3(-2.5, 2.0, 0.07), 2000.0, 0.13, "on the floor")
    items["Cup_99"] = items.pop("Plant_99")
    del items["Cup_45"]
    room = TextRoom("Put the cup near the plate", items=items).run()
    assert room.near("Cup_99", "Plate_57")


def test_a_corner_is_an_area_of_one_metre():
    p = TextRoom(PROMPT["T7"]).run().items["Flashlight_2"].position
    assert abs(p.x) >= 2
    assert p.y >= 2 or p.y <= -4


def test_it_says_so_when_the_thing_is_nowhere():
    items = table_items()
    del items["Plate_57"]
    room = TextRoom("Put the glass on the floor and pick the plate", items=items).run()
    assert room.on_floor() == {"37"}
    assert "found no plate" in room.answer
    assert any(name == "Walk" for name, _ in room.calls)


def test_it_says_so_when_it_does_not_understand():
    room = TextRoom("Juggle with the plates").run()
    assert room.calls == []
    assert "juggle" in room.answer
    assert "did nothing" in room.answer


def test_one_hand_holds_one_thing():
    room = TextRoom("Pick the plate and the cup").run()
    assert room.held == "Plate_57"
    assert "I did not take Cup_45" in room.answer
    assert "one thing only" in room.answer


def test_superlatives_compare_within_a_class():
    assert TextRoom("Pick the smaller battery").run().held == "Battery_30"
    assert TextRoom("Pick the larger battery").run().held == "Battery_3"


def test_two_of_a_kind_can_be_brought_together():
    room = TextRoom("Put the smaller battery near the larger battery").run()
    assert room.near("Battery_30", "Battery_3")


class _Stubborn(TextRoom):
    """Refuses or misplaces a number of times."""

    refuse: int = 0
    misplace: int = 0

    def _drop(self, tag: str, point: Vec3) -> str:
        if self.refuse > 0:
            self.refuse -= 1
            return "Refused: no free, supported spot within 0.5 m of that point."
        if self.misplace > 0:
            self.misplace -= 1
            item = self.items[tag]
            rest = Vec3(-0.2, -0.2, 0.78 + item.height_m / 2)
            self.items[tag] = replace(item, position=rest)
            self.held = None
            return (
                f"Corrected: the very point was not free or not supported; {tag} rests at {rest} "
                "on the table, 0.48 m from it."
            )
        return super()._drop(tag, point)


@pytest.mark.parametrize(("refuse", "misplace"), [(1, 0), (0, 1), (1, 1)])
def test_it_tries_another_spot(refuse, misplace):
    room = _Stubborn(PROMPT["T5"])
    room.refuse, room.misplace = refuse, misplace
    room.run()
    assert check("T5", room), room.answer
    drops = [arguments for name, arguments in room.calls if name == "Drop"]
    assert len(drops) == refuse + misplace + 1
    assert drops[0] != drops[-1]


def test_it_gives_up_in_the_end_and_says_so():
    room = _Stubborn(PROMPT["T11"])
    room.refuse = 1000
    room.run()
    assert "Not done" in room.answer
    assert "Tape_4" in room.answer


def test_every_call_is_valid():
    for task in TASKS:
        for name, arguments in TextRoom(task.prompt).run().calls:
            parse(name, arguments, (Look, Walk, Pick, Drop))


def test_it_is_a_rule_based_model():
    model = BaselineModel()
    assert (model.info.name, model.info.kind) == ("baseline", ModelKind.RULE_BASED)


def test_without_the_tool_it_ends():
    room = TextRoom("Pick the plate")
    message = BaselineModel().complete(room.messages(), TOOLS[:2], Sampling()).message
    assert not message.calls
    assert "Pick" in message.text


def test_an_empty_prompt_is_answered():
    assert BaselineModel().complete([], TOOLS, Sampling()).message.text


_TEXT = st.text(max_size=120)


@settings(max_examples=200, deadline=None)
@given(_TEXT, _TEXT, _TEXT, _TEXT, _TEXT)
def test_no_text_crashes_it(system, state, instruction, note, feedback):
    messages: list[Message] = [
        SystemMessage(system),
        SystemMessage("## Visible objects\n" + state + "\n## You\n" + feedback),
        HumanMessage((TextPart("Pick the plate " + instruction),)),
        AIMessage("Memory: " + note, (ToolCall("1", "Drop", {"object": note}),)),
        ToolMessage("1", "Drop", feedback),
    ]
    reply = BaselineModel().complete(messages, TOOLS, Sampling())
    assert reply.message.text


_LINES = st.lists(
    st.sampled_from(
        [
            "looked 2 times", "hand Plate_57", "hand empty", "goal 1: Plate_57 todo",
            "goal 1: Plate_57 done", "goal 1: Cup_45 failed (tries 4)", "goal 9: X todo",
            "goal 1 = Plate_57 0.90, Cup_45 0.30", "place 1 = Nothing_1 0.90",
            "Plate_57 at (0.100, 0.200, 0.300), 5.0 cm3, 0.1 m wide, 0.1 m high (moved)",
        ]
    ),
    max_size=6,
)  # fmt: skip
_CALLS = st.tuples(
    st.sampled_from(["Look", "Walk", "Pick", "Drop", "Wave"]),
    st.sampled_from([None, {}, {"object": "Plate_57"}, {"object": 5}]),
    st.sampled_from(
        ["", "Done", "Done: Plate_57 is in your hand.", "Refused: your hand is empty.",
         "Done: Plate_57 rests at (0.00, 0.10, 0.20) on the floor.",
         "Corrected: rests at (bad) nowhere", "Refused: your hand already holds Cup_45; drop"]
    ),
)  # fmt: skip


@settings(max_examples=200, deadline=None)
@given(_LINES, _CALLS, st.sampled_from([PROMPT["T4"], PROMPT["T10"], PROMPT["T14"]]))
def test_no_memory_crashes_it(lines, call, instruction):
    name, arguments, feedback = call
    room = TextRoom(instruction)
    message = AIMessage("Memory: " + "; ".join(lines) + ".", (ToolCall("1", name, arguments),))
    room.steps.append((message, ToolMessage("1", name, feedback)))
    reply = BaselineModel().complete(room.messages(), TOOLS, Sampling())
    assert reply.message.text
