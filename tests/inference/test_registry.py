"""A URI makes a model, or an error that names the fix; a switch keeps tests off the network."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

from adamo_vh.errors import AdamoError, ModelConfigError
from adamo_vh.inference.model import ModelKind
from adamo_vh.inference.registry import create_model
from adamo_vh.inference.remote.endpoint import NO_REMOTE


@pytest.mark.parametrize(
    "uri", ["", "gpt", "nosuch:thing", "scripted", "scripted:", "cassette:", "replay:run"]
)
def test_an_unknown_model_is_refused_with_a_list_of_the_known(uri: str) -> None:
    with pytest.raises(ModelConfigError) as caught:
        create_model(uri)
    for known in (
        "baseline",
        "random:SEED",
        "scripted:FILE.json",
        "cassette:RUN_DIR",
        "openai:NAME",
    ):
        assert known in str(caught.value)


def test_the_baseline_is_rule_based() -> None:
    model = create_model("baseline")
    assert model.info.name == "baseline"
    assert model.info.kind is ModelKind.RULE_BASED


def test_a_random_player_is_made_from_its_seed() -> None:
    for uri in ("random", "random:7"):
        assert create_model(uri).info.kind is ModelKind.RANDOM
    with pytest.raises(ModelConfigError, match="random:7"):
        create_model("random:often")


def test_a_random_player_takes_the_seed_of_the_episode_unless_its_uri_names_one() -> None:
    names = [create_model(uri, seed=5).info.name for uri in ("random", "random:7", "random:0")]
    assert names == ["random:5", "random:7", "random"]


def test_a_cassette_that_is_not_there_is_a_plain_error(tmp_path: Path) -> None:
    with pytest.raises(AdamoError, match="nowhere"):
        create_model(f"cassette:{tmp_path / 'nowhere'}")


@pytest.mark.parametrize(
    "uri",
    [
        "openai:gpt-4o",
        "openai:tiny@http://192.168.1.7:8000/v1",
        "openai:tiny@https://example.org/v1",
        "openai:tiny@http://127.0.0.1.example.org/v1",
        "openai-responses:gpt-4o",
        "anthropic:claude",
        "ollama:tiny",
    ],
)
def test_the_switch_blocks_what_is_not_on_loopback(
    monkeypatch: pytest.MonkeyPatch, uri: str
) -> None:
    monkeypatch.setenv(NO_REMOTE, "1")
    monkeypatch.setenv("OPENAI_API_KEY", "some-secret-key")
    with pytest.raises(ModelConfigError, match=NO_REMOTE):
        create_model(uri)


@pytest.mark.parametrize("host", ["127.0.0.1:9", "localhost:9", "[::1]:9"])
def test_the_switch_lets_loopback_through_without_a_key(
    monkeypatch: pytest.MonkeyPatch, host: str
) -> None:
    monkeypatch.setenv(NO_REMOTE, "1")
    monkeypatch.delenv("OPENAI_API_KEY", raising=False)
    uri = f"openai:tiny@http://{host}/v1"
    model = create_model(uri, tools="native")
    assert model.info.name == uri
    assert model.info.kind is ModelKind.VLM


def test_a_missing_key_names_its_variable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(NO_REMOTE, raising=False)
    monkeypatch.setenv("OPENAI_API_KEY", "")
    with pytest.raises(ModelConfigError, match="OPENAI_API_KEY"):
        create_model("openai:gpt-4o")


def test_a_missing_key_of_another_provider_is_a_config_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv(NO_REMOTE, raising=False)
    monkeypatch.delenv("OPENROUTER_API_KEY", raising=False)
    with pytest.raises(ModelConfigError, match="OPENROUTER_API_KEY"):
        create_model("openrouter:some/model")


def test_a_missing_extra_names_the_command(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(NO_REMOTE, raising=False)
    if importlib.util.find_spec("anthropic"):
        pytest.skip("the extra is installed")
    with pytest.raises(ModelConfigError, match=r"pip install 'pydantic-ai-slim\[anthropic\]'"):
        create_model("anthropic:claude")


@pytest.mark.parametrize(
    ("uri", "fix"),
    [
        ("openai:tiny@http://me:hush-hush@127.0.0.1:9/v1", "OPENAI_API_KEY"),
        ("openai:tiny@http://127.0.0.1:9/v1?key=hush-hush", "OPENAI_API_KEY"),
        ("openai:tiny@http://127.0.0.1:port/v1", "malformed"),
        ("openai:tiny@http://", "malformed"),
        ("openai:@http://127.0.0.1:9/v1", "PROVIDER:NAME"),
    ],
)
def test_a_bad_address_is_refused_and_never_repeated(uri: str, fix: str) -> None:
    with pytest.raises(ModelConfigError) as caught:
        create_model(uri)
    assert fix in str(caught.value)
    assert "hush-hush" not in str(caught.value)


def test_importing_inference_loads_no_provider_library() -> None:
    code = (
        "import sys, adamo_vh.inference.registry;"
        "import adamo_vh.inference.remote.provider, adamo_vh.inference.remote.probe;"
        "sys.exit('pydantic_ai' in sys.modules or 'openai' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
