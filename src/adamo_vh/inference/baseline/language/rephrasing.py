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
_UNITS = {"cm": 1, "centimetre": 1, "centimeter": 1, "m": 100, "metre": 100, "meter": 100,
          "inch": 2.54, "inche": 2.54, "foot": 30, "feet": 30, "step": 60}  # fmt: skip
_NUMBERS = {"a": 1, "an": 1, "one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "half a": 0.5,
            "ten": 10, "twenty": 20, "thirty": 30, "forty": 40, "fifty": 50}  # fmt: skip
_LENGTH = re.compile(
    r"\b(?:by )?(?:about |around |at least |some |roughly |exactly )?"
    r"(\d+(?:[.,]\d+)?|half a|an?|one|two|three|four|five|ten|twenty|thirty|forty|fifty) ?"
    r"(cm|centimet(?:re|er)|m|met(?:re|er)|inche?|foot|feet)s?\b(?: away)?"
)
_WAY_FIRST = re.compile(
    r"\b(?:(?:to|on|towards?) (?:the|your|my) )?(left|right|front|back|forwards?|backwards?|"
    r"closer to me|away from me)(?: (?:for|of))? (@\d+)(?! (?:from|to the|left|right)\b)"
)
_PLAIN_WAY = re.compile(r"(@\d+) (?:towards? )?(?:the )?(left|right)\b(?! (?:of|side|hand)\b)")
_WAY = re.compile(
    r"(@(\d+)|\ba (?:little )?bit|\ba little|\bslightly|\bfurther|\bmore)? ?"
    r"\b(?:(?:to|on|towards?) (?:the|your|my) (left|right|front|back)|"
    r"(forwards?|backwards?|closer to me|away from me|to one side))"
    r"(?! (?:of|side|corner|edge|most|hand))\b"
)
_COUNTED = re.compile(
    r"\b(\d{1,2}) (?=(?:\w+ ){0,2}(?:objects|items|things|batteries|locks|padlocks|keys|bottles|"
    r"glasses|cups|mugs|plates|plants|lighters|tins|cans|screwdrivers|flashlights|torches|tapes)\b)"
)
_WORDS = ["zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"]
_NUMBER_LEFT_OUT = re.compile(
    r"(?!\ball but (?:one|two|three)\b)"
    r"\b(?:all|every\w*|each|any\w*|both|(?:the|two|three|four|five) \w+s)\b[^.;!?]*?"
    r"\b(?:but|except|save|apart from|other than|excluding|aside from|leaving out|minus|"
    r"with the exception of|leave(?: out)?|leaving|keep)(?: for)?"
    r" (?:just |only |exactly |about |any |a )?"
    r"(?:one|two|three|four|five|six|seven|eight|nine|ten|some|few|couple|half|single)\b"
    r"(?: of)?(?: the)?(?: (?!on\b|in\b|to\b|near\b|next\b)\w+)?"
)
_SPOKEN: tuple[tuple[str, str], ...] = (
    (r"^(?:could|can|may) (?:i|we) (?:please )?(?:have|get|take|borrow) ", "get me "),
    (r"^(?:i am|i'm) (?:still )?looking for |^i (?:can't|cannot|can not) find |"
     r"^i(?: have|'ve)? lost (?=[^.,;!]*$)", "find "),
    (r"\bhand ((?:the|my|that|a) [\w ]+?) over\b", r"hand over \1"),
    (r"\b(?:what|whatever) (?:you (?:hold|are holding|have)|is)(?: in your hand)?"
     r"(?=$|[.,;!]| and\b| on\b| in\b| next\b| back\b| down\b)(?<!^what is)", "it"),
    (r"\b(put|place|set|lay|move|drop|leave) (?:that|this) (?=on\b|in\b|next\b|near\b|to\b|down\b|"
     r"back\b|under\b|between\b|beside\b)", r"\1 it "),
    (r"\b(which|what)((?: \w+)?) (is|are) (\w+er)[,:] (.+? or )", r"\1\2 \3 \4 of \5"),
    (r"\bas far (?:away )?from (.+?) as (?:possible|you can)\b", r"far from \1"),
    (r"\bpl[sz]\b", "please"),
    (r"^(?:i|we)(?: have|'ve)? (?:just )?(?:dropped|lost|misplaced|forgot|left) "
     r"((?:my|the|our) [\w ]+?)[.,;!]+", r"find \1,"),
    (r"\b(\w+) neither (.+?) nor (.+)", r"do not \1 \2 or \3"),
    (r"^without (touching|moving|taking|using) ([^,]+), (.+)$", r"do not touch \2, \3"),
    (r"^(.+?),? without (?:touching|moving|taking|using) ([^,.]+)$", r"do not touch \2, \1"),
    (r"\b(?:leave|let) (.+?) (?:alone|where (?:it|they) (?:is|are)|as (?:it|they) (?:is|are)|"
     r"untouched|in (?:its|their) place)\b(?: and\b)?", r"do not touch \1,"),
    (r"\ball (?:of )?(?:the )?(\w+(?: \w+)?) (?:but|except|save)(?: for)? (one|two|three)\b"
     r"(?: of them)?(?! (?!on\b|in\b|to\b|near\b|next\b)\w)", r"all but \2 \1"),
    (r"\ball (?:except|save)(?: for)? (one|two|three)\b", r"all but \1"),
)  # fmt: skip
"""What changes which parts an instruction has."""
_RULES: tuple[tuple[str, str], ...] = (
    (r"\bi'd\b", "i would"),
    (r"\b(?:possibly|perhaps|maybe)\b ?", ""),
    (r"\b(?:something|anything) (red|orange|yellow|green|blue|purple|pink|brown|black|grey|gray|"
     r"white|round|flat|transparent)\b", r"an \1 object"),
    (r"\bnon[- ](\w+) (things|objects|items)", r"\2 except \1 \2"),
    (r"\bbesides (?=(?:the|a|an|my)\b)", "beside "),
    (r"^(?:i|we) (?:need|want|would like) (?=(?:the|a|an|my|that|some) [^,.;]*$)"
     r"(?!.*\b(?:on|in|next|near|to|at|beside|under|between|behind|be)\b)", "get me "),
    (r"\b(?:to |over to )?where (the \w+(?: \w+)?) (?:is|are|stands|lies)\b", r"next to \1"),
    (r"\b(?:that|those|the) ([\w ]+?) over there\b", r"the \1"),
    (r"\b(everything|anything|all|every\w*|each)\b([^.;!?]*?) (?:that|which) (?:is|are) not "
     r"(?:an? |the )?(?=\w)", r"\1\2 except "),
    (r"(?<!where )(?<!or )(?<!nothing )\b(?:all |everything )?else\b|"
     r"\b(?:all )?the rest\b(?: of (?:them|the \w+|it))?",
     "all other objects"),
    (r"\bnothing (?:but|except|other than) ", ""),
    (r"\bthe (\w[\w ]*?)\. (?=(?:on|in|next to|near|under|behind) )", r"the \1 "),
    (r"^(?:i'm|i am|we are|we're|it is|it's) (?:so |very )?\w+\s*[,.;!]\s*", ""),
    (r"\b(?:that|which) (?:is|are) (?:not|n't) (?:an? |the )?", "except "),
    (r"\b(?:that|which) (?:isn't|aren't|is not|are not) (?:an? |the )?", "except "),
    (r"\b(everything|anything|all (?:of )?(?:the )?\w+|every \w+|all) but "
     r"(?!not\b|(?:one|two|three)\b|do\b|don't|never|then\b|first\b|only\b|put\b|place\b|pick\b|take\b|get\b|"
     r"bring\b|move\b|leave\b|drop\b|set\b|lay\b|keep\b|look\b|go\b|hold\b|avoid\b)",
     r"\1 except "),
    (r"\b((?:everything|anything|all|every|each)\b[^.;!?]*?) but (?:for )?(?=(?:the|an?|my)\b)",
     r"\1 except "),
    (r"\b(put|place|set|lay|bring|move|take|get) ((?:(?!\bback\b)[\w' ])+?) back"
     r"(?=\s*(?:$|[.!?;,]|and\b|then\b|please\b))", r"\1 \2 where it was"),
    (r"\b(?:put|place|set|lay) back ((?:the |my |a )?\w+)(?=\s*(?:$|[.!?;,]))",
     r"put \1 where it was"),
    (r"\breturn ((?:the |my |a )?(?!to\b|here\b|back\b)\w+)(?=\s*(?:$|[.!?;,]))",
     r"put \1 where it was"),
    (r"\b(?:put|set|lay|place) (it|them|(?:the|a|my) [\w ]+?) down"
     r"(?=\s*(?:$|[.!?;,]|please\b|and\b|then\b|again\b|now\b))", r"put down \1"),
    (r"\bswap (?:the )?place", "swap place"),
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


def spoken_plainly(text: str) -> str:
    """An instruction whose parts say plainly what to do and what not to do.

    Args:
        text: Lower case.
    """
    for pattern, plain in _SPOKEN:
        text = re.sub(pattern, plain, text)
    return text


def rephrased(text: str) -> str:
    """An instruction in plainer words, lower case.

    Passive becomes a wish about a place, subordinate clauses become clauses of their own, lists
    behind a colon go where they belong.

    Args:
        text: What the user wrote.
    """
    plain = " ".join(text.lower().replace("\u2019", "'").split())
    plain = _COUNTED.sub(_count_word, plain)
    plain = _WAY_FIRST.sub(_way_last, _LENGTH.sub(_length, plain))
    plain = _WAY.sub(_way, _PLAIN_WAY.sub(r"\1 to the \2", plain))
    for pattern, better in _compiled():
        plain = pattern.sub(better, plain)
    return plain


def with_lengths(text: str) -> str:
    """Distances in the one form that the rest of the grammar knows: "1 m" as "@100"."""
    return _LENGTH.sub(_length, text)


def number_left_out(text: str) -> str:
    """Words that leave out a number of things, not which: "all but one lock"; empty if none do."""
    plain = _COUNTED.sub(_count_word, text)
    match = _NUMBER_LEFT_OUT.search(plain)
    return match[0] if match else ""


def _way_last(match: re.Match[str]) -> str:
    side = match[1] in ("left", "right", "front", "back")
    return f"{match[2]} to the {match[1]}" if side else f"{match[2]} {match[1]}"


def _count_word(match: re.Match[str]) -> str:
    number = int(match[1])
    return f"{_WORDS[number]} " if 2 <= number < len(_WORDS) else match[0]


def _length(match: re.Match[str]) -> str:
    number = _NUMBERS.get(match[1]) or float(match[1].replace(",", "."))
    return f"@{round(number * _UNITS[match[2].replace('ers', 'er')])}"


def _way(match: re.Match[str]) -> str:
    way = match[3] or {"f": "front", "b": "back", "c": "back", "a": "front"}.get(
        match[4][0], "left"
    )
    return f" @{way}{match[2] or 25}"
