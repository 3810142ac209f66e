"""Whether a final message claims that everything is done: told from its words, conservatively.

A claim counts only where nothing in the message takes it back. What cannot be told, other
languages than English among it, is neither a claim nor an admission.
"""

from __future__ import annotations

import re

_BENIGN = re.compile(
    r"""
    \b(?:nothing|no\ more
        |no\ (?:further|more|other|additional)\ (?:\w+\ )?(?:actions?|steps?|calls?))
        \ (?:(?:is|are|was|were|has|have|been)\ )?(?:left|remains?|missing|needed|required|necessary
        |more)?(?:\ to\ (?:do|be\ done))?
    | \bnothing\ else\ (?:was|has\ been|is|needs?|to)\b[^.;!\n]*
    | \bwithout\ (?:any\ )?(?:problems?|issues?|errors?|difficult(?:y|ies)|moving\ anything\ else)
    | \bno\ (?:problems?|issues?|errors?|corrections?)\b
    | \bno\ longer\ (?=on|in|at)
    | \bnot\ only\b | \bthe\ only\b | \bnot\ on\ the\ table\ any\ ?more\b
    | \b(?:did\ not|didn't|have\ not|haven't)\ (?:move|touch|disturb)(?:ed)?\ (?:anything|any\ other
        |the\ other|other)[^.;!\n]*
    | [^.;,!\n]*\b(?:at\ first|initially|the\ first\ (?:try|attempt|time))\b[^.;,!\n]*
    | [^.!?\n]*\?
    | \b(?:please\ )?let\ me\ know\b[^.!\n]*
    | \bif\ (?:you|there)\b[^.!\n]*
    """,
    re.VERBOSE,
)
"""Words that sound like an admission and are none."""

_ADMITS = re.compile(
    r"""
    \b(?:can|could|did|do|does|was|were|is|are|has|have|had|would|will|should)\ ?(?:not|n't)\b
    | \b(?:cannot|cant|couldnt|didnt|wont|won't|isnt|arent)\b
    | \b(?:not|never)\b | \bnothing\b | \bno\ \w+
    | \bunable\b | \bfail(?:s|ed|ing|ure)?\b | \bimpossible\b | \bunsuccessful(?:ly)?\b
    | \bin(?:complete|correct)\b | \bunfinished\b | \bpart(?:ly|ially)\b | \bonly\b | \bhalf\b
    | \bmissing\b | \bremain(?:s|ing)\b | \bstill\ (?:need|have|has|must|to|open|in|on|held|holding)
    | \bleft\ to\ (?:do|be|pick|place)\b | \b(?:give|giving|gave)\ up\b | \bran\ out\b
    | \brefused\b | \bunreachable\b | \bout\ of\ reach\b | \bblocked\b | \bexcept\b
    | \b(?:sorry|unfortunately|apolog\w+)\b | \binstead\b | \bwrong\b | \bwithout\ success\b
    | \babort(?:ed|ing)?\b | \bstuck\b | \bunverified\b
    """,
    re.VERBOSE,
)
"""Something was not done, or may not be."""

_HEDGES = re.compile(
    r"""
    \b(?:i|we)(?:'ll|\ will|\ shall|'m\ going\ to|\ am\ going\ to|\ need|\ must|\ should|\ would
        |\ can|\ could|\ plan|\ intend|\ want|\ think|\ believe|\ assume|\ guess|\ tried|\ try
        |\ attempt\w*)\b
    | \blet\ me\b | \blet's\b | \bnext\b(?!\ to\b) | \bwill\ be\b
    | \bto\ be\ (?:done|placed|picked|moved)\b
    | \b(?:maybe|perhaps|might|may|possibly|probably|likely|presumably|apparently|supposedly)\b
    | \b(?:appears?|seems?|should|hopefully|assum\w+|unsure|uncertain|unclear|doubt\w*)\b
    | \bas\ far\ as\b | \b(?:could|can)\ (?:find|see)\b | \bvisible\b
    | \bthat\ i\ (?:found|saw|see|know)\b | \b(?:but|however|although|though|yet)\b
    | \b(?:almost|nearly|mostly|so\ far|partial|some\ of|most\ of)\b
    | \b(?:tool|function)\ ?call\b | \d+\ ?(?:of|/|out\ of)\ ?(?:the\ )?\d+ | \d+\ ?%
    """,
    re.VERBOSE,
)
"""A plan, a doubt or a restriction: no claim, and no admission either."""

