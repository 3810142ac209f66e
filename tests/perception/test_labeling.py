"""Tags name objects, and only what was named is found again."""

from __future__ import annotations

import pytest
from tests.percepts import NAMES

from adamo_vh.perception import Labeling


def test_semantic_tag_tells_class_and_id():
    assert Labeling.SEM.tag(57, "Plate") == "Plate_57"


def test_opaque_tag_tells_the_id_alone():
    assert Labeling.OPAQ.tag(57, "Plate") == "57"


@pytest.mark.parametrize("labeling", Labeling)
def test_every_tag_resolves_to_its_object(labeling):
    for object_id, name in NAMES.items():
        assert labeling.resolve(labeling.tag(object_id, name), NAMES) == object_id


@pytest.mark.parametrize("labeling", Labeling)
@pytest.mark.parametrize("text", ["34", " 34 ", '"34"', "`34`", "'34'", "\u201c34\u201d"])
def test_the_bare_id_is_understood_under_both_labelings(labeling, text):
    assert labeling.resolve(text, NAMES) == 34


@pytest.mark.parametrize(
    "text", ["plate_57", "PLATE_57", " Plate_57\n", "'Plate_57'", '" Plate_57"']
)
def test_case_space_and_quotes_do_not_matter(text):
    assert Labeling.SEM.resolve(text, NAMES) == 57


@pytest.mark.parametrize(
    "text",
    [
        "Cup_57",
        "Plate_58",
        "Plate",
        "_57",
        "",
        "P57",
        "57.5",
        "057",
        "-57",
        "5 7",
        "57 or 34",
        "٥٧",
        "1_0",
        "5_7",
        "Plate_057",
        "Plate_57.0",
        "Plate: 57",
        "the Plate 57",
        "Plate_57 Tape_4",
        "#",
        "[]",
        "57" * 200,
        "Plates_57",
    ],
)
def test_nothing_is_guessed(text):
    assert Labeling.SEM.resolve(text, NAMES) is None


@pytest.mark.parametrize("labeling", Labeling)
@pytest.mark.parametrize(
    "text",
    ["#57", "[57]", "57.0", "(57)", "<57>", "**57**", '["57"]', "object 57", "Tag #57", "id_57"],
)
def test_a_number_in_common_dress_is_understood_under_both_labelings(labeling, text):
    assert labeling.resolve(text, NAMES) == 57


@pytest.mark.parametrize(
    "text",
    ["Plate 57", "plate-57", "Plate #57", "Plate57", "[Plate_57]", "<plate_57>", "**Plate_57**"],
)
def test_class_and_number_in_common_dress_name_one_object(text):
    assert Labeling.SEM.resolve(text, NAMES) == 57
    assert Labeling.OPAQ.resolve(text, NAMES) is None


def test_a_class_of_two_words_may_be_written_as_two():
    known = {7: "RemoteControl", 8: "Measuring_Cup"}
    assert Labeling.SEM.resolve("remote control 7", known) == 7
    assert Labeling.SEM.resolve("MeasuringCup_8", known) == 8


def test_opaque_labeling_knows_no_semantic_tag():
    assert Labeling.OPAQ.resolve("Plate_57", NAMES) is None


def test_objects_that_are_not_known_are_not_found():
    assert Labeling.SEM.resolve("Plate_57", {4: "Tape"}) is None
    assert Labeling.SEM.resolve("57", {}) is None
