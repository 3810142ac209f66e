"""A recorded episode as one conversation, for readers: everything once, in order.

It is no prompt: the model saw the latest state in words in each turn, and perhaps not all of the
pictures; see `adamo_vh.adapters.exports.prompts` for what it was really given.
"""

from __future__ import annotations

from dataclasses import replace

from adamo_vh.adapters.exports.recorded import Episode
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    SystemMessage,
    TextPart,
    ToolMessage,
)
from adamo_vh.record.trajectory import Acted, LeftOut, Observed, Shown, Started, Thought


def dialogue(episode: Episode) -> tuple[Message, ...]:
    """What was said, done and shown.

    Raises:
        RecordError: A picture is missing.
    """
    said: list[Message] = []
    for event in episode.trajectory.events:
        match event:
            case Started():
                if not said:
                    said.append(SystemMessage(event.system_prompt))
                said.append(HumanMessage((TextPart(event.instruction),)))
            case Thought():
                said.append(event.reply.message)
            case Acted():
                # A doubted call is answered too, by the close-up that was made for it.
                said.append(ToolMessage(event.call_id, event.name, event.feedback.text))
            case LeftOut():
                said.append(ToolMessage(event.call_id, event.name, f"Not executed: {event.why}."))
            case Observed() | Shown():
                _show(said, _picture(episode, event))
            case _:
                pass
    return tuple(said)


def _show(said: list[Message], picture: ImagePart) -> None:
    """Put a picture to what brought it: the instruction, or the last call that was executed."""
    match said[-1] if said else None:
        case HumanMessage() as last:
            said[-1] = replace(last, parts=(*last.parts, picture))
        case ToolMessage() as last:
            said[-1] = replace(last, images=(*last.images, picture))
        case AIMessage() | SystemMessage() | None:
            said.append(HumanMessage((picture,)))


def _picture(episode: Episode, event: Observed | Shown) -> ImagePart:
    frame = episode.picture(event)
    return ImagePart(frame.data, frame.media_type, frame.width_px, frame.height_px)
