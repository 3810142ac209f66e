"""What the next prompt will be, if a call goes as planned: for plans of several calls."""

from __future__ import annotations

import math
from dataclasses import replace

from adamo_vh.geometry import Vec3
from adamo_vh.inference.baseline.goals import Plan
from adamo_vh.inference.baseline.happenings import happened
from adamo_vh.inference.baseline.memory import Memory
from adamo_vh.inference.baseline.placing import place_words
from adamo_vh.inference.baseline.reading import Event, Prompt
from adamo_vh.inference.baseline.state_text import Body
from adamo_vh.inference.baseline.steps import Move


def imagined(prompt: Prompt, memory: Memory, move: Move, plan: Plan) -> tuple[Prompt, Memory]:
    """Go on in thought.

    Args:
        prompt: Before the call.
        memory: Before the call; stays as it is.
        move: The call, taken to be done as wished.
        plan: What the instruction asks for.

    Returns:
        Prompt and memory after it.
    """
    after = memory.copy()
    event = Event(move.name, dict(move.arguments), _feedback(move, memory))
    happened(event, move.search, after, plan, prompt.room)
    body = replace(_moved(prompt.body, move), hand=after.hand or "empty")
    return replace(prompt, body=body, event=event, fresh=False), after


def _feedback(move: Move, memory: Memory) -> str:
    if move.name != "Drop" or move.point is None:
        return f"Done: {move.tag}."
    thing = memory.things.get(move.tag)
    height = thing.height_m if thing else 0.1
    rest = move.point + Vec3(0.0, 0.0, height / 2)
    return f"Done: {move.tag} rests at {rest} {place_words(move.point)}."


def _moved(body: Body, move: Move) -> Body:
    here, point = body.position, move.point
    if move.name == "Walk" and point is not None:
        heading = math.atan2(point.y - here.y, point.x - here.x)
        return replace(body, position=Vec3(point.x, point.y, 0.0), heading_rad=heading)
    if move.name == "Look" and point is not None:
        heading = math.atan2(point.y - here.y, point.x - here.x)
        return replace(body, heading_rad=heading, gaze=point)
    return body  # where it will stand to pick or drop is up to the body
