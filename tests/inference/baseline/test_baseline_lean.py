"""The baseline in the lean layout: state as changes, notes as arguments, plans, an explicit end."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from tests.inference.baseline.room import TOOLS, LeanRoom, TextRoom, table_items
from tests.inference.baseline.test_baseline_policy import ENDS, PROMPT, check

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline import BaselineModel
from adamo_vh.inference.baseline.prompt.reading import read_prompt
from adamo_vh.inference.baseline.prompt.speaking import manner_of
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.model import Sampling


@pytest.mark.parametrize("task", ENDS)
@pytest.mark.parametrize("full", [True, False], ids=["full", "paper"])
def test_tasks_are_solved_from_what_changed(task, full):
    room = LeanRoom(PROMPT[task], full=full).run()
    assert check(task, room), room.answer
    assert room.answer.startswith("Done:")


@pytest.mark.parametrize("notes", [True, False])
@pytest.mark.parametrize("finish", [True, False])
@pytest.mark.parametrize("plan", [True, False])
def test_every_switch_alone(notes, finish, plan):
    room = LeanRoom(PROMPT["T9"], notes=notes, finish=finish, plan=plan).run()
    assert check("T9", room), room.answer
    assert bool(room.finished) == finish


def test_the_end_says_what_was_asked_and_what_is_known():
    room = LeanRoom("Pick the plate").run()
    assert room.finished["asked"] == "Pick the plate"
    assert "Plate_57" in str(room.finished["verified"])
    assert room.finished["unseen"]
    assert float(str(room.finished["confidence"])) > 0.9


def test_a_plan_takes_fewer_turns_for_the_same_end():
    planned, single = (LeanRoom(PROMPT["T8"], plan=plan).run() for plan in (True, False))
    assert (planned.turns, single.turns) == (2, 5)
    assert check("T8", planned)
    assert check("T8", single)


def test_notes_are_short():
    assert _note_length(LeanRoom(PROMPT["T8"]).run()) < 700
    assert _note_length(TextRoom(PROMPT["T8"]).run()) < 1100


def _note_length(room: TextRoom) -> int:
    messages = room.told if isinstance(room, LeanRoom) else [m for s in room.steps for m in s]
    own = [message for message in messages if isinstance(message, AIMessage)]
    notes = [str((call.arguments or {}).get("note", "")) for m in own for call in m.calls]
    return sum(map(len, notes)) + sum(len(message.text) for message in own)


def test_after_a_surprise_it_plans_anew():
    class Occupied(LeanRoom):
        left: int = 1

        def _drop(self, tag: str, point: Vec3) -> str:
            if self.left:
                self.left -= 1
                return "Refused: no free, supported spot within 0.5 m of that point."
            return super()._drop(tag, point)

    room = Occupied(PROMPT["T8"]).run()
    assert check("T8", room), room.answer
    texts = [m.text for m in room.told if isinstance(m, ToolMessage)]
    assert any(text.startswith("Not executed") for text in texts)


def test_what_left_the_view_is_still_known():
    items = table_items()
    items["Cup_45"] = replace(
        items["Cup_45"], position=Vec3(-2.5, 2.0, 0.07), support="on the floor"
    )
    room = LeanRoom("Put the cup near the plate", items=items).run()
    assert room.near("Cup_45", "Plate_57")


def test_the_next_instruction_goes_on_in_the_same_world():
    room = LeanRoom("Put the plate on the floor").run()
    room.told.append(HumanMessage((TextPart("Now pick the plate"), TextPart(room._view()))))
    room.run()
    assert room.held == "Plate_57"


def _reply(messages: list[Message], room: LeanRoom) -> AIMessage:
    return BaselineModel().complete(messages, room.tools, Sampling()).message


def test_a_doubted_end_is_said_again():
    room = LeanRoom("Pick the plate").run()
    last = _reply(room.messages(), room)
    told = [*room.messages(), last, ToolMessage(last.calls[0].id, "Finish", "Not finished yet: x")]
    assert _reply(told, room).calls[0].name == "Finish"


def test_arguments_can_be_sent_as_json():
    room = LeanRoom(PROMPT["T12"]).run()
    for message in room.told:
        if isinstance(message, AIMessage):
            json.dumps([dict(call.arguments or {}) for call in message.calls], allow_nan=False)


def test_how_to_speak_shows_in_tools_and_instructions():
    manner = manner_of([SystemMessage("You may make several calls in one turn, up to 5, when")], [])
    assert manner.plan == 5
    room = LeanRoom("x")
    assert manner_of(room.messages(), room.tools).notes >= {"Pick", "Finish"}
    assert manner_of([SystemMessage("call exactly one tool")], TOOLS).plan == 1


def _image(data: bytes) -> ImagePart:
    return ImagePart(data, "image/jpeg", 8, 8)


def test_a_close_up_is_not_taken_for_the_view():
    messages: list[Message] = [
        HumanMessage((TextPart("Pick it"), TextPart("# The view now\nIn view: 4"), _image(b"1"))),
        AIMessage("", (ToolCall("1", "Inspect", {"object": "4"}),)),
        ToolMessage("1", "Inspect", "Done: 4 close up.", (_image(b"2"),)),
        AIMessage("", (ToolCall("2", "Pick", {"object": "4"}),)),
        ToolMessage("2", "Pick", "Not executed: your confidence is low.", (_image(b"3"),)),
    ]
    prompt = read_prompt(messages)
    assert prompt.frame == _image(b"1")
    assert not prompt.fresh
    assert [event.pictures for turn in prompt.turns for event in turn.events] == [
        (_image(b"2"),),
        (_image(b"3"),),
    ]
    assert prompt.event is not None
    assert prompt.event.name == "Inspect"


def test_a_view_inside_a_result_is_the_newest():
    view = "Done: looking.\n\nNew in view:\n- Cup_1: center (1.000, 2.000, 0.500), volume 9.0 cm3\n"
    view += "You: position (1.00, 0.00, 0.00), heading 90 deg, gaze (1.00, 2.00, 0.80), hand: empty"
    view += "\n\n# The view now\nIn view: Cup_1 [1, 2, 3, 4]\nReference points: P0 (1.0, 2.0, 0.0)"
    messages: list[Message] = [
        HumanMessage((TextPart("Pick the cup"), _image(b"1"))),
        AIMessage("", (ToolCall("1", "Look", {"x": 1}),)),
        ToolMessage("1", "Look", view, (_image(b"2"),)),
    ]
    prompt = read_prompt(messages)
    assert prompt.frame == _image(b"2")
    assert prompt.fresh
    assert prompt.things[0].box_px == (1, 2, 3, 4)
    assert prompt.points == (Vec3(1.0, 2.0, 0.0),)
    assert prompt.body.gaze == Vec3(1.0, 2.0, 0.8)
    assert prompt.body.hand == "empty"
    assert prompt.turns[0].events[0].text == "Done: looking."


def test_few_words_tell_the_same():
    view = "New in view:\n- Cup_45 (-0.42,-0.35,0.85), 2049 cm3\n- 7 (1.00,2.00,0.05), 3 cm3\n"
    view += "You: position (-2.00, -1.00, 0.00), heading 0 deg, hand: empty\n\n# The view now\n"
    view += "In view: 45, 7\nReference points: P0 (0.34,0.95,0.00), P1 (1.44,1.77,0.00)"
    prompt = read_prompt([HumanMessage((TextPart("Pick the cup"), TextPart(view), _image(b"1")))])
    assert [thing.tag for thing in prompt.things] == ["Cup_45", "7"]
    assert [thing.volume_cm3 for thing in prompt.things] == [2049.0, 3.0]
    assert prompt.things[0].position == Vec3(-0.42, -0.35, 0.85)
    assert len(prompt.points) == 2
