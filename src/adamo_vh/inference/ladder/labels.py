"""The labels of steps as text: Thought, Action, Action Input, Observation, Final Answer."""

from __future__ import annotations

import re
from collections.abc import Iterator

THOUGHT, ACTION, INPUT = "thought", "action", "actioninput"
OBSERVATION, ANSWER = "observation", "finalanswer"
_LABEL = re.compile(
    r"^[ \t>*_#`-]*+(thought|action[ _]?input|action|observation|final[ _]?answer)[ \t*_`]{0,20}:"
    r"[ \t*]*+",
    re.IGNORECASE | re.MULTILINE,
)
_INPUT_ON_THE_SAME_LINE = re.compile(
    r"(?<![ \t,;\n])[ \t,;]++(?=action[ _]?input[ \t*]{0,9}:)", re.IGNORECASE
)


def sections(text: str) -> Iterator[tuple[str, str]]:
    """Labels in small letters without spaces, with what follows each; "" before the first."""
    text = _INPUT_ON_THE_SAME_LINE.sub("\n", text)
    label, begin = "", 0
    for found in _LABEL.finditer(text):
        yield label, text[begin : found.start()]
        label, begin = re.sub(r"[ _]", "", found[1]).lower(), found.end()
    yield label, text[begin:]


def without_thoughts(text: str) -> str:
    """The text without what may be a draft of a step: all thoughts before an action or an answer.

    Where there is neither, a thought ends with the first line that begins with JSON or a code
    fence: some put their step there.
    """
    kept: list[str] = []
    found = list(sections(text))
    last = max((i for i, (label, _) in enumerate(found) if label in (ACTION, ANSWER)), default=-1)
    for place, (label, content) in enumerate(found):
        if label != THOUGHT:
            kept.append(content)
        elif place > last:
            lines = content.splitlines(keepends=True)[1:]
            begin = next((i for i, line in enumerate(lines) if _begins_step(line)), len(lines))
            kept += lines[begin:]
    return "\n".join(kept)


def _begins_step(line: str) -> bool:
    return line.lstrip().startswith(("{", "```"))
