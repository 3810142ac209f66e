"""Questions and statements about what is where, and what it is like."""

from __future__ import annotations

import re
from dataclasses import replace

from adamo_vh.inference.baseline.language.grammar import read_place, read_things
from adamo_vh.inference.baseline.language.plan import Ask, Description, Goal, Question, Relation

_POLITE = re.compile(
    r"^(?:(?:please|now|so|and|then)[, ]+)*(?:(?:can|could|would|will) you )?(?:please )?"
    r"(?:tell me|say|do you know|let me know|i wonder|i want to know|describe|explain|name|list)?"
    r"(?: me)?[, ]*"
)
_NOUN = r"(?:objects?|things?|items?|one|ones|stuff)"
_MORE = r"smaller|bigger|larger|taller|shorter"
_TAIL = (
    r"(?: (?:here|there|now|in the room|in this room|around|please|right now|at the moment|"
    r"in total|in all|altogether|currently|then|again|do you see|can you see|do you know of|"
    r"are there|is there|do you know|you see|you can see|lying around|visible|left))*"
)
_RULES: tuple[tuple[str, Ask], ...] = (
    (r"(?:what|which thing|anything|what object|what thing)? ?(?:are|do|have|is|'s) ?(?:you )?"
     r"(?:you )?(?:now |currently )?(?:holding|hold|carrying|carry|got|have|there)? ?"
     r"(?:anything |something )?in (?:your|the) hands?", Ask.HELD),
    (r"(?:what|which thing|which object|what object|what thing) (?:are|do|have) you "
     r"(?:now |currently )?(?:holding|hold|carrying|carry|got|have)(?: in your hands?)?", Ask.HELD),
    (r"(?:do|are) you (?:hold|holding|carry|carrying|have) (?:anything|something)"
     r"(?: in your hands?)?|is your hand (?:empty|free|full)|(?:are|is) your hands? "
     r"(?:empty|free|full)", Ask.HELD),
    (r"(?:what can you do|what are you able to do|help|what do you (?:do|understand)|"
     r"who are you|what are you|what is your name|how can you help(?: me)?|"
     r"what should i (?:say|ask))", Ask.HELP),
    (r"where (?:are|do) you(?: stand| now)*|(?:what is )?your (?:position|place)", Ask.STAND),
    (r"(?:what|which) colou?r (?:is|are|has|have|does) (?P<thing>.+?)(?: have)?", Ask.COLOUR),
    (r"(?:the )?colou?r of (?P<thing>.+)|what is the colou?r of (?P<thing2>.+)", Ask.COLOUR),
    (r"(?:what|which) colou?rs? (?P<thing>(?:the |a ).+?) (?:is|are|has|have)", Ask.COLOUR),
    (rf"(?:how many|count) (?P<thing>.+?)(?: are| is| lie| stand| rest)?(?: there)? "
     rf"(?P<place>(?:on|in|under|near|next to|beside|left of|to the|between|behind) .+?){_TAIL}",
     Ask.COUNT),
    (rf"(?:count|how many|the number of) (?P<thing>.+?)(?: are there| is there| do you (?:see|know|"
     rf"know of)| can you see| are| did you see| exist)?{_TAIL}", Ask.COUNT),
    (r"where (?:is|are|did you (?:put|leave|see)|do you see|can i find|has|have|does|lies?|stands?|"
     r"would i find|can you see|was|were) (?P<thing>.+?)(?: gone| lie| stand| now| located|"
     r" put| right now| then)*", Ask.WHERE),
    (r"where (?P<thing>(?:the|my|a|an|it|they|object) ?.*?) (?:is|are|lies|stands|"
     r"went)", Ask.WHERE),
    (r"(?:find|locate|look for|search for|spot|seek) (?P<thing>.+)", Ask.WHERE),
    (rf"(?:what|which|which {_NOUN}|what {_NOUN}|who|everything)(?: all| else)? ?"
     rf"(?:is|are|lies?|stands?|rests?|'s|do you see|can you see|do you find|you see|have you seen|"
     rf"sits?)(?: there)?(?: lying| standing)? (?P<place>(?:on|in|under|underneath|near|next to|"
     rf"beside|left of|right of|to the|between|behind|close to|by|around|in front of) .+?){_TAIL}",
     Ask.AT),
    (rf"(?:is|are) (?:there )?(?:anything|something|any {_NOUN}) (?P<place>(?:on|in|"
     rf"under|near|next "
     rf"to|beside|left of|right of|to the|between|behind|close to|by|in front of) .+?){_TAIL}",
     Ask.AT),
    (rf"(?:which|what)(?: of them)?(?: {_NOUN})? (?:is|are) (?P<thing>(?:the )?(?:second |third )?"
     r"(?:smallest|largest|biggest|tallest|shortest|highest|tiniest|littlest|greatest|lowest|"
     r"nearest|closest|farthest|furthest).*?)"
     rf"{_TAIL}", Ask.WHICH),
    (rf"(?:which|what)(?: one| {_NOUN})? (?:is|are) (?:the )?(?P<size>{_MORE}) (?:of |between )?"
     r"(?P<one>.+?) (?:or|and) (?P<other>.+)", Ask.WHICH),
    (rf"which (?:of )?(?P<group>(?:the |these |those )?[\w ]+?) (?:is|are) (?:the )?"
     rf"(?P<size>{_MORE})(?: one)?", Ask.WHICH),
    (rf"(?:which|what)(?: of them)?(?: (?P<noun>{_NOUN}|\w+))? (?:is|are|looks?) "
     rf"(?P<quality>(?!there\b)\w[\w ]*?){_TAIL}", Ask.EXISTS),
    (rf"(?:which|what) (?P<thing>\w.*?) (?:are|is|do you see|can you see|have you seen)(?: there)?"
     rf"{_TAIL}", Ask.EXISTS),
    (rf"(?:what|which {_NOUN}|what {_NOUN}) (?:do|can|did) you (?:see|find|notice|spot|"
     rf"know|know of|"
     rf"observe|remember){_TAIL}|(?:what|who) (?:is|are|'s)(?: there| all)?(?: here| there| in the "
     rf"room| in this room| around(?: you)?| in front of you| visible| in view| near you)|"
     rf"(?:all )?(?:what you see|the room|your surroundings|everything|all (?:the )?{_NOUN}|"
     rf"the {_NOUN}|all you see|the scene|what you can see|everything you see|your view)"
     rf"(?: in (?:the|this) room| you see| you know)?|look what is there", Ask.SEE),
    (rf"(?:is|are) there (?:still )?(?:an?y? |some )?(?P<thing>.+?){_TAIL}", Ask.EXISTS),
    (rf"(?:do|can|did|have) you (?:see|seen|find|know of|spot|know|notice) (?:an?y? )?"
     rf"(?P<thing>.+?){_TAIL}", Ask.EXISTS),
    (r"do you (?:have|hold) (?P<thing>.+?)(?: in your hand)?|are you (?:holding|carrying) "
     r"(?P<thing2>.+)", Ask.IS),
    (r"(?:how (?:far|far away|distant|near|close)|what) is (?:the distance (?:from|between) )?"
     r"(?P<thing>.+?)(?: away)? (?:from|to|and) (?P<seat>(?!you\b|here\b|me\b|your\b).+)",
     Ask.DISTANCE),
    (r"how (?:far|far away|distant|near|close) (?:is|are) (?P<thing>.+?)(?: away|"
     r" from (?:you|here)|"
     r" to you)*", Ask.DISTANCE),
    (r"how (?:big|large|tall|high|small|wide) (?:is|are) (?P<thing>.+)|what (?:size|"
     r"volume) (?:is|has|"
     r"are) (?P<thing2>.+)|what is the (?:size|volume) of (?P<thing3>.+)", Ask.SIZE),
)  # fmt: skip
_COMPILED = tuple((re.compile(pattern), ask) for pattern, ask in _RULES)
_IS = re.compile(r"^(?:is|are|was|were|does|do) (?P<rest>.+)$")
_STATEMENT = re.compile(
    r"^(?P<thing>.+?) (?:is|are|lies|stands|rests|has|have|looks|be|isn't|aren't)(?P<no> not|n't)? "
    r"?(?P<what>.*)$"
)
_EXISTS = re.compile(
    r"^(?:there (?:is|are)|you (?:see|find|can see|can find|know of|spot)) "
    r"(?P<no>no |not )?(?:an?y? |some )?(?P<thing>.+)$"
)
_HELD = re.compile(r"^you (?:hold|are holding|have|carry|are carrying) (?P<no>no )?(?P<thing>.+?)"
                   r"(?: in your hand)?$")  # fmt: skip
