"""What a server offers: checked before anything starts, and told in golden words."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from adamo_vh.cognition.profile import PROFILES
from adamo_vh.errors import ConfigError
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.service.mcp.episodes import Episodes
from adamo_vh.service.mcp.offer import Offer
from adamo_vh.service.mcp.prompts import render
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.runs import run_episode

GOLDEN = Path(__file__).parent / "golden"


@pytest.mark.parametrize("name", ["paper", "lean"])
@pytest.mark.parametrize("story", ["", "(Before: I look. - Look {})\n\nDone."])
def test_the_instructions_are_as_agreed(name: str, story: str) -> None:
    profile = PROFILES[name]
    told = render(
        "instructions",
        episode="t8-1234",
        system="(What any model is told.)",
        instruction="Do it.",
        story=story,
        note_argument=profile.note_argument,
        finish_check=profile.finish_check,
        state=profile.state,
        pictures=profile.pictures,
        max_steps=60,
        max_minutes="10",
    )
    golden = GOLDEN / f"instructions_{name}{'_later' if story else ''}.md"
    assert told + "\n" == golden.read_text(encoding="utf-8")


@pytest.mark.parametrize("episode", ["", "my-run"])
def test_the_first_words_are_as_agreed(episode: str) -> None:
    told = render("server", episode=episode, finish="finish")
    golden = GOLDEN / f"server{'_fixed' if episode else ''}.md"
    assert told + "\n" == golden.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"profile": "none"}, "There is no profile"),
        ({"resolution": "big"}, "write WIDTHxHEIGHT"),
        ({"task": "T99"}, "T99"),
        ({"task": "T8", "instruction": "Do it."}, "not both"),
    ],
)
def test_a_wrong_setting_is_told_at_once(settings: dict[str, Any], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        Offer(settings)


def test_what_the_server_sets_up_holds_where_the_client_says_nothing() -> None:
    offer = Offer({"labeling": "opaq", "resolution": "160x90", "profile": "single"})
    config = offer.config({"task": "T3", "seed": 4})
    assert (config.task, config.labeling, config.seed) == ("T3", "opaq", 4)
    assert config.resolution == (160, 90) and config.profile.name == "single"
    assert offer.config({"task": "T3", "labeling": "sem"}).labeling == "sem"
    assert offer.config({"task": "", "instruction": "Sing."}).instruction == "Sing."


def test_only_own_runs_are_found(lent: LentWorld, tmp_path: Path, engine: BuiltinEngine) -> None:
    other = tmp_path / "other"
    run_episode("Sing.", model="random", engine=engine, out=other, resolution="160x90")
    (tmp_path / "empty").mkdir()
    offer = Offer({"resolution": "160x90"}, tmp_path)
    with Episodes(offer, make_engine=lambda *_: lent.lender.lend()) as episodes:
        name, _ = episodes.begin("me", {"task": "T8"})
        (tmp_path / "link").symlink_to(tmp_path / name)
        for wrong in ("other", "empty", "link", "..", "", f"../{tmp_path.name}/{name}", "a" * 200):
            with pytest.raises(ConfigError, match="There is no episode"):
                episodes.find(wrong, "me")
        for frame in ("../manifest.json", "x.jpg", f"{'0' * 24}.jpg"):
            with pytest.raises(ConfigError, match="no such frame"):
                episodes.frame(name, frame)
        assert episodes.find(name, "me") is not None


def test_scenes_that_nobody_plays_make_room(lent: LentWorld, tmp_path: Path) -> None:
    made = []

    def engine(scene: str, figure: str, variation: int) -> LentWorld:
        made.append(variation)
        return lent.lender.lend()

    offer = Offer({"resolution": "160x90"}, tmp_path)
    with Episodes(offer, make_engine=engine) as episodes:
        held = []
        for number in range(4):
            # The engine here has no variations, which is told after it was made.
            with pytest.raises(ConfigError, match="variation"):
                episodes.begin("me", {"task": "T8", "variation": number + 1})
            held.append(number + 1)
        _, first = episodes.begin("me", {"task": "T8"})
        assert made == [*held, 0]
        _, second = episodes.begin("me", {"task": "T8"})
        assert made == [*held, 0] and not first.ended and not second.ended
    assert first.ended and second.ended
    assert sorted(path.name[:3] for path in tmp_path.iterdir()) == ["t8-", "t8-"]
