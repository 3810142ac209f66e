"""Which way a request goes: proxies never get what is near, and the switch blocks the rest."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.dialects import DIALECTS, Dialect, uri
from tests.fake_provider import FakeProvider, completion
from tests.talk import ASK, NAMES, QUICK, TOOLS

from adamo_vh.errors import ModelConfigError
from adamo_vh.inference.model import Sampling
from adamo_vh.inference.registry import create_model
from adamo_vh.inference.remote.endpoint import NO_REMOTE
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.routes import environment_problems, is_near, proxy_for

NEAR = "http://127.0.0.1:8000/v1"
FAR = "https://models.example.org/v1"
PROXIES = ("http_proxy", "https_proxy", "all_proxy", "no_proxy")


@pytest.fixture(autouse=True)
def clean(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in PROXIES:
        monkeypatch.delenv(name, raising=False)
        monkeypatch.delenv(name.upper(), raising=False)
    monkeypatch.delenv(NO_REMOTE, raising=False)


@pytest.mark.parametrize("variable", ["HTTP_PROXY", "http_proxy", "ALL_PROXY"])
@pytest.mark.parametrize("switch", ["0", "1"])
@pytest.mark.parametrize("dialect", DIALECTS, ids=NAMES)
def test_a_proxy_gets_nothing_of_a_loopback_model(
    monkeypatch: pytest.MonkeyPatch, dialect: Dialect, variable: str, switch: str
) -> None:
    with FakeProvider(lambda _: completion("proxy")) as proxy:
        monkeypatch.setenv(variable, proxy.base_url.removesuffix("/v1"))
        monkeypatch.setenv(NO_REMOTE, switch)
        with (
            FakeProvider([dialect.answer("ok")]) as server,
            ProviderModel(uri(dialect, server), QUICK) as model,
        ):
            assert model.complete(ASK, TOOLS, Sampling()).message.text == "ok"
        assert proxy.requests == []


def test_a_proxy_that_is_meant_is_used(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", "some-key")
    with FakeProvider(lambda _: completion("through the proxy")) as proxy:
        monkeypatch.setenv("HTTP_PROXY", proxy.base_url.removesuffix("/v1"))
        with ProviderModel("openai:tiny@http://models.example.org/v1", QUICK) as model:
            reply = model.complete(ASK, TOOLS, Sampling())
        assert reply.message.text == "through the proxy"
        monkeypatch.setenv(NO_REMOTE, "1")
        with pytest.raises(ModelConfigError, match=NO_REMOTE):
            create_model("openai:tiny@http://models.example.org/v1", tools="native")
        assert len(proxy.requests) == 1


@pytest.mark.parametrize(
    "host",
    [
        "127.0.0.1",
        "127.8.8.8",
        "::1",
        "::ffff:127.0.0.1",
        "localhost",
        "LOCALHOST",
        "10.1.2.3",
        "192.168.1.7",
        "172.16.0.1",
        "169.254.1.1",
        "fd00::1",
        "fe80::1",
        "gpu-box",
        "gpu.local",
    ],
)
def test_what_is_near_goes_straight(monkeypatch: pytest.MonkeyPatch, host: str) -> None:
    monkeypatch.setenv("ALL_PROXY", "http://127.0.0.1:3128")
    assert is_near(host)
    shown = f"[{host}]" if ":" in host else host
    assert proxy_for(f"http://{shown}:8000/v1") is None


@pytest.mark.parametrize("host", ["example.org", "127.0.0.1.example.org", "8.8.8.8", "2001:db9::1"])
def test_what_is_far_goes_through_the_proxy(monkeypatch: pytest.MonkeyPatch, host: str) -> None:
    monkeypatch.setenv("ALL_PROXY", "127.0.0.1:3128")
    monkeypatch.setenv("NO_PROXY", "intern.example.org")
    shown = f"[{host}]" if ":" in host else host
    assert proxy_for(f"https://{shown}/v1") == "http://127.0.0.1:3128"
    assert proxy_for("https://intern.example.org/v1") is None


def test_the_switch_blocks_each_request_that_leaves_the_machine(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv(NO_REMOTE, "1")
    assert proxy_for(NEAR) is None
    for url in (FAR, "http://192.168.1.7/v1", "http://gpu-box/v1", "http://0.0.0.0/v1"):
        with pytest.raises(ModelConfigError, match=NO_REMOTE):
            proxy_for(url)


@pytest.mark.parametrize(
    ("variable", "value", "fix"),
    [
        ("ALL_PROXY", "socks5://127.0.0.1:1080", "pip install socksio"),
        ("ALL_PROXY", "socks://127.0.0.1:7890/", r"write socks5://127\.0\.0\.1:7890/"),
        ("HTTPS_PROXY", "ftp://127.0.0.1:21", "use http, https, socks5 or socks5h"),
        ("HTTPS_PROXY", "http://:port", "write it like"),
        ("SSL_CERT_FILE", "/nonexistent/cacert.pem", "which is not there; correct or unset it"),
        ("SSL_CERT_DIR", "/nonexistent", "which is not there; correct or unset it"),
        ("OPENAI_API_KEY", "some-key\n", "OPENAI_API_KEY holds a line break"),
        ("OPENAI_API_KEY", "some-kéy", "not ASCII"),
        ("OPENAI_ORG_ID", "my org", "OPENAI_ORG_ID holds a blank"),
    ],
)
def test_what_cannot_work_is_said_before_anything_is_sent(
    monkeypatch: pytest.MonkeyPatch, variable: str, value: str, fix: str
) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", "some-key")
    monkeypatch.setenv(variable, value)
    with pytest.raises(ModelConfigError, match=fix) as caught:
        create_model(f"openai:tiny@{FAR}", tools="native")
    assert "\n" not in str(caught.value) and variable in str(caught.value)
    problems = environment_problems()
    assert len(problems) == 1 and variable in problems[0]


def test_a_key_that_no_header_can_hold_is_said_for_a_near_model_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", "some-key\n")
    with pytest.raises(ModelConfigError, match="line break"):
        create_model(f"openai:tiny@{NEAR}", tools="native")


def test_a_near_model_needs_neither_proxy_nor_certificate(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("ALL_PROXY", "socks://127.0.0.1:7890/")
    monkeypatch.setenv("SSL_CERT_FILE", "/nonexistent/cacert.pem")
    with (
        FakeProvider([completion("ok")]) as server,
        ProviderModel(server.uri(), QUICK) as model,
    ):
        assert model.complete(ASK, TOOLS, Sampling()).message.text == "ok"


def test_certificates_that_are_none_are_said(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    file = tmp_path / "ca.pem"
    file.write_text("none")
    monkeypatch.setenv("SSL_CERT_FILE", str(file))
    with pytest.raises(ModelConfigError, match="holds no certificates"):
        create_model(f"openai:tiny@{FAR}", tools="native")


@pytest.mark.parametrize(
    "uri",
    [
        "openai:tiny@http://me:hush-hush@127.0.0.1:9/v1",
        "openai:tiny@me:hush-hush@127.0.0.1:9/v1",
        "opnai:tiny@http://me:hush-hush@127.0.0.1:9/v1",
        "nosuch@http://hush-hush@127.0.0.1:9",
        "scripted@me:hush-hush@host",
    ],
)
def test_a_password_in_a_uri_is_never_repeated(uri: str) -> None:
    with pytest.raises(ModelConfigError) as caught:
        create_model(uri)
    assert "hush-hush" not in str(caught.value)