_BARE = Description("")
_THAN = re.compile(rf"(?P<size>{_MORE}) than (?P<other>.+)")


def read_question(text: str, before: tuple[str, ...] = ()) -> Question | None:
    """A question; None if the words ask nothing that can be answered.

    Args:
        text: Lower case, one sentence.
        before: Tags that were spoken of before.
    """
    plain = text.strip(" ?.!")
    for words in dict.fromkeys((plain, _POLITE.sub("", plain, count=1).strip(" ?.!"))):
        for pattern, ask in _COMPILED:
            match = pattern.fullmatch(words)
            if match and (question := _question(ask, match, before)):
                return question
        if (match := _IS.match(words)) and (found := _yes_or_no(match["rest"], before)):
            return found
    return None


def _question(ask: Ask, match: re.Match[str], before: tuple[str, ...]) -> Question | None:
    groups = match.groupdict()
    if groups.get("quality"):
        noun = re.sub(r"s$", "", groups.get("noun") or "") or "object"
        noun = "object" if noun in ("thing", "item", "one") else noun
        things = read_things(f"all the {groups['quality']} {noun}s", before)
        known = things and len(things) == 1 and (things[0].by_looks or things[0].size)
        return Question(ask, things[0]) if things and known else None
    if groups.get("size"):
        return _comparison(groups, before)
    if groups.get("seat"):
        return _distance(groups, before)
    spoken = next((groups[name] for name in ("thing", "thing2", "thing3") if groups.get(name)), "")
    place = None
    if groups.get("place"):
        place = read_place(groups["place"], before)
        if place is None:
            return None
    if not spoken:
        return Question(ask, place=place)
    if ask is Ask.WHICH and spoken.split()[0] != "the":
        spoken = f"the object {spoken}" if " to " in spoken or " from " in spoken else spoken
    things = read_things(spoken, before) or _any_thing(spoken)
    if not things or len(things) > 1:
        return None
    thing = things[0]
    if ask is Ask.IS:
        return Question(Ask.IS, thing, Goal(_BARE))
    return Question(ask, thing, place)


