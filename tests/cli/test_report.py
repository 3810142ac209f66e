"""`adamo-vh report`: the page of a study, its tables and pages, and what it says of bad input."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from urllib.parse import unquote

import pytest
from tests.cli.process import Done, walk
from tests.study.episodes import record
from typer.testing import CliRunner

from adamo_vh.cli.app import app
from adamo_vh.cli.study_report import study_names
from adamo_vh.errors import ConfigError
from adamo_vh.study.plan import Study, plan
from adamo_vh.study.store import Store

STUDY = Study(("T1", "T8"), models=("random",), repetitions=2, labelings=("sem", "opaq"))


@pytest.fixture(scope="module")
def played(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of eight episodes, recorded without a world."""
    folder = tmp_path_factory.mktemp("studies") / "mine"
    episodes = plan(STUDY)
    with Store(folder, STUDY, episodes) as store:
        for planned in episodes:
            store.add(record(folder, planned))
    return folder


@pytest.fixture
def study(played: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(played, tmp_path / "mine"))


def report(*arguments: str | Path) -> Done:
    """The command, in this process: what it does is looked at, and its start was tested."""
    done = CliRunner().invoke(app, ["report", *map(str, arguments)])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    return Done(done.exit_code, done.stdout, done.stderr)


def links_of(page: Path) -> set[str]:
    return {unquote(link) for link in re.findall(r'href="([^"#]+)"', page.read_text("utf-8"))}


def test_a_report_is_written_beside_the_study(study: Path) -> None:
    done = report(study)
    assert done.code == 0, done.all
    assert str(study / "report.html") in done.out and "8 of 8 episodes" in done.out
    for link in links_of(study / "report.html"):
        assert (study / link).exists(), link
    assert {path.name for path in study.iterdir()} >= {"report.md", "report.tex", "tables"}


def test_some_failures_get_a_page_and_more_if_asked(study: Path) -> None:
    counts = []
    for pages in ("none", "examples", "failed"):
        assert report(study, "--pages", pages).code == 0
        counts.append(len(list(study.rglob("episode.html"))))
    assert counts == [0, 4, 8]


def test_a_report_to_be_passed_on_leads_nowhere_else(study: Path, tmp_path: Path) -> None:
    assert report(study, "--pages", "none", "--out", tmp_path / "alone").code == 0
    shutil.rmtree(study)
    page = tmp_path / "alone" / "report.html"
    assert links_of(page) == {"report.md", "report.tex", "tables/"}
    for link in links_of(page):
        assert (page.parent / link).exists()


def test_a_report_elsewhere_leads_back(study: Path, tmp_path: Path) -> None:
    assert report(study, "--out", tmp_path / "else where" / "r").code == 0
    page = tmp_path / "else where" / "r" / "report.html"
    links = links_of(page)
    assert sum("episodes/" in link for link in links) == 8
    assert all((page.parent / link).exists() for link in links)


def test_several_studies_stand_side_by_side(
    study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = Path(shutil.copytree(study, tmp_path / "other"))
    monkeypatch.chdir(tmp_path)
    done = report(study, other)
    assert done.code == 0, done.all
    text = (tmp_path / "report" / "report.md").read_text("utf-8")
    assert "other, random less mine, random" in text.replace("\\", "")
    assert "would it repeat?" in text and "could have seen" in text


def test_the_json_of_a_study_is_as_it_was(study: Path) -> None:
    told = json.loads(report(study, "--json").out)
    assert {"cells", "means", "failures", "spearman", "planned", "damaged"} <= told.keys()
    assert not (study / "report.html").exists()
    bare = report(study, "--json", "--no-timings").out
    assert bare == report(study, "--json", "--no-timings").out
    assert "model_s" not in bare


def test_what_is_wrong_is_told_in_a_line(study: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    one, other, file = str(study), str(tmp_path), str(tmp_path / "file")
    cases = {
        (one, "--pages", "some"): "examples, failed, all, none",
        (one, one): "twice",
        (one, other): "is no study",
        (other, "--json"): "is none",
        (one, one, "--json"): "one study at a time",
        (one, "--out", file, "--pages", "none"): "file",
    }
    for done, said in zip(
        walk([("report", *case) for case in cases], cwd=tmp_path), cases.values(), strict=True
    ):
        assert done.code == 2, done.all
        assert said in done.err and len(done.err.splitlines()) == 1
    assert not (study / "report.html").exists()


def damage(text: str) -> Callable[[Path], None]:
    def do(folder: Path) -> None:
        (folder / "index.sqlite").unlink()
        next(folder.rglob("result.json")).write_text(text)

    return do


@pytest.mark.parametrize("text", ["", "{", "[]", "\x00"])
def test_a_damaged_record_is_named_and_the_rest_reported(study: Path, text: str) -> None:
    damage(text)(study)
    done = report(study)
    assert done.code == 1
    assert "damaged: s1/" in done.err and "7 of 8 episodes" in done.out
    page = (study / "report.html").read_text("utf-8")
    assert "1 record damaged" in page and "1 damaged record, in no figure" in page
    assert str(study) not in page  # Where it was made is nobody's business.


def test_a_study_that_has_only_begun_has_a_report(study: Path) -> None:
    shutil.rmtree(study / "episodes")
    done = report(study)
    assert done.code == 0, done.all
    assert "0 of 8 episodes" in done.out
    assert "not finished: 0 of 8" in (study / "report.html").read_text("utf-8")


@pytest.mark.parametrize(
    ("folders", "names"),
    [
        (["/x/a"], ["a"]),
        (["/x/a", "/x/b"], ["a", "b"]),
        (["/x/a", "/y/a"], ["x/a", "y/a"]),
        (["/x/c/a", "/y/c/a", "/y/c/b"], ["x/c/a", "y/c/a", "y/c/b"]),
    ],
)
def test_studies_are_called_by_what_tells_them_apart(folders: list[str], names: list[str]) -> None:
    assert list(study_names([Path(folder) for folder in folders])) == names


def test_a_study_is_named_once() -> None:
    with pytest.raises(ConfigError, match="twice"):
        study_names([Path("/x/a"), Path("/x/b/../a")])
