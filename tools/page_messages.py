"""Write web/tests/messages.json: one message of each kind, as the studio's server tells it.

The page's own tests read it, so that nothing is told in words that the page does not know.
"""

from __future__ import annotations

import json
from pathlib import Path

from adamo_vh.action import Code, Feedback, Outcome
from adamo_vh.engine import LightChanged, ObjectAdded, ObjectMoved, ObjectTaken
from adamo_vh.geometry import Vec3
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Reply, Spent, Usage
from adamo_vh.observation import AgentState, ObservedObject, ReferencePoint
from adamo_vh.record.termination import TerminationReason
from adamo_vh.record.trajectory import (
    Acted,
    Ended,
    Event,
    Happened,
    LeftOut,
    Lost,
    Observed,
    Restored,
    Shown,
    Started,
    Thought,
    Vetoed,
)
from adamo_vh.record.turn import Turn, Wish
from adamo_vh.session.posing import Pose
from adamo_vh.studio import messages

FILE = Path(__file__).resolve().parents[1] / "web" / "tests" / "messages.json"
_FRAME = "0123456789abcdef01234567.png"
_AGENT = AgentState(Vec3(0, -1, 0), 0.5, Vec3(1, 0, 0.8), Vec3(0, -1, 1.6), "Cup_45")
_CUP = {"object": "Cup_45"}
_PICK = ToolCall("call-1", "Pick", _CUP)
_REPLY = Reply(AIMessage("A cup.", (_PICK,)), Usage(900, 40), 1.5, cost_usd=0.01)


def events() -> tuple[Event, ...]:
    """One event of each kind that a page is told."""
    return (
        Started("Pick up the cup", "You are an agent.", "", ""),
        Observed(
            1,
            _FRAME,
            1920,
            1080,
            (ObservedObject("Cup_45", Vec3(1, 0, 0.8), 0.001, (10, 20, 40, 60), 500),),
            (ReferencePoint("P0", Vec3(1, 1, 0), (960.0, 800.5)),),
            _AGENT,
        ),
        Thought(1, "Holding: nothing", 3, Turn(_REPLY, (Wish(_PICK, _CUP, "A cup.", 0.9),))),
        Shown(1, _FRAME, 640, 480),
        Acted(
            1,
            "call-1",
            "Pick",
            _CUP,
            Feedback(Outcome.CORRECTED, Code.CANCELLED, "Corrected: stopped.", 0.5, 1.2),
            _AGENT,
            "",
            "",
            0.1,
        ),
        LeftOut(1, "call-2", "Walk", "the user spoke"),
        Vetoed(1, "Not that one."),
        Happened(2, ObjectMoved(45, Vec3(1, 0, 0.8)), "", by_user=True),
        Happened(2, ObjectTaken(45), ""),
        Happened(2, ObjectAdded(45, Vec3(1, 0, 0.8)), ""),
        Happened(2, LightChanged(0, 0.2), ""),
        Restored(2, "", ""),
        Lost(2, Spent(Usage(300, 10), 1, 0.002)),
        Ended(2, TerminationReason.STOPPED, "", "", 4.0, "the user stopped it"),
    )


def told() -> list[messages.Message]:
    """One message of each kind; a greeting is made of a whole run, and tested with one."""
    poses = [
        Pose(
            (0.5, -1.0, 0.25),
            (0.0, 0.0, 0.93),
            (0.0, 0.0, 0.0, 1.0),
            (0.1, -0.2),
            45,
            {"45": (1.0, 0.0, 0.8, 0.0, 0.0, 0.0, 1.0)},
            (7,),
            (0.8, 0.4),
        ),
        Pose((0.5, -1.0, 0.25), (0.0, 0.0, 0.93), (0.0, 0.0, 0.0, 1.0), (0.0, 0.0), None),
    ]
    found = [
        *(messages.pose(pose) for pose in poses),
        *(messages.event(event, lambda name: f"frames/{name}") for event in events()),
        messages.status("thinking", 2.0, Spent(Usage(900, 40), cost_usd=0.01), can_undo=True),
        messages.asked([{"name": "Pick", "arguments": _CUP}], "A cup."),
        messages.notice("Something is odd.", "warning"),
    ]
    return [{"n": n, "t": float(n), **message} for n, message in enumerate(found, 1)]


def text() -> str:
    """The file as it is kept."""
    return json.dumps(told(), indent=1) + "\n"


if __name__ == "__main__":
    FILE.write_text(text(), encoding="utf-8")
