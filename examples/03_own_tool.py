"""A new tool for the body: a frozen dataclass and a function.

The dataclass is the tool's schema, its validation and its line in the record at once; what stands
in its docstring and its fields is what the model reads.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from pydantic import Field

import adamo_vh
from adamo_vh.action import Code, Feedback, Outcome
from adamo_vh.action_server import PAPER_TOOLS, Tool, ToolContext
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.players.scripted import ScriptedModel


@dataclass(frozen=True, slots=True)
class Measure:
    """Tell how far away an object is from you."""

    object: Annotated[str, Field(description="Tag of an object that you have seen.")]


def measure(context: ToolContext, action: Measure) -> Feedback:
    """What the tool does; it may use the body and the tags, never the world's truth."""
    number = context.seen_object(action.object)  # An unseen tag is refused by itself.
    seen = context.body.see(640, 360).objects.get(number)
    if seen is None:
        text = f"{action.object} is not in view now."
        return Feedback(Outcome.REFUSED, Code.NOT_IN_VIEW, f"Refused: {text}")
    far = seen.box.center.horizontal_distance(context.body.state().position)
    return Feedback(Outcome.DONE, Code.OK, f"Done: {action.object} is {far:.2f} m away.")


def main() -> None:
    """Offer it to a model; here a script."""
    steps = [
        AIMessage("I ask how far the cup is.", (ToolCall("1", "Measure", {"object": "Cup_45"}),)),
        AIMessage("I know it now."),
    ]
    heard: list[str] = []

    class Listener:
        """An observer is told of every event."""

        def notify(self, event: object, frame: object = None) -> None:
            feedback = getattr(event, "feedback", None)
            if feedback is not None:
                heard.append(feedback.text)

    adamo_vh.run_episode(
        "How far is the cup?",
        model=ScriptedModel("script", steps),
        tools=(*PAPER_TOOLS, Tool(Measure, measure)),
        observers=[Listener()],
        resolution=(640, 360),
    )
    print("\n".join(heard))


if __name__ == "__main__":
    main()
