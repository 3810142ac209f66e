"""Our studies in Inspect AI: the same calls come to the same state and score as in a session."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import adamo_vh
from adamo_vh.episode.result import read_result
from adamo_vh.record.trajectory import read_trajectory
from adamo_vh.session.verifying import verify_run

pytestmark = pytest.mark.extras

SMALL = "160x90"
ONE: dict[str, Any] = {
    "scene": "s1",
    "labeling": "sem",
    "tasks": "T3",
    "repetitions": 1,
    "resolution": SMALL,
}


@pytest.fixture(scope="module")
def played(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """T3 by the baseline, in a session of ours."""
    folder = tmp_path_factory.mktemp("played")
    adamo_vh.run_episode(task="T3", resolution=SMALL, out=folder)
    return folder


def said(folder: Path) -> list[Any]:
    """The answers of a recorded run, as Inspect's model gives them."""
    from inspect_ai.model import ChatCompletionChoice, ChatMessageAssistant, ModelOutput, ModelUsage
    from inspect_ai.tool import ToolCall

    outputs = []
    for thought in read_trajectory(folder).thoughts:
        message = thought.reply.message
        calls = [ToolCall(call.id, call.name, dict(call.arguments or {})) for call in message.calls]
        told = ChatMessageAssistant(content=message.text, tool_calls=calls or None)
        stop = "tool_calls" if calls else "stop"
        choice = ChatCompletionChoice(message=told, stop_reason=stop)
        usage = ModelUsage(input_tokens=100, output_tokens=10, total_tokens=110)
        outputs.append(ModelOutput(model="mockllm/model", choices=[choice], usage=usage))
    return outputs


def evaluated(outputs: Any, logs: Path, **arguments: Any) -> Any:
    """The log of an evaluation with a model that answers so."""
    import inspect_ai
    from inspect_ai.model import get_model

    model = get_model("mockllm/model", custom_outputs=outputs, memoize=False)
    (log,) = inspect_ai.eval(
        arguments.pop("name", "adamo_vh/paper"),
        model=model,
        task_args={**ONE, **arguments},
        log_dir=str(logs),
        display="none",
        fail_on_error=False,
    )
    return log


def test_the_same_calls_come_to_the_same_score_and_state(played: Path, tmp_path: Path) -> None:
    log = evaluated(said(played), tmp_path / "logs", out=str(tmp_path / "runs"))
    assert log.status == "success", log.error
    metrics = {score.name: score.metrics["mean"].value for score in log.results.scores}
    assert metrics == {"completion": 1.0, "strict": 1.0}
    (run,) = (tmp_path / "runs").iterdir()
    here, there = read_result(run), read_result(played)
    assert here is not None and there is not None
    assert (here.state_hash, here.score) == (there.state_hash, there.score)
    assert here.model == "inspect:mockllm/model"
    assert here.usage.total_tokens == 110 * here.model_calls
    assert verify_run(run).problems == ()


def test_the_model_is_never_told_the_score(played: Path, tmp_path: Path) -> None:
    log = evaluated(said(played), tmp_path / "logs")
    (sample,) = log.samples
    asked = [event for event in sample.events if event.event == "model"]
    assert len(asked) == len(said(played))
    for event in asked:
        told = json.dumps([message.model_dump(mode="json") for message in event.input])
        assert "completion" not in told and "strict" not in told
        assert [tool.name for tool in event.tools] == ["Look", "Walk", "Pick", "Drop"]
    assert {message.role for message in sample.messages} == {"system", "user", "assistant", "tool"}
    assert any("data:image" in text for text in sample.attachments.values())


def test_a_failing_model_is_an_error_and_no_zero(tmp_path: Path) -> None:
    def fail(*_: object) -> Any:
        raise RuntimeError("the provider is down")

    log = evaluated(fail, tmp_path / "logs")
    (sample,) = log.samples
    assert "the provider is down" in sample.error.message
    assert not sample.scores


