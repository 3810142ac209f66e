"""The models of speech: which there are, how they are fetched, and where they are kept."""

from __future__ import annotations

import errno
import hashlib
import logging
import shutil
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
_PART = ".fetching"
"""Folder within a model's own of what is not whole yet."""
_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


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
    """Download a model to where it is kept; files that are there already are not fetched again.

    A file is there whole, with the digest that the hub tells, or not at all.

    Args:
        model: Which one.
        tell: Is told of each file.

    Returns:
        Its folder.

    Raises:
        ConfigError: The extra `speech` is missing, or the model cannot be had or kept now.
    """
    with extra("speech", "Fetching a model of speech"):
        from huggingface_hub import get_hf_file_metadata, hf_hub_download, hf_hub_url
    # It would tell each attempt in lines of its own; what came of all is told below.
    logging.getLogger("huggingface_hub").setLevel(logging.CRITICAL)
    folder = make_folder(model.folder)
    part = folder / _PART
    try:
        for file in model.files:
            if (folder / file).is_file():
                continue
            tell(f"{model.source}/{file}")
            told = get_hf_file_metadata(hf_hub_url(model.source, file))
            path = Path(
                hf_hub_download(model.source, file, revision=told.commit_hash, local_dir=part)
            )
            if told.etag and not _has_digest(path, told.etag):
                raise ConfigError(
                    f"{model.name}: {file} came otherwise than it is on the Hugging Face Hub; it "
                    "was deleted. Fetch it again."
                )
            make_folder((folder / file).parent)
            path.replace(folder / file)
    except ConfigError:
        raise
    except Exception as error:  # The library raises what its network library does.
        raise ConfigError(f"{model.name} {_why(error, model, folder)}") from None
    finally:
        shutil.rmtree(part, ignore_errors=True)
    return folder


def _has_digest(path: Path, etag: str) -> bool:
    """Whether a file is what the hub tells: the SHA-256 of large ones, Git's name of the others."""
    size, content = path.stat().st_size, path.open("rb")
    with content:
        match len(etag):
            case 64:
                return hashlib.file_digest(content, "sha256").hexdigest() == etag
            case 40:
                told = hashlib.sha1(b"blob %d\0" % size + content.read(), usedforsecurity=False)
                return told.hexdigest() == etag
    return True


def _why(error: Exception, model: SpeechModel, folder: Path) -> str:
    """Why a model could not be fetched, and what helps."""
    if isinstance(error, OSError) and error.errno in _FULL:
        return (
            f"cannot be kept in {folder}: {error.strerror}. It takes {model.megabytes} MB; make "
            "room, or set ADAMO_VH_DATA_DIR to another folder, and fetch it again."
        )
    first = str(error).strip().splitlines()[:1]
    return (
        f"cannot be fetched from the Hugging Face Hub: "
        f"{(first[0] if first else type(error).__name__).rstrip('.')}. Try later, or put its files "
        f"into {folder}."
    )


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
