"""What other packages add is found by name; what is wrong with it is said with theirs."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from adamo_vh.errors import AdamoError, ConfigError, ModelConfigError
from adamo_vh.inference.model import Sampling
from adamo_vh.inference.registry import create_model
from adamo_vh.plugins import MODELS, load_plugin, plugin_names

CODE = """
from adamo_vh.inference.messages import AIMessage
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply

class Parrot:
    def __init__(self, text, seed):
        self.text = text
        self.info = ModelInfo(f"parrot:{text}:{seed}", ModelKind.RULE_BASED)

    def complete(self, messages, tools, sampling):
        return Reply(AIMessage(self.text)) if self.text else None

def failing(text, seed):
    raise KeyError("no")
"""
ENTRIES = """[adamo_vh.models]
parrot = parrots_of_a_test:Parrot
failing = parrots_of_a_test:failing
lost = parrots_of_a_test:Nobody
"""


@pytest.fixture(autouse=True)
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "parrots_of_a_test.py").write_text(CODE)
    info = tmp_path / "parrots-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: parrots\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(ENTRIES)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "parrots_of_a_test", raising=False)


def test_a_model_of_another_package_is_made_by_its_name() -> None:
    model = create_model("parrot:hello", seed=3)
    assert model.info.name == "parrot:hello:3"
    assert model.complete((), (), Sampling()).message.text == "hello"
    assert {"parrot", "failing", "lost"} <= {*plugin_names(MODELS)}
    assert load_plugin(MODELS, "nobody") is None


def test_its_mistakes_name_it() -> None:
    with pytest.raises(AdamoError, match="The model Parrot gave None"):
        create_model("parrot").complete((), (), Sampling())
    with pytest.raises(ModelConfigError, match=r"The model failing .*KeyError"):
        create_model("failing:x")
    with pytest.raises(ConfigError, match=r"parrots offers 'lost'.*cannot be loaded"):
        create_model("lost")


def test_it_is_among_the_known() -> None:
    with pytest.raises(ModelConfigError, match="parrot"):
        create_model("nosuch:thing")
