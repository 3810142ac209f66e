"""What the README shows works as it stands."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import adamo_vh

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_the_python_example_runs(capsys: pytest.CaptureFixture[str]) -> None:
    [code] = re.findall(r"```python\n(.*?)```", README, flags=re.DOTALL)
    exec(compile(code, "README.md", "exec"), {})
    printed = capsys.readouterr().out
    assert printed.startswith("1.0 1.0 answered\n")


def test_links_lead_somewhere() -> None:
    links = re.findall(r"\]\(([^)#]+)\)", README)
    local = [link for link in links if "://" not in link]
    assert local
    assert [link for link in local if not (ROOT / link).exists()] == []


def test_the_public_names_are_sorted_complete_and_there() -> None:
    assert list(adamo_vh.__all__) == sorted(adamo_vh.__all__)
    for name in adamo_vh.__all__:
        assert getattr(adamo_vh, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        adamo_vh.nonsense  # noqa: B018