_FINISHED = (
    r"(?:done|completed?|finished|accomplished|fulfill?ed|achieved|satisfied|carried\ out|executed"
    r"|performed|met|solved|taken\ care\ of)"
)
_WHOLE = re.compile(
    rf"""
    (?:^|[.!;:\n✓✔✅]|--)\W*(?:all\ |now\ |i'm\ |i\ am\ |it's\ |it\ is\ |that's\ |ok(?:ay)?,?\ )*
        (?:{_FINISHED}|all\ set|success|successful)\b\W*(?:$|[.!:;,\n]|--|\ -)
    | \b(?:tasks?|instructions?|requests?|jobs?|goals?|objectives?|missions?|commands?|everything
        |all|both|that|this|it)\b[^.;!\n]{{0,60}}?
        \b(?:is|are|has|have|was|were|been|now)\ (?:\w+ly\ |now\ |all\ |been\ )*{_FINISHED}\b
    | \b(?:task|mission|request|instruction|goal|objective|job)s?\ (?:\w+ly\ )?{_FINISHED}\b
    | \b(?:i|we)(?:'ve|\ have)?\ (?:\w+ly\ |now\ |already\ |just\ )*{_FINISHED}\ (?:with\ )?
        (?:the|your|this|all|everything|that|what|it|both|my)\b
    | (?:^|[.!;:\n])\W*(?:i\ (?:have\ )?(?:picked|placed|put|moved|dropped)\ (?:up\ )?)?
        (?:all|both|each|every|everything)\b[^.;!\n]*
        \b(?:is|are|has|have|was|were|on|in|next\ to|near|beside)\b
    | \bsuccessfully\ {_FINISHED}\b
    """,
    re.VERBOSE,
)
"""It says of the whole that it is done."""

_DEED = re.compile(
    r"""
    \b(?:picked|placed|put|dropped|moved|set|laid|brought|carried|taken|took|grabbed|holding|held|hold
        |released|positioned|delivered|rests?|resting|lies|lying|stands?|sits|sitting)\b
    | \bin\ (?:my|the|your|its)\ (?:right\ |left\ )?hands?\b
    | \b(?:is|are)\ (?:now\ |currently\ |both\ |all\ |safely\ )*
        (?:on|in|near|by|at|next\ to|beside|close\ to)\b
    """,
    re.VERBOSE,
)
"""It tells of something that is done."""

_OPEN_POINT = re.compile(
    r"""
    \b(?:fail\w*|unable|unsure|uncertain|missing|remaining|incomplete|unverified|wrong)\b
    | \b(?:could|can|did|have|has|was|were|is|are|am)\ ?(?:not|n't)\ (?:\w+\ )?(?:find|found|reach
        |place|pick|verif|confirm|see|seen|sure|certain|done|complete|move|drop|put|been)
    | \bcannot\b | \bwhether\b
    | \bnot\ (?:placed|picked|moved|found|done|verified|confirmed|complete|sure|certain)
    | \bstill\ (?:to|need|have|must)\b
    """,
    re.VERBOSE,
)
"""A gap that matters, among what a model says it has not looked at."""

_NO_THINGS = re.compile(
    r"a|all|an|and|any|are|as|at|by|close|go|has|have|in|into|is|it|its|moreover|near|next|objects?"
    r"|of|on|or|other|pick|place|please|put|room|tag|tagged|that|the|them|then|there|to|up|with"
)
"""Words of an instruction that name neither a thing nor a place."""


def claims_success(instruction: str, answer: str) -> bool | None:
    """What a final message says of the instruction as a whole.

    Args:
        instruction: What was asked.
        answer: The final message.

    Returns:
        True if it says that all is done: in so many words, or by telling of deeds that name every
        thing and place of the instruction. False if it says that something is not done or could
        not be. None if neither can be told.
    """
    text = _BENIGN.sub(" ", _plain(answer))
    if _ADMITS.search(text):
        return False
    if _HEDGES.search(text):
        return None
    if _WHOLE.search(text):
        return True
    if _DEED.search(text) and _things(instruction) <= _words(text):
        return True
    return None


def names_a_gap(unseen: str) -> bool:
    """Whether what a model says it has not seen leaves open that all is done."""
    return _OPEN_POINT.search(_plain(unseen)) is not None


def _plain(text: str) -> str:
    """Small letters, straight quotes, single blanks, and no marks of emphasis."""
    text = text.lower().replace("’", "'").replace("‘", "'")
    return re.sub(r"[ \t]+", " ", re.sub(r"[*`#\"“”>|]", "", text)).strip()


def _words(text: str) -> frozenset[str]:
    """Words that name a thing or a place, singular and plural alike."""
    found = re.findall(r"[a-z]+|\d+", text.lower())
    return frozenset(word.removesuffix("s") for word in found if not _NO_THINGS.fullmatch(word))


def _things(instruction: str) -> frozenset[str]:
    """What an answer must name to tell of the whole; a lone number may go by another name."""
    things = _words(instruction)
    numbers = frozenset(word for word in things if word.isdigit())
    return things - numbers if len(numbers) == 1 and things > numbers else things
