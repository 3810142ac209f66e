"""The models of speech: which there are, how they are fetched, and where they are kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from adamo_vh.errors import ConfigError
from adamo_vh.extras import extra
from adamo_vh.files import data_folder, make_folder
from adamo_vh.speech.hearing import Recognizer, Whisper
from adamo_vh.speech.speaking import Flite, Piper, Voice

FLITE = "flite"


@dataclass(frozen=True, slots=True)
class SpeechModel:
    """A model that can be fetched."""

    name: str
    kind: Literal["hears", "speaks"]
    what: str
    megabytes: int
    """About; of the download."""
    license: str
    """As its publisher says."""
    source: str
    """Repository on the Hugging Face Hub."""
    files: tuple[str, ...]
    """Paths in it."""

    @property
    def folder(self) -> Path:
        """Where it is kept."""
        return data_folder() / "speech" / self.name

    @property
    def is_here(self) -> bool:
        """Whether it was fetched."""
        return all((self.folder / file).is_file() for file in self.files)


def _whisper(size: str, megabytes: int) -> SpeechModel:
    files = ("config.json", "model.bin", "tokenizer.json", "vocabulary.txt")
    return SpeechModel(
        size,
        "hears",
        f"Whisper {size.removesuffix('.en')}, English",
        megabytes,
        "MIT",
        f"Systran/faster-whisper-{size}",
        files,
    )


def _piper(name: str, what: str, licensed: str) -> SpeechModel:
    _, speaker, quality = name.split("-")
    path = f"en/en_US/{speaker}/{quality}/{name}.onnx"
    files = (path, f"{path}.json")
    return SpeechModel(name, "speaks", what, 63, licensed, "rhasspy/piper-voices", files)


MODELS = (
    _whisper("tiny.en", 75),
    _whisper("base.en", 145),
    _whisper("small.en", 484),
    _piper("en_US-ljspeech-medium", "a woman, American", "public domain (LJ Speech)"),
    _piper("en_US-joe-medium", "a man, American", "CC0 data, tuned from another voice"),
)
DEFAULT_EARS, DEFAULT_VOICE = "tiny.en", "en_US-ljspeech-medium"


def known(name: str) -> SpeechModel:
    """A model by its name.

    Raises:
        ConfigError: There is none; lists them.
    """
    for model in MODELS:
        if model.name == name:
            return model
    names = ", ".join(model.name for model in MODELS)
    raise ConfigError(f"There is no model {name!r}. Models: {names}.")


def fetch(model: SpeechModel, tell: Callable[[str], None] = lambda _: None) -> Path:
    """Download a model to where it is kept; what is there already is not fetched again.

    Args:
        model: Which one.
        tell: Is told of each file.

    Returns:
        Its folder.

    Raises:
        ConfigError: The extra `speech` is missing, or the model cannot be had now.
    """
    with extra("speech", "Fetching a model of speech"):
        from huggingface_hub import hf_hub_download
    folder = make_folder(model.folder)
    for file in model.files:
        tell(f"{model.source}/{file}")
        try:
            hf_hub_download(model.source, file, local_dir=folder)
        except Exception as error:  # The library raises what its network library does.
            first = str(error).strip().splitlines()[:1]
            raise ConfigError(
                f"{model.name} cannot be fetched from the Hugging Face Hub: "
                f"{first[0] if first else type(error).__name__}. Try later, or put its files into "
                f"{folder}."
            ) from None
    return folder


def recognizer(name: str = DEFAULT_EARS, hints: str = "") -> Recognizer:
    """What hears.

    Args:
        name: A model's name, or the folder of any Whisper model in CTranslate2's form.
        hints: Words that are likely.

    Raises:
        ConfigError: It was not fetched, or the extra `speech` is missing.
    """
    if (folder := Path(name)).is_dir():
        return Whisper(folder, hints)
    return Whisper(_fetched(name, "hears").folder, hints)


def voice(name: str = DEFAULT_VOICE) -> Voice:
    """What speaks.

    Args:
        name: A voice's name, the path of any voice of Piper's kind (NAME.onnx), or ``flite`` or
            ``flite:VOICE`` for that program.

    Raises:
        ConfigError: It was not fetched, or the extra `speech` is missing.
    """
    if name.partition(":")[0] == FLITE:
        return Flite(name.partition(":")[2] or "slt")
    if (file := Path(name)).suffix == ".onnx" and file.is_file():
        return Piper(file)
    model = _fetched(name, "speaks")
    return Piper(model.folder / model.files[0])


def _fetched(name: str, kind: str) -> SpeechModel:
    model = known(name)
    if model.kind != kind:
        names = ", ".join(one.name for one in MODELS if one.kind == kind)
        raise ConfigError(f"{name} {model.kind}; what {kind}: {names}.")
    if not model.is_here:
        raise ConfigError(
            f"{name} is not here. Fetch it once ({model.megabytes} MB, {model.license}): "
            f"adamo-vh speech fetch {name}"
        )
    return model
