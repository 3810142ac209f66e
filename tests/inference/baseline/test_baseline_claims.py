"""What the baseline says is so: generated and everyday instructions, judged by text and world."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from benchmarks import everyday
from benchmarks.claims import Case, cases, judged, played
from benchmarks.judging import Outcome, false_claims, holds
from tests.spread import spread

import adamo_vh
from adamo_vh.inference.baseline import BaselineModel
from adamo_vh.inference.baseline.mind.notes import Entry, read

_SMALL = (640, 360)
_LARGER = (1280, 720)
"""For what depends on colours: at the small size a cup far off is a few dozen pixels."""
_SAMPLE = (1, 7, 13, 15, 18, 23, 24, 35, 41, 42, 49, 57, 61)
"""Lines of the everyday instructions for every run; `make test-all` plays all of them."""


@pytest.fixture(scope="module", params=["s1", "s2"])
def world(request):
    made = adamo_vh.create_engine(request.param)
    yield request.param, made
    made.close()


def _play(world, text: str, resolution: tuple[int, int]) -> Outcome:
    scene, engine = world
    return played(Case(text, "", scene, "sem", "paper"), engine, "baseline", resolution)


def test_generated_instructions_get_no_false_claim(world):
    scene, engine = world
    made = cases(random.Random(11), 3, [scene], ["sem", "opaq"], ["paper", "lean"])
    for case in made:
        _, false = judged(case, played(case, engine, "baseline", _SMALL))
        assert not false, case


@pytest.mark.slow
@pytest.mark.parametrize("labeling", ["sem", "opaq"])
def test_many_generated_instructions(world, labeling):
    scene, engine = world
    done = possible = 0
    for case in cases(random.Random(5), 150, [scene], [labeling], ["paper", "lean"]):
        met, false = judged(case, played(case, engine, "baseline", _SMALL))
        assert not false, case
        done, possible = done + met, possible + bool(case.condition)
    assert done >= (0.85 if labeling == "sem" else 0.5) * possible


@pytest.mark.parametrize("line", spread(_SAMPLE, 2))
def test_everyday_instructions(world, line):
    _everyday(world, line)


@pytest.mark.slow
def test_most_everyday_instructions_are_carried_out(world):
    count = len(list(everyday.lines(world[0])))
    met = sum(_everyday(world, line, must=False) for line in range(1, count + 1))
    assert met >= 0.9 * count


def _everyday(world, line: int, must: bool = True) -> bool:
    text, condition = list(everyday.lines(world[0]))[line - 1]
    coloured = "looks" in condition or "orange" in condition
    outcome = _play(world, text, _LARGER if coloured else _SMALL)
    met = holds(condition, outcome)
    assert not false_claims(outcome, met if "refuses" not in condition else None)
    assert met or not must, outcome.answer
    return met


@pytest.mark.parametrize(
    ("text", "says", "never"),
    [
        ("Put the tape on the desk", "no desk", "on the desk"),
        ("Pick the green cup", "no green cup", "I hold"),
        ("Put the blue plate on the floor", "no blue plate", "on the floor"),
        ("Put the three batteries on the floor", "2 of 3", "^Done"),
        ("Put the battery on the floor", "Several fit", "not done"),
        ("Is the cup green?", "No: Cup_45 looks orange", "Yes"),
    ],
)
def test_what_is_not_so_is_said(world, text, says, never):
    if world[0] == "s2" and "battery" in text:
        pytest.skip("the other battery may be out of view")
    coloured = "green" in text or "blue" in text
    answer = _play(world, text, _LARGER if coloured else _SMALL).answer
    assert says in answer
    assert never.strip("^") not in answer[: 4 if never[0] == "^" else None]


@pytest.mark.parametrize("word", ["bookcase", "bookshelf"])
def test_what_was_taken_for_something_is_told(world, word):
    answer = _play(world, f"Put the plate on the {word}", _SMALL).answer
    assert not answer.startswith("Done")
    if world[0] == "s2":
        assert answer.startswith("As far as I can tell: Plate_57 rests on the tall shelf")
        assert answer.endswith(f"I took the tall shelf for the {word}.")


class Overheard(BaselineModel):
    """The baseline, with its notes kept."""

    def __init__(self) -> None:
        super().__init__()
        self.notes: list[str] = []

    def complete(self, messages, tools, sampling):
        reply = super().complete(messages, tools, sampling)
        told = [str((call.arguments or {}).get("note", "")) for call in reply.message.calls]
        self.notes += [reply.message.text, *told]
        return reply


@pytest.mark.parametrize("profile", ["paper", "lean"])
def test_no_note_holds_codes(world, profile):
    scene, engine = world
    player = Overheard()
    case = Case(
        "Put the glass next to the plate and the key on the floor", "", scene, "opaq", profile
    )
    played(case, engine, player, _SMALL)
    notes = [note for note in player.notes if note]
    assert notes
    for note in notes:
        assert "[#" not in note
        for item in read(note).items:
            assert item[0].isalpha(), item
    assert read("no memory at all") == Entry()


def test_the_everyday_data_has_a_condition_for_each_line():
    for scene in ("s1", "s2"):
        for text, condition in everyday.lines(scene):
            assert text
            assert condition
    assert Path(everyday.__file__).with_suffix(".tsv").exists()
