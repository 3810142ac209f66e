"""The server of the container serves what OpenEnv's clients look for, to those with the token."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import httpx
import pytest

from adamo_vh.errors import ConfigError

FOLDER = Path(__file__).resolve().parents[3] / "deploy" / "openenv"
TOKEN = "token-of-the-tests"


@pytest.fixture(scope="module")
def server() -> ModuleType:
    found = importlib.util.spec_from_file_location("deployed", FOLDER / "server" / "app.py")
    assert found is not None and found.loader is not None
    module = importlib.util.module_from_spec(found)
    sys.modules["deployed"] = module
    found.loader.exec_module(module)
    return module


def settings(tmp_path: Path, **more: str) -> dict[str, str]:
    return {"HOST": "127.0.0.1", "PORT": "0", "ADAMO_VH_RUNS": str(tmp_path), **more}


def test_it_stands_at_the_root_and_wants_the_token(server: ModuleType, tmp_path: Path) -> None:
    with server.running(settings(tmp_path, ADAMO_VH_TOKEN=TOKEN)) as url:
        assert httpx.get(f"{url}/health").status_code == 401
        with httpx.Client(base_url=url, headers={"Authorization": f"Bearer {TOKEN}"}) as http:
            assert http.get("/health").json() == {"status": "healthy"}
            assert {"/reset", "/step", "/state"} <= set(http.get("/openapi.json").json()["paths"])
            assert http.post("/mcp", json={}).json()["jsonrpc"] == "2.0"
            assert http.post("/reset", json={"task": "T99"}).status_code == 400
            space = {"host": "name-space.hf.space"}
            assert http.get("/health", headers=space).status_code == 403


def test_a_space_is_reached_under_its_name(server: ModuleType, tmp_path: Path) -> None:
    space = "name-space.hf.space"
    with server.running(settings(tmp_path, SPACE_HOST=space)) as url:
        assert httpx.get(f"{url}/health", headers={"host": space}).status_code == 200


def test_other_machines_are_served_with_a_token_alone(server: ModuleType, tmp_path: Path) -> None:
    with (
        pytest.raises(ConfigError, match="nothing is locked"),
        server.running(settings(tmp_path, HOST="0.0.0.0")),
    ):
        pass


def test_the_image_has_what_the_server_needs() -> None:
    recipe = (FOLDER / "Dockerfile").read_text(encoding="utf-8")
    assert "adamo-vh[serve]" in recipe and "libegl1" in recipe
    assert '"server.app"' in recipe and "EXPOSE 8000" in recipe
    told = (FOLDER / "openenv.yaml").read_text(encoding="utf-8")
    assert "spec_version: 1" in told and "port: 8000" in told
