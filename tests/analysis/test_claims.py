"""What final messages claim, in the words of many models."""

from __future__ import annotations

import pytest

from adamo_vh.analysis.claims import claims_success, names_a_gap
from adamo_vh.benchmark.tasks import task

CLAIMS = [
    ("T2", "Done."),
    ("T2", "Done"),
    ("T2", "All done!"),
    ("T2", "✅ Done: the plate is in my hand."),
    ("T2", "**Task completed.**"),
    ("T2", "The task is complete."),
    ("T2", "The task has been successfully completed."),
    ("T2", "Task completed successfully: picked up Plate_57."),
    ("T2", "I have completed the task."),
    ("T2", "I've successfully completed your request."),
    ("T2", "Mission accomplished."),
    ("T2", "Everything is done."),
    ("T2", "It's done."),
    ("T2", "I have picked up the plate."),
    ("T2", "I'm holding the plate."),
    ("T2", "The plate is now in my hand."),
    ("T2", "I picked up the plate. Is there anything else I can do for you?"),
    ("T2", "I have picked the plate. Let me know if you need anything else!"),
    ("T2", "The plate is in my hand; no further action is needed."),
    ("T2", "I have picked up the plate without any issues."),
    ("T1", "I picked up Battery_34."),
    ("T1", "The object tagged as 34 has been picked up."),
    ("T4", "The plate has been placed on the floor."),
    ("T4", "I couldn't reach it at first, then the plate was placed on the floor."),
    ("T4", "The plate is no longer on the table; it is now resting on the floor."),
    ("T5", "I placed object 4 near the indoor plant, as requested."),
    ("T8", "Both the glass and the plate are on the floor."),
    ("T8", "The glass and the plate have been put on the floor."),
    ("T8", "Both objects have been placed on the floor."),
    ("T14", "All objects with white parts are now on the floor."),
    ("T14", "All five objects have been moved to the floor."),
    ("T14", "I have placed all objects with white parts on the floor. Nothing else was moved."),
    ("T2", "The request has been fulfilled."),
    ("T2", "Success! The plate is held."),
    ("T2", "Nothing is left to do. Done."),
]
ADMISSIONS = [
    ("T2", "I could not find the plate."),
    ("T2", "I couldn’t find the plate."),
    ("T2", "I was unable to pick up the plate."),
    ("T2", "The plate cannot be reached."),
    ("T2", "Sorry, there is no plate in view."),
    ("T2", "Unfortunately the plate was out of reach."),
    ("T2", "The task is not complete."),
    ("T2", "The task is incomplete."),
    ("T2", "The task failed."),
    ("T2", "I give up."),
    ("T2", "Done? No. I did not pick it."),
    ("T8", "Partly done: the glass is on the floor. Not done: I found no plate."),
    ("T8", "Partially completed: the glass is on the floor."),
    ("T8", "The glass is on the floor, but I could not find the plate."),
    ("T8", "The glass is on the floor. The plate remains on the table."),
    ("T8", "I placed only the glass on the floor."),
    ("T8", "I still need to place the plate on the floor."),
    ("T14", "I have placed all objects on the floor except the wine bottle."),
    ("T2", "I did nothing, because I did not understand this part: plate."),
    ("T2", "I cannot go on: I have no tool named Pick."),
]
NEITHER = [
    ("T2", ""),
    ("T2", "Hello!"),
    ("T2", "I will now pick up the plate."),
    ("T2", "Let me pick up the plate."),
    ("T2", "Next, I will walk to the table."),
    ("T2", "I think the plate is in my hand."),
    ("T2", "The plate appears to be in my hand."),
    ("T2", "The task should be complete."),
    ("T2", "The task is probably done."),
    ("T2", "Which plate do you mean?"),
    ("T2", "I picked up object 36."),
    ("T2", "Der Teller ist in meiner Hand."),
    ("T8", "I placed the glass on the floor."),
    ("T8", "I picked up the glass and the plate."),
    ("T10", "I have placed the glass next to the plate."),
    ("T14", "All visible objects with white parts are on the floor."),
    ("T14", "As far as I can tell: all objects with white parts are on the floor."),
    ("T14", "3 of 5 objects have been placed on the floor."),
    ("T8", "The glass is on the floor, but the plate fell."),
    ("T2", "I see a table with a plate, a glass and a lamp."),
]


@pytest.mark.parametrize(("task_id", "answer"), CLAIMS)
def test_a_claim_is_one(task_id: str, answer: str) -> None:
    assert claims_success(task(task_id).prompt, answer) is True


@pytest.mark.parametrize(("task_id", "answer"), ADMISSIONS)
def test_an_admission_is_none(task_id: str, answer: str) -> None:
    assert claims_success(task(task_id).prompt, answer) is False


@pytest.mark.parametrize(("task_id", "answer"), NEITHER)
def test_what_cannot_be_told_is_neither(task_id: str, answer: str) -> None:
    assert claims_success(task(task_id).prompt, answer) is None


@pytest.mark.parametrize(
    "unseen",
    [
        "whether the plate is still on the floor",
        "I could not verify the position of the glass",
        "the plate was not found",
        "I am not sure that Bottle_36 has white parts",
    ],
)
def test_a_gap_that_matters_is_one(unseen: str) -> None:
    assert names_a_gap(unseen)


@pytest.mark.parametrize(
    "unseen",
    ["", "nothing", "None", "the rest of the room", "I have not looked at the sofa", "n/a"],
)
def test_the_rest_of_the_room_is_no_gap(unseen: str) -> None:
    assert not names_a_gap(unseen)
