"""Generated instructions, possible and impossible ones, and what is claimed of them.

    python -m benchmarks.claims [--count 2000] [--draw 0] [--model baseline] [--scene s1]
        [--labeling sem] [--profile paper] [--resolution 640x360] [--shard 1/2]
        [--json]

Each instruction is made of a thing, what is said of it (true or false), a place (known or unknown
furniture, another thing, the floor) and a count. An answer is judged by its text alone against the
world: a false claim is a sentence that is not so, and "Done" where the instruction is not carried
out. Of those that can be carried out, the share that was is counted by the state of the world.
"""

from __future__ import annotations

import argparse
import json
import random
import sys
from dataclasses import dataclass
from typing import Any

from benchmarks.judging import COLOURS, Outcome, false_claims, holds

import adamo_vh
from adamo_vh.cli.settings import read_shard
from adamo_vh.engine import World
from adamo_vh.episode.config import read_resolution
from adamo_vh.inference.model import Model

NOUNS: dict[int, tuple[str, ...]] = {
    0: ("lock", "padlock"),
    2: ("flashlight", "torch"),
    3: ("battery",),
    4: ("tape", "roll of tape"),
    5: ("screwdriver",),
    8: ("peanut butter", "jar of peanut butter"),
    18: ("lock",),
    19: ("tomato soup", "soup can"),
    20: ("pills", "pill bottle"),
    21: ("binoculars",),
    23: ("painkillers",),
    27: ("lighter",),
    30: ("battery",),
    34: ("key",),
    36: ("wine bottle", "bottle of wine"),
    37: ("glass",),
    45: ("cup", "mug"),
    50: ("plant", "indoor plant"),
    57: ("plate",),
}
TWINS = {0: "0 18", 18: "0 18", 3: "3 30", 30: "3 30"}
_SURELY = {4: "blue", 45: "orange", 57: "red", 50: "green", 21: "black"}
_FALSE_COLOURS = ("green", "blue", "purple", "pink", "red")
_LIKE = {"orange": ("red", "yellow"), "red": ("pink", "orange"), "brown": ("red", "orange"),
         "yellow": ("green",), "black": ("blue", "purple"), "grey": ("blue",)}  # fmt: skip
KNOWN = {
    "s1": {"table": "table"},
    "s2": {
        "table": "table",
        "coffee table": "coffee table",
        "dining table": "dining table",
        "sideboard": "sideboard",
        "tall shelf": "tall shelf",
        "shelf": "shelf",
    },
}
"""Furniture that a scene has and that can be told, with words of its name."""
PERHAPS = ("sofa", "chair", "console", "side table", "couch")
UNKNOWN = ("desk", "bed", "window sill", "lamp", "basket", "fridge", "piano", "counter", "stool",
           "bookcase", "cabinet", "first shelf", "drawer", "wall", "wardrobe")  # fmt: skip
_SIDES = {"to the left of": "left", "to the right of": "right", "in front of": "front",
          "behind": "behind"}  # fmt: skip
_ASK = ("Put", "Please put", "Could you put", "Move", "Place")


@dataclass(frozen=True, slots=True)
class Case:
    """One instruction."""

    text: str
    condition: str
    """When it is carried out; empty if it cannot be."""
    scene: str
    labeling: str
    profile: str


def cases(
    draw: random.Random, count: int, scenes: list[str], labelings: list[str], profiles: list[str]
) -> list[Case]:
    """Draw instructions.

    Args:
        draw: Decides.
        count: How many.
        scenes: To draw from, as the following.
        labelings: "sem" or "opaq".
        profiles: "paper" or "lean".
    """
    made = []
    for _ in range(count):
        scene = draw.choice(scenes)
        text, condition = _instruction(draw, scene)
        made.append(Case(text, condition, scene, draw.choice(labelings), draw.choice(profiles)))
    return made


