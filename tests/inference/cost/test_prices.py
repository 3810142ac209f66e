"""Prices come from the user's table or the list; what is not known has none."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.errors import ConfigError
from adamo_vh.inference.cost.prices import PRICES, Price, cost_usd, prices_file
from adamo_vh.inference.model import Usage

SOME = Usage(1000, 1000)
OWN = "openai:qwen@http://127.0.0.1:8000/v1"


@pytest.fixture(autouse=True)
def table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A user's price table, empty at first."""
    path = tmp_path / "prices.toml"
    path.write_text("")
    monkeypatch.setenv(PRICES, str(path))
    monkeypatch.delenv("OPENAI_BASE_URL", raising=False)
    return path


@pytest.mark.parametrize(
    ("uri", "usage", "usd"),
    [
        # By hand, from the list prices for a million tokens: input, cached input, output.
        # gpt-4o: 2.5, 1.25, 10.
        ("openai:gpt-4o", Usage(32_978, 600), 32_978 * 2.5e-6 + 600 * 10e-6),
        (
            "openai:gpt-4o",
            Usage(10_000, 100, 4_000),
            6_000 * 2.5e-6 + 4_000 * 1.25e-6 + 100 * 10e-6,
        ),
        ("openai-responses:gpt-4o", Usage(1_000_000, 0), 2.5),
        ("openai-chat:gpt-4o-2024-08-06", Usage(0, 1_000_000), 10.0),
        # gpt-5: 1.25, 0.125, 10; hidden reasoning is output.
        ("openai:gpt-5", Usage(8_000, 2_000, 0, 1_500), 8_000 * 1.25e-6 + 2_000 * 10e-6),
        # Claude Sonnet 3.5: 3, 0.3, 15.
        (
            "anthropic:claude-3-5-sonnet-latest",
            Usage(5_000, 200, 1_000),
            4_000 * 3e-6 + 1_000 * 0.3e-6 + 200 * 15e-6,
        ),
        # Gemini 2.5 Pro: 1.25 and 10 up to 200,000 tokens of input, 2.5 and 15 beyond.
        ("google:gemini-2.5-pro", Usage(100_000, 1_000), 100_000 * 1.25e-6 + 1_000 * 10e-6),
        ("google:gemini-2.5-pro", Usage(300_000, 1_000), 300_000 * 2.5e-6 + 1_000 * 15e-6),
        # OpenRouter lists the same model by its own name.
        ("openrouter:anthropic/claude-3.5-sonnet", Usage(1_000_000, 0), 3.0),
        ("openai:gpt-4o", Usage(), 0.0),
    ],
)
def test_list_prices_are_charged_by_kind_of_token(uri: str, usage: Usage, usd: float) -> None:
    assert cost_usd(uri, usage) == pytest.approx(usd, rel=1e-9)


@pytest.mark.parametrize(
    "uri",
    [
        "openai:no-such-model",
        "nowhere:gpt-4o",
        "openai:gpt-4o@http://127.0.0.1:8000/v1",
        "openai:text-embedding-3-large",
        "baseline",
        "scripted:plan.json",
        "",
    ],
)
def test_an_unknown_price_is_none_and_not_zero(uri: str) -> None:
    assert cost_usd(uri, Usage(1000, 1000)) is None
    assert cost_usd(uri, Usage()) is None


def test_a_server_named_by_the_environment_is_an_own_server(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("OPENAI_BASE_URL", "http://127.0.0.1:8000/v1")
    assert cost_usd("openai:gpt-4o", SOME) is None
    assert cost_usd("anthropic:claude-3-5-sonnet-latest", SOME) is not None
    monkeypatch.setenv("OPENAI_BASE_URL", "https://api.openai.com/v1")
    assert cost_usd("openai:gpt-4o", SOME) is not None


def test_what_a_gateway_gives_away_has_a_price_of_zero() -> None:
    assert cost_usd("openrouter:agentica-org/deepcoder-14b-preview:free", Usage(1000, 9)) == 0


def test_more_cached_tokens_than_input_are_no_fault() -> None:
    assert cost_usd("openai:gpt-4o", Usage(100, 0, 500)) == pytest.approx(100 * 1.25e-6)


def test_the_users_table_goes_before_the_list(table: Path) -> None:
    table.write_text(
        f'["openai:*"]\ninput = 9\noutput = 9\n["{OWN}"]\ninput = 0.5\ncached = 0.05\noutput = 2\n'
        '["openai:gpt-*"]\ninput = 1\noutput = 1\n'
    )
    exact = cost_usd(OWN, Usage(1_000_000, 1_000_000, 500_000))
    assert exact == pytest.approx(0.25 + 0.025 + 2.0)
    assert cost_usd("openai:gpt-4o", Usage(1_000_000, 1_000_000, 500_000)) == pytest.approx(18.0)
    assert cost_usd("anthropic:claude-3-5-sonnet-latest", SOME) is not None


def test_an_edited_table_counts_at_once(table: Path) -> None:
    assert cost_usd(OWN, SOME) is None
    table.write_text(f'["{OWN}"]\ninput = 0\noutput = 0\n')
    assert cost_usd(OWN, Usage(5, 5)) == 0


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("[x\n", ["not valid TOML"]),
        ('["m"]\ninput = 1\n', ['["m"]', "output is missing"]),
        ('["m"]\ninput = "1"\noutput = 2\n', ["input must be a number", "'1'"]),
        ('["m"]\ninput = -1\noutput = 2\n', ["input must be 0 or more"]),
        ('["m"]\ninput = 1\noutput = inf\n', ["output must be 0 or more"]),
        ('["m"]\ninput = true\noutput = 2\n', ["input must be a number"]),
        ('["m"]\ninput = 1\noutput = 2\ncache = 1\n', ["unknown field cache", "cached"]),
        ("m = 3\n", ['["m"]', "must be a section"]),
    ],
)
def test_a_wrong_table_names_file_field_and_fix(table: Path, text: str, parts: list[str]) -> None:
    table.write_text(text)
    with pytest.raises(ConfigError) as error:
        cost_usd("openai:gpt-4o", SOME)
    assert all(part in str(error.value) for part in [str(table), *parts]), str(error.value)


def test_a_table_that_is_named_must_exist(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(PRICES, str(tmp_path / "none.toml"))
    with pytest.raises(ConfigError, match="cannot be read"):
        cost_usd("openai:gpt-4o", SOME)
    monkeypatch.delenv(PRICES)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    assert prices_file().name == "prices.toml"
    assert cost_usd("openai:gpt-4o", SOME) is not None


@given(st.integers(0, 10**6), st.integers(0, 10**6), st.integers(0, 10**6), st.integers(0, 10**5))
def test_more_tokens_never_cost_less_and_a_cache_never_costs_more(
    tokens_in: int, out: int, cached: int, more: int
) -> None:
    price = Price(2.5, 1.25, 10.0)
    cost = price.cost_usd(Usage(tokens_in, out, cached))
    assert 0 <= cost <= price.cost_usd(Usage(tokens_in + more, out + more, cached))
    assert cost <= price.cost_usd(Usage(tokens_in, out))
