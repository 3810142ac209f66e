"""The loop under `lean`: plans, fresh views, doubts, loops and unreadable replies."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import pytest

from adamo_vh.action import ToolSchema
from adamo_vh.action_server import LEAN_TOOLS, LocalActionServer
from adamo_vh.cognition.agent import Agent, AgentConfig
from adamo_vh.cognition.profile import PROFILES, Profile
from adamo_vh.inference.messages import AIMessage, HumanMessage, Message, ToolCall, ToolMessage
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling
from adamo_vh.record.termination import Limits, TerminationReason
from adamo_vh.record.trajectory import Acted, Ended, Observed, Shown, Trajectory
from adamo_vh.runtime.builtin import BuiltinEngine

TERSE = PROFILES["lean"]
LEAN = replace(TERSE, terse=False)


class Player:
    """Answers through a list or a function, and keeps the prompts it was given."""

    info = ModelInfo("player", ModelKind.SCRIPTED)

    def __init__(self, answers: Sequence[Reply] | Callable[[int], Reply]) -> None:
        self.prompts: list[list[Message]] = []
        self._answers = answers

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        self.prompts.append(list(messages))
        number = len(self.prompts) - 1
        if callable(self._answers):
            return self._answers(number)
        return self._answers[number] if number < len(self._answers) else finish()

    def results(self, prompt: int) -> list[ToolMessage]:
        return [m for m in self.prompts[prompt] if isinstance(m, ToolMessage)]


def says(*calls: tuple[str, dict[str, Any]], text: str = "") -> Reply:
    made = tuple(ToolCall(f"{name}{i}", name, args) for i, (name, args) in enumerate(calls))
    return Reply(AIMessage(text, made))


def noted(name: str, confidence: float = 0.9, **arguments: Any) -> tuple[str, dict[str, Any]]:
    return name, {"note": f"I {name}.", "confidence": confidence, **arguments}


def finish(confidence: float = 0.9) -> Reply:
    end = noted("Finish", confidence, asked="a", verified="v", unseen="", answer="It is done.")
    return says(end)


def play(
    engine: BuiltinEngine,
    answers: Sequence[Reply] | Callable[[int], Reply],
    profile: Profile = LEAN,
    limits: Limits | None = None,
) -> tuple[Ended, Trajectory, Player]:
    trajectory, player = Trajectory(), Player(answers)
    server = LocalActionServer(engine, resolution=(640, 360), tools=LEAN_TOOLS)
    config = AgentConfig(profile, limits=limits or Limits())
    agent = Agent(player, server, "rules", config, observers=[trajectory])
    return agent.run("Put the plate on the floor"), trajectory, player


PICK = noted("Pick", object="Plate_57")
DROP = noted("Drop", object="Plate_57", x=-1.5, y=-2.5, z=0.0)
NOWHERE = noted("Pick", object="Ghost_99")


def kinds(trajectory: Trajectory) -> list[str]:
    return [event.type for event in trajectory.events]


def test_a_plan_is_executed_in_one_turn_and_seen_once(engine: BuiltinEngine) -> None:
    ended, trajectory, player = play(engine, [says(PICK, DROP), finish()])
    assert (ended.reason, ended.answer) == (TerminationReason.ANSWERED, "It is done.")
    assert (ended.steps, len(player.prompts)) == (2, 2)
    assert engine.state().object(57).support == "floor"
    assert kinds(trajectory) == [
        "started", "observed", "thought", "acted", "acted", "observed", "thought", "ended",
    ]  # fmt: skip
    first, second = player.results(1)
    assert not first.images
    assert len(second.images) == 1
    assert "Plate_57: center" in second.text


def test_a_plan_stops_at_the_first_surprise(engine: BuiltinEngine) -> None:
    ended, trajectory, player = play(engine, [says(PICK, NOWHERE, DROP), finish()])
    assert [act.name for act in trajectory.acts] == ["Pick", "Pick"]
    texts = [result.text for result in player.results(1)]
    assert texts[1].startswith("Refused")
    assert texts[2].startswith("Not executed: an earlier call of this turn did not go as planned.")
    assert engine.state().body.held == 57
    assert ended.steps == 2


def test_few_words_leave_out_what_was_left_out(engine: BuiltinEngine) -> None:
    _, _, player = play(engine, [says(PICK, NOWHERE, DROP, PICK), finish()], TERSE)
    said = [m for m in player.prompts[1] if isinstance(m, AIMessage)]
    assert [call.arguments for call in said[0].calls] == [PICK[1], NOWHERE[1]]
    results = player.results(1)
    assert len(results) == 2
    assert "The 2 calls after it were not executed: an earlier call" in results[1].text
    kept = replace(says(PICK, NOWHERE, DROP).message, kept="signed")
    _, _, player = play(engine, [Reply(kept), finish()], TERSE)
    assert len(player.results(1)) == 3


def test_a_plan_has_a_length_and_so_has_the_episode(engine: BuiltinEngine) -> None:
    looks = [noted("Look", x=0.1 * i, y=-1.0, z=0.8) for i in range(5)]
    _, trajectory, player = play(engine, [says(*looks)], replace(LEAN, plan=2))
    assert len(trajectory.acts) == 2
    assert "at most 2 actions a turn" in player.results(1)[2].text
    ended, trajectory, _ = play(engine, [says(*looks)], limits=Limits(max_steps=3))
    assert len(trajectory.acts) == 3
    assert ended.reason is TerminationReason.STEP_LIMIT


def test_nothing_new_is_shown_when_nothing_has_changed(engine: BuiltinEngine) -> None:
    _, trajectory, player = play(engine, [says(NOWHERE), finish()])
    assert len([e for e in trajectory.events if isinstance(e, Observed)]) == 1
    assert player.results(1)[0].text.startswith("Refused")
    assert "The view now" not in player.results(1)[0].text


def test_a_doubtful_pick_is_inspected_first_and_once(engine: BuiltinEngine) -> None:
    unsure = noted("Pick", 0.3, object="Plate_57")
    _, trajectory, player = play(engine, [says(unsure), says(unsure), finish()])
    assert [act.name for act in trajectory.acts] == ["Inspect", "Pick"]
    (result,) = player.results(1)
    assert "your confidence of 0.3 is below 0.5" in result.text
    assert len(result.images) == 1
    assert [e.type for e in trajectory.events if isinstance(e, Shown)] == ["shown"]
    assert engine.state().body.held == 57


def test_a_doubtful_end_is_asked_back_once(engine: BuiltinEngine) -> None:
    ended, _, player = play(engine, [finish(0.2), finish(0.2)])
    assert len(player.prompts) == 2
    assert "Not finished yet: your confidence of 0.2" in player.results(1)[0].text
    assert ended.reason is TerminationReason.ANSWERED


def test_an_end_in_prose_is_asked_back_once(engine: BuiltinEngine) -> None:
    ended, _, player = play(engine, [says(text="All done."), says(text="Really.")])
    last = player.prompts[1][-1]
    assert isinstance(last, HumanMessage)
    assert "call Finish" in last.text
    assert (ended.reason, ended.answer) == (TerminationReason.ANSWERED, "Really.")


def test_finish_comes_alone(engine: BuiltinEngine) -> None:
    end = finish().message.calls[0]
    both = Reply(AIMessage("", (*says(PICK).message.calls, end)))
    _, trajectory, player = play(engine, [both, finish()])
    assert [act.name for act in trajectory.acts] == ["Pick"]
    assert "Finish comes alone" in player.results(1)[1].text


@pytest.mark.parametrize("name", ["paper", "lean"])
def test_a_loop_ends_with_its_own_reason(engine: BuiltinEngine, name: str) -> None:
    there, here = (("Look", {"x": x, "y": -1.0, "z": 0.8}) for x in (0.0, 0.4))
    ended, trajectory, _ = play(
        engine, lambda i: says(there if i % 2 else here, text="hm"), PROFILES[name]
    )
    assert ended.reason is TerminationReason.LOOP
    assert len(trajectory.acts) == 7
    ended, _, _ = play(
        engine,
        lambda i: says(there, text="hm"),
        PROFILES[name],
        Limits(max_steps=9, max_repeats=0),
    )
    assert ended.reason is TerminationReason.STEP_LIMIT


def test_looking_again_after_a_change_is_no_loop(engine: BuiltinEngine) -> None:
    look = noted("Look", x=0.0, y=-1.0, z=0.8)
    back = noted("Drop", object="Plate_57", x=-1.5, y=-2.5, z=0.0)
    turns = [says(look), says(look), says(look), says(PICK), says(look), says(back), says(look)]
    ended, _, _ = play(engine, turns)
    assert ended.reason is TerminationReason.ANSWERED


def test_unreadable_replies_are_told_counted_and_end_at_last(engine: BuiltinEngine) -> None:
    odd = Reply(AIMessage("blah"), unreadable="could not be read: there is no Action.")
    ended, trajectory, player = play(engine, [odd, odd, says(PICK), odd, odd, odd])
    assert ended.reason is TerminationReason.PROTOCOL
    assert sum(bool(thought.reply.unreadable) for thought in trajectory.thoughts) == 5
    last = player.prompts[1][-1]
    assert isinstance(last, HumanMessage)
    assert "could not be read: there is no Action." in last.text


def test_only_the_last_view_is_in_the_prompt(engine: BuiltinEngine) -> None:
    looks = [says(noted("Look", x=x, y=-1.0, z=0.8)) for x in (-0.2, 0.0, 0.3)]
    _, trajectory, player = play(engine, looks)
    prompt = player.prompts[-1]
    assert str(prompt).count("The view now") == 1
    assert sum(len(m.images) for m in prompt if isinstance(m, ToolMessage)) == 1
    assert sum(isinstance(event, Observed) for event in trajectory.events) == 4
    assert sum(isinstance(event, Acted) for event in trajectory.events) == 3


def test_a_second_instruction_goes_on_in_the_same_world(engine: BuiltinEngine) -> None:
    player = Player([says(PICK), finish(), says(DROP), finish()])
    server = LocalActionServer(engine, resolution=(640, 360), tools=LEAN_TOOLS)
    trajectory = Trajectory()
    agent = Agent(player, server, "rules", AgentConfig(LEAN), observers=[trajectory])
    first = agent.run("Take the plate")
    second = agent.run("Now put it on the floor")
    assert (first.steps, second.steps) == (1, 1)
    assert engine.state().object(57).support == "floor"
    assert [act.step for act in trajectory.acts] == [1, 2]
    texts = [m.parts[0] for m in player.prompts[-1] if isinstance(m, HumanMessage)]
    assert len(texts) == 2
    assert trajectory.instructions == ["Take the plate", "Now put it on the floor"]


@pytest.mark.parametrize(
    "odd",
    [
        {"confidence": 10**400, "object": "Plate_57"},
        {"confidence": "high", "note": ["a", 1], "object": "Plate_57"},
        {"confidence": None, "note": None, "object": ["Plate_57"]},
        {"confidence": -3, "object": {"tag": "Plate_57"}},
        {"confidence": 0.1},
        {},
        None,
    ],
)
@pytest.mark.parametrize("name", ["Pick", "Inspect", "Survey", "", "Nothing"])
def test_odd_arguments_are_feedback(engine: BuiltinEngine, name: str, odd: Any) -> None:
    ended, _, _ = play(engine, [says((name, odd), (name, odd)), finish()], TERSE)
    assert ended.reason is TerminationReason.ANSWERED


@pytest.mark.parametrize("said", [None, {}, {"answer": ["x"]}, {"answer": 1, "confidence": 9e99}])
def test_an_odd_end_is_asked_back_once(engine: BuiltinEngine, said: Any) -> None:
    odd = says(("Finish", said))
    ended, _, player = play(engine, [odd, odd])
    assert len(player.prompts) == 2
    assert player.results(1)[0].text.startswith("Refused: ")
    assert ended.reason in (TerminationReason.ANSWERED, TerminationReason.EMPTY_REPLY)


def test_replies_that_lead_to_nothing_are_a_loop(engine: BuiltinEngine) -> None:
    both = Reply(AIMessage("", (*finish().message.calls, *says(PICK).message.calls)))
    ended, trajectory, _ = play(engine, lambda _: both)
    assert ended.reason is TerminationReason.LOOP
    assert len(trajectory.thoughts) == Limits().max_repeats


def test_without_the_check_finish_is_no_tool(engine: BuiltinEngine) -> None:
    ended, trajectory, _ = play(
        engine, [finish(), says(text="Done.")], replace(LEAN, finish_check=False)
    )
    assert [act.feedback.code for act in trajectory.acts] == ["unknown_tool"]
    assert ended.answer == "Done."


def test_a_doubtful_pick_out_of_view_is_told_so(engine: BuiltinEngine) -> None:
    away = noted("Look", x=-2.9, y=-1.0, z=1.5)
    unsure = noted("Pick", 0.3, object="57")
    _, trajectory, player = play(engine, [says(away, unsure), says(unsure), finish()])
    assert [act.name for act in trajectory.acts] == ["Look", "Inspect", "Pick"]
    assert "Refused: Plate_57 is not in view now" in player.results(1)[1].text
    assert engine.state().body.held == 57


def test_a_view_that_a_call_brought_is_not_taken_again(engine: BuiltinEngine) -> None:
    look = noted("Look", x=0.0, y=-1.0, z=0.8)
    see = noted("Inspect", object="Plate_57")
    _, trajectory, _ = play(engine, [says(look, see, NOWHERE), finish()])
    assert len([e for e in trajectory.events if isinstance(e, Observed)]) == 2


def test_what_is_asked_back_says_how_to_go_on(engine: BuiltinEngine) -> None:
    odd = Reply(AIMessage("blah"), unreadable="could not be read: there is no Action.")
    _, _, player = play(engine, [Reply(AIMessage("")), odd, finish()])
    told = [m.text for m in player.prompts[-1] if isinstance(m, HumanMessage)][1:]
    assert len(told) == 2
    assert all(text.endswith("call Finish.") and "short note" not in text for text in told)


class Counted:
    """An action server that says which calls reached it: each is a round trip on a wire."""

    def __init__(self, server: LocalActionServer) -> None:
        self.calls: list[str] = []
        self._server = server

    def __getattr__(self, name: str) -> Any:
        part = getattr(self._server, name)
        if callable(part):
            self.calls.append(name)
        return part


@pytest.mark.parametrize(
    ("call", "calls"),
    [
        (PICK, ["execute", "observe"]),
        (noted("Look", x=0.0, y=-1.0, z=0.8), ["execute"]),
        (NOWHERE, ["execute"]),
        (noted("Fly"), ["refuse"]),
    ],
)
def test_an_action_takes_one_round_trip_and_a_fresh_view_another(
    engine: BuiltinEngine, call: tuple[str, dict[str, Any]], calls: list[str]
) -> None:
    server = Counted(LocalActionServer(engine, resolution=(640, 360), tools=LEAN_TOOLS))
    agent = Agent(Player([says(call), finish()]), server, "rules", AgentConfig(LEAN))
    agent.run("Put the plate on the floor")
    assert server.calls == ["observe", *calls, "say"]
