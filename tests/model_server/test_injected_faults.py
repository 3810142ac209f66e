"""Faults on purpose: the file that names them, and what each does to an episode over a socket."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import httpx
import pytest

import adamo_vh
from adamo_vh.action import Code
from adamo_vh.episode.result import EpisodeResult
from adamo_vh.errors import ConfigError
from adamo_vh.inference.ladder import Ladder
from adamo_vh.inference.model import Rung
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.retry import RetryPolicy
from adamo_vh.model_server.fault_rules import Faults, Rule, What, load_faults
from adamo_vh.model_server.model_serving import serve_model
from adamo_vh.model_server.openai_endpoint import Served
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import Trajectory
from adamo_vh.runtime.builtin import BuiltinEngine

QUICK = RetryPolicy(max_tries=3, max_wait_s=5.0, base_s=0.01, timeout_s=0.5)
SMALL = (640, 360)


def faults(what: What, *, every: int | None = None, **settings: Any) -> Faults:
    """A fault of the second request, or of every so many."""
    when: dict[str, Any] = {"requests": (2,)} if every is None else {"every": every}
    return Faults(fault=(Rule(what=what, **when, **settings),))


def play(
    engine: BuiltinEngine,
    rules: Faults,
    *,
    task: str = "T4",
    tools: bool = True,
    rung: Rung = Rung.NATIVE,
) -> tuple[EpisodeResult, Trajectory, list[Served]]:
    trajectory, seen = Trajectory(), list[Served]()
    with serve_model("baseline", tools=tools, faults=rules, watch=seen.append) as served:
        inner = ProviderModel(served.uri, QUICK)
        result = adamo_vh.run_episode(
            task=task,
            model=Ladder(inner, rung),
            engine=engine,
            resolution=SMALL,
            observers=[trajectory],
        )
        inner.close()
        return result, trajectory, seen


@pytest.fixture(scope="module")
def undisturbed(s1_engine: BuiltinEngine) -> EpisodeResult:
    s1_engine.reset(0)
    result = adamo_vh.run_episode(task="T4", engine=s1_engine, resolution=SMALL)
    assert (result.completion, result.steps) == (1.0, 2)
    return result


@pytest.mark.parametrize(
    ("what", "settings"),
    [
        (What.ERROR, {"status": 429, "retry_after_s": 1}),
        (What.ERROR, {"status": 500}),
        (What.ERROR, {"status": 503}),
        (What.ERROR_IN_200, {}),
        (What.HANG, {"seconds": 0.1}),
        (What.HANG, {"seconds": 60}),
        (What.RESET, {}),
        (What.HALF_BODY, {}),
        (What.BAD_JSON, {}),
    ],
)
def test_a_passing_fault_is_tried_again_and_changes_nothing(
    engine: BuiltinEngine, undisturbed: EpisodeResult, what: What, settings: dict[str, Any]
) -> None:
    result, trajectory, seen = play(engine, faults(what, **settings))
    assert (result.completion, result.state_hash) == (1.0, undisturbed.state_hash)
    assert [one.text.startswith("fault: ") for one in seen] == [False, True, False, False]
    assert seen[1].status == settings.get("status", seen[1].status)
    if "retry_after_s" in settings:
        assert trajectory.thoughts[1].reply.waited_s >= 1


@pytest.mark.parametrize(
    ("what", "settings"),
    [
        (What.ERROR, {"status": 401}),
        (What.ERROR, {"status": 503}),
        (What.ERROR_IN_200, {}),
        (What.RESET, {}),
        (What.BAD_JSON, {}),
    ],
)
def test_a_lasting_fault_leaves_the_episode_unscored(
    engine: BuiltinEngine, what: What, settings: dict[str, Any]
) -> None:
    result, _, _ = play(engine, faults(what, every=1, **settings))
    assert result.termination is TerminationReason.BROKEN
    assert result.completion is None


@pytest.mark.parametrize(
    ("what", "code"),
    [
        (What.UNKNOWN_TOOL, Code.UNKNOWN_TOOL),
        (What.WRONG_ARGUMENTS, Code.BAD_ARGUMENT),
        (What.BROKEN_ARGUMENTS, Code.BAD_ARGUMENT),
    ],
)
def test_a_wrong_call_becomes_feedback_and_the_episode_goes_on(
    engine: BuiltinEngine, what: What, code: Code
) -> None:
    result, trajectory, _ = play(engine, faults(what))
    assert [act.feedback.code for act in trajectory.acts][1] == code
    assert result.termination is TerminationReason.ANSWERED
    assert result.completion is not None
    assert len(trajectory.acts) > 2


def test_of_two_calls_one_is_executed(engine: BuiltinEngine, undisturbed: EpisodeResult) -> None:
    result, trajectory, _ = play(engine, faults(What.TWO_CALLS))
    assert [len(t.turn.wishes) for t in trajectory.thoughts] == [1, 2, 0]
    assert result.state_hash == undisturbed.state_hash


@pytest.mark.parametrize("style", ["fence", "tags", "bare"])
def test_a_leaked_call_is_found(
    engine: BuiltinEngine, undisturbed: EpisodeResult, style: str
) -> None:
    result, _, _ = play(engine, faults(What.LEAKED_CALL, style=style))
    assert result.state_hash == undisturbed.state_hash


def test_an_empty_reply_is_nudged(engine: BuiltinEngine, undisturbed: EpisodeResult) -> None:
    result, trajectory, _ = play(engine, faults(What.EMPTY_REPLY))
    assert len(trajectory.thoughts) == 4
    assert result.state_hash == undisturbed.state_hash


def test_a_slow_answer_is_the_same_answer(
    engine: BuiltinEngine, undisturbed: EpisodeResult
) -> None:
    result, trajectory, _ = play(engine, faults(What.SLOW, seconds=0.2))
    assert result.state_hash == undisturbed.state_hash
    assert trajectory.thoughts[1].reply.seconds >= 0.2


def test_a_refused_parameter_is_left_out(engine: BuiltinEngine, undisturbed: EpisodeResult) -> None:
    rules = faults(What.REFUSED_PARAMETER, every=1, parameter="temperature")
    result, _, seen = play(engine, rules)
    assert result.state_hash == undisturbed.state_hash
    assert [one.status for one in seen] == [400, 200, 200, 200]


@pytest.mark.parametrize("rung", [Rung.SCHEMA, Rung.REACT])
@pytest.mark.parametrize("what", [What.EMPTY_REPLY, What.LEAKED_CALL, What.BROKEN_ARGUMENTS])
def test_without_tools_an_unreadable_step_is_repaired(
    engine: BuiltinEngine, undisturbed: EpisodeResult, what: What, rung: Rung
) -> None:
    result, trajectory, _ = play(engine, faults(what), tools=False, rung=rung)
    assert result.state_hash == undisturbed.state_hash
    assert len(trajectory.thoughts) == 3  # the repair is no turn of its own


def test_pictures_can_be_refused(engine: BuiltinEngine) -> None:
    rules = faults(What.REFUSED_PARAMETER, every=1, parameter="image_url")
    result, _, seen = play(engine, rules)
    assert result.termination is TerminationReason.BROKEN
    assert "image_url" in result.answer
    assert [one.status for one in seen] == [400, 200, 400]  # Without pictures it answers.
    assert "--switch pictures=none" in result.answer


def test_stopping_does_not_wait_for_a_hanging_request() -> None:
    rules = faults(What.HANG, every=1, seconds=60)
    with serve_model("baseline", faults=rules) as served:
        body = {"model": "m", "messages": [{"role": "user", "content": "x"}]}
        with pytest.raises(httpx.ReadTimeout):
            httpx.post(f"{served.base_url}/chat/completions", json=body, timeout=0.1)
        begin = time.monotonic()
    assert time.monotonic() - begin < 3


def test_a_file_says_which_requests_go_wrong(tmp_path: Path) -> None:
    path = tmp_path / "faults.toml"
    path.write_text(
        """
        seed = 7
        [without_tools]
        tools = "prose"
        [[fault]]
        what = "error"
        status = 429
        retry_after_s = 1
        requests = [2, 5]
        [[fault]]
        what = "refused_parameter"
        parameter = "top_p"
        every = 1
        [[fault]]
        what = "reset"
        every = 3
        [[fault]]
        what = "slow"
        seconds = 0.1
        probability = 0.5
        """
    )
    rules = load_faults(path)
    assert rules.without_tools.tools == "prose"
    met = [rules.meeting(number, ()) for number in range(1, 7)]
    assert [rule and rule.what for rule in met][1:3] == [What.ERROR, What.RESET]
    assert met[4] is met[1] and met[5] is met[2]
    named = rules.meeting(3, {"top_p"})
    assert named is not None and named.what is What.REFUSED_PARAMETER
    drawn = [rules.meeting(number, ()) is not None for number in range(1, 200)]
    assert drawn == [load_faults(path).meeting(n, ()) is not None for n in range(1, 200)]
    assert 0.5 < sum(drawn) / len(drawn) < 0.85


def test_the_example_of_the_guide_is_valid(tmp_path: Path) -> None:
    guide = Path(__file__).resolve().parents[2] / "docs" / "serve-model.md"
    examples = guide.read_text(encoding="utf-8").split("```toml\n")[1:]
    for number, example in enumerate(examples):
        path = tmp_path / f"{number}.toml"
        path.write_text(example.split("```")[0])
        assert load_faults(path).seed in (0, 7)
    for what in What:
        assert f"| `{what}` |" in guide.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("seed = ", "not valid TOML"),
        ("speed = 3", "speed: there is no such setting"),
        ('[[fault]]\nwhat = "fire"\nevery = 1', "fault 1 what: .*'reset'"),
        ('[[fault]]\nwhat = "reset"', r"fault 1 \(reset\): give one of every"),
        ('[[fault]]\nwhat = "reset"\nevery = 1\nrequests = [2]', "give one of every"),
        ('[[fault]]\nwhat = "reset"\nevery = 0', "fault 1 every: .*greater than or equal to 1"),
        ('[[fault]]\nwhat = "error"\nevery = 1', "status is missing"),
        ('[[fault]]\nwhat = "error"\nevery = 1\nstatus = 200', "fault 1 status"),
        ('[[fault]]\nwhat = "reset"\nevery = 1\nseconds = 1', "seconds does not belong"),
        ('[[fault]]\nwhat = "reset"\nevery = 1\nwhen = 1', "fault 1 when: there is no such"),
        ('[without_tools]\ntools = "maybe"', "without_tools tools: .*'refuse' or 'prose'"),
    ],
)
def test_a_wrong_file_is_told_the_rule_and_the_fix(tmp_path: Path, text: str, part: str) -> None:
    path = tmp_path / "faults.toml"
    path.write_text(text)
    with pytest.raises(ConfigError, match=part) as caught:
        load_faults(path)
    assert str(path) in str(caught.value)


def test_a_file_that_is_not_there_is_told() -> None:
    with pytest.raises(ConfigError, match="Check the path"), serve_model(faults="nowhere.toml"):
        pass
