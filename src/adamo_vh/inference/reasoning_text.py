"""Tell reasoning that a model wrote into its text from what it says.

Servers that do not know a model's format leave its reasoning in the text, often without the tag
that opens it, because the chat template has already written that one. What stands in there is a
draft: it is never said, and never executed.
"""

from __future__ import annotations

import re

from adamo_vh.inference.json_scan import whole_json

_WORDS = (
    r"(?:think(?:ing)?|thoughts?|reason(?:ing)?(?:_content)?|analysis|reflection|scratch_?pad"
    r"|(?:inner_|internal_)?monologue|cot|chain_of_thought)"
)
_TAG = re.compile(
    rf"(?P<open><(?:\w{{1,12}}[:_])?{_WORDS}>|\[{_WORDS}\]|◁{_WORDS}▷"
    rf"|<\|(?:begin_of_|start_)?{_WORDS}\|>|<\|channel>{_WORDS}\b|<unused94>)"
    rf"|(?P<close></(?:\w{{1,12}}[:_])?{_WORDS}>|\[/{_WORDS}\]|◁/{_WORDS}▷"
    rf"|<\|(?:/|end_of_|end_){_WORDS}\|>|<channel\|>|<unused95>)",
    re.IGNORECASE,
)
_TOKEN = re.compile(r"<\|(start|channel|message|constrain|end|call|return)\|>")
_RECIPIENT = re.compile(r"\bto=(\S{1,200})")
_STRIPPED = re.compile(r"assistant(?=(?:analysis|commentary|final))")
_CHANNEL = re.compile(r"\A(analysis|commentary|final)")
_END = re.compile(
    r"(?:\s|<\|(?:im_end|eot_id|eom_id|end|endoftext|end_of_text|return)\|>|</s>)++\Z"
)


def split_reasoning(text: str) -> tuple[str, str]:
    """What a text says, and the reasoning in it.

    Args:
        text: The text of an answer.

    Returns:
        The rest without reasoning, with calls of Harmony's channels in ``<tool_call>`` tags; and
        the reasoning, without its tags.
    """
    if whole_json(text) is not None:
        return text, ""  # A tag inside a JSON string is no tag.
    said, drafts = _channels(text)
    position, inside = 0, False
    shown: list[str] = []
    for tag in _TAG.finditer(said):
        piece = said[position : tag.start()]
        if tag["close"]:
            # Without an opening tag, all that came before was reasoning.
            drafts += [piece] if inside else [*shown, piece]
            shown = shown if inside else []
        else:
            (drafts if inside else shown).append(piece)
        position, inside = tag.end(), not tag["close"]
    (drafts if inside else shown).append(said[position:])
    return _without_end("".join(shown)).strip(), "\n".join(drafts).strip()


def _without_end(text: str) -> str:
    """The text without the tokens that end a turn, where a server left them."""
    tail = max(0, len(text) - 200)
    return text[:tail] + _END.sub("", text[tail:])


def _channels(text: str) -> tuple[str, list[str]]:
    """The text of Harmony's channels, and what was on the channel for reasoning."""
    if "<|channel|>" in text or "<|message|>" in text:
        return _joined(_messages(text))
    if _CHANNEL.match(text) and _STRIPPED.search(text):
        # The server took the tokens out and left the words between them.
        parts = [part for part in _STRIPPED.split(text) if part]
        return _joined([_stripped_message(part) for part in parts])
    return text, []


def _messages(text: str) -> list[tuple[str, str]]:
    """Head and body of each message."""
    found: list[tuple[str, str]] = []
    head, kind, position = "", "", 0
    for token in [*_TOKEN.finditer(text), None]:
        piece = text[position : token.start() if token else len(text)]
        if kind in ("start", "channel", "constrain"):
            head += f" {piece}"
        elif piece.strip() or kind == "message":
            found.append((head, piece))
            head = ""
        if token is None:
            break
        if token[1] in ("start", "end", "call", "return"):
            head = ""
        head += " channel " if token[1] == "channel" else ""
        kind, position = token[1], token.end()
    return found


def _stripped_message(part: str) -> tuple[str, str]:
    channel = _CHANNEL.match(part)
    if channel is None:
        return "", part
    rest = part[channel.end() :]
    begin = rest.find("{")
    if _RECIPIENT.match(rest.lstrip()) and begin >= 0:
        return f"{channel[1]} {rest[:begin]}", rest[begin:]
    return f"channel {channel[1]}", rest


def _joined(messages: list[tuple[str, str]]) -> tuple[str, list[str]]:
    said: list[str] = []
    drafts: list[str] = []
    for head, body in messages:
        recipient = _RECIPIENT.search(head)
        if recipient:
            said.append(f"<tool_call>{recipient[1]}\n{body.strip()}</tool_call>")
        else:
            (drafts if "analysis" in head.split() else said).append(body)
    return "\n".join(said), drafts
