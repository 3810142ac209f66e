"""The text mirror says what the frame shows, in plain numbers."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from adamo_vh.geometry import Vec3
from adamo_vh.observation import AgentState, ObservedObject, ReferencePoint
from adamo_vh.perception import TextForm, agent_lines, object_lines, point_lines

PLATE = ObservedObject(
    "Plate_57", Vec3(0.326, -0.603, 0.795), 0.25 * 0.25 * 0.03, (812, 500, 910, 560), 3000
)
KEY = ObservedObject("34", Vec3(-0.1744, -0.0001, 0.781), 2.64e-6, (5, 6, 15, 12), 44)
AGENT = AgentState(
    position=Vec3(-2.0, -1.0, 0.0),
    heading_rad=0.0,
    gaze=Vec3(0.51, -1.25, 1.17),
    eyes=Vec3(-2.0, -1.0, 1.6),
)


def test_full_object_lines():
    assert object_lines([PLATE, KEY], TextForm.FULL) == (
        "- Plate_57: center (0.326, -0.603, 0.795), volume 1875.0 cm3, "
        "box [812, 500, 910, 560] px\n"
        "- 34: center (-0.174, 0.000, 0.781), volume 2.6 cm3, box [5, 6, 15, 12] px"
    )


def test_paper_object_lines_have_no_box():
    assert object_lines([PLATE], TextForm.PAPER) == (
        "- Plate_57: center (0.326, -0.603, 0.795), volume 1875.0 cm3"
    )


def test_point_lines():
    points = [
        ReferencePoint("P0", Vec3(1.2, -0.33, -0.004), (160.0, 990.0)),
        ReferencePoint("P1", Vec3(3.0, 2.987, 1.005), (160.0, 810.0)),
    ]
    assert point_lines(points) == "- P0: (1.20, -0.33, 0.00)\n- P1: (3.00, 2.99, 1.00)"


def test_empty_lists_say_so():
    assert object_lines([], TextForm.FULL) == "none"
    assert object_lines([], TextForm.PAPER) == "none"
    assert point_lines([]) == "none"


def test_full_agent_lines():
    assert agent_lines(AGENT, TextForm.FULL) == (
        "- position (-2.00, -1.00, 0.00)\n"
        "- heading 0 deg\n"
        "- gaze (0.51, -1.25, 1.17)\n"
        "- hand: empty"
    )
    assert agent_lines(replace(AGENT, held="Plate_57"), TextForm.FULL).endswith("- hand: Plate_57")


def test_paper_agent_lines_have_the_position_alone():
    assert agent_lines(replace(AGENT, held="57"), TextForm.PAPER) == (
        "- position (-2.00, -1.00, 0.00)"
    )


@pytest.mark.parametrize(
    ("heading_deg", "said"), [(0, 0), (-0.2, 0), (90, 90), (-90, 270), (180, 180), (359.7, 0)]
)
def test_headings_are_whole_degrees_from_0_to_359(heading_deg, said):
    agent = replace(AGENT, heading_rad=math.radians(heading_deg))
    assert f"- heading {said} deg" in agent_lines(agent, TextForm.FULL)


def test_negative_zero_never_appears():
    tiny = Vec3(-1e-9, -0.0, -0.0004)
    agent = AgentState(tiny, -1e-9, tiny, tiny)
    item = ObservedObject("1", tiny, 1e-9, (0, 0, 1, 1), 4)
    text = "\n".join(
        [
            agent_lines(agent, TextForm.FULL),
            object_lines([item], TextForm.FULL),
            point_lines([ReferencePoint("P0", tiny, (0.0, 0.0))]),
        ]
    )
    assert "-0" not in text
