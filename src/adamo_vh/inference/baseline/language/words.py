"""The words of household instructions: phrases mapped to the symbols of the grammar."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum
from functools import cache


class Kind(StrEnum):
    """Symbols of the grammar."""

    TAKE = "take"
    FIND = "find"
    PUT = "put"
    BRING = "bring"
    """Takes, and puts where a place is named."""
    ON = "on"
    IN = "in"
    TO = "to"
    NEAR = "near"
    FROM = "from"
    OF = "of"
    FLOOR = "floor"
    CORNER = "corner"
    ROOM = "room"
    FURNITURE = "furniture"
    CLASS = "class"
    OBJECT = "object"
    COLOUR = "colour"
    SHAPE = "shape"
    GLASSY = "glassy"
    SIZE = "size"
    MEASURE = "measure"
    LABEL = "label"
    PART = "part"
    EVERY = "every"
    COUNT = "count"
    DET = "det"
    PRONOUN = "pronoun"
    ID = "id"
    TAGGED = "tagged"
    WITH = "with"
    THAT = "that"
    BE = "be"
    GOES = "goes"
    """States a wish about a place: "should be", "belongs"."""
    HELD = "held"
    """In the own hand."""
    THERE = "there"
    """The place named last."""
    AGAIN = "again"
    """The wish named last, for another thing."""
    NEAREST = "nearest"
    SIDE = "side"
    """Left of, right of, in front of, behind: as the viewer sees it."""
    BETWEEN = "between"
    UNDER = "under"
    FAR = "far"
    EDGE = "edge"
    HOME = "home"
    """Where a thing was before."""
    SHIFT = "shift"
    """A distance, with a direction or without one: "@right50", "@30" (cm)."""
    TOGETHER = "together"
    EXCEPT = "except"
    OTHER = "other"
    OR = "or"
    LANDMARK = "landmark"
    """Parts of a room that no text tells the place of: a window, a wall."""
    AND = "and"
    COMMA = "comma"
    THEN = "then"
    SKIP = "skip"
    UNKNOWN = "unknown"


@dataclass(frozen=True, slots=True)
class Token:
    """One symbol, with the words it was read from."""

    kind: Kind
    value: str
    text: str


_PHRASES: dict[Kind, str] = {
    Kind.TAKE: "pick|pick up|picking|picking up|take|taking|take up|grab|grabbing|get|getting|"
    "get hold of|fetch|fetching|lift|lift up|lifting|collect|collecting|hold|holding|gather|"
    "gathering|grasp|retrieve|seize|choose|hold on to|pick out|give me|hand me|pass me|get me|"
    "bring me|fetch me|grab me|give|giving me|handing me|passing me|bringing me|hand over|pass|"
    "gather up|collect up|find and pick|find and pick up|clutch|"
    "pick me up",
    Kind.FIND: "find|finding|look for|looking for|locate|search for|seek|identify|"
    "find out|detect|discover|determine",
    Kind.PUT: "put|putting|place|placing|drop|dropping|set|setting|lay|laying|leave|leaving|"
    "put down|set down|lay down|place down|deposit|position|rest|release|stand|arrange|drop off|"
    "let go of|put back|lower|i want|i would like|i need|make sure that|make sure|see that",
    Kind.BRING: "bring|bringing|carry|carrying|move|moving|transfer|transport|relocate|shift|"
    "deliver|bring over|carry over|move over|bring down|carry down|take over|take down",
    Kind.ON: "on|onto|on to|upon|down on|down onto|on top of",
    Kind.IN: "in|into|within|inside|inside of|down in|at|over in",
    Kind.TO: "to|over to|towards|toward|all the way to|down to",
    Kind.NEAR: "near|next to|beside|by|close to|alongside|near to|nearby|adjacent to|right by|"
    "right next to|right beside|in the vicinity of|at the side of|by the side of|next door to|"
    "to the side of|together with|over by|close by|along side|not far from|directly next to|"
    "on the same surface as|alongside of|just next to|just beside|closely to",
    Kind.FROM: "from|off|off of|out of|from off",
    Kind.OF: "of",
    Kind.FLOOR: "floor|ground|the ground",
    Kind.CORNER: "corner|corner area|corners|room corner|corner zone|room's corner",
    Kind.ROOM: "room|living room|the room|space",
    Kind.FURNITURE: "table|dining table|tabletop|table top|tables|desk|writing desk|coffee table|"
    "side table|end table|kitchen table|big table|small table|low table|sofa|couch|settee|"
    "sofa table|shelf|tall shelf|top shelf|upper shelf|highest shelf|middle shelf|lower shelf|"
    "bottom shelf|lowest shelf|first shelf|second shelf|third shelf|shelves|bookshelf|bookcase|"
    "top of the shelf|top of the tall shelf|sideboard|cabinet|cupboard|counter|chair|chairs|"
    "armchair|stool|bench|console|console table|surface|bed|nightstand|dresser|wardrobe|"
    "kitchen counter|worktop|windowsill|window sill|sill|window ledge|mantelpiece|piano|tv stand|"
    "drawer|basket|lamp|floor lamp|rug|carpet|mat|vase|box|bin|trash|trash can|fridge|oven|sink|"
    "bathtub|tray|rack|ottoman|cushion|pillow|hallway|ledge|tabletops|footstool|recliner|crate|"
    "bucket|bag|radiator|fireplace",
    Kind.LANDMARK: "window|windows|wall|walls|door|doors|ceiling|curtain|curtains|picture|"
    "pictures|painting|paintings|poster|mirror|entrance|exit|me|myself|outlet",
    Kind.OBJECT: "object|item|thing|article|one|objects|items|things|articles|ones|stuff|"
    "product|products|household item|household items|household object|household objects|belongings",
    Kind.MEASURE: "volume|size|height|dimensions|extent",
    Kind.LABEL: "label|labels|product label|product labels|printed label|printed labels|"
    "printed product label|printed product labels|printed text|text|writing|print|printed words|"
    "words|lettering|letters|brand label|brand labels|sticker|stickers|product name|product names|"
    "product text|labelling|labeling|labeled|labelled|printed|printing|text label|text labels|"
    "inscription|logo|packaging label|printed packaging|brand name|brand",
    Kind.PART: "part|parts|bit|bits|area|areas|section|sections|element|elements|portion|portions|"
    "piece|pieces|patch|patches|component|components|region|regions|spot|spots|surfaces|handle|"
    "cap|lid|rim|ring|rings|grip|top|base|edge|stripe|stripes|detail|details|colour|color|body|"
    "colouring|coloring",
    Kind.EVERY: "all|every|each|all the|all of the|all of|everything|anything|any and all|"
    "every single|each and every|whatever|each of the|every one of the|all those|all these|"
    "every last|all but one|all but two|all but three|all but one of the|all but two of the|"
    "all but one of|all but two of",
    Kind.DET: "the|a|an|that|this|those|these|your|my|its|their|any|some|another",
    Kind.PRONOUN: "it|them|they|both of them|all of them|each of them|this one|that one|"
    "these ones|both there|each one|all three|all|those things|these things|these objects|"
    "these items|those objects|those items|the objects there|the same",
    Kind.TAGGED: "tagged|tagged as|tagged with|tag|with tag|with the tag|with tag number|number|"
    "numbered|id|with id|with the id|with number|with the number|identified as|marked|marked as|"
    "marked with|carrying the tag|bearing the tag|named|called|identifier|with the tag number|"
    "tag number|with identifier|whose tag is|whose id is|which is tagged|that is tagged|"
    "having tag|that has tag|that has the tag|that has id|that has the id|tagged as number|"
    "tagged number|having the tag|having id|identified by|under tag",
    Kind.WITH: "with|having|featuring|bearing|showing|carrying|which have|which has|that have|"
    "that has|that bear|that bears|that carry|that carries|that show|that shows|which show|"
    "that contain|that contains|which contain|containing|including|that feature|that features|"
    "which carry|which carries|which bear|which bears|have|has|displaying|that display|"
    "that displays|that you see|whose|that include|that includes",
    Kind.THAT: "which|who",
    Kind.BE: "is|are|be|that is|that are|which is|which are|that's|looks|that looks|that look|"
    "lies|stands|lying|standing|sitting|that lies|that stands|located|placed|being",
    Kind.GOES: "should be|must be|should go|must go|goes|belongs|belong|needs to be|need to be|"
    "needs to go|need to go|has to be|have to be|shall be|has to go|have to go|to be|should stand|"
    "should lie|should rest|ends up|end up|should end up|should be placed|should be put|"
    "must be placed|must be put|needs to be put|needs to be placed|to go|shall go|should move|"
    "must move|should stay|to stand|to lie|to rest|to end up|stays|stay|will be|ought to be|"
    "ought to go",
    Kind.THERE: "there|over there|to the same place|in the same place|at the same place|"
    "in the same spot|to the same spot",
    Kind.HELD: "in your hand|in the hand|to your hand|into your hand|into the hand|in hand|"
    "in your hands|into your hands|to me|over to me",
    Kind.AGAIN: "do the same with|do the same for|the same with|the same for|likewise",
    Kind.NEAREST: "nearest|closest",
    Kind.BETWEEN: "between|in between|midway between|halfway between|in the middle between|"
    "in the middle of",
    Kind.UNDER: "under|underneath|below|beneath",
    Kind.FAR: "far from|far away from|away from|as far as possible from|well away from|"
    "at a distance from|far off from|distant from|far apart from|as far away as possible from",
    Kind.EDGE: "near the edge of|at the edge of|close to the edge of|on the edge of|"
    "to the edge of|by the edge of|next to the edge of|near an edge of|at an edge of|"
    "close to an edge of|along the edge of|onto the edge of|near the border of|near the edge|"
    "at the edge|close to the edge|on the edge|by the edge|to the edge",
    Kind.HOME: "where it was|where they were|where it came from|where you found it|"
    "where it stood|where it lay|to its place|in its place|to its old place|where you got it|"
    "where you took it from|where you picked it up|where it was before|to where it was|"
    "to where you found it|to where it came from|where it belongs|to its original place|"
    "to its original position|in its original place|at its original place|to its original spot|"
    "in its old place|where they came from|where you found them|where it had been|"
    "to where it had been|to where they were|in the place where it was|at the place where it was|"
    "where they stood|to the place where it was|to its previous place|to their places|"
    "where it started",
    Kind.TOGETHER: "next to each other|beside each other|near each other|close to each other|"
    "next to one another|beside one another|near one another|close to one another|close together|"
    "side by side|together|by each other|in a group|in one place|near to each other|"
    "alongside each other",
    Kind.EXCEPT: "except|except for|save|but not|apart from|other than|excluding|save for|"
    "with the exception of|aside from|leaving out|minus",
    Kind.OTHER: "other|others|remaining",
    Kind.OR: "or|or else|or maybe",
    Kind.AND: "and|plus|as well as|along with|&|and also|but also",
    Kind.COMMA: ",",
    Kind.THEN: "then|moreover|after that|afterwards|afterward|next|finally|subsequently|later|"
    "after this|after which|once done|when done|thereafter|furthermore|in addition|additionally|"
    "besides|;|.|!|?|:|and then|before|lastly|once you have done that|when you are done|"
    "when that is done|once that is done|following that|secondly|thirdly|after|once|"
    "once you have it|when you have it|having done that|followed by|or rather|as well|too|also|"
    "second|third",
    Kind.SKIP: "please|kindly|could you|can you|would you|will you|could you please|"
    "can you please|would you please|i would like you to|i'd like you to|i want you to|"
    "i need you to|for me|now|just|first|firstly|go|go and|walk|down|up|over|here|carefully|"
    "gently|safely|slowly|quickly|thanks|thank you|hey|hi|hello|adamo|ok|okay|let us|let's|you|"
    "your task is to|your job is to|try to|start by|somewhere|anywhere|directly|right|exactly|"
    "simply|you should|you must|you have to|you need to|back|there is|sir|so|together|"
    "would you mind|do me a favor and|do me a favour and|be so kind as to|would you be so kind to|"
    "task|i ask you to|we need you to|we want you to|must|should|if possible|with your hand|go to|"
    "begin by|by hand|in order|coloured|colored|your goal is to|away|along|only|each time|"
    "one by one|one after another|one after the other|immediately|straight|again|once more|"
    "once again|as well as possible|for us|softly|neatly|exactly there|and so on|at once|"
    "right away|right now|if you like|either|currently|at the moment|at present|still|already|"
    "free|available|a free spot|a free place|an empty spot|an empty place|"
    "well|nicely|proceed to|continue to|go ahead and|a bit|very|"
    "respectively|that you can find|that you find|you can find|you can see|that you can see|"
    "you see|you find|in the room|of the room|from the room|in this room|around|present|visible|"
    "dear|friend",
}

_VALUED: dict[Kind, dict[str, str]] = {
    Kind.CLASS: {
        "Lock": "lock|padlock|locks|padlocks",
        "Flashlight": "flashlight|torch|flash light|electric torch|hand lamp|pocket lamp|"
        "flashlights|torches|pocket torch",
        "Battery": "battery|batteries|battery cell|cell",
        "Tape": "tape|roll of tape|adhesive tape|tape roll|roll of adhesive tape|duct tape|"
        "sticky tape|roll of duct tape|masking tape|scotch tape|roll|tapes",
        "PeanutButter": "peanut butter|jar of peanut butter|peanut butter jar|jar|"
        "peanutbutter|peanut butter pot|peanut spread",
        "TomatoSoup": "tomato soup|can of tomato soup|tomato soup can|soup can|can of soup|"
        "can|tin|soup|tin of soup|tin can|soup tin|tin of tomato soup|food can|tomato can|"
        "tomatosoup|canned soup|can of tomatoes|cans|tins|tomato soup tin",
        "Pills": "pills|pill bottle|pills bottle|bottle of pills|pill|pill container|"
        "tablets|prescription bottle|vitamins|pill jar|pillbox|container of pills",
        "Pills Painkiller": "medicine|medicine bottle|medication|medicines|drug|drugs|"
        "medicine container|medicine bottles|pill bottles|bottles of medicine",
        "Binoculars": "binoculars|binocular|pair of binoculars|field glasses|field glass|"
        "pair of field glasses|spyglass",
        "Painkiller": "painkiller|painkillers|painkiller bottle|pain killer|pain killers|"
        "bottle of painkillers|bottle of painkiller|pain relief|pain reliever|aspirin|"
        "painkillers bottle|pain medication|painkiller medicine",
        "Lighter": "lighter|cigarette lighter|zippo|petrol lighter|gas lighter|fire lighter|"
        "lighters",
        "Key": "key|house key|door key|keys|metal key",
        "WineBottle Painkiller Pills": "bottle|bottles",
        "Glass": "glass|tumbler|drinking glass|water glass|glass of water|beaker|glasses|"
        "drinking glasses|tumblers",
        "Cup": "cup|mug|coffee cup|coffee mug|tea cup|teacup|cups|mugs",
        "IndoorPlant": "indoor plant|plant|potted plant|houseplant|house plant|pot plant|"
        "plant pot|flower pot|flowerpot|flower|indoorplant|plants|potted flower|green plant",
        "PeanutButter TomatoSoup": "food|foods|groceries|food items|food item|edible things|"
        "things to eat|something to eat|eatables|edibles|food products|canned food|snacks",
        "Screwdriver": "screwdriver|screw driver|screwdrivers|tools|tool|hand tools|hand tool",
        "Glass Cup Plate": "kitchen things|kitchen items|kitchen objects|kitchen thing|"
        "kitchenware|tableware|crockery|kitchen item|kitchen utensils|kitchen stuff|kitchen ware|"
        "kitchen object",
        "Cup Glass": "something to drink from|something to drink out of|drinking vessel|"
        "drinking vessels|drinkware|drinking things|things to drink from",
        "WineBottle": "wine|wine bottle|bottle of wine|red wine|bottle of red wine|"
        "red wine bottle|winebottle|wine bottles|alcohol|something to drink|drink|drinks|beverage|"
        "beverages",
        "Plate": "plate|dish|dinner plate|plates|dishes|platter|saucer",
    },
    Kind.COLOUR: {
        "red": "red|crimson|scarlet",
        "orange": "orange",
        "yellow": "yellow|golden|gold",
        "green": "green",
        "blue": "blue|navy",
        "purple": "purple|violet",
        "pink": "pink|magenta",
        "brown": "brown|copper|brass|bronze|amber|terracotta",
        "black": "black|dark",
        "grey": "grey|gray|silver|steel|metallic|metal",
        "white": "white|cream|creamy|whitish|off white|cream coloured|cream colored",
    },
    Kind.SHAPE: {
        "round": "round|circular|rounded|disc shaped|disk shaped|circle shaped|circle|disc|disk",
        "ring": "ring shaped|annular|doughnut shaped|donut shaped|torus shaped|toroidal|ring like",
        "cylinder": "cylindrical|cylinder shaped|cylinder|tubular|tube shaped|can shaped|"
        "cylinder like",
        "sphere": "spherical|ball shaped|sphere shaped|globular",
        "box": "rectangular|box shaped|boxy|square|cuboid|block shaped|cubic",
        "long": "long|elongated|thin|slim|slender|stick shaped|narrow",
        "flat": "flat",
    },
    Kind.GLASSY: {"transparent": "transparent|see through|clear|translucent|glassy|made of glass"},
    Kind.SIZE: {
        "smallest": "smallest|tiniest|littlest|smaller|lowest|least|minimum|minimal|small|tiny|"
        "little|most tiny|minor",
        "largest": "largest|biggest|greatest|larger|bigger|highest|maximum|large|big|bulkiest|"
        "most voluminous|huge|hugest",
        "tallest": "tallest|taller|tall",
        "shortest": "shortest|shorter",
        "farthest": "farthest|furthest|most distant|remotest",
    },
    Kind.SIDE: {
        "left": "left of|to the left of|on the left of|at the left of|on the left side of|"
        "to the left side of|left to|on the left hand side of|left from",
        "right": "right of|to the right of|on the right of|at the right of|on the right side of|"
        "to the right side of|on the right hand side of|right from",
        "front": "in front of|on the near side of|this side of|to the front of",
        "behind": "behind|in back of|at the back of|on the far side of|to the back of|"
        "to the rear of",
    },
    Kind.COUNT: {
        "1": "exactly one|a single|single",
        "2": "two|the two|both|both the|both of the|a pair of|the pair of",
        "3": "three|the three|all three",
        "4": "four|the four|all four",
        "5": "five|the five|all five",
        "6": "six|the six|all six",
        "7": "seven|the seven|all seven",
        "8": "eight|the eight|all eight",
        "9": "nine|the nine|all nine",
        "10": "ten|the ten|all ten",
    },
}

_RANKS = {"second": 2, "2nd": 2, "next": 2, "third": 3, "3rd": 3, "fourth": 4}

_SHIFT_LETTERS = "@abcdefghijklmnopqrstuvwxyz"
_WORD = re.compile(r"@(?:left|right|front|back)?\d+|[a-z]+_\w+|#?\d+|[a-z]+(?:'[a-z]+)?|[,.;:!?&]")


@cache
def phrase_table() -> dict[str, tuple[Kind, str]]:
    """All known phrases with their symbols and values."""
    table: dict[str, tuple[Kind, str]] = {}
    for kind, phrases in _PHRASES.items():
        for phrase in phrases.split("|"):
            table.setdefault(phrase, (kind, phrase))
    for kind, by_value in _VALUED.items():
        for value, phrases in by_value.items():
            for phrase in phrases.split("|"):
                table[phrase] = (kind, value)
    for value, phrases in _VALUED[Kind.SIZE].items():
        for word, rank in _RANKS.items():
            table.update(
                {
                    f"{word} {phrase}": (Kind.SIZE, f"{value} {rank}")
                    for phrase in phrases.split("|")
                }
            )
    return table


@cache
def _longest() -> int:
    return max(len(phrase.split()) for phrase in phrase_table())


def class_words() -> dict[str, str]:
    """Each class-meaning phrase with its classes, separated by blanks."""
    return {phrase: value for phrase, (kind, value) in phrase_table().items() if kind is Kind.CLASS}


def tokenize(text: str) -> list[Token]:
    """Split a text into symbols, the longest known phrase first.

    Args:
        text: Any text.

    Returns:
        The symbols in order, filler included; a word that no phrase starts with is UNKNOWN.
    """
    plain = text.lower().replace("\u2019", "'").replace("-", " ")
    words = _WORD.findall(re.sub(r"[^\x00-\x7f]", " ", plain))
    tokens: list[Token] = []
    at = 0
    while at < len(words):
        token, used = _longest_match(words, at)
        tokens.append(token)
        at += used
    return tokens


def _longest_match(words: list[str], at: int) -> tuple[Token, int]:
    table = phrase_table()
    if words[at].startswith("@"):
        way, centimetres = words[at][1:].rstrip("0123456789"), words[at].lstrip(_SHIFT_LETTERS)
        spoken = f"{centimetres} cm{f' to the {way}' if way else ''}"
        return Token(Kind.SHIFT, words[at][1:], spoken), 1
    if re.fullmatch(r"#?\d+|[a-z]+_\w+", words[at]):
        return Token(Kind.ID, words[at].lstrip("#"), words[at]), 1
    for length in range(min(_longest(), len(words) - at), 0, -1):
        phrase = " ".join(words[at : at + length])
        if phrase in table:
            kind, value = table[phrase]
            return Token(kind, value, phrase), length
    return Token(Kind.UNKNOWN, words[at], words[at]), 1
