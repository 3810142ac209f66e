"""The documentation and the code say the same."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def test_every_environment_variable_is_documented() -> None:
    read = {
        name
        for path in (*ROOT.glob("src/**/*.py"), ROOT / "tests" / "conftest.py")
        for name in re.findall(r"\bADAMO_VH_[A-Z_]+", path.read_text(encoding="utf-8"))
    }
    page = (ROOT / "docs" / "reference" / "environment.md").read_text(encoding="utf-8")
    assert {name for name in read if name not in page} == set()


def test_every_page_is_in_the_navigation() -> None:
    navigation = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    pages = [path.relative_to(ROOT / "docs") for path in (ROOT / "docs").rglob("*.md")]
    assert [str(page) for page in pages if f"- {page}" not in navigation.replace(": ", "- ")] == []


def test_links_between_pages_lead_somewhere() -> None:
    for page in (ROOT / "docs").rglob("*.md"):
        text = page.read_text(encoding="utf-8")
        links = [link for link in re.findall(r"\]\(([^)#\s]+)[^)]*\)", text) if "://" not in link]
        assert [link for link in links if not (page.parent / link).exists()] == [], page


def test_files_that_the_documentation_names_exist() -> None:
    named = re.compile(r"`(?:python )?((?:benchmarks|tests|examples|tools|src/adamo_vh)/[\w/.]+)`")
    for page in (*(ROOT / "docs").rglob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"):
        found = named.findall(page.read_text(encoding="utf-8"))
        assert [name for name in found if not (ROOT / name).exists()] == [], page


def test_the_list_of_rooms_is_that_of_the_layers() -> None:
    layers = re.search(r"^layers = \[(.*?)^\]", (ROOT / "pyproject.toml").read_text(), re.S | re.M)
    block = re.search(r"```\n(errors .*?)```", (ROOT / "docs/architecture.md").read_text(), re.S)
    assert layers is not None and block is not None
    rooms = re.findall(r"\w+", layers[1])
    there = {path.stem for path in (ROOT / "src/adamo_vh").iterdir()}
    known = [name for name in rooms if name in there and name != "__main__"]
    heads = [re.split(r"\s{2,}", line)[0] for line in block[1].splitlines() if line[0] != " "]
    assert {*re.findall(r"\w+", " ".join(heads))} == {*known}
