"""What a mind is told, as the content of MCP messages."""

from __future__ import annotations

import base64
import re

import mcp_types as types

from adamo_vh.inference.messages import ImagePart
from adamo_vh.observation import Frame
from adamo_vh.record.trajectory import frame_name
from adamo_vh.service.mcp.pictures import fitted
from adamo_vh.service.mcp.prompts import render
from adamo_vh.session.outside import OutsideEpisode, View

SCHEME = "adamo"
_FRAME_URI = re.compile(rf"{SCHEME}://episode/([^/]+)/frame/([^/]+)")
_INSTRUCTIONS_URI = re.compile(rf"{SCHEME}://episode/([^/]+)/instructions")


def text(words: str) -> types.TextContent:
    """A text."""
    return types.TextContent(text=words)


def instructions_uri(name: str) -> str:
    """Address of what an episode asks for."""
    return f"{SCHEME}://episode/{name}/instructions"


def frame_uri(name: str, frame: str) -> str:
    """Address of a picture as it was drawn."""
    return f"{SCHEME}://episode/{name}/frame/{frame}"


def read_uri(uri: str) -> tuple[str, str] | None:
    """The episode and the frame of an address; no frame for its instructions; None if neither."""
    if found := _FRAME_URI.fullmatch(uri):
        return found[1], found[2]
    if found := _INSTRUCTIONS_URI.fullmatch(uri):
        return found[1], ""
    return None


def instructions(name: str, episode: OutsideEpisode) -> str:
    """What an episode asks for, how its world works and what happened in it so far."""
    profile, limits = episode.config.profile, episode.config.limits
    return render(
        "instructions",
        episode=name,
        system=episode.system_prompt(),
        instruction=episode.instruction,
        story=episode.story(),
        note_argument=profile.note_argument,
        finish_check=profile.finish_check,
        state=profile.state,
        pictures=profile.pictures,
        max_steps=limits.max_steps,
        max_minutes=f"{limits.max_seconds / 60:g}",
    )


def content(name: str, view: View) -> list[types.ContentBlock]:
    """What came back: the words, the whole state, and each picture with a link to its frame."""
    blocks: list[types.ContentBlock] = [text(words) for words in (view.text, view.state) if words]
    for picture in view.pictures:
        blocks += _shown(name, picture)
    return blocks


def _shown(name: str, picture: ImagePart) -> list[types.ContentBlock]:
    small = fitted(picture)
    frame = frame_name(Frame(picture.data, picture.media_type, picture.width_px, picture.height_px))
    note = render(
        "picture_reduced",
        width=small.width_px,
        height=small.height_px,
        frame_width=picture.width_px,
        frame_height=picture.height_px,
    )
    data = base64.b64encode(small.data).decode()
    return [
        *([] if small is picture else [text(note)]),
        types.ImageContent(data=data, mime_type=small.media_type),
        types.ResourceLink(
            name=frame,
            uri=frame_uri(name, frame),
            description="The picture as it was drawn.",
            mime_type=picture.media_type,
            size=len(picture.data),
        ),
    ]