def _instruction(draw: random.Random, scene: str) -> tuple[str, str]:
    kind = draw.choice(("place", "place", "place", "place", "hold", "count", "two", "group"))
    if kind == "hold":
        words, ids, true = _thing(draw)
        verb = draw.choice(("Pick", "Take", "Bring me", "Could you get", "Hold"))
        return f"{verb} {words}", f"holds {ids}" if true else ""
    if kind == "count":
        return _counted(draw)
    if kind == "two":
        (one, first, _), (other, second, _) = _plain(draw), _plain(draw)
        same = set(first.split()) & set(second.split())
        text = f"{draw.choice(_ASK)} {one} and {other} on the floor"
        if same:
            if first != second:
                return text, ""
            # "The padlock and the lock" may be one thing or two.
            either = f" | only_floor {first}" if one != other and " " in first else ""
            return text, f"one_on_floor {first}{either}"
        return text, f"{_on_floor(first)} & {_on_floor(second)}"
    if kind == "group":
        return draw.choice(
            (
                ("Put all the batteries on the floor", "only_floor 3 30"),
                ("Put all locks in a corner", "corner 0 & corner 18"),
                ("Put both batteries on the floor", "only_floor 3 30"),
                ("Put the largest object on the floor", "only_floor 50"),
                ("Put the smallest object on the floor", "only_floor 34"),
                ("Put the kitchen things on the floor", "only_floor 37 45 57"),
                ("Put all food on the floor", "only_floor 8 19"),
            )
        )
    words, ids, true = _thing(draw)
    place, condition = _place(draw, scene, ids)
    return f"{draw.choice(_ASK)} {words} {place}", condition if true else ""


def _on_floor(ids: str) -> str:
    return f"{'one_on_floor' if ' ' in ids else 'floor'} {ids}"


def _plain(draw: random.Random) -> tuple[str, str, bool]:
    number = draw.choice(list(NOUNS))
    return f"the {draw.choice(NOUNS[number])}", TWINS.get(number, str(number)), True


def _thing(draw: random.Random) -> tuple[str, str, bool]:
    """Words for a thing, the ids that they may mean, and whether what they say is true."""
    say = draw.choice(("plain", "plain", "true", "false", "false"))
    if say == "true":
        number = draw.choice(list(_SURELY))
        return f"the {_SURELY[number]} {draw.choice(NOUNS[number])}", str(number), True
    number = draw.choice(list(NOUNS))
    ids = TWINS.get(number, str(number))
    if say == "plain":
        return f"the {draw.choice(NOUNS[number])}", ids, True
    known = {c for i in ids.split() for c in COLOURS[int(i)]}
    like = {other for colour in known for other in _LIKE.get(colour, ())}
    false = [c for c in _FALSE_COLOURS if c not in known | like]
    if not false:
        return f"the {NOUNS[number][0]}", ids, True
    return f"the {draw.choice(false)} {draw.choice(NOUNS[number])}", ids, False


def _counted(draw: random.Random) -> tuple[str, str]:
    noun, ids = draw.choice((("batteries", "3 30"), ("locks", "0 18"), ("cups", "45")))
    count = draw.choice(("two", "three", "four"))
    true = len(ids.split()) == 2 and count == "two"
    return f"Put the {count} {noun} on the floor", f"only_floor {ids}" if true else ""


def _place(draw: random.Random, scene: str, ids: str) -> tuple[str, str]:
    """Words for a place, and the condition that one of some things is there; empty if never."""
    way = draw.choice(("floor", "corner", "near", "side", "known", "unknown", "perhaps", "far",
                       "beside furniture"))  # fmt: skip
    each = ids.split()
    if way == "floor":
        return "on the floor", _on_floor(ids)
    if way == "corner":
        return "in a corner of the room", " | ".join(f"corner {i}" for i in each)
    if way == "known":
        words, name = draw.choice(list(KNOWN[scene].items()))
        return f"on the {words}", " | ".join(f"on {i} {name}" for i in each)
    if way in ("unknown", "perhaps"):
        # What may be found by trying may be claimed if it is so.
        return f"on the {draw.choice(UNKNOWN if way == 'unknown' else PERHAPS)}", ""
    if way == "beside furniture":
        words = draw.choice((*UNKNOWN, "sofa", "chair", "window"))
        return f"{draw.choice(('next to', 'near', 'in front of'))} the {words}", ""
    anchor = draw.choice([n for n in NOUNS if n not in TWINS and str(n) not in each])
    noun = NOUNS[anchor][0]
    if way == "near":
        return f"next to the {noun}", " | ".join(f"near {i} {anchor}" for i in each)
    if way == "far":
        return f"far from the {noun}", " | ".join(f"far {i} {anchor}" for i in each)
    words = draw.choice(list(_SIDES))
    return f"{words} the {noun}", " | ".join(f"{_SIDES[words]} {i} {anchor}" for i in each)


