"""The mind: a model from its URI, recorded runs and cassettes included."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from adamo_vh.action_server.tools import INSPECT, SURVEY, Tool
from adamo_vh.cognition.profile import PAPER, Profile, StateText
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.errors import ConfigError, ModelConfigError
from adamo_vh.inference.model import Model, ModelKind, Reply, Rung
from adamo_vh.inference.players.cassette import FOLDER, Cassette, taped
from adamo_vh.inference.players.checked import checked
from adamo_vh.inference.players.outside import HUMAN, OUTSIDE
from adamo_vh.inference.players.resumed import resumed
from adamo_vh.inference.players.scripted import ScriptedModel, load_script
from adamo_vh.inference.registry import check_remote_uri, create_model
from adamo_vh.inference.remote.capabilities import Support
from adamo_vh.plugins import MODELS, plugin_names
from adamo_vh.record.run_folder import SCRIPT
from adamo_vh.record.trajectory import Trajectory, read_trajectory

_REPLAY = "replay:"
_REPEATS = ("baseline", "scripted", "replay", "cassette")
"""What answers the same to the same, by the first word of its URI."""


def model_of(
    uri: str,
    *,
    tools: str = "auto",
    profile: Profile = PAPER,
    answered: int = 0,
    seed: int = 0,
    script: Path | None = None,
) -> Model:
    """The model of a URI.

    Args:
        uri: As in `adamo_vh.inference.registry.create_model`, or ``replay:RUN_DIR``.
        tools: How a remote model is asked for calls: "auto", "native", "schema" or "react".
        profile: Decides whether a remote model may give several calls at once, and whether a
            cache of its prompt pays.
        answered: Replies that were given before an interruption; a model that answers from a list
            leaves them out.
        seed: Seed of the episode.
        script: In place of the file that a scripted model names.

    Raises:
        ModelConfigError: The model is unknown or lacks a key or an extra.
        RecordError: A run folder or cassette is missing or damaged.
    """
    if uri == HUMAN:
        raise ModelConfigError("A person drives the body in the studio: adamo-vh studio.")
    if uri.startswith(f"{OUTSIDE}:"):
        raise ModelConfigError(
            f"{uri} is a mind that comes from outside: it plays, or goes on, by adamo-vh mcp."
        )
    if uri.startswith(_REPLAY):
        folder = Path(uri.removeprefix(_REPLAY))
        model: Model = recorded_model(read_trajectory(folder), uri, answered)
    elif script is not None:
        model = ScriptedModel(uri, load_script(script))
    else:
        model = create_model(
            uri,
            tools=tools,
            several_calls=profile.plan > 1,
            # A state at the front changes with every action, and all behind it would be written
            # into the cache in vain.
            cache=profile.state is not StateText.FIRST,
            seed=seed,
        )
    if isinstance(model, ScriptedModel | Cassette):
        model.skip(answered)
    return model


def is_deterministic(uri: str) -> bool:
    """Whether a model plays the same episode again and again, whatever the seed of the episode.

    Nothing is asked and no key is needed.

    Raises:
        ModelConfigError: The model is unknown.
    """
    prefix, _, rest = uri.partition(":")
    if prefix in _REPEATS:
        return True
    if prefix == "random":
        return bool(rest)
    if prefix in plugin_names(MODELS):
        model = model_of(uri)
        model.info.close()
        return model.info.kind in (ModelKind.RULE_BASED, ModelKind.SCRIPTED, ModelKind.REPLAY)
    from adamo_vh.inference.remote.endpoint import parse_endpoint

    check_remote_uri(uri)
    parse_endpoint(uri)
    return False


def lasting(uri: str) -> str:
    """The URI of a model with the whole path of what it plays, which holds from any folder."""
    prefix, _, rest = uri.partition(":")
    is_path = prefix in ("replay", "cassette") and rest
    return f"{prefix}:{Path(rest).absolute()}" if is_path else uri


def fitting(profile: Profile, model: Model, tools: Sequence[Tool] | None = None) -> Profile:
    """The profile that a model can follow, with the tools that it is given.

    One that sees no pictures is shown none, one whose server takes one a prompt is shown the
    newest alone, one that is asked for steps as text gives one a turn,
    and without the tools for close-ups there are none.

    Raises:
        ConfigError: The model sees no pictures, and the profile has nothing but pictures.
    """
    known = model.info.capabilities
    if known is not None and known.pictures in (Support.NO, Support.REFUSED):
        if profile.state is StateText.NONE:
            raise ConfigError(
                f"{model.info.name} sees no pictures, and state=none tells it nothing in words: "
                "leave state=none out."
            )
        profile = profile.without_pictures()
    elif known is not None and known.several_pictures is Support.REFUSED:
        profile = profile.with_one_picture()
    if model.info.rung in (Rung.SCHEMA, Rung.REACT):
        profile = replace(profile, plan=1)
    if tools is not None and not {INSPECT, SURVEY} <= set(tools):
        profile = replace(profile, closeups=False, min_confidence=0.0)
    return profile


def recorded_model(trajectory: Trajectory, name: str, answered: int = 0) -> Model:
    """A model that says again what was said in a recorded episode, what could not be read too."""
    said = [
        Reply(
            thought.reply.message,
            unreadable=thought.reply.unreadable,
            ending=thought.reply.ending,
            finish_reason=thought.reply.finish_reason,
        )
        for thought in trajectory.thoughts[answered:]
    ]
    return resumed(said, ScriptedModel(name, (), kind=ModelKind.REPLAY))


def opened_model(stack: ExitStack, config: EpisodeConfig, model: Model | None) -> Model:
    """The model of an episode that begins: the one that was handed in, or that of the URI.

    Args:
        stack: Closes what is made here.
        config: Names the model.
        model: What was handed in.

    Raises:
        ModelConfigError: The model is unknown or lacks a key or an extra, or is no model.
    """
    if model is not None:
        return checked(model)
    made = model_of(config.model, tools=config.tool_calls, profile=config.profile, seed=config.seed)
    stack.callback(made.info.close)
    return made


def resumed_model(
    stack: ExitStack,
    folder: Path,
    config: EpisodeConfig,
    recorded: Trajectory,
    model: Model | None,
) -> Model:
    """A model that says again what was recorded, and then goes on live.

    Args:
        stack: Closes what is made here.
        folder: The run folder.
        config: Names the model.
        recorded: What happened so far.
        model: Who goes on, if it was handed in.
    """
    said = [thought.reply for thought in recorded.thoughts]
    script = folder / SCRIPT
    live = None if model is None else checked(model)
    if live is None:
        live = model_of(
            config.model,
            tools=config.tool_calls,
            profile=config.profile,
            answered=len(said),
            seed=config.seed,
            script=script if script.is_file() else None,
        )
        stack.callback(live.info.close)
    if (folder / FOLDER).is_dir():
        live = taped(live, folder / FOLDER, known=len(said))
    return resumed(said, live)
