"""`adamo-vh speech`: models of ears and voices, and a try of each."""

from __future__ import annotations

from pathlib import Path

import typer

from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import line, say
from adamo_vh.files import naming, write_whole
from adamo_vh.speech.models import (
    DEFAULT_EARS,
    DEFAULT_VOICE,
    MODELS,
    fetch,
    known,
    recognizer,
    voice,
)
from adamo_vh.speech.sound import Sound

_MOST_BYTES = 60_000_000


def show_models() -> None:
    """Print every model that can be fetched."""
    for model in MODELS:
        here = "here" if model.is_here else f"{model.megabytes} MB"
        line(here, f"{model.name}: {model.kind}; {model.what}; {model.license}; {model.source}")


def fetch_model(name: str, *, asked: bool) -> None:
    """Download a model, after a question.

    Args:
        name: Of the model.
        asked: Whether the user has said so already.
    """
    model = known(name)
    if model.is_here:
        say(f"{name} is here already: {model.folder}")
        return
    say(f"{name}: {model.megabytes} MB from {model.source}; license: {model.license}")
    if not asked and not typer.confirm("Fetch it?", default=True):
        raise typer.Exit(Exit.NO)
    say(f"Kept in {fetch(model, tell=say)}")


def say_text(text: str, out: Path, name: str | None) -> None:
    """Say a text into a file."""
    spoken = voice(name or DEFAULT_VOICE).speak(text)
    write_whole(out, spoken.sound.wav())
    say(f"{out}: {spoken.sound.seconds:.1f} s, {len(spoken.phonemes)} phonemes")


def hear_file(file: Path, name: str | None) -> None:
    """Print what is said in a file."""
    with naming("read", file), file.open("rb") as opened:
        sound = Sound.of_wav(opened.read(_MOST_BYTES))
    heard = recognizer(name or DEFAULT_EARS).hear(sound)
    if not heard.text:
        say("Nobody speaks in it.")
        raise typer.Exit(Exit.NO)
    say(heard.text)
