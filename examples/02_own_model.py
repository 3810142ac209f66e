"""Your own model behind the loop: anything with `info` and `complete`.

It gets the whole prompt (messages with texts and pictures) and the tools on offer, and answers with
a note and a call, or with a final answer. This one reads the list of objects and takes the first.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import adamo_vh
from adamo_vh.action import ToolSchema
from adamo_vh.inference.messages import AIMessage, Message, SystemMessage, ToolCall, ToolMessage
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling


class FirstInTheList:
    """Takes what the list names first, whatever it is told."""

    info = ModelInfo("first-in-the-list", ModelKind.RULE_BASED)

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        """Answer a prompt."""
        results = [message for message in messages if isinstance(message, ToolMessage)]
        if results:
            return Reply(AIMessage(f"The body told me: {results[-1].text}"))
        state = "\n".join(m.text for m in messages if isinstance(m, SystemMessage))
        tag = re.findall(r"\b[A-Z][A-Za-z]+_\d+", state)[-1]
        call = ToolCall("call-1", "Pick", {"object": tag})
        return Reply(AIMessage(f"The list names {tag}, so I take it.", (call,)))


def main() -> None:
    """Let it play."""
    result = adamo_vh.run_episode("Take something", model=FirstInTheList(), resolution=(640, 360))
    print(result.termination, "-", result.answer)


if __name__ == "__main__":
    main()
