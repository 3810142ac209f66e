"""What a server offers: checked before anything starts, and told in golden words."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from tests.service.mcp.shared_engine import engines_of

from adamo_vh.benchmark.tasks import task
from adamo_vh.benchmark.tasks.writing import task_text
from adamo_vh.cognition.profile import PROFILES
from adamo_vh.errors import ConfigError
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.service.mcp.episodes import Episodes
from adamo_vh.service.mcp.offer import Offer
from adamo_vh.service.mcp.prompts import render
from adamo_vh.session.lending import LentWorld
from adamo_vh.session.pooling import BusyError, Engines
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
    with Episodes(offer, engines=engines_of(lent)) as episodes:
        name, _ = episodes.begin("me", {"task": "T8"})
        (tmp_path / "link").symlink_to(tmp_path / name)
        for wrong in ("other", "empty", "link", "..", "", f"../{tmp_path.name}/{name}", "a" * 200):
            with pytest.raises(ConfigError, match="There is no episode"):
                episodes.find(wrong, "me")
        for frame in ("../manifest.json", "x.jpg", f"{'0' * 24}.jpg"):
            with pytest.raises(ConfigError, match="no such frame"):
                episodes.frame(name, frame)
        assert episodes.find(name, "me") is not None


def test_what_does_not_begin_leaves_nothing_behind(lent: LentWorld, tmp_path: Path) -> None:
    lacking = tmp_path / "own.toml"
    lacking.write_text(task_text(task("T1")).replace("34", "999").replace('"T1"', '"OWN"'))
    settings = {"resolution": "160x90", "task": str(lacking)}
    offer = Offer(settings, tmp_path / "runs", tmp_path / "runs" / "one")
    with (
        Episodes(offer, engines=engines_of(lent)) as episodes,
        pytest.raises(ConfigError, match="needs object 999"),
    ):
        episodes.find("one", "me")
    assert not (tmp_path / "runs").exists()


def test_a_server_that_has_no_room_says_so(lent: LentWorld, tmp_path: Path) -> None:
    engines = Engines(most=0, ready={("s1", "mara", 0): lent.lender})
    with Episodes(Offer({"resolution": "160x90"}, tmp_path), engines=engines) as episodes:
        with pytest.raises(BusyError, match="scenes are played in already"):
            episodes.begin("me", {"task": "T8", "scene": "S2"})
        name, _ = episodes.begin("me", {"task": "T8"})
    assert [path.name for path in tmp_path.iterdir()] == [name]
