"""Pictures of an export: files named by their content, each written once, or inside the text."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

from adamo_vh.files import data_url, make_folder, naming
from adamo_vh.inference.messages import ImagePart
from adamo_vh.observation import Frame
from adamo_vh.record.trajectory import frame_name

IMAGES = "images"


class Pictures(Protocol):
    """Where pictures go."""

    def url(self, picture: Frame | ImagePart) -> str:
        """Keep a picture; says how a text refers to it."""
        ...


class PictureFiles:
    """Pictures as files beside the text."""

    def __init__(self, folder: Path) -> None:
        """Write them below a folder.

        Args:
            folder: That of the texts; the references are relative to it.
        """
        self._folder = folder / IMAGES

    def url(self, picture: Frame | ImagePart) -> str:
        """Write a picture, unless it is there; its relative path."""
        frame = Frame(picture.data, picture.media_type, picture.width_px, picture.height_px)
        path = make_folder(self._folder) / frame_name(frame)
        if not path.exists():
            with naming("written", path):
                path.write_bytes(frame.data)
        return f"{IMAGES}/{path.name}"


class InlinePictures:
    """Pictures inside the text, as data URLs."""

    def url(self, picture: Frame | ImagePart) -> str:
        """The picture itself."""
        return data_url(picture.media_type, picture.data)
