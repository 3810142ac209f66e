"""Tokens and model calls of an episode under each profile, for the same sequence of actions.

    python benchmarks/tokens.py [--scene s1] [--rule openai] [--task T4 ...] [--json]

The oracle's calls of every task are played through the loop: in `paper` one call a turn with its
note as text; in `lean` with the note as an argument and, where plans are on, as many calls in a
turn as the plan takes, or (`by object`) only what is done with one object, pick and drop. A plan
ends at the first surprise; what was left out is called again in the next turn, so that the actions
are the same everywhere. The notes are the same words everywhere. Tokens are estimated
(docs/tokens.md). `fresh` leaves out what a provider's cache could serve: the messages that the
request shares with the beginning of the one before. The paper's baseline (GPT-4o, S1, SEM) used
32,978 tokens and 4.67 model calls an episode.
"""

from __future__ import annotations

import argparse
import json
import statistics
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import takewhile
from typing import Any

import adamo_vh
from adamo_vh.action import Action, Pick, ToolSchema, action_name
from adamo_vh.action_server import LocalActionServer
from adamo_vh.benchmark.oracle import Oracle
from adamo_vh.benchmark.tasks import TASKS, Task
from adamo_vh.cognition.profile import PROFILES, Profile, profile
from adamo_vh.engine import World
from adamo_vh.inference.cost.tokens import (
    ANTHROPIC,
    GEMINI,
    OPENAI_TILES,
    ImageRule,
    estimate_message,
    estimate_reply,
    estimate_request,
    estimate_tools,
)
from adamo_vh.inference.messages import AIMessage, Message, ToolCall, ToolMessage
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling, Usage
from adamo_vh.perception import PerceptionConfig
from adamo_vh.record.turn import CONFIDENCE, FINISH, NOTE

PAPER_TOKENS, PAPER_CALLS = 32_978, 4.67
RULES: dict[str, ImageRule] = {
    "openai": OPENAI_TILES, "anthropic": ANTHROPIC, "gemini": GEMINI,
}  # fmt: skip
ANSWER = "Everything that was asked is done."
SWITCHES: dict[str, dict[str, Any]] = {
    "state=last": {"state": "last"},
    "state=changes": {"state": "changes"},
    "terse": {"terse": True},
    "fresh_view": {"fresh_view": True},
    "pictures=1": {"pictures": 1},
    "pictures=new": {"pictures": "new"},
    "pictures_in_results": {"pictures_in_results": True},
    "closeups": {"closeups": True},
    "note_argument": {"note_argument": True},
    "finish_check": {"finish_check": True},
    "plan=12": {"plan": 12},
}


