"""Words that are known, but for a slip of the fingers."""

from __future__ import annotations

import re
from functools import cache

from adamo_vh.inference.baseline.language.words import phrase_table

_FURTHER_WORDS = (
    "what where how many which who do does did don't dont never not avoid touch look turn round "
    "around come back go walk wait stop stay thanks thank if unless otherwise else left right "
    "forward backward ahead behind are am was can see tell about many much far big colour color "
    "window door wall holding near visible anything something nothing everything here there when "
    "why steps step metres meters centimetres metre meter face return follow me my away look"
)
_SLIPS = {"teh": "the", "hte": "the", "thr": "the", "adn": "and", "nad": "and", "fo": "of"}
_LEAST_LETTERS = 3
_LONG_WORD = 7
_USUAL = frozenset(("pick", "place", "drop", "floor", "table", "take", "bring", "plate", "glass"))
"""Of several known words that are equally close, these are the likely ones."""
_WORDS_OF_THEIR_OWN = """
apple bad bake ball banana bath because bell bend best block bold book bottle bowl bread break
brush bucket burn but butter cake call camera can candle cap car card cards carrot cat catch cheap
cheese chess clean clock close coat coffee coin cold comb cook cord cork count dance dirty dog
doll drink eat egg empty except expensive fall fan feel fight fill fish flask flip fold fork full
gold good grape hammer hard hat heat heaviest heavy hide hold hook hot hungry into iron jug juice
jump kettle kick knife ladder lamp laptop lemon letter light lightest lock mall meat might milk
model money mop motor mount mouse nail needle new nice night nor not old onion onto open orange
pace pack pact pad pan paper past pasta paste patch peach pear peel pen pencil pepper phone pick
pillow pin pipe place plane planet plank plastic post poster pot potato pour radio read remote
rice right ring rip rock roll rolls rope rotate ruler run salt saw scarf scissors screw sell shake
shape share sharp sheet shirt shoe shut sing sink sit sleep smell soap sock soft sold soup spin
sponge spoon spray stack stapler stay steal steel stick stone string sugar swap switch talk tall
tea teapot tear tell than thank that their then there these think thirsty this those throw tie
tilt tired told tomato tool towel toy tube turn ugly unless unlock untie until unto wait walk wall
wallet want warm wash watch wear well when where which while who whom whose why will wipe wire
wish with wooden word work world worst wrench write young
"""
_OTHER_WORDS = frozenset(_WORDS_OF_THEIR_OWN.split())
"""Words of their own that look like known ones; a slip is never assumed for them."""


@cache
def known_words() -> frozenset[str]:
    """All single words that occur in any phrase, and those of questions and small talk."""
    words = {word for phrase in phrase_table() for word in phrase.split()}
    return frozenset(words | set(_FURTHER_WORDS.split()))


def corrected(word: str) -> str | None:
    """The known word that was meant, or None if that is not plain.

    Args:
        word: Lower case, not known as it is.
    """
    from rapidfuzz.distance import OSA

    if len(word) < _LEAST_LETTERS or word in _OTHER_WORDS or not word.isalpha():
        return None
    allowed = 2 if len(word) >= _LONG_WORD else 1
    least = max(4, len(word) - 1)
    found = [
        (OSA.distance(word, known, score_cutoff=allowed), known)
        for known in _long_words()
        if known[0] == word[0] and len(known) >= least
    ]
    close = sorted(pair for pair in found if pair[0] <= allowed)
    best = [known for distance, known in close if close and distance == close[0][0]]
    if len(best) > 1:
        whole = [k for k in best if k in _USUAL or _is_part(word, k)]
        best = [k for k in whole if k in _USUAL] or whole
    return best[0] if len(best) == 1 else None


def _as_phrase(word: str, behind: str) -> str | None:
    """The word that makes a known phrase with the next one: "gass lighter"."""
    from rapidfuzz.distance import OSA

    following = re.match(r" ([a-z]+)", behind)
    if following is None or word in known_words() or word in _OTHER_WORDS:
        return None
    found = {
        first
        for first, _, rest in (phrase.partition(" ") for phrase in phrase_table())
        if rest == following[1] and first[0] == word[0] and OSA.distance(word, first) == 1
    }
    return found.pop() if len(found) == 1 else None


def _is_part(word: str, known: str) -> bool:
    """Whether only letters are missing."""
    letters = iter(known)
    return all(letter in letters for letter in word)


@cache
def _long_words() -> tuple[str, ...]:
    return tuple(sorted(word for word in known_words() if len(word) >= 4))


def spelled(text: str) -> tuple[str, dict[str, str]]:
    """A text with slips put right, and which they were.

    Args:
        text: Lower case.
    """
    known, slips = known_words(), dict[str, str]()

    def put_right(match: re.Match[str]) -> str:
        word = match[0]
        meant = _SLIPS.get(word) or _as_phrase(word, text[match.end() :])
        meant = meant or (None if word in known else corrected(word))
        if meant is None:
            return word
        slips[word] = meant
        return meant

    return re.sub(r"(?<![\w@#'])[a-z]{3,}(?![\w'])", put_right, text), slips