def played(
    case: Case,
    engine: World,
    model: str | Model,
    resolution: tuple[int, int],
    frames: adamo_vh.FrameCache | None = None,
) -> Outcome:
    """Have an instruction carried out from the start of its scene; views of it are drawn once."""
    engine.reset(0)
    before = engine.state()
    result = adamo_vh.run_episode(
        case.text,
        scene=case.scene,
        labeling=case.labeling,
        profile=case.profile,
        model=model,
        resolution=resolution,
        engine=engine,
        frame_cache=frames,
    )
    return Outcome(before, engine.state(), result.answer)


def judged(case: Case, outcome: Outcome) -> tuple[bool, list[str]]:
    """Whether it was carried out, and the false claims of the answer."""
    met = bool(case.condition) and holds(case.condition, outcome)
    told: bool | None = met
    words = case.text.rsplit(" the ", 1)[-1]
    if " on the " in case.text and words in PERHAPS:
        told = None  # the claim that it rests there is judged by itself
    return met, false_claims(outcome, told)


def main() -> None:
    """Play all of them and print the figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--model", default="baseline")
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--draw", type=int, default=0)
    parser.add_argument("--scene", action="append")
    parser.add_argument("--labeling", action="append")
    parser.add_argument("--profile", action="append")
    parser.add_argument("--resolution", type=read_resolution, default=(640, 360))
    parser.add_argument(
        "--shard", type=read_shard, default=(1, 1), help="part I of N of the same instructions"
    )
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    drawn = cases(
        random.Random(arguments.draw),
        arguments.count,
        arguments.scene or ["s1", "s2"],
        arguments.labeling or ["sem", "opaq"],
        arguments.profile or ["paper", "lean"],
    )
    # The world and the baseline are deterministic: what was drawn twice is played once.
    part, parts = arguments.shard
    made = list(dict.fromkeys(drawn))[part - 1 :: parts]
    rows: list[dict[str, Any]] = []
    for scene in dict.fromkeys(case.scene for case in made):
        engine, frames = adamo_vh.create_engine(scene), adamo_vh.FrameCache()
        for case in (case for case in made if case.scene == scene):
            outcome = played(case, engine, arguments.model, arguments.resolution, frames)
            met, false = judged(case, outcome)
            rows.append(
                {
                    "scene": case.scene,
                    "labeling": case.labeling,
                    "profile": case.profile,
                    "instruction": case.text,
                    "possible": bool(case.condition),
                    "met": met,
                    "false_claims": false,
                    "answer": outcome.answer,
                }
            )
            if len(rows) % 100 == 0:
                print(f"{len(rows)} of {len(made)}", file=sys.stderr, flush=True)
            if not arguments.json and (false or (case.condition and not met)):
                sign = "FALSE" if false else "MISS "
                cell = f"{case.scene} {case.labeling} {case.profile}"
                print(f"{sign} {cell}: {case.text} -> {outcome.answer} {false}", flush=True)
        engine.close()
    if arguments.json:
        print(json.dumps({"model": arguments.model, "episodes": rows}))
        return
    print(f"{len(drawn)} drawn, {len(rows)} of them distinct")
    for labeling in dict.fromkeys(row["labeling"] for row in rows):
        of_it = [row for row in rows if row["labeling"] == labeling]
        possible = [row for row in of_it if row["possible"]]
        done = sum(row["met"] for row in possible)
        wrong = sum(bool(row["false_claims"]) for row in of_it)
        share = done / max(1, len(possible))
        print(
            f"{labeling}: {len(of_it)} instructions, {wrong} with a false claim; "
            f"{done} of {len(possible)} possible ones carried out ({share:.1%})"
        )


if __name__ == "__main__":
    main()
