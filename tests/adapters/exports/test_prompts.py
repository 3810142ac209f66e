"""The prompts of a record are exactly those that the model was given."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from tests.adapters.exports.runs import SMALL, run
from tests.cognition.test_lean_agent import Player, finish, noted, says
from tests.run_folder import played
from tests.session.test_lean_resume import SAID, Live

import adamo_vh
from adamo_vh.action import ToolSchema
from adamo_vh.adapters.exports.prompts import prompts
from adamo_vh.adapters.exports.recorded import recorded
from adamo_vh.errors import RecordError
from adamo_vh.inference.messages import Message
from adamo_vh.inference.model import Reply, Sampling
from adamo_vh.record.run_folder import EVENTS, RESULT
from adamo_vh.session.lending import LentWorld


@pytest.mark.parametrize("profile", ["paper", "lean", "single"])
def test_prompts_come_out_as_they_were(profile: str, lent: LentWorld, tmp_path: Path) -> None:
    asked = run(tmp_path, lent, profile, "T3")
    (episode,) = recorded([tmp_path])
    found = prompts(episode)
    assert [(prompt.messages, prompt.tools) for prompt in found] == asked
    assert [prompt.reply for prompt in found] == [t.reply for t in episode.trajectory.thoughts]


def test_doubts_refusals_and_close_ups_come_again(lent: LentWorld, tmp_path: Path) -> None:
    player = Live(0)
    adamo_vh.run_episode(
        "Put it down.", model=player, engine=lent, profile="lean", resolution=SMALL, out=tmp_path
    )
    (episode,) = recorded([tmp_path])
    assert len(prompts(episode)) == len(SAID)


class Heard(Player):
    """Says what it is given, and keeps what it was asked."""

    def __init__(self, said: Sequence[Reply]) -> None:
        super().__init__(said)
        self.heard: list[tuple[Message, ...]] = []

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        self.heard.append(tuple(messages))
        return super().complete(messages, tools, sampling)


def test_a_view_behind_a_doubted_pick_belongs_to_what_was_done_before_it(
    lent: LentWorld, tmp_path: Path
) -> None:
    walk = noted("Walk", x=1.0, y=1.0, z=0.0)
    player = Heard([says(walk, noted("Pick", 0.2, object="Plate_57")), finish()])
    adamo_vh.run_episode(
        "Take the plate.", model=player, engine=lent, profile="lean", resolution=SMALL, out=tmp_path
    )
    (episode,) = recorded([tmp_path])
    assert [prompt.messages for prompt in prompts(episode)] == player.heard


def test_a_conversation_has_one_memory(lent: LentWorld, tmp_path: Path) -> None:
    config = adamo_vh.EpisodeConfig.of("Pick the plate.", profile="lean", resolution=SMALL)
    with adamo_vh.Session.begin(config, tmp_path, engine=lent) as session:
        session.say("Pick the plate.")
        session.say("Where is the plate?")
    (episode,) = recorded([tmp_path])
    last = prompts(episode)[-1]
    said = [message.text for message in last.messages if message.role == "human"]
    assert any("Pick the plate." in text for text in said)
    assert any("Where is the plate?" in text for text in said)


def test_an_unfinished_record_gives_what_it_has(lent: LentWorld, tmp_path: Path) -> None:
    run(tmp_path, lent, "paper", "T3")
    lines = (tmp_path / EVENTS).read_bytes().splitlines(keepends=True)
    (tmp_path / EVENTS).write_bytes(b"".join(lines[:-2]))
    (tmp_path / RESULT).unlink()
    (episode,) = recorded([tmp_path])
    assert episode.result is None
    assert len(prompts(episode)) == len(episode.trajectory.thoughts) > 0


def test_a_missing_picture_is_named(lent: LentWorld, tmp_path: Path) -> None:
    run(tmp_path, lent, "paper", "T3")
    for picture in (tmp_path / "frames").iterdir():
        picture.unlink()
    (episode,) = recorded([tmp_path])
    with pytest.raises(RecordError, match=r"lacks the picture frames/.*copy the run folder again"):
        prompts(episode)


def test_prompts_of_somebodys_own_memory_are_not_made_up(tmp_path: Path) -> None:
    played(tmp_path)  # Its thoughts speak of three messages each: no memory of ours wrote them.
    (episode,) = recorded([tmp_path])
    with pytest.raises(RecordError, match="prompts cannot be told"):
        prompts(episode)
