"""Fine-tuning data: one line a turn, the prompt exactly as it was and the answer to learn.

The prompt of a turn is not the beginning of the next one: the symbolic state is always the latest,
and old pictures leave. So every turn is an example of its own, and only its last message has
weight.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from adamo_vh.adapters.exports.chat import chat_message, chat_messages, chat_tools
from adamo_vh.adapters.exports.form import Form
from adamo_vh.adapters.exports.pictures import InlinePictures, PictureFiles, Pictures
from adamo_vh.adapters.exports.prompts import Prompt, prompts
from adamo_vh.adapters.exports.recorded import Episode
from adamo_vh.files import naming

TRAIN = "train.jsonl"


def write_sft(episodes: Iterable[Episode], folder: Path, form: Form) -> int:
    """Write episodes as chat examples in the OpenAI format.

    Nothing but what the model was shown and said is written; answers that were neither a call nor
    a final answer are left out.

    Args:
        episodes: What is exported.
        folder: Takes `train.jsonl` and `images/`.
        form: Whether pictures come inside the lines, and scores beside them.

    Returns:
        How many episodes were written.
    """
    pictures: Pictures = InlinePictures() if form.inline_pictures else PictureFiles(folder)
    count = 0
    with naming("written", folder / TRAIN), (folder / TRAIN).open("w", encoding="utf-8") as file:
        for episode in episodes:
            with episode.tolerated():
                lines = [_line(prompt, episode, pictures, form) for prompt in prompts(episode)]
                file.writelines(lines)
                count += 1
    return count


def _line(prompt: Prompt, episode: Episode, pictures: Pictures, form: Form) -> str:
    """An example as its line; nothing for an answer that is not to be learnt."""
    if prompt.reply.ending.is_failure:
        return ""
    example = _example(prompt, episode, pictures)
    if form.with_score:
        score = {"completion": episode.completion, "strict": episode.strict}
        example |= {"episode": episode.name, **score}
    return json.dumps(example, ensure_ascii=False) + "\n"


def _example(prompt: Prompt, episode: Episode, pictures: Pictures) -> dict[str, Any]:
    messages = chat_messages(prompt.messages, pictures)
    for message in messages:
        if message["role"] == "assistant":
            message["weight"] = 0
    messages.append(chat_message(prompt.reply.message, pictures) | {"weight": 1})
    several = episode.manifest.config.profile.plan > 1
    tools = chat_tools(prompt.tools)
    return {"messages": messages, "tools": tools, "parallel_tool_calls": several}
