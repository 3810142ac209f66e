"""Profiles: names, switches, and what the model is offered and told under them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh import run_episode
from adamo_vh.action import Drop, Inspect, Look, Pick, Survey, ToolSchema, Walk
from adamo_vh.action_server import LEAN_TOOLS, PAPER_TOOLS
from adamo_vh.benchmark.conditions import NEAR_M
from adamo_vh.cognition.instructions import system_prompt
from adamo_vh.cognition.profile import (
    PAPER,
    PROFILES,
    SWITCHES,
    BufferUnit,
    Profile,
    StateText,
    profile,
    told_without,
)
from adamo_vh.cognition.turns import offered, read_turn
from adamo_vh.errors import ConfigError
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.model import ModelInfo, Reply, Rung, Sampling
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.inference.remote.capabilities import Capabilities, Support, ToolSupport
from adamo_vh.perception import Labeling
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.turn import FINISH
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.scenes import load_scene
from adamo_vh.session.minds import fitting

LEAN = PROFILES["lean"]
BODY = (Look, Walk, Pick, Drop)
EVERY_SWITCH: dict[str, tuple[Any, ...]] = {
    "state": tuple(StateText),
    "terse": (True, False),
    "fresh_view": (True, False),
    "pictures": (0, 1, 2, "new", "none"),
    "pictures_in_results": (True, False),
    "closeups": (True, False),
    "note_argument": (True, False),
    "min_confidence": (0.0,),
    "finish_check": (True, False),
    "plan": (1, 4),
    "buffer_unit": tuple(BufferUnit),
    "exact_sampling": (True, False),
}


def test_the_papers_protocol_is_the_default() -> None:
    assert profile("paper") == Profile() == PAPER
    assert str(PAPER) == "paper"


def test_switches_are_read_and_named() -> None:
    chosen = profile("lean", {"plan": "1", "fresh-view": "off", "state": "last"})
    assert (chosen.plan, chosen.fresh_view, chosen.state) == (1, False, StateText.LAST)
    assert str(chosen) == "lean (state=last, fresh_view=off, plan=1)"
    assert str(profile("paper", {"pictures": 2})) == "paper (pictures=2)"
    assert str(profile("paper", {"pictures": "none"})) == "paper (pictures=none)"
    assert str(profile("paper", {"state": "none"})) == "paper (state=none)"


def test_a_switch_that_is_told_elsewhere_is_left_out() -> None:
    assert told_without("lean (state=last, plan=1)", {"plan"}) == "lean (state=last)"
    assert told_without("lean (plan=1)", {"plan", "terse"}) == "lean"
    assert told_without("paper", {"plan"}) == "paper"


def test_without_pictures_there_are_no_close_ups_either() -> None:
    chosen = profile("lean", {"pictures": "none"})
    assert str(chosen) == "lean (pictures=none, closeups=off, min_confidence=0.0)"
    assert chosen == LEAN.without_pictures()


def test_a_switch_that_confidence_rests_on_takes_it_along() -> None:
    assert profile("lean", {"closeups": "off"}).min_confidence == 0
    assert profile("lean", {"note_argument": "off"}).min_confidence == 0


@pytest.mark.parametrize(
    ("name", "switches", "told"),
    [
        ("slim", {}, "paper, paper-exact, lean, single"),
        ("lean", {"plans": 3}, "Switches: state, terse"),
        ("lean", {"plan": "many"}, "a number"),
        ("lean", {"plan": 0}, "at least 1"),
        ("lean", {"closeups": "maybe"}, "on or off"),
        ("paper", {"state": "middle"}, "first, last, changes, none"),
        ("paper", {"pictures": "some"}, "a number, new or none"),
        ("paper", {"pictures": -1}, "at least 0, new or none"),
        ("paper", {"pictures": "none", "state": "none"}, "would see nothing"),
        ("paper", {"pictures": "new", "state": "none"}, "set pictures=1"),
        ("lean", {"pictures": "none", "closeups": "on"}, "closeups are pictures"),
        ("paper", {"min_confidence": 0.5}, "needs note_argument"),
    ],
)
def test_what_is_wrong_is_refused(name: str, switches: dict[str, Any], told: str) -> None:
    with pytest.raises(ConfigError, match=told):
        profile(name, switches)


def test_every_switch_is_covered_here() -> None:
    assert set(EVERY_SWITCH) == set(SWITCHES)


def is_possible(switches: dict[str, Any]) -> bool:
    """Whether something is shown, and close-ups only where there are pictures."""
    if switches["pictures"] == "new":
        return switches["state"] is not StateText.NONE
    if switches["pictures"] != "none":
        return True
    return switches["state"] is not StateText.NONE and not switches["closeups"]


profiles = (
    st.fixed_dictionaries({k: st.sampled_from(v) for k, v in EVERY_SWITCH.items()})
    .filter(is_possible)
    .map(lambda switches: Profile("own", **switches))
)


@given(profiles)
def test_the_prompt_says_what_is_on_and_nothing_else(chosen: Profile) -> None:
    actions = (*BODY, Inspect, Survey) if chosen.closeups else BODY
    text = system_prompt(load_scene("s1").info(), Labeling.SEM, actions, NEAR_M, chosen)
    assert ("several calls" in text) == (chosen.plan > 1)
    assert ("exactly one tool" in text) == (chosen.plan == 1)
    assert ("Inspect shows" in text) == chosen.closeups
    assert ("Tools: Look(x, y, z)" in text) != chosen.terse
    assert ("call Finish" in text) == chosen.finish_check
    assert ("no tool call. That ends" in text) != chosen.finish_check
    assert ("Every tool takes a note" in text) == chosen.note_argument
    assert ("short reasoning note" in text) != chosen.note_argument
    assert ("only after Look" in text) != chosen.fresh_view
    whole = chosen.state in (StateText.FIRST, StateText.LAST)
    assert ("symbolic state" in text.lower()) == whole
    assert ("view as text" in text) == (chosen.state is not StateText.NONE)
    assert ("coordinates you are told" in text) == (chosen.state is not StateText.NONE)
    assert (" list" in text) == (chosen.state is not StateText.NONE)
    assert ("frame from your eyes" in text) == chosen.has_pictures
    assert ("You get no pictures" in text) != chosen.has_pictures
    if not chosen.has_pictures:
        assert "new frame" not in text and "latest picture" not in text
    assert "\n\n\n" not in text
    assert "{" not in text


@given(profiles)
def test_the_tools_ask_for_what_is_on(chosen: Profile) -> None:
    tools = {tool.name: tool for tool in offered((*BODY, Inspect, Survey), chosen)}
    assert (FINISH in tools) == chosen.finish_check
    for tool in tools.values():
        required = tool.parameters.get("required", [])
        assert (required[:2] == ["note", "confidence"]) == chosen.note_argument
        assert set(required) <= set(tool.parameters["properties"])


def reply(*calls: tuple[str, Any], text: str = "") -> Reply:
    made = tuple(ToolCall(f"c{i}", name, args) for i, (name, args) in enumerate(calls))
    return Reply(AIMessage(text, made))


def test_notes_are_taken_out_of_the_arguments() -> None:
    said = reply(("Pick", {"note": "I see it.", "confidence": 0.9, "object": "57"}))
    turn = read_turn(said, LEAN)
    (wish,) = turn.wishes
    assert (wish.arguments, wish.note, wish.confidence) == ({"object": "57"}, "I see it.", 0.9)
    assert read_turn(said, LEAN).note == "I see it."
    assert read_turn(said, PAPER).wishes[0].arguments == said.message.calls[0].arguments


@pytest.mark.parametrize("odd", [{"note": 3}, {"confidence": "high"}, {"confidence": True}, {}])
def test_an_odd_note_does_no_harm(odd: dict[str, Any]) -> None:
    turn = read_turn(reply(("Pick", {**odd, "object": "57"})), LEAN)
    assert turn.wishes[0].arguments == {"object": "57"}
    assert turn.wishes[0].note == ""
    assert turn.wishes[0].confidence is None


def test_what_ends_an_episode() -> None:
    finish = {"note": "n", "asked": "a", "verified": "v", "unseen": "", "answer": "It is done."}
    turn = read_turn(reply((FINISH, finish)), LEAN)
    assert turn.ends
    assert (turn.answer, turn.stop.reason) == ("It is done.", TerminationReason.ANSWERED)
    assert read_turn(reply(text="Done."), PAPER).ends
    assert not read_turn(reply(("Look", {}), (FINISH, finish)), LEAN).ends
    assert read_turn(reply(), PAPER).stop.reason is TerminationReason.EMPTY_REPLY
    assert not read_turn(replace(reply(text="Hm"), unreadable="no action"), PAPER).ends


def test_a_number_of_any_size_is_a_confidence() -> None:
    said = [reply(("Pick", {"confidence": value})) for value in (10**400, -3, 0.25)]
    assert [read_turn(r, LEAN).wishes[0].confidence for r in said] == [1.0, 0.0, 0.25]


def test_without_the_tools_for_close_ups_there_are_none() -> None:
    player = ScriptedModel("s", ())
    assert fitting(LEAN, player, PAPER_TOOLS) == profile("lean", {"closeups": False})
    assert fitting(LEAN, player, LEAN_TOOLS) == fitting(LEAN, player) == LEAN


class Blind(ScriptedModel):
    """A model that a probe found to see no pictures."""

    sight = Support.NO
    several = Support.UNTESTED

    @property
    def info(self) -> ModelInfo:
        found = Capabilities(
            "openai:m", Rung.NATIVE, ToolSupport.NATIVE, Support.YES, self.sight, Support.UNTESTED
        )
        found = replace(found, several_pictures=self.several)
        return replace(super().info, capabilities=found)


def test_a_model_that_sees_no_pictures_is_shown_none() -> None:
    blind = Blind("b", ())
    assert fitting(LEAN, blind) == profile("lean", {"pictures": "none"})
    assert fitting(PAPER, blind) == profile("paper", {"pictures": "none"})
    with pytest.raises(ConfigError, match="leave state=none out"):
        fitting(profile("paper", {"state": "none"}), blind)
    blind.sight = Support.UNKNOWN
    assert fitting(PAPER, blind) == PAPER


@pytest.mark.parametrize(
    ("name", "switches"),
    [
        ("paper", {"pictures": "1"}),
        ("lean", {"closeups": "off", "min_confidence": "0"}),
        ("single", {"closeups": "off", "min_confidence": "0"}),
    ],
)
def test_a_server_that_takes_one_picture_a_prompt_is_sent_one(
    name: str, switches: dict[str, str]
) -> None:
    narrow = Blind("n", ())
    narrow.sight, narrow.several = Support.YES, Support.REFUSED
    assert fitting(profile(name, {}), narrow) == profile(name, switches)
    narrow.several = Support.UNKNOWN
    assert fitting(profile(name, {}), narrow) == profile(name, {})


@pytest.mark.parametrize("name", ["paper", "lean"])
@pytest.mark.parametrize(
    ("switches", "sees", "reads"),
    [({"pictures": "none"}, False, True), ({"state": "none"}, True, False), ({}, True, True)],
)
def test_an_episode_shows_what_is_on_alone(
    name: str, switches: dict[str, str], sees: bool, reads: bool, engine: BuiltinEngine
) -> None:
    prompts: list[Sequence[Message]] = []

    class Listener(ScriptedModel):
        def complete(
            self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
        ) -> Reply:
            prompts.append(messages)
            return super().complete(messages, tools, sampling)

    look = ToolCall("a", "Look", {"x": 0.3, "y": -0.6, "z": 0.8})
    pick = ToolCall("b", "Pick", {"object": "57"})
    run_episode(
        "Pick object 57.",
        model=Listener("s", [AIMessage("n", (look,)), AIMessage("n", (pick,)), AIMessage("Done.")]),
        engine=engine,
        resolution=(640, 360),
        profile=name,
        switches=switches,
    )
    parts = [part for m in prompts[-1] if isinstance(m, HumanMessage) for part in m.parts]
    images = [m.images for m in prompts[-1] if isinstance(m, ToolMessage)]
    assert (any(isinstance(part, ImagePart) for part in parts) or any(images)) == sees
    words = "\n".join(m.text for m in prompts[-1])
    assert ("cm3" in words) == reads
    assert ("P0" in words.partition("# How you act")[2]) == reads
    assert ("] px" in words) == (sees and reads and name == "paper")
    if not sees:
        assert "picture" not in words.replace("You get no pictures", "").lower()
