"""Every reply is exactly one of six things, and says which."""

from __future__ import annotations

import pytest

from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.model import Ending, Reply

CALL = ToolCall("a", "Pick", {"object": "57"})


@pytest.mark.parametrize(
    ("reply", "ending"),
    [
        (Reply(AIMessage("", (CALL,))), Ending.CALL),
        (Reply(AIMessage("I take it.", (CALL,))), Ending.CALL),
        (Reply(AIMessage("Done.")), Ending.ANSWER),
        (Reply(AIMessage(" \n")), Ending.EMPTY),
        (Reply(AIMessage("Pick"), unreadable="could not be read."), Ending.UNPARSED_CALL),
        (Reply(AIMessage("The pl"), ending=Ending.CUT_OFF), Ending.CUT_OFF),
    ],
)
def test_what_a_reply_is_follows_from_it_unless_it_is_told(reply: Reply, ending: Ending) -> None:
    assert reply.ending is ending
    assert reply.ending.is_failure == (ending not in (Ending.CALL, Ending.ANSWER))
