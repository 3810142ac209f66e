"""Ways of speaking turned into plainer ones, before the grammar reads them."""

from __future__ import annotations

import re
from functools import cache

_NOUN = r"(?:objects?|items?|things?|ones?)"
_MODAL = (
    r"(?:should|must|shall|ought to|needs? to|has to|have to|is to|are to|can|could|will|to|"
    r"(?:i )?want|(?:i )?would like)"
)
_TAKEN = r"(?:picked|taken|grabbed|lifted|fetched|held|got|gotten|grasped|collected)"
_PLACED = (
    r"(?:moved|brought|carried|taken|put|set|laid|placed|dropped|left|positioned|located|rested|"
    r"deposited|transferred|stood)"
)
_PREPOSITION = r"(?:on|onto|in|into|to|near|next|beside|by|close|alongside|adjacent|at|down)"
_PLACE_VERB = r"(?:put|place|drop|leave|set|lay)"
_RULES: tuple[tuple[str, str], ...] = (
    (r"\bi'd\b", "i would"),
    (r"\b(?:that|it|what)'s\b", "that is"),
    (r"^\W*(?:your|the|my) (?:task|job|goal|instruction|mission)\b(?: is)?(?: to)?\s*:?", ""),
    (r"^(.+?) is the (?:object|thing|item|one)(?: that| which)? i (?:want|need|would like) you to "
     r"([^.]+)", r"\2 \1"),
    (rf"^(?:of|among|amongst|out of|from) all (?:of )?(?:the )?{_NOUN}(?: in the room)?\s*,", ""),
    (r"\bwhich (object|item|thing|one) is\b", r"the \1 that is"),
    (rf"\bwhichever ({_NOUN}) (?=is\b|are\b|has\b|have\b)", r"the \1 that "),
    (r"\bwhichever\b", "any"),
    (r"\b(?:partly|partially|somewhat|in part) (\w+)", r"with \1 parts"),
    (r"\b(?:that|which) (?:is|are) with\b", "with"),
    (rf"\b({_NOUN}) carrying\b", r"\1 having"),
    (r"\blet (.+?) be\b", r"\1 should be"),
    (rf"\b({_MODAL}) (?:all|both|each|now) be\b", r"\1 be"),
    (r"\b(?:is|are) to be\b", "should be"),
    (rf"\b({_MODAL}) be {_PLACED}(?: down| over| back)?(?= {_PREPOSITION}\b)", "should be"),
    (rf"\b{_MODAL} be {_TAKEN}(?: up)?\b", "should be in your hand"),
    (rf"\b(?:once|after|when|as soon as) (?:you (?:have |had )?|having )({_TAKEN}|pick|take|get)"
     r"(?: up)?\b", "pick up"),
    (r"\bso that (?:it|they) (?:is|are|stands?|lies?|ends? up|rests?|goes)\b", ""),
    (r"\bso (?:it|they) (?:is|are|stands?|lies?|ends? up|rests?)\b", ""),
    (rf"\b(?:the following|(?:these |those |the )?(?:two|three|four|five))(?: {_NOUN})? "
     rf"({_PREPOSITION} [^:]+):([^.!?]+)", r"\2 \1"),
    (r"\b(?:go|walk|head|move)(?: over)? (?:to|into) ((?:a|any|one|some|the)[\w ]*? corner"
     rf"(?: of the room)?)\W+(?:and |then )*{_PLACE_VERB} (it|them)(?: down)?(?: on the floor)?"
     r"(?: there)?", r"put \2 in \1"),
    (r"\b(?:that|which) you (?:like|want|prefer|please|choose)\b", ""),
    (r"\b(?:you (?:like|prefer|choose)|of your choice)\b", ""),
)  # fmt: skip


@cache
def _compiled() -> tuple[tuple[re.Pattern[str], str], ...]:
    return tuple((re.compile(pattern), plain) for pattern, plain in _RULES)


def rephrased(text: str) -> str:
    """An instruction in plainer words, lower case.

    Passive becomes a wish about a place, subordinate clauses become clauses of their own, lists
    behind a colon go where they belong.

    Args:
        text: What the user wrote.
    """
    plain = " ".join(text.lower().replace("\u2019", "'").split())
    for pattern, better in _compiled():
        plain = pattern.sub(better, plain)
    return plain
