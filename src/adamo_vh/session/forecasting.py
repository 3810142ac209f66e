"""What episodes will take with a model, said or refused before any of them starts."""

from __future__ import annotations

from pathlib import Path

from adamo_vh.action import ToolSchema
from adamo_vh.action_server import LocalActionServer
from adamo_vh.cognition.budget import Budget
from adamo_vh.cognition.forecast import SECONDS_PER_CALL, Forecast, forecast
from adamo_vh.cognition.memory.short_term import ShortTermMemory
from adamo_vh.cognition.turns import offered
from adamo_vh.engine import World
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import ConfigError
from adamo_vh.files import check_place
from adamo_vh.inference.cost.prices import cost_usd
from adamo_vh.inference.cost.tokens import estimate_image, estimate_request, rule_for
from adamo_vh.inference.messages import Message
from adamo_vh.inference.model import Model, ModelKind, Usage
from adamo_vh.inference.players.cassette import Cassette
from adamo_vh.inference.registry import is_remote
from adamo_vh.observation import Observation
from adamo_vh.record.run_folder import check_unused
from adamo_vh.session.bodies import instructions, open_server

USUAL_CALLS = 4.67
"""Model calls an episode: GPT-4o on S1 in the paper."""
_TOKENS_PER_CALL = 150
"""What a call adds to the prompt: its note, its arguments, its feedback, and what changed."""
_LOOKS_PER_CALL = 0.25
"""Share of the calls that bring another picture into the prompt."""
_OUTPUT_PER_CALL = 80
"""A note of two sentences and a call with its arguments."""


def forecast_episodes(config: EpisodeConfig, engine: World, episodes: int = 1) -> Forecast:
    """Forecast what episodes take, from their first prompt.

    The prompt is made exactly; how many calls follow is a guess: for a task one for each of its
    actions and one for the end, else the paper's mean. Nothing is sent.

    Args:
        config: How they are set up.
        engine: Its engine, just reset.
        episodes: How many there will be.

    Raises:
        ConfigError: The user's price table is damaged.
    """
    server = open_server(config, engine)
    prompt, tools = first_prompt(config, engine, server, server.observe().observation)
    first = estimate_request(prompt, tools, rule_for(config.model))
    return forecast_from(config, first, episodes)


def first_prompt(
    config: EpisodeConfig, engine: World, server: LocalActionServer, view: Observation
) -> tuple[list[Message], tuple[ToolSchema, ...]]:
    """What a model is sent first, and the tools on offer.

    Args:
        config: How the episode is set up.
        engine: Its engine, just reset.
        server: Of that engine.
        view: The first one.
    """
    words = instructions(config, engine, server)
    memory = ShortTermMemory(words, config.k, config.profile, config.text_form)
    memory.instruct(config.instruction, view)
    return memory.messages(), tuple(offered(server.actions, config.profile))


def forecast_from(
    config: EpisodeConfig,
    first: int,
    episodes: int = 1,
    seconds_per_call: float = SECONDS_PER_CALL,
) -> Forecast:
    """Forecast what episodes take.

    Args:
        config: How they are set up.
        first: Tokens of their first request.
        episodes: How many there will be.
        seconds_per_call: How long the model takes.
    """
    # A profile that keeps only the last pictures does not add any.
    looks = 0.0 if config.profile.pictures else _LOOKS_PER_CALL
    picture = looks * estimate_image(*config.resolution, rule_for(config.model))
    return forecast(
        config.model,
        calls_expected=calls_expected(config),
        first_request_tokens=first,
        growth_per_call_tokens=round(_TOKENS_PER_CALL + picture),
        output_per_call=_OUTPUT_PER_CALL,
        episodes=episodes,
        seconds_per_call=seconds_per_call,
    )


def calls_expected(config: EpisodeConfig) -> float:
    """How many model calls an episode is taken to need."""
    task = config.scored_task
    return USUAL_CALLS if task is None else 1.0 + task.computed.act


def check_price(uri: str, budget: Budget, model: Model | None = None) -> None:
    """Make sure that a budget of money can be kept, before anything is paid or written.

    Args:
        uri: Names the model.
        budget: The caps.
        model: The model itself, where it is there already; without it only the name is judged.

    Raises:
        ConfigError: No price is known for the model.
    """
    if budget.usd is None:
        return
    if model is None:
        is_paid = is_remote(uri)
    else:
        is_paid = model.info.kind is ModelKind.VLM and not isinstance(model, Cassette)
    if is_paid and cost_usd(uri, Usage(1000, 1000)) is None:
        raise ConfigError(
            f"No price is known for {uri}, so that a budget of {budget.usd:g} US dollars cannot be "
            "kept. Put the model into the price table (prices.toml), or cap tokens or calls."
        )


def refuse_early(config: EpisodeConfig, out: Path | None, cap: Budget | None = None) -> None:
    """Refuse what can be told from the settings alone, before anything is made, asked or written.

    Args:
        config: The settings.
        out: The run folder, if one is written.
        cap: On all instructions together.

    Raises:
        ConfigError: A budget of money cannot be kept.
        RecordError: The folder holds a run already.
        FileError: It cannot be written to.
    """
    check_price(config.model, config.budget)
    check_price(config.model, cap or Budget())
    if out is not None:
        check_unused(out)
        check_place(out)