def test_any_study_is_a_task(tmp_path: Path) -> None:
    from adamo_vh.adapters.inspect.tasks import memory, paper, study

    assert len(paper().dataset) == 15 * 2 * 2
    assert paper().epochs == 15
    assert len(memory(tasks="T1,T8").dataset) == 2 * 4 * 2  # k, and both ways of counting
    file = tmp_path / "mine.toml"
    file.write_text('tasks = ["T1"]\nvariations = "0-2"\nrepetitions = 2\n')
    mine = study(str(file))
    assert [sample.id for sample in mine.dataset] == [
        f"s1/T01/sem/paper/v{number:04d}" for number in range(3)
    ]


def test_a_limit_of_inspect_ends_the_sample_without_a_score(played: Path, tmp_path: Path) -> None:
    import inspect_ai
    from inspect_ai.model import get_model

    model = get_model("mockllm/model", custom_outputs=said(played), memoize=False)
    (log,) = inspect_ai.eval(
        "adamo_vh/paper",
        model=model,
        task_args=ONE,
        log_dir=str(tmp_path / "logs"),
        display="none",
        token_limit=50,
    )
    (sample,) = log.samples
    assert sample.limit is not None and sample.limit.type == "token"
    scores = [score.value for score in (sample.scores or {}).values()]
    assert all(value != {"completion": 0.0, "strict": 0.0} for value in scores)
    assert log.results is None or all(score.scored_samples == 0 for score in log.results.scores)


def test_an_agent_of_inspect_drives_the_body_with_our_tools(played: Path, tmp_path: Path) -> None:
    out = tmp_path / "runs"
    log = evaluated(said(played), tmp_path / "logs", out=str(out), loop="inspect")
    assert log.status == "success", log.error
    (sample,) = log.samples
    assert sample.scores["episode"].value == {"completion": 1.0, "strict": 1.0}
    roles = [message.role for message in sample.messages]
    assert roles == ["system", "user", "assistant", "tool", "assistant"]
    assert "in your hand" in sample.messages[3].text
    calls = [event for event in sample.events if event.event == "tool"]
    assert [event.function for event in calls] == ["Pick"]
    (run,) = out.iterdir()
    here, there = read_result(run), read_result(played)
    assert here is not None and there is not None
    assert (here.state_hash, here.answer) == (there.state_hash, there.answer)
    assert here.model == "inspect:mockllm/model"


def test_any_agent_of_inspect_can_take_the_seat(played: Path, tmp_path: Path) -> None:
    import inspect_ai
    from inspect_ai.agent import react
    from inspect_ai.model import get_model

    from adamo_vh.adapters.inspect.tasks import BodyTools

    outputs = said(played)
    (log,) = inspect_ai.eval(
        "adamo_vh/study",
        model=get_model("mockllm/model", custom_outputs=outputs, memoize=False),
        task_args={**ONE, "loop": "inspect"},
        solver=react(tools=[BodyTools()], submit=False),
        log_dir=str(tmp_path / "logs"),
        display="none",
        message_limit=12,
    )
    (sample,) = log.samples
    assert sample.scores["episode"].value == {"completion": 1.0, "strict": 1.0}


def test_a_limit_of_inspect_in_its_own_loop_is_a_truncation(played: Path, tmp_path: Path) -> None:
    import inspect_ai
    from inspect_ai.model import get_model

    looking = said(played)[:1] * 5  # The same call again and again.
    out = tmp_path / "runs"
    (log,) = inspect_ai.eval(
        "adamo_vh/paper",
        model=get_model("mockllm/model", custom_outputs=looking, memoize=False),
        task_args={**ONE, "loop": "inspect", "out": str(out)},
        log_dir=str(tmp_path / "logs"),
        display="none",
        message_limit=5,
    )
    assert log.samples[0].limit.type == "message"
    (run,) = out.iterdir()
    result = read_result(run)
    assert result is not None and result.termination == "budget"


def test_an_unknown_loop_names_those_there_are() -> None:
    from adamo_vh.adapters.inspect.tasks import paper
    from adamo_vh.errors import ConfigError

    with pytest.raises(ConfigError, match="Use one of adamo, inspect"):
        paper(loop="mine")
