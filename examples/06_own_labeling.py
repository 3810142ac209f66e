"""Names of your own for the objects: in the frame, in the text and in the tools alike.

A labeling makes tags and reads them; nothing else in the program takes a tag apart. The two of the
paper are `sem` (`Cup_45`) and `opaq` (`45`).
"""

from __future__ import annotations

from collections.abc import Mapping

import adamo_vh
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.players.scripted import ScriptedModel


class Dashed:
    """Small letters and a dash: `cup-45`."""

    described = "A tag is the kind of thing, a dash and a number, e.g. cup-45."

    def tag(self, object_id: int, class_name: str) -> str:
        """The tag of an object."""
        return f"{class_name.lower()}-{object_id}"

    def short(self, object_id: int, class_name: str) -> str:
        """The shortest name that is understood."""
        return self.tag(object_id, class_name)

    def resolve(self, text: str, known: Mapping[int, str]) -> int | None:
        """The object that a model means; None if it names none without doubt."""
        wanted = text.strip().lower()
        for object_id, class_name in known.items():
            if wanted == self.tag(object_id, class_name):
                return object_id
        return None


class Listener:
    """An observer is told of every event."""

    def notify(self, event: object, frame: object = None) -> None:
        """Print what the body answers."""
        if feedback := getattr(event, "feedback", None):
            print(feedback.text)


def main() -> None:
    """Let a script use the new tags."""
    steps = [
        AIMessage("There is cup-45.", (ToolCall("1", "Pick", {"object": "cup-45"}),)),
        AIMessage("I hold it."),
    ]
    result = adamo_vh.run_episode(
        "Take the cup",
        model=ScriptedModel("script", steps),
        labeling=Dashed(),
        observers=[Listener()],
        resolution=(640, 360),
    )
    print(result.termination, "-", result.answer)


if __name__ == "__main__":
    main()