def _comparison(groups: dict[str, str], before: tuple[str, ...]) -> Question | None:
    """Read "which is bigger of the cup or the glass", "which of the locks is smaller"."""
    size = groups["size"]
    if groups.get("group"):
        group = groups["group"]
        things = read_things(f"the {size} of {group}", before) or read_things(
            f"the {size} {group}", before
        )
        ok = things and len(things) == 1 and things[0].size and things[0].classes
        return Question(Ask.WHICH, things[0]) if things and ok else None
    compared = _compared(size, groups["one"], groups["other"], before)
    return Question(Ask.WHICH, compared) if compared else None


def _compared(size: str, one: str, other: str, before: tuple[str, ...]) -> Description | None:
    """The larger, smaller, taller ... of two things of different kinds."""
    both = [read_things(words, before) for words in (one, other)]
    extreme = read_things(f"the {size} object", before)
    if not extreme or any(not things or len(things) > 1 for things in both):
        return None
    kinds = [things[0].classes[:1] for things in both if things]
    if not all(kinds) or kinds[0] == kinds[1]:
        return None
    words = f"the {size} of {one} and {other}"
    return Description(words, classes=kinds[0] + kinds[1], size=extreme[0].size)


def _distance(groups: dict[str, str], before: tuple[str, ...]) -> Question | None:
    """Read "how far is the cup from the plate"."""
    both = [read_things(groups[name], before) for name in ("thing", "seat")]
    if any(not things or len(things) > 1 for things in both):
        return None
    (thing,), (anchor,) = (things or [] for things in both)
    return Question(Ask.DISTANCE, thing, Goal(_BARE, Relation.NEAR, anchor))


def _any_thing(spoken: str) -> list[Description]:
    if re.fullmatch(r"(?:different |other )?(?:objects?|things?|items?)", spoken):
        return [Description(spoken, every=True)]
    return []


def read_statement(text: str, before: tuple[str, ...] = ()) -> Question | None:
    """A statement such as "the cup is green", as the question whether it is so."""
    plain = text.strip(" ?.!,")
    if match := _EXISTS.match(plain):
        things = read_things(match["thing"], before)
        if things:
            return Question(Ask.EXISTS, things[0], negated=bool(match["no"]))
    if match := _HELD.match(plain):
        things = read_things(match["thing"], before)
        if things:
            return Question(Ask.IS, things[0], Goal(_BARE), negated=bool(match["no"]))
    if match := _STATEMENT.match(plain):
        negated = bool(match["no"]) or "n't" in plain
        return _predicate(match["thing"], match["what"], before, negated)
    return None


def _yes_or_no(rest: str, before: tuple[str, ...]) -> Question | None:
    """Read "the cup green"; where the thing ends, and what is said of it begins, is tried."""
    words = rest.split()
    for cut in range(len(words) - 1, 0, -1):
        thing, what = " ".join(words[:cut]), " ".join(words[cut:])
        if found := _predicate(thing, what, before, False):
            return found
    return None


def _predicate(thing: str, what: str, before: tuple[str, ...], negated: bool) -> Question | None:
    if what.startswith("not "):
        what, negated = what[4:], not negated
    things = read_things(thing, before)
    if not things or len(things) > 1:
        return None
    subject = things[0]
    if re.fullmatch(r"(?:being )?(?:held|in your hand|in the hand)(?: by you)?", what):
        return Question(Ask.IS, subject, Goal(_BARE), negated=negated)
    if what in ("here", "there", "in the room", "visible", "in view", "in sight"):
        return Question(Ask.EXISTS, subject, negated=negated)
    if (than := _THAN.fullmatch(what)) and not subject.every:
        compared = _compared(than["size"], thing, than["other"], before)
        if compared is None:
            return None
        return Question(Ask.IS, subject, quality=replace(compared, text=what), negated=negated)
    if place := read_place(re.sub(r"^(?:lying|standing|resting|placed) ", "", what), before):
        return Question(Ask.IS, subject, place, negated=negated)
    quality = (
        read_things(f"the {what} object", before)
        or read_things(f"the object that is {what}", before)
        or read_things(f"the object with {what}", before)
        or read_things(what, before)
    )
    if quality and len(quality) == 1:
        said = replace(quality[0], text=what)
        return Question(Ask.IS, subject, quality=said, negated=negated)
    return None
