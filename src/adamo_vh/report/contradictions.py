"""Answers that say other than the feedback did: flagged for the reader, never scored.

Careful rather than complete: a clause that denies, hedges or tells of the past is passed over, and
so is a place whose name is not known. What is flagged is therefore worth reading.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from adamo_vh.action import Outcome
from adamo_vh.engine import ObjectState, WorldState
from adamo_vh.perception import Labeling
from adamo_vh.record.trajectory import Acted
from adamo_vh.report.whereabouts import Whereabouts

_KINDS = (
    "floor ground rug carpet",
    "sofa couch settee loveseat",
    "table desk console nightstand",
    "sideboard cabinet cupboard dresser commode drawer console",
    "shelf shelves bookshelf bookcase rack",
    "chair armchair stool seat",
    "bed",
    "bench",
    "counter worktop",
    "box basket bin",
    "windowsill sill",
    "lamp",
)
"""Names of places; those of one line, or with a word in common, may mean the same thing."""
_SEES_ONLY = ("Look", "Inspect", "Survey")
"""Tools that change nothing in the world."""
_CLAUSES = re.compile(
    r"[.;:!?](?=\s|$)|\n|, (?!\d|-)|\b(?:and|but|then|which|that|where|so)\b", re.I
)
_OTHERWISE = re.compile(
    r"\b(?:not?|never|none|nothing|cannot|unable|fail\w*|refus\w*|instead|rather|however|except|"
    r"although|though|only|partly|tr(?:y|ied)|asked|want\w*|should|would|could|supposed|was|were|"
    r"had|from|if|perhaps|maybe|may|might|probably|seems?|unless|until|before|but|still)\b|n['’]t\b",
    re.I,
)
_DONE = re.compile(
    r"\b(?:done|completed?|finished|success\w*|accomplished|placed|moved|is now|are now)\b", re.I
)
_ON = re.compile(
    r"\b(?:on|onto|in|into|inside|upon|atop|under)\s+(?:top\s+of\s+)?(?:the|a|an|my|your|this)\s+"
    r"(?P<place>[\w-]+(?:\s+[\w-]+){0,2})",
    re.I,
)
_BESIDE = re.compile(r"\b(?:next|near|beside|by|with|behind|left|right|between|close)\b", re.I)
_IS_PUT = re.compile(
    r"\b(?:is|are|lies|rests|stands|placed|put|dropped)\b.*"
    r"\b(?:on|onto|next to|near|beside|under|in front of)\b",
    re.I,
)
_HOLDING = re.compile(r"\b(?:hold|holding|carry|carrying)\s+(?:the\s+|an?\s+)?\W*$", re.I)
_IN_HAND = re.compile(r"\W*(?:\([^)]*\)\s*)?(?:is|are)\s+(?:still\s+)?in (?:my|the) hand\b", re.I)


def contradictions(
    said: str,
    world: WorldState,
    labeling: Labeling,
    known: Mapping[str, Whereabouts],
    acts: Sequence[Acted],
) -> tuple[str, ...]:
    """What an answer says against the last feedback on the same thing.

    Args:
        said: The answer, and what was said to be verified.
        world: The world at the start: which things and places there are.
        labeling: What the things are called.
        known: What the feedback says became of the things that were handled.
        acts: What was executed for the instruction that is answered.

    Returns:
        Sentences for the reader; none if nothing is plainly contradicted.
    """
    found: dict[str, str] = {}
    for clause in _CLAUSES.split(said):
        if clause and not _OTHERWISE.search(clause):
            for tag, sentence in _misplaced(clause.strip(), world, labeling, known):
                found.setdefault(tag, sentence)
    return (*_refused(said, acts), *found.values())


def _refused(said: str, acts: Sequence[Acted]) -> Iterator[str]:
    """Whether the last call that could change anything was refused, and the answer is "done"."""
    last = next((act for act in reversed(acts) if act.name not in _SEES_ONLY), None)
    if last is None or last.feedback.outcome is not Outcome.REFUSED:
        return
    if _DONE.search(said) and not _OTHERWISE.search(said):
        yield f"The answer says that it is done; {last.name}, step {last.step}, was refused."


def _misplaced(
    clause: str, world: WorldState, labeling: Labeling, known: Mapping[str, Whereabouts]
) -> Iterator[tuple[str, str]]:
    """The things that a clause puts elsewhere, and a sentence for each."""
    for item in world.objects:
        now = known.get(labeling.tag(item.id, item.class_name))
        named = _name_of(item, world).search(clause) if now else None
        if now is None or named is None:
            continue
        claim = clause[named.end() :]
        if now.is_held:
            wrong = bool(_IS_PUT.search(claim))
        elif _HOLDING.search(clause[: named.start()]) or _IN_HAND.match(claim):
            wrong = True
        else:
            wrong = _is_elsewhere(claim, now.support, world)
        if wrong:
            told = f"the feedback of step {now.step} says that {now.tag} is {now.place}"
            yield now.tag, f"The answer says “{clause}”; {told}."


def _name_of(item: ObjectState, world: WorldState) -> re.Pattern[str]:
    """What means this object and no other."""
    names = [rf"{item.class_name}_{item.id}", rf"(?:object|tag|tagged as|number)\s+#?{item.id}"]
    if sum(other.class_name == item.class_name for other in world.objects) == 1:
        names.append(r"\s*".join(re.findall(r"[A-Z]?[a-z0-9]+|[A-Z]+", item.class_name)))
    return re.compile(rf"\b(?:{'|'.join(names)})\b", re.I)


def _is_elsewhere(claim: str, support: str, world: WorldState) -> bool:
    """Whether a claim names another place than the one that carries a thing."""
    place = _ON.search(claim)
    if place is None or not support or _BESIDE.search(claim[: place.start()]):
        return False
    words = place["place"].casefold().split()
    kinds = next((kinds for word in words if (kinds := _kinds(word))), frozenset())
    rests = support.casefold().rstrip("0123456789 ")
    things = {item.class_name.casefold() for item in world.objects}
    if any(thing in rests for thing in things):
        return False  # On a thing, which itself lies somewhere.
    if words[0] in things and not kinds:
        return True
    pieces = {piece.name.casefold() for piece in world.furniture}
    if " " in rests and " ".join(words[:2]) in pieces:
        return " ".join(words[:2]) != rests
    return bool(kinds and _kinds(*rests.split())) and not kinds & _kinds(*rests.split())


def _kinds(*words: str) -> frozenset[str]:
    """The kinds of places that words name."""
    return frozenset(kind for kind in _KINDS if set(words) & set(kind.split()))
