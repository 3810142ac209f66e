"""What the body shall do that moves no thing: look, turn, walk; and what it cannot do."""

from __future__ import annotations

import re

from adamo_vh.inference.baseline.language.grammar import read_things
from adamo_vh.inference.baseline.language.plan import Act, Plan
from adamo_vh.inference.baseline.language.rephrasing import with_lengths

_SWITCH = re.compile(
    r"(?!turn (?:to|towards?|left|right|back|around|about|round|your head)\b(?! the \w+ on)|"
    r"turn (?:around|about|round|over)$|point your eyes|(?:spin|rotate|flip) (?:around|round|left|"
    r"right)$)"
    r"(?:(?:turn|switch|power|flip|rotate|spin|tilt|light|ignite|shine|flash|point|aim|click|"
    r"activate|deactivate|start|enable|disable|toggle)(?: (?:on|off|up|over|out|down|round|"
    r"around))?) (?:the|an?|my|your|it|them|that|this|all|both|every\w*|one|some|\w+)\b.*"
)
_LOOK = re.compile(
    r"(?:(?:look|gaze|stare|glance|peer|face|watch|observe|inspect|examine|check out|"
    r"take a look|have a look|look closely|look over)"
    r"(?: over| closely| directly| straight)?(?: (?:at|to|towards|toward|to face|on))?|"
    r"(?:turn|turn your head|point your eyes)(?: over| directly| straight)?"
    r" (?:at|to|towards|toward|to face)) (.+)"
)
_LOOK_WAY = re.compile(
    r"(?:look|turn|gaze|glance|face|spin|rotate|turn your head|make a turn)(?: (?:to|"
    r"towards|over|all|"
    r"to the|to your|the|your|a bit|on the|on your))* ?"
    r"(around|round|about|left|right|back|behind(?: you| yourself)?|up|down|ahead|straight ahead|"
    r"forwards?|the other way|other way|upwards?|downwards?|up at the ceiling|at the ceiling|"
    r"at the floor|at your feet|at the ground|straight)(?: (?:you|the room|once|again|please|side|"
    r"in the room|yourself|a bit|now))*"
)
_LOOK_OUT = re.compile(r"(?:look|gaze|stare|peer) (?:out|through|outside)\b.*")
_RETURN = re.compile(
    r"(?:(?:go|walk|come|head|move|get|run) back|return|come home|go home)"
    r"(?: (?:here|again|please|now|to me|home|to the start|to your start|to where you (?:were|"
    r"started|stood|came from|began)|where you (?:were|started|stood|came from|began)|to your "
    r"(?:old |first )?(?:place|position|spot|starting (?:point|position))|to the beginning|"
    r"to the (?:start|starting (?:point|position|place))))*"
)
_WALK_WAY = re.compile(
    r"(?:go|walk|step|move|take|come|run|head)(?: (?P<first>@\d+|\w+ steps?|a few steps))?"
    r" ?(?:to (?:the|your) )?(?P<way>forwards?|ahead|straight ahead|straight on|"
    r"backwards?|back|left|"
    r"right|closer|nearer)(?: (?:by )?(?P<last>@\d+|\w+ steps?|a few steps|a bit))?"
)
_WALK_TO = re.compile(
    r"(?:go|walk|head|move|run|come|step|get|approach|proceed|stand|wander|stroll)"
    r"(?: over| up| yourself)?(?: (?:to|towards|toward|near|next to|beside|by|close to|into|in|"
    r"closer to|up to|in front of))? (.+)"
)
_HERE = re.compile(
    r"(?:(?:come|get|walk|move) (?:over )?(?:here|to me|closer to me|near me|towards me)|follow me|"
    r"(?:come|walk|go) with me|come|come in|come on|come over|stay with me|find me|look at me)"
    r"(?: (?:please|now|quickly))*"
)
_MIDDLE = re.compile(r"(?:the |a )?(?:middle|centre|center)(?: of (?:the |this )?(?:room|floor))?")
_CORNER = re.compile(
    r"(?:the |a |any |one )?(?:nearest |closest |of the )*corners?(?: of (?:the )?room)?"
)
_REFUSED = (
    (_HERE, "I do not know where you are"),
    (_LOOK_OUT, "I cannot tell where a window is"),
    (_SWITCH, "I cannot switch, light, aim or turn things"),
)
_STEPS = re.compile(r"(?:one|two|three|four|five|a few|a) steps?\b")
_DEGREES = re.compile(
    r"(?:turn|rotate|spin|look)(?: (?:around|round))?(?: (?:to the )?(?P<way>left|right))?(?: by)? "
    r"(?P<angle>\d{1,3}) ?(?:degrees?|\u00b0)(?: (?:to the )?(?P<side>left|right))?"
)
_STEP_M = 0.6
_COUNT_WORDS = {"one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "a": 1, "few": 3}


def read_act(plain: str, before: tuple[str, ...]) -> Plan | None:
    """Look, turn or walk, or why that cannot be done; None if the words are no such act.

    Args:
        plain: Lower case, one part of a sentence.
        before: Tags that were spoken of before.
    """
    for refused, why in _REFUSED:
        if refused.fullmatch(plain):
            return Plan(problem=f"'{plain}' ({why})")
    if way := read_way(plain):
        return way
    if match := _LOOK.fullmatch(plain):
        return _towards("look", match[1], before)
    if match := _WALK_TO.fullmatch(plain):
        return _towards("walk", match[1], before)
    return None


def read_way(plain: str) -> Plan | None:
    """A turn or a walk some way, told without any thing; None if the words are none.

    Args:
        plain: Lower case, one part of a sentence.
    """
    plain = f"take {plain}" if _STEPS.match(plain) else plain
    if match := _DEGREES.fullmatch(plain):
        return _turned(plain, int(match["angle"]), match["way"] or match["side"] or "right")
    if _RETURN.fullmatch(plain):
        return Plan(acts=(Act("walk", direction="start", text="back"),))
    if match := _LOOK_WAY.fullmatch(plain):
        return Plan(acts=(_turn(plain, match[1]),))
    if match := _WALK_WAY.fullmatch(with_lengths(plain)):
        return Plan(acts=(_stride(match),))
    return None


def _turned(plain: str, degrees: int, way: str) -> Plan:
    if degrees == 180:
        return Plan(acts=(Act("look", direction="back", text=plain),))
    if degrees != 90:
        return Plan(problem=f"'{plain}' (I turn by 90 or 180 degrees)")
    return Plan(acts=(Act("look", direction=way, text=plain),))


def _turn(plain: str, way: str) -> Act:
    first = way.split(maxsplit=1)[0]
    if first in ("around", "round", "about", "back", "behind", "the", "other"):
        whole = plain.startswith("look") and first in ("around", "round", "about")
        return Act("look", direction="round" if whole else "back", text=plain)
    words = {"at": "down", "straight": "ahead", "forward": "ahead", "forwards": "ahead",
             "upward": "up", "upwards": "up", "downward": "down", "downwards": "down"}  # fmt: skip
    direction = "up" if "ceiling" in way else words.get(first, first)
    return Act("look", direction=direction, text=plain)


def _stride(match: re.Match[str]) -> Act:
    way = match["way"].split()[0].rstrip("s")
    direction = {"forward": "ahead", "straight": "ahead", "closer": "ahead", "nearer": "ahead",
                 "backward": "back"}.get(way, way)  # fmt: skip
    words = match["first"] or match["last"] or "@60"
    if words.startswith("@"):
        return Act("walk", direction=direction, distance_m=int(words[1:]) / 100, text=match[0])
    count = next((_COUNT_WORDS[w] for w in words.split() if w in _COUNT_WORDS), 1)
    return Act("walk", direction=direction, distance_m=count * _STEP_M, text=match[0])


def _towards(name: str, words: str, before: tuple[str, ...]) -> Plan | None:
    if name == "walk" and _MIDDLE.fullmatch(words):
        return Plan(acts=(Act(name, direction="middle", text="to the middle of the room"),))
    if name == "walk" and _CORNER.fullmatch(words):
        return Plan(acts=(Act(name, direction="corner", text="to a corner of the room"),))
    things = read_things(words, before)
    if not things:
        last = words.rsplit(maxsplit=1)[-1]
        if last in ("window", "door", "wall", "sofa", "chair", "table", "shelf", "lamp", "picture",
                    "curtain", "sideboard", "console", "rug", "couch", "mirror", "desk", "bed",
                    "ceiling", "kitchen", "bathroom", "bedroom", "garden", "hallway"):  # fmt: skip
            return Plan(problem=f"'{words}' (I cannot tell where the {last} is, only where things "
                                "are)")  # fmt: skip
        return None
    return Plan(acts=tuple(Act(name, target=thing) for thing in things))
