"""The mind: a model from its URI, recorded runs and cassettes included."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from adamo.cognition.profile import PAPER, Profile, StateText
from adamo.cognition.trajectory import Trajectory, read_trajectory
from adamo.inference.cassette import Cassette
from adamo.inference.messages import AIMessage
from adamo.inference.model import Model, ModelKind, Rung
from adamo.inference.registry import create_model
from adamo.inference.scripted import ScriptedModel

CASSETTE = "cassette"
"""Folder within a run folder that keeps the requests and replies of a recorded model."""
_REPLAY, _CASSETTE = "replay:", "cassette:"


def create_player(
    uri: str, *, tools: str = "auto", profile: Profile = PAPER, answered: int = 0
) -> Model:
    """The model of a URI.

    Args:
        uri: As in `adamo.inference.registry.create_model`, or ``replay:RUN_DIR``, or
            ``cassette:DIR`` with a run folder or the cassette in it.
        tools: How a remote model is asked for calls: "auto", "native", "schema" or "react".
        profile: Decides whether a remote model may give several calls at once, and whether a
            cache of its prompt pays.
        answered: Replies that were given before an interruption; a model that answers from a list
            leaves them out.

    Raises:
        ModelConfigError: The model is unknown or lacks a key or an extra.
        RecordError: A run folder or cassette is missing or damaged.
    """
    if uri.startswith(_REPLAY):
        folder = Path(uri.removeprefix(_REPLAY))
        model: Model = recorded_model(read_trajectory(folder), uri)
    elif uri.startswith(_CASSETTE):
        folder = Path(uri.removeprefix(_CASSETTE))
        model = Cassette(folder / CASSETTE if (folder / CASSETTE).is_dir() else folder)
    else:
        model = create_model(
            uri,
            tools=tools,
            several_calls=profile.plan > 1,
            # A state at the front changes with every action, and all behind it would be written
            # into the cache in vain.
            cache=profile.state is not StateText.FIRST,
        )
    if isinstance(model, ScriptedModel | Cassette):
        model.skip(answered)
    return model


def fitting(profile: Profile, model: Model) -> Profile:
    """The profile that a model can follow: one that is asked for steps as text gives one a turn."""
    if getattr(model, "rung", None) in (Rung.SCHEMA, Rung.REACT):
        return replace(profile, plan=1)
    return profile


def close_player(model: Model) -> None:
    """Close a model's connections, if it has any."""
    close = getattr(model, "close", None)
    if callable(close):
        close()


def recorded_model(trajectory: Trajectory, name: str) -> Model:
    """A model that says again what was said in a recorded episode."""
    said = [AIMessage(thought.note, thought.calls) for thought in trajectory.thoughts]
    return ScriptedModel(name, said, kind=ModelKind.REPLAY)
