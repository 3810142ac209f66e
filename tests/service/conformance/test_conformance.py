"""The built-in engine keeps the contract, here and through the wire; what does not is told so."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from html import unescape
from pathlib import Path
from typing import Any

import pytest
from tests.dialled import Passing, dialled, with_body
from typer.testing import CliRunner

from adamo_vh.abilities import Abilities
from adamo_vh.action import Outcome, Pick
from adamo_vh.action_server import LocalActionServer
from adamo_vh.cli.app import app
from adamo_vh.engine import BodyReport
from adamo_vh.errors import ConfigError, EngineError
from adamo_vh.observation import Percept
from adamo_vh.report.templating import csp_hash
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.service.conformance import CHECKS, Verdict, conform, engine_faults
from adamo_vh.service.conformance.page import as_json, page, summary

SMALL = (320, 180)


def failures(report: Any) -> dict[str, str]:
    return {i.name: i.found for i in report.findings if i.verdict is Verdict.FAILED}


def test_the_built_in_engine_keeps_the_contract(engine: BuiltinEngine) -> None:
    before = engine.state()
    report = conform(engine)
    assert failures(report) == {} and report.conforms
    assert report.count(Verdict.PASSED) >= len(CHECKS) - 2
    assert report.count(Verdict.MISSING) == 0
    assert engine.state() == before


@pytest.mark.slow
def test_how_long_calls_take_is_told(engine: BuiltinEngine) -> None:
    report = conform(engine, ["say"], timed=True)
    assert {item.call for item in report.latencies} >= {"state", "36 rays", "snapshot"}
    assert all(item.median_ms > 0 for item in report.latencies)
    assert "36 rays" in page(report)


@pytest.mark.slow
@pytest.mark.parametrize(
    "able", [Abilities(), Abilities(ids=False, snapshot=False, events=False, closeup=False)]
)
def test_it_keeps_the_contract_through_the_wire(engine: BuiltinEngine, able: Abilities) -> None:
    with dialled(engine, able) as world:
        report = conform(world)
    assert failures(report) == {}
    missing = {i.name.partition("-")[0] for i in report.findings if i.verdict is Verdict.MISSING}
    assert missing == (set() if able.ids else {"capture", "closeup", "snapshot", "events"})


def test_the_wire_makes_no_difference(engine: BuiltinEngine) -> None:
    only = ("scene", "capture-projection", "rays", "pick-takes", "drop-floor", "snapshot")
    with dialled(engine) as world:
        report = conform(world, only)
    assert failures(report) == {}
    assert report.engine == "dialled in: Built-in 1"


def test_names_of_checks_are_unique_and_tell_what_to_do() -> None:
    assert len({check.name for check in CHECKS}) == len(CHECKS) >= 40
    for check in CHECKS:
        assert check.expected.endswith(".") and check.mend.endswith("."), check.name
        assert check.needs in ("", *Abilities.__slots__)
    must = {check.group for check in CHECKS if not check.needs}
    assert must >= {"scene", "reset", "capture", "rays", "look", "walk", "pick", "drop", "say"}


def test_what_is_no_engine_is_told_so() -> None:
    (fault,) = engine_faults(object())  # type: ignore[arg-type]
    assert "object is no engine: it lacks scene, object_names, bodies" in fault


def test_there_is_no_such_check(engine: BuiltinEngine) -> None:
    with pytest.raises(ConfigError, match="There is no check 'speed'; use a name, or one of scene"):
        conform(engine, ["speed"])


def test_an_engine_that_ends_in_the_middle_fails_the_rest(engine: BuiltinEngine) -> None:
    def crash(*_: Any) -> None:
        raise EngineError("the program has ended.")

    broken = Passing(with_body(engine, see=crash), reset=crash)
    report = conform(broken, ["capture-size", "state-sound"], timed=True)
    assert set(failures(report).values()) == {"the program has ended."}
    assert report.latencies == () and not report.conforms


def test_a_check_that_cannot_be_made_is_no_failure(engine: BuiltinEngine) -> None:
    def refused(_: int) -> BodyReport:
        return BodyReport(Outcome.REFUSED, "unreachable")

    report = conform(with_body(engine, pick=refused), ["hand-carries", "pick-full"])
    assert [item.verdict for item in report.findings] == [Verdict.NOT_TRIED] * 2
    assert "no object in the first view could be picked" in report.findings[0].found


def test_the_page_shows_everything_and_trusts_nothing(engine: BuiltinEngine) -> None:
    bad = replace(engine.scene, source="<script>alert(1)</script>", height_m=0.0)
    report = conform(Passing(engine, scene=bad), ["scene", "body-sizes"], timed=False)
    html = page(report)
    assert "<script>" not in html and "&lt;script&gt;" in html
    assert "scene-extent" in html and "Does not conform: " in html
    style = html.partition("<style>")[2].partition("</style>")[0]
    assert csp_hash(style) in unescape(html)
    assert summary(report).startswith("Does not conform: ")
    data = as_json(report)
    assert json.loads(json.dumps(data)) == data
    assert data["checks"][0].keys() >= {"name", "verdict", "expected", "found", "mend"}


def test_the_command_line_looks_an_engine_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, engine: BuiltinEngine
) -> None:
    monkeypatch.chdir(tmp_path)
    module = type(sys)("my_engine")
    vars(module).update(make=lambda scene: Passing(engine))
    monkeypatch.setitem(sys.modules, "my_engine", module)
    arguments = ["conformance", "my_engine:make", "--only", "say", "--html", "page.html"]
    done = CliRunner().invoke(app, arguments, catch_exceptions=False)
    assert done.exit_code == 0 and "passed    say-accepts" in done.stdout
    assert "Conforms: 1 passed." in done.stdout
    assert "say-accepts" in (tmp_path / "page.html").read_text()
    vars(module).update(make=lambda scene: Passing(engine, scene=replace(engine.scene, name="")))
    failed = CliRunner().invoke(app, ["conformance", "my_engine:make", "--only", "scene", "--json"])
    assert failed.exit_code == 1
    assert json.loads(failed.stdout)["conforms"] is False


@pytest.mark.parametrize(
    ("target", "told"),
    [
        ("nonsense", "write built-in, MODULE:NAME"),
        ("no_such_module:make", "gives no engine: ModuleNotFoundError"),
        ("math:pi", "gives no engine: TypeError"),
        ("ws://127.0.0.1:8020/other", "is no address for engines"),
        ("ws://127.0.0.1/engine", "is no address for engines"),
        ("wss://127.0.0.1:1/engine", "is no address for engines"),
    ],
)
def test_what_is_no_target_is_told(target: str, told: str) -> None:
    result = CliRunner().invoke(app, ["conformance", target])
    assert isinstance(result.exception, ConfigError) and told in str(result.exception)


def test_mistakes_of_an_engine_from_outside_are_a_sentence(engine: BuiltinEngine) -> None:
    def typo(*_: Any) -> Percept:
        return engine.body.seee()  # type: ignore[attr-defined, no-any-return]

    server = LocalActionServer(with_body(engine, see=typo, pick=typo), resolution=SMALL)
    with pytest.raises(EngineError, match="failed in observe: AttributeError"):
        server.observe()
    LocalActionServer(engine, resolution=SMALL)
    seen = LocalActionServer(with_body(engine, pick=typo), resolution=SMALL)
    seen.observe()
    with pytest.raises(EngineError, match="failed in Pick: AttributeError"):
        seen.execute(Pick("Plate_57"))


@pytest.mark.parametrize("code", ["too heavy", "no_free_spot", "", "ok", "unknown_tag"])
def test_an_engine_may_have_reasons_of_its_own(engine: BuiltinEngine, code: str) -> None:
    def refused(_: int) -> BodyReport:
        return BodyReport(Outcome.REFUSED, code)

    server = LocalActionServer(with_body(engine, pick=refused), resolution=SMALL)
    server.observe()
    feedback = server.execute(Pick("Plate_57")).feedback
    assert feedback.outcome is Outcome.REFUSED
    assert feedback.text.startswith("Refused: ")
    assert "within reach" not in feedback.text
    if code == "too heavy":
        assert feedback.text == "Refused: the body cannot do that (too heavy)."
