"""Where a model URI leads: to the right wire and address, with the right key, or to a clear no."""

from __future__ import annotations

import builtins
import sys
from typing import Any

import pytest
from tests.dialects import DIALECTS, Chat, Dialect, Google, uri
from tests.fake_provider import FakeProvider
from tests.talk import ASK, NAMES, QUICK, SECOND, TOOLS, calls

from adamo_vh.errors import ModelConfigError
from adamo_vh.inference.messages import ToolMessage
from adamo_vh.inference.model import Sampling
from adamo_vh.inference.remote.endpoint import NO_REMOTE, Endpoint, parse_endpoint
from adamo_vh.inference.remote.provider import ProviderModel

every_wire = pytest.mark.parametrize("dialect", DIALECTS, ids=NAMES)
KEYS = (
    "OPENAI_API_KEY",
    "ANTHROPIC_API_KEY",
    "GOOGLE_API_KEY",
    "GEMINI_API_KEY",
    "OLLAMA_API_KEY",
    "VLLM_API_KEY",
    "OPENROUTER_API_KEY",
    "MISTRAL_API_KEY",
)


@pytest.fixture(autouse=True)
def keyless(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(NO_REMOTE, "1")
    for key in KEYS:
        monkeypatch.delenv(key, raising=False)


def reached(uri: str, dialect: Dialect, server: FakeProvider) -> ProviderModel:
    """The model of a URI, after it was asked something."""
    with ProviderModel(uri, QUICK) as model:
        assert model.complete(ASK, TOOLS, Sampling()).message.text == "ok"
    return model


@every_wire
def test_a_server_of_ones_own_needs_no_key(dialect: Dialect) -> None:
    with FakeProvider([dialect.answer("ok")]) as server:
        assert reached(uri(dialect, server), dialect, server).wire == dialect.name
        assert server.paths == [dialect.path]


@every_wire
def test_the_version_of_the_api_may_be_left_out_where_the_library_adds_it(
    dialect: Dialect,
) -> None:
    if dialect.name.startswith("openai"):
        pytest.skip("an OpenAI address ends where its API begins")
    with FakeProvider(lambda _: dialect.answer("ok")) as server:
        root = server.base_url.removesuffix("/v1")
        for address in (root, f"{root}/", f"{root}/v1", f"{root}/v1beta"):
            reached(f"{dialect.name}:{dialect.model}@{address}", dialect, server)
        assert server.paths == [dialect.path] * 4


@pytest.mark.parametrize("prefix", ["ollama", "vllm", "litellm", "openai-chat"])
def test_other_providers_of_the_library_take_an_address(prefix: str) -> None:
    with FakeProvider([Chat().answer("ok")]) as server:
        model = reached(f"{prefix}:tiny@{server.base_url}", Chat(), server)
        assert model.wire == prefix
        assert server.paths == ["/v1/chat/completions"]


def test_a_provider_that_takes_no_address_names_what_does() -> None:
    with pytest.raises(ModelConfigError, match=r"Write openai:tiny@http://127\.0\.0\.1:9/v1"):
        ProviderModel("deepseek:tiny@http://127.0.0.1:9/v1")


@pytest.mark.parametrize(
    ("prefix", "variable"),
    [
        ("openai", "OPENAI_API_KEY"),
        ("openai-responses", "OPENAI_API_KEY"),
        ("anthropic", "ANTHROPIC_API_KEY"),
        ("google", "GOOGLE_API_KEY"),
        ("openrouter", "OPENROUTER_API_KEY"),
        ("mistral", ""),
    ],
)
def test_a_missing_key_or_package_is_named(
    monkeypatch: pytest.MonkeyPatch, prefix: str, variable: str
) -> None:
    monkeypatch.delenv(NO_REMOTE)
    named = variable or r"pip install 'pydantic-ai-slim\[mistral\]'"
    with pytest.raises(ModelConfigError, match=named):
        ProviderModel(f"{prefix}:some-model")


@pytest.mark.parametrize("extra", ["anthropic", "google"])
def test_a_missing_extra_of_ours_is_named(monkeypatch: pytest.MonkeyPatch, extra: str) -> None:
    for name in [*sys.modules]:
        if name.startswith((f"pydantic_ai.providers.{extra}", f"pydantic_ai.models.{extra}")):
            monkeypatch.delitem(sys.modules, name)
    load = builtins.__import__

    def without(name: str, *args: Any) -> Any:
        if name.partition(".")[0] == extra:
            raise ImportError(name)
        return load(name, *args)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(ModelConfigError, match=rf"pip install 'adamo-vh\[{extra}\]'"):
        ProviderModel(f"{extra}:some-model@http://127.0.0.1:9")


@every_wire
def test_the_switch_blocks_what_is_not_on_loopback(dialect: Dialect) -> None:
    prefix = {"openai-chat": "openai"}.get(dialect.name, dialect.name)
    for address in ("", "@http://192.168.1.7:8000/v1", "@https://127.0.0.1.example.org"):
        with pytest.raises(ModelConfigError, match=NO_REMOTE):
            ProviderModel(f"{prefix}:{dialect.model}{address}")


@pytest.mark.parametrize("prefix", ["openai", "openai-responses", "anthropic", "google", "ollama"])
@pytest.mark.parametrize("secret", ["me:hush-hush@127.0.0.1:9", "127.0.0.1:9/v1?key=hush-hush"])
def test_a_secret_in_the_address_is_refused_and_never_repeated(prefix: str, secret: str) -> None:
    with pytest.raises(ModelConfigError) as caught:
        ProviderModel(f"{prefix}:tiny@http://{secret}")
    assert "_API_KEY" in str(caught.value)
    assert "hush" not in str(caught.value)


def test_a_uri_is_read_into_its_parts() -> None:
    assert parse_endpoint("openrouter:a/b:free") == Endpoint("openrouter", "a/b:free")
    assert parse_endpoint("ollama:q@4@http://h:1/v1") == Endpoint("ollama", "q@4", "http://h:1/v1")


@every_wire
def test_a_closed_model_opens_again(dialect: Dialect) -> None:
    with FakeProvider(lambda _: dialect.answer("ok")) as server:
        model = ProviderModel(uri(dialect, server), QUICK)
        for _ in range(2):
            assert model.complete(ASK, TOOLS, Sampling()).message.text == "ok"
            model.close()
            model.close()


def test_whether_a_result_may_hold_pictures_depends_on_the_model() -> None:
    """Gemini takes them from version 3 on; before, they follow as the user's."""
    dialect = Google()
    prompt = (*ASK, calls("a"), ToolMessage("a", "Inspect", "See the picture.", (SECOND,)))
    with (
        FakeProvider([dialect.answer("ok")]) as server,
        ProviderModel(f"google:gemini-2.5-flash@{server.base_url}", QUICK) as model,
    ):
        assert not model.pictures_in_results
        model.complete(prompt, TOOLS, Sampling())
        result, caption, picture = [*dialect.read(server.requests[0])][-3:]
    assert (result.kind, result.text) == ("result", "See the picture.")
    assert caption.text == "Picture from Inspect (a):"
    assert (picture.role, picture.data) == ("user", SECOND.data)


@pytest.mark.parametrize(
    "address", ["127.0.0.1:8000", "localhost/v1", "//gpu.lan:80/v1", "[::1]:8000/v1"]
)
def test_an_address_without_its_scheme_is_not_taken_for_a_name(address: str) -> None:
    """Else the key would go to the provider, and the prompts too."""
    with pytest.raises(ModelConfigError, match="openai:tiny@http://"):
        parse_endpoint(f"openai:tiny@{address}")


def test_a_name_may_have_an_at_sign() -> None:
    assert parse_endpoint("google-vertex:claude@20250101").model == "claude@20250101"
