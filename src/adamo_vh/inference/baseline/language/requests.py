"""What an instruction asks for in all: wishes, questions, acts, conditions, what not to do."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import lru_cache

from adamo_vh.inference.baseline.language.acts import read_act, read_way
from adamo_vh.inference.baseline.language.grammar import read_things, wishes
from adamo_vh.inference.baseline.language.plan import Description, Plan
from adamo_vh.inference.baseline.language.questions import read_question, read_statement
from adamo_vh.inference.baseline.language.rephrasing import (
    number_left_out,
    spoken_plainly,
)
from adamo_vh.inference.baseline.language.spelling import corrected, known_words, spelled

CAN = (
    "I can pick things up, put them on the floor, in a corner, on furniture, back, or beside, "
    "between or away from other things, look, walk, and tell what I see."
)
_NOT = re.compile(
    r"^(?:please |and |but |so |also )*(?:do not|don't|dont|never|you must not|you should not|"
    r"must not|mustn't|shouldn't|you may not|there is no need to|no need to|"
    r"(?P<bare>avoid|refrain from|not))\b ?(?:ever )?(?P<what>.*)$"
)
_HANDLE = re.compile(
    r"^(?:touch(?:ing)?|mov(?:e|ing)|includ(?:e|ing)|tak(?:e|ing)|us(?:e|ing)|disturb(?:ing)?|"
    r"handl(?:e|ing)|remov(?:e|ing)|forget) "
)
_IF = re.compile(
    r"^(?:only )?(?:if|in case|provided that|provided) (?P<condition>.+?)"
    r"(?:, ?(?:then )?| then )(?P<wish>.+?)"
    r"(?:[,;.]? ?(?:and )?(?:otherwise|or else|else|if not)[, ]+(?P<other>.+))?$"
)
_IF_LAST = re.compile(r"^(?P<wish>.+?),? (?:only )?(?P<word>if|unless|provided that|provided) "
                      r"(?P<condition>.+)$")  # fmt: skip
_UNLESS = re.compile(r"^unless (?P<condition>.+?),? (?:then )?(?P<wish>(?:put|pick|take|get|grab|"
                     r"move|bring|place|drop|look|go|lay|set|hold)\b.+)$")  # fmt: skip
_PAUSE = re.compile(
    r"(?:wait|stop|halt|freeze|pause|stay|hold on|stand still|do nothing|nothing|"
    r"never ?mind|cancel|"
    r"forget (?:it|that|about it)|that is (?:all|enough|it)|that's (?:all|enough|it)|enough|stay "
    r"(?:here|there|where you are|put)|don't move|do not move|no|abort|rest|relax|be quiet|"
    r"leave it|leave it there|leave it alone)"
    r"(?: (?:it|that|now|please|there|here|everything|a moment|a minute|a second|"
    r"a bit|for a moment|"
    r"for a minute|moving|working|immediately|a while|for me))*"
)
_COURTESY = re.compile(
    r"(?:many thanks|thanks|thank you|thx|cheers|hello|hi|hey|good (?:morning|day|"
    r"evening|night|job|"
    r"bye|work)|well done|great|nice|perfect|very good|good|ok|okay|bye|goodbye|sorry|please|great "
    r"job|nice work|hello there|hi there|how are you|yes|sure|fine|awesome|excellent)"
    r"(?: (?:you|a lot|so much|very much|adamo|there|again|for your help|for that|"
    r"everyone|my friend))*"
)
_POLITE = re.compile(
    r"^(?:please|kindly|now|so|and|then|next|first|finally|ok|okay|hey|hi|hello|adamo|just|"
    r"could you|can you|would you|will you|i want you to|i'd like you to|i would like you to|"
    r"you should|you can|let us|let's|go and|try to|afterwards|after that)[, ]+"
)


@lru_cache(maxsize=256)
def understand(instruction: str, before: tuple[str, ...] = (), former: str = "") -> Plan:
    """Compile an instruction.

    Args:
        instruction: What the user wrote.
        before: Tags that were spoken of or handled before, the latest first.
        former: The instruction before this one; "now the other one" goes on with it.

    Returns:
        The plan; if any part has no meaning, one that names this part and does nothing.
    """
    text = " ".join(instruction.lower().replace("\u2019", "'").replace("@", " ").split())
    text = spoken_plainly(text)
    plan = _read(text, before)
    if plan.problem and former:
        plan = _gone_on_with(former, text, before) or plan
    if plan.problem:
        better, slips = spelled(text)
        again = _read(better, before) if slips else plan
        if again.problem:
            return Plan(problem=_with_language(plan.problem, text))
        plan = again
        words = ", ".join(f"'{word}' as '{meant}'" for word, meant in slips.items())
        plan = replace(plan, remarks=(*plan.remarks, f"I read {words}."))
    return _others_named(plan, former, before)


def _others_named(plan: Plan, former: str, before: tuple[str, ...]) -> Plan:
    """Read "the other one" behind a tag without a name as the kind that was asked for before."""
    bare = [g for g in plan.goals if g.target.other and not (g.target.classes or g.target.every)]
    if not bare:
        return plan
    named = [g.target.classes for g in wishes(former.lower(), before).goals if g.target.classes]
    if not named:
        return Plan(problem=f"'{bare[0].target.text}' (I do not know which other one)")
    goals = tuple(
        replace(g, target=replace(g.target, classes=named[-1])) if g in bare else g
        for g in plan.goals
    )
    return replace(plan, goals=goals)


def _gone_on_with(former: str, text: str, before: tuple[str, ...]) -> Plan | None:
    """Read "and now the cup" as the former wish for another thing."""
    begin = (
        r"^(?:(?:and|now|then|also|next|what about|how about|the same for|no|not that one|sorry|"
        r"actually|i meant?|rather)\b[, ]*)+"
    )
    words = re.sub(begin, "", text).strip(" .!?")
    things = read_things(re.sub(r"[, ]+(?:too|as well|please|also|instead)$", "", words), before)
    goals = wishes(former.lower(), before).goals if things else ()
    if not things or not goals:
        return None
    return Plan(tuple(replace(goals[-1], target=thing) for thing in things))


def _with_language(problem: str, text: str) -> str:
    words = re.findall(r"[^\W\d_]+", text)
    strange = [w for w in words if w not in known_words() and corrected(w) is None]
    if len(strange) >= 3 and len(strange) > len(words) / 2:
        return f"{problem} (I read English only)"
    return problem


def _read(text: str, before: tuple[str, ...]) -> Plan:
    text = text.strip(" .!")
    if number := number_left_out(text):
        return Plan(problem=f"'{number}' (say which, e.g. 'all but the red one')")
    special = _pause(text) or read_way(_unadorned(text)) or _conditional(text, before)
    if special:
        return special
    if not _asks(text) and not _NOT.match(text):
        plan = wishes(text, before)
        if not plan.problem:
            return plan
    return _by_parts(text, before)


def _asks(text: str) -> bool:
    return bool(re.match(r"(?:what|where|how|who|why|when|is|are|was|do you|did you)\b", text))


def _pause(text: str) -> Plan | None:
    plain = _unadorned(text)
    for words in (text, plain):
        if _PAUSE.fullmatch(words):
            return Plan(remarks=("I do nothing and wait.",))
        if _COURTESY.fullmatch(words):
            return Plan(remarks=(f"You are welcome. I did nothing. {CAN}",))
    return None


def _unadorned(text: str) -> str:
    """Without polite words at both ends."""
    plain, before = text.strip(" ,.!;?"), ""
    while plain != before:
        before = plain
        plain = _POLITE.sub("", plain)
        plain = re.sub(
            r"[, ]+(?:please|now|for me|thanks|thank you|then|again|would you)$", "", plain
        )
    return plain


def _conditional(text: str, before: tuple[str, ...]) -> Plan | None:
    plain = _unadorned(text)
    match = _IF.match(plain) or _UNLESS.match(plain) or _IF_LAST.match(plain)
    if match is None or " if possible" in f" {plain}" or plain.endswith("if you like"):
        return None
    parts = match.groupdict()
    negated = plain.startswith("unless") or parts.get("word") == "unless"
    condition = read_statement(parts["condition"], before)
    if condition is None:
        return Plan(problem=f"'if {parts['condition']}' (I cannot tell whether it is so)")
    spoken = condition.target.text if condition.target else ""
    wish = _with_pronouns(parts["wish"], spoken)
    plan = _read(wish, before)
    if plan.problem:
        return plan
    other = _read(_with_pronouns(parts["other"], spoken), before) if parts.get("other") else None
    if other and other.problem:
        return other
    if negated:
        condition = replace(condition, negated=not condition.negated)
    return replace(plan, condition=condition, otherwise=other)


def _with_pronouns(text: str, spoken: str) -> str:
    """Read "it" behind "if the cup is green" means the cup."""
    return re.sub(r"\b(?:it|them)\b", spoken, text, count=1) if spoken else text


def _by_parts(text: str, before: tuple[str, ...]) -> Plan:
    """Take out what is no wish about things, part by part; the rest is read as one."""
    rest: list[str] = []
    plan = Plan()
    spared: list[Description] = []
    spoken = ""
    for part in _parts(text):
        more = _special_part(_with_pronouns(part, spoken) if not rest else part, before)
        spared += _spared(part, before)
        spoken = _spoken(more, spared) or spoken
        if more is None:
            rest.append(part)
        elif more.problem:
            return more
        else:
            plan = _joined(plan, more)
    if rest:
        read = wishes(", ".join(rest), before)
        if "what it refers to" in read.problem and spoken:
            rest[0] = _with_pronouns(rest[0], spoken)
            read = wishes(", ".join(rest), before)
        if read.problem:
            read = _further_split(rest, before, Plan()) or read
        if read.problem:
            return read
        plan = _joined(_without(read, spared), plan)
    return plan if not plan.empty else Plan(problem="what to do, as I found no wish in it")


def _spoken(plan: Plan | None, spared: list[Description]) -> str:
    """What "it" means behind a part that is no wish: what was looked at or shall be left alone."""
    targets = [act.target.text for act in plan.acts if act.target] if plan else []
    return (targets or [thing.text for thing in spared[-1:]] or [""])[-1]


def _spared(part: str, before: tuple[str, ...]) -> list[Description]:
    """The things that "not the cup" and "do not touch the cup" leave out."""
    match = _NOT.match(_unadorned(part))
    if match is None:
        return []
    words = match["what"].rstrip(" .?!")
    things = read_things(words, before) or read_things(_HANDLE.sub("", words), before)
    return things or [goal.target for goal in wishes(words, before).goals]


def _without(plan: Plan, spared: list[Description]) -> Plan:
    """The same wishes, but of "all" things without those that were spoken of so."""
    goals = tuple(
        replace(g, target=replace(g.target, but=(*g.target.but, *spared))) if g.target.every else g
        for g in plan.goals
    )
    return replace(plan, goals=goals)


def _further_split(rest: list[str], before: tuple[str, ...], plan: Plan) -> Plan | None:
    """Parts that are joined by "and" only, e.g. "pick the cup and look at the plate"."""
    pieces = [piece for part in rest for piece in re.split(r"\s+(?:and|but)\s+", part)]
    if len(pieces) == len(rest):
        return None
    kept: list[str] = []
    spoken = ""
    for piece in pieces:
        more = _special_part(piece, before)
        spoken = _spoken(more, []) or spoken
        if more is None:
            kept.append(piece if kept else _with_pronouns(piece, spoken))
        elif more.problem:
            return more
        else:
            plan = _joined(plan, more)
    if len(kept) == len(pieces):
        return None
    read = wishes(" and ".join(kept), before) if kept else Plan()
    return read if read.problem else _joined(read, plan)


def _parts(text: str) -> list[str]:
    pieces = re.split(
        r"(?<=\?)\s+|[.!;]+\s*|,\s*(?:and |then |but )*|\s+(?:and then|then|but)\s+", text
    )
    return [piece.strip(" ,") for piece in pieces if piece and piece.strip(" ,")]


def _joined(one: Plan, other: Plan) -> Plan:
    return replace(
        one,
        goals=one.goals + other.goals,
        questions=one.questions + other.questions,
        acts=one.acts + other.acts,
        remarks=one.remarks + other.remarks,
    )


def _special_part(part: str, before: tuple[str, ...]) -> Plan | None:
    """A part that is no wish about a thing; None if it may be one."""
    plain = _unadorned(part)
    if not plain or _COURTESY.fullmatch(plain):
        return Plan(remarks=("You are welcome.",)) if part.startswith("thank") else Plan()
    if match := _NOT.match(plain):
        heeded = f"'{plain.rstrip(' .?!')}'" if match["bare"] else ""
        what = f"I heed {heeded}" if heeded else f"I do not {match['what'].rstrip(' .?!')}"
        return Plan(remarks=(f"As you asked, {what}.",))
    if question := read_question(plain, before) or read_question(part, before):
        return Plan(questions=(question,))
    if _PAUSE.fullmatch(plain):
        return Plan(remarks=("Then I wait.",))
    return read_act(plain, before)