class OraclePlayer:
    """Says a known sequence of actions in the way that a profile asks for, and counts tokens."""

    info = ModelInfo("oracle", ModelKind.SCRIPTED)

    def __init__(
        self, actions: Sequence[Action], chosen: Profile, rule: ImageRule, by_object: bool
    ) -> None:
        self._actions = actions
        self._by_object = by_object
        self._profile = chosen
        self._rule = rule
        self._last: list[Message] = []
        self.fresh = 0

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Say the next turn; count what it takes."""
        answered = [m for m in messages if isinstance(m, ToolMessage)]
        executed = len([m for m in answered if not m.text.startswith("Not executed")])
        message = self._say(executed, len(messages))
        pairs = zip(self._last, messages, strict=False)
        shared = len(list(takewhile(lambda pair: pair[0] == pair[1], pairs)))
        # The tools come before the messages, so any shared beginning holds them as well.
        held = sum(estimate_message(m, self._rule) for m in messages[:shared])
        held += estimate_tools(tools, self._rule) if shared else 0
        self._last = list(messages)
        tokens = estimate_request(messages, tools, self._rule)
        self.fresh += tokens - held
        return Reply(message, Usage(tokens, estimate_reply(message), held))

    def _say(self, executed: int, number: int) -> AIMessage:
        turn = self._turn(executed)
        if turn:
            calls = [(action_name(type(a)), asdict(a)) for a in turn]
        elif self._profile.finish_check:
            told = {"asked": "What the user asked for.", "unseen": "Nothing that matters."}
            verified = "Each feedback says done, and the last view shows it."
            calls = [(FINISH, {**told, "verified": verified, "answer": ANSWER})]
        else:
            return AIMessage(ANSWER)
        if not self._profile.note_argument:
            text = " ".join(_note(name, arguments) for name, arguments in calls)
            made = calls
        else:
            text = ""
            made = [(n, {NOTE: _note(n, a), CONFIDENCE: 0.9, **a}) for n, a in calls]
        return AIMessage(
            text, tuple(ToolCall(f"call_{number}_{i}", n, a) for i, (n, a) in enumerate(made))
        )

    def _turn(self, executed: int) -> Sequence[Action]:
        """The next actions, as many as belong into one turn."""
        turn = self._actions[executed : executed + self._profile.plan]
        if self._by_object:
            picks = [i for i, action in enumerate(turn) if i and isinstance(action, Pick)]
            turn = turn[: picks[0]] if picks else turn
        return turn


def _note(name: str, arguments: dict[str, Any]) -> str:
    target = arguments.get("object", "that place")
    return (
        f"The list and the frame show {target}, which is what the instruction means. "
        f"Next I {name.lower()} it where it has to be."
    )


def oracle_actions(engine: World, task: Task) -> list[Action]:
    """What the oracle does, played once without pictures of any size that matters."""
    engine.reset(0)
    server = LocalActionServer(engine, perception=PerceptionConfig(grid=0), resolution=(1920, 1080))
    oracle = Oracle(task.conditions, server.tag, server.body.info)
    actions: list[Action] = []
    server.observe()
    while (action := oracle.next_action(engine.state(), server.seen)) is not None:
        actions.append(action)
        server.execute(action)
    return actions


@dataclass(frozen=True)
class Row:
    """Means over the episodes of a profile."""

    profile: str
    tokens: float
    output: float
    fresh: float
    calls: float
    completion: float


def measure(
    engine: World,
    chosen: Profile,
    plans: dict[str, list[Action]],
    rule: ImageRule,
    by_object: bool = False,
) -> Row:
    """Play every task under a profile."""
    results, fresh = [], []
    for task, actions in plans.items():
        player = OraclePlayer(actions, chosen, rule, by_object)
        results.append(
            adamo_vh.run_episode(
                task=task, scene=engine.scene.name, model=player, profile=chosen, engine=engine
            )
        )
        fresh.append(player.fresh + results[-1].usage.output_tokens)
    return Row(
        f"{chosen}{' by object' if by_object else ''}",
        statistics.mean(r.tokens for r in results),
        statistics.mean(r.usage.output_tokens for r in results),
        statistics.mean(fresh),
        statistics.mean(r.model_calls for r in results),
        statistics.mean(r.completion or 0.0 for r in results),
    )


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--scene", default="s1")
    parser.add_argument("--rule", choices=RULES, default="openai")
    parser.add_argument("--task", action="append", help="only these; all 15 by default")
    parser.add_argument("--profiles-only", action="store_true", help="leave single switches out")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    engine = adamo_vh.create_engine(arguments.scene)
    tasks = [task for task in TASKS if not arguments.task or task.id in arguments.task]
    plans = {task.id: oracle_actions(engine, task) for task in tasks}
    chosen = [PROFILES["paper"], PROFILES["lean"], PROFILES["single"]]
    if not arguments.profiles_only:
        chosen[1:1] = [profile("paper", switches) for switches in SWITCHES.values()]
        chosen += [profile("lean", {"plan": 1}), profile("lean", {"fresh_view": False})]
    rule = RULES[arguments.rule]
    rows = [measure(engine, item, plans, rule) for item in chosen]
    rows.append(measure(engine, PROFILES["lean"], plans, rule, by_object=True))
    engine.close()
    if arguments.json:
        print(json.dumps({"rule": arguments.rule, "rows": [vars(row) for row in rows]}))
        return
    print(f"{'profile':<34} {'tokens':>7} {'ratio':>6} {'output':>7} {'fresh':>7} {'calls':>6}  CR")
    for row in rows:
        print(
            f"{row.profile:<34} {row.tokens:7.0f} {row.tokens / rows[0].tokens:6.2f} "
            f"{row.output:7.0f} {row.fresh:7.0f} {row.calls:6.2f}  {row.completion:.2f}"
        )
    paper = f"{PAPER_TOKENS:7d} {'':6} {'':7} {'':7} {PAPER_CALLS:6.2f}"
    print(f"{'the original (GPT-4o, its paper)':<34} {paper}")


if __name__ == "__main__":
    main()
