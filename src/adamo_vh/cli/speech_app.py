"""The commands about ears and voices."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

speech_app = typer.Typer(help="Ears and a voice.", no_args_is_help=True)

Ears = Annotated[
    str | None,
    typer.Option(
        help="tiny.en, base.en, small.en, or the folder of a Whisper model.", show_default="tiny.en"
    ),
]
VoiceName = Annotated[
    str | None,
    typer.Option(
        help="A voice that was fetched, FILE.onnx of Piper's kind, or flite.",
        show_default="en_US-ljspeech-medium",
    ),
]


@speech_app.command("list")
def list_models() -> None:
    """List the models that can be fetched, with size and license."""
    from adamo_vh.cli.speech import show_models

    show_models()


@speech_app.command("fetch")
def fetch(
    name: Annotated[str, typer.Argument(help="One of: adamo-vh speech list.")],
    yes: Annotated[bool, typer.Option("--yes", "-y", help="Do not ask first.")] = False,
) -> None:
    """Download a model once; says its size and license, and asks first."""
    from adamo_vh.cli.speech import fetch_model

    fetch_model(name, asked=yes)


@speech_app.command("say")
def say(
    text: Annotated[str, typer.Argument(help="What to say.")],
    out: Annotated[Path, typer.Option(help="The WAV file to write.")],
    voice: VoiceName = None,
) -> None:
    """Say a text into a WAV file."""
    from adamo_vh.cli.speech import say_text

    say_text(text, out, voice)


@speech_app.command("hear")
def hear(
    file: Annotated[Path, typer.Argument(help="A WAV file.")],
    model: Ears = None,
) -> None:
    """Print what is said in a WAV file."""
    from adamo_vh.cli.speech import hear_file

    hear_file(file, model)
