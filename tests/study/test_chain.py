"""The chain of a study: no result comes, goes or changes without a trace."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from tests.keys import key_file
from tests.study.episodes import record, small_study

from adamo_vh.errors import RecordError
from adamo_vh.record.run_folder import RESULT
from adamo_vh.record.signing import Signer, fingerprint
from adamo_vh.record.termination import TerminationReason
from adamo_vh.session.verifying import Verified
from adamo_vh.study.chain import CHAIN, read_chain
from adamo_vh.study.index import Index
from adamo_vh.study.merging import merge
from adamo_vh.study.plan import plan
from adamo_vh.study.rescoring import score_again
from adamo_vh.study.store import Store, episode_folder
from adamo_vh.study.verifying import verify_chain, verify_episodes

STUDY = small_study()
EPISODES = plan(STUDY)
KEYS = [one.key for one in EPISODES]


def _filled(folder: Path, count: int = 3, signer: Signer | None = None) -> Path:
    with Store(folder, STUDY, EPISODES, signer) as store:
        for planned in EPISODES[:count]:
            store.add(record(folder, planned))
    return folder


def _runs(folder: Path, key: str = "") -> dict[str, Verified]:
    return dict(verify_episodes(folder, key=key, replayed=False))


def test_results_are_linked_in_the_order_in_which_they_come(tmp_path: Path) -> None:
    _filled(tmp_path)
    assert [link.episode for link in read_chain(tmp_path)] == KEYS[:3]
    found = verify_chain(tmp_path)
    assert (found.links, found.problems, found.signed_by, found.repeated) == (3, (), (), ())
    runs = _runs(tmp_path)
    assert list(runs) == KEYS[:3]
    assert [found.problems for found in runs.values()] == [()] * 3


def test_going_on_adds_what_a_kill_left_out_and_nothing_twice(tmp_path: Path) -> None:
    _filled(tmp_path)
    record(tmp_path, EPISODES[3])
    (problem,) = verify_chain(tmp_path).problems
    assert problem.startswith(f"{KEYS[3]} has a result that the chain does not know")
    Store(tmp_path, STUDY, EPISODES).close()
    assert [link.episode for link in read_chain(tmp_path)] == KEYS[:4]
    assert verify_chain(tmp_path).problems == ()


def _line(folder: Path, number: int, **change: object) -> None:
    lines = (folder / CHAIN).read_text().splitlines()
    lines[number - 1] = json.dumps({**json.loads(lines[number - 1]), **change})
    (folder / CHAIN).write_text("\n".join(lines) + "\n")


def _dropped(folder: Path, number: int) -> None:
    lines = (folder / CHAIN).read_text().splitlines()
    del lines[number - 1]
    (folder / CHAIN).write_text("\n".join(lines) + "\n")


def _played_again(folder: Path, key: str) -> None:
    shutil.rmtree(episode_folder(folder, key))
    record(folder, EPISODES[KEYS.index(key)], TerminationReason.STEP_LIMIT)


HARM: dict[str, tuple[Callable[[Path], object], str]] = {
    "a result is taken away": (
        lambda f: shutil.rmtree(episode_folder(f, KEYS[1])),
        f"{KEYS[1]} has no result any more, and the chain knows one",
    ),
    "a result is played again": (
        lambda f: _played_again(f, KEYS[1]),
        f"{KEYS[1]} has another result than the one that was chained last",
    ),
    "a line is changed": (
        lambda f: _line(f, 2, digest="0" * 64),
        f"chain.jsonl, line 2 ({KEYS[1]}) does not follow from the line before",
    ),
    "a line is taken out": (
        lambda f: _dropped(f, 2),
        f"chain.jsonl, line 2 ({KEYS[2]}) does not follow from the line before",
    ),
    "the chain is taken away": (
        lambda f: (f / CHAIN).unlink(),
        f"{KEYS[0]} has a result that the chain does not know",
    ),
    "a line is no link": (lambda f: _line(f, 2, link=7), "line 2 is damaged"),
}


@pytest.mark.parametrize("name", HARM)
def test_what_was_done_to_a_chain_is_told(tmp_path: Path, name: str) -> None:
    _filled(tmp_path)
    harm, said = HARM[name]
    harm(tmp_path)
    assert said in verify_chain(tmp_path).problems[0]


def test_a_result_that_comes_again_stays_visible(tmp_path: Path) -> None:
    with Store(tmp_path, STUDY, EPISODES) as store:
        store.add(record(tmp_path, EPISODES[0], TerminationReason.BROKEN))
        shutil.rmtree(episode_folder(tmp_path, KEYS[0]))
        store.add(record(tmp_path, EPISODES[0]))
    found = verify_chain(tmp_path)
    assert (found.links, found.repeated, found.problems) == (2, (KEYS[0],), ())


def test_a_last_line_that_was_cut_off_is_written_again(tmp_path: Path) -> None:
    _filled(tmp_path)
    path = tmp_path / CHAIN
    path.write_bytes(path.read_bytes()[:-20])
    assert len(read_chain(tmp_path)) == 2
    Store(tmp_path, STUDY, EPISODES).close()
    assert verify_chain(tmp_path).problems == ()


def test_a_damaged_chain_stops_nobody_for_good(tmp_path: Path) -> None:
    _filled(tmp_path)
    _line(tmp_path, 1, link=None)
    with pytest.raises(RecordError, match="begins a new chain"):
        Store(tmp_path, STUDY, EPISODES)
    (tmp_path / CHAIN).unlink()
    Store(tmp_path, STUDY, EPISODES).close()
    assert verify_chain(tmp_path).problems == ()


def test_a_damaged_result_keeps_the_others_from_nothing(tmp_path: Path) -> None:
    _filled(tmp_path)
    (episode_folder(tmp_path, KEYS[1]) / RESULT).write_text("{")
    Store(tmp_path, STUDY, EPISODES).close()
    runs = _runs(tmp_path)
    assert "result.json" in runs[KEYS[1]].problems[0]
    assert runs[KEYS[0]].problems == ()


def test_signatures_cover_results_and_chain(tmp_path: Path) -> None:
    signer, other = Signer(key_file(tmp_path / "key")), Signer(key_file(tmp_path / "other"))
    folder = _filled(tmp_path / "study", 2, signer)
    assert verify_chain(folder, key=signer.key).problems == ()
    assert verify_chain(folder).signed_by == (fingerprint(signer.key),)
    runs = _runs(folder, key=signer.key)
    assert {found.signed_by for found in runs.values()} == {fingerprint(signer.key)}
    assert "not signed by" in verify_chain(folder, key=other.key).problems[0]
    for found in _runs(folder, key=other.key).values():
        assert "another key" in found.problems[0]
    _line(folder, 2, signature={"key": other.key, "value": signer.sign("chain", "x").value})
    assert "signature is not that of its key" in verify_chain(folder).problems[0]


def test_what_was_played_unsigned_is_signed_by_the_same_command(tmp_path: Path) -> None:
    signer = Signer(key_file(tmp_path / "key"))
    folder = _filled(tmp_path / "study")
    assert "not signed" in _runs(folder, key=signer.key)[KEYS[0]].problems[0]
    for _ in range(2):
        Store(folder, STUDY, EPISODES, signer).close()
        found = verify_chain(folder, key=signer.key)
        assert (found.links, found.repeated, found.problems) == (6, (), ())


def test_a_whole_has_its_own_chain(tmp_path: Path) -> None:
    signer = Signer(key_file(tmp_path / "key"))
    merge(tmp_path / "all", [_filled(tmp_path / "1"), _filled(tmp_path / "2", 0)], signer)
    assert verify_chain(tmp_path / "all", key=signer.key).problems == ()


def test_new_scores_are_sealed_and_chained(tmp_path: Path) -> None:
    _filled(tmp_path)
    path = episode_folder(tmp_path, KEYS[0]) / RESULT
    told = json.loads(path.read_text())
    told["score"]["completion"] = 1.0
    path.write_text(json.dumps(told))
    problems = _runs(tmp_path)[KEYS[0]].problems
    assert problems[0] == "result.json was changed after it was written"
    assert "score is not what the record gives" in problems[1]
    score_again(tmp_path, write=True)
    assert _runs(tmp_path)[KEYS[0]].problems == ()
    assert verify_chain(tmp_path).problems == ()


def test_going_on_links_nothing_that_was_changed_behind_its_back(tmp_path: Path) -> None:
    _filled(tmp_path)
    _played_again(tmp_path, KEYS[1])
    Store(tmp_path, STUDY, EPISODES).close()
    assert len(read_chain(tmp_path)) == 3
    assert f"{KEYS[1]} has another result" in verify_chain(tmp_path).problems[0]


def test_new_scores_are_chained_though_the_command_was_killed_before(tmp_path: Path) -> None:
    _filled(tmp_path)
    # As it stands in the moment after a new result was written: its row is gone already.
    Index(tmp_path).drop([KEYS[0]])
    _played_again(tmp_path, KEYS[0])
    Store(tmp_path, STUDY, EPISODES).close()
    found = verify_chain(tmp_path)
    assert (found.links, found.repeated, found.problems) == (4, (KEYS[0],), ())
