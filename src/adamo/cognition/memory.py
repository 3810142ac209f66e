"""The Multimodal Short-Term Memory (MSTM): one prompt out of instructions, state and history.

Paper, Sec. 3.1: (i) fixed instructions (system), (ii) the symbolic state, always the latest
(system), (iii) a rolling buffer of human, AI and tool messages. Here `k` counts steps: an AI
message, the answers to its calls, and the frame that followed, cut or kept together, so that no
tool result ever loses its call. The first human message is never dropped.
"""

from __future__ import annotations

from collections import deque

from adamo.errors import ConfigError
from adamo.inference.messages import HumanMessage, Message, SystemMessage


class ShortTermMemory:
    """What the model is shown in each turn."""

    def __init__(self, instructions: str, k: int = 50) -> None:
        """Start empty.

        Args:
            instructions: The fixed system prompt.
            k: How many past steps to keep; at least 1.
        """
        if k < 1:
            raise ConfigError(f"k is {k}; the memory keeps at least 1 step.")
        self._instructions = instructions
        self._state = ""
        self._first: HumanMessage | None = None
        self._steps: deque[tuple[Message, ...]] = deque(maxlen=k)

    def begin(self, message: HumanMessage, state: str) -> None:
        """Remember the instruction with its first frame, and the first symbolic state."""
        self._first = message
        self._state = state
        self._steps.clear()

    def add_step(self, *messages: Message) -> None:
        """Remember a step: what the model said, what came back, and the new frame, if any."""
        self._steps.append(messages)

    def update_state(self, state: str) -> None:
        """Replace the symbolic state."""
        self._state = state

    def messages(self) -> list[Message]:
        """The whole prompt, oldest first."""
        prompt: list[Message] = [SystemMessage(self._instructions), SystemMessage(self._state)]
        if self._first is not None:
            prompt.append(self._first)
        for step in self._steps:
            prompt.extend(step)
        return prompt
