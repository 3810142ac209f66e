"""What is published of the wire is what is spoken, and the server keeps to its own description."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from tests.service.conftest import JUDGE, Serve
from tools.wire import FOLDER, texts

from adamo_vh.action_server.wire import Create
from adamo_vh.service.app import MAX_BODY_BYTES
from adamo_vh.serving.admission import Rules
from adamo_vh.serving.rate import Rate

KEY = {"authorization": f"Bearer {JUDGE}"}
UNHURRIED = Rules(MAX_BODY_BYTES, judge_token=JUDGE, rate=Rate(per_s=0))
FEW = settings(
    max_examples=1,
    database=None,
    phases=[Phase.generate],
    suppress_health_check=list(HealthCheck),
)
SETTINGS_DEPEND_ON_EACH_OTHER = "positive_data_acceptance"
"""A task or an instruction, and no switch that others forbid: no schema says that."""


@pytest.mark.parametrize("name", ["session.json", "openapi.json", "engine.json"])
def test_the_published_schemas_are_those_of_today(name: str) -> None:
    told = (FOLDER / name).read_text(encoding="utf-8")
    assert told == texts()[name], "the wire has changed: run python tools/wire.py"


def test_every_message_is_published_with_its_fields() -> None:
    told = json.loads((FOLDER / "session.json").read_text(encoding="utf-8"))
    mapping = told["$defs"]["Request"]["discriminator"]["mapping"]
    assert set(mapping) >= {"create", "attach", "observe", "act", "think", "say", "finish", "load"}
    assert "saved" in told["$defs"]["Done"]["properties"]
    assert told["title"].endswith("version 1")


def test_the_server_keeps_to_what_it_publishes(serve: Serve) -> None:
    import schemathesis
    from schemathesis.core.result import Ok

    url, host = serve(UNHURRIED, most_sessions=100_000)
    session = host.create(Create("T1")).id
    schema = schemathesis.openapi.from_url(f"{url}/openapi.json", headers=KEY)
    operations = [found.ok() for found in schema.get_all_operations() if isinstance(found, Ok)]
    assert len(operations) >= 16
    left_out = getattr(schemathesis.checks, SETTINGS_DEPEND_ON_EACH_OTHER, None)
    for operation in operations:

        @FEW
        @given(case=operation.as_strategy())
        def check(case: Any) -> None:
            if "session" in case.path_parameters and case.method != "DELETE":
                case.path_parameters["session"] = session
            case.call_and_validate(
                headers=KEY, timeout=30, excluded_checks=[left_out] if left_out else []
            )

        check()


@pytest.mark.slow
def test_the_server_keeps_to_what_it_publishes_however_it_is_asked(
    serve: Serve, tmp_path: Path
) -> None:
    url, host = serve(UNHURRIED, most_sessions=100_000, resolution="64x64")
    host.create(Create("T1"))
    command = [
        *(sys.executable, "-m", "schemathesis.cli", "run", f"{url}/openapi.json"),
        *("--header", f"Authorization: Bearer {JUDGE}", "--request-timeout", "60"),
        *("--phases", "coverage,fuzzing", "--max-examples", "10"),
        *("--exclude-checks", SETTINGS_DEPEND_ON_EACH_OTHER, "--continue-on-failure"),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stdout[-6000:]
