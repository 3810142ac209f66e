"""A page that is an engine is offered where engines dial in, and nothing else is."""

from __future__ import annotations

import http.client
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from tests.dialled import open_door

from adamo_vh.errors import ConfigError, EngineError
from adamo_vh.service.engines.page import PAGE, page_folder
from adamo_vh.service.engines.waiting import dialled_in


@pytest.fixture
def page(tmp_path: Path) -> Path:
    """A built page, and what lies beside it."""
    folder = tmp_path / "dist"
    (folder / "scenes" / "s1").mkdir(parents=True)
    (folder / "index.html").write_text("<title>engine</title>", encoding="utf-8")
    (folder / "main.js").write_text("1;", encoding="utf-8")
    (folder / "notes.txt").write_text("mine", encoding="utf-8")
    (folder / "scenes" / "s1" / "cup.glb").write_bytes(b"glTF")
    (tmp_path / "secret.json").write_text("{}", encoding="utf-8")
    (folder / "out.json").symlink_to(tmp_path / "secret.json")
    return folder


def asked(url: str, path: str, method: str = "GET", **headers: str) -> tuple[int, str, bytes]:
    """Status, content type and content of an answer."""
    there = http.client.HTTPConnection(urlsplit(url).netloc, timeout=10)
    there.request(method, path, headers=headers)
    answer = there.getresponse()
    return answer.status, answer.headers["content-type"], answer.read()


@pytest.fixture
def url(page: Path) -> Iterator[str]:
    with open_door(page=page_folder(str(page))) as (_, url):
        yield url


def test_its_files_are_offered(url: str) -> None:
    assert asked(url, "/") == (200, "text/html; charset=utf-8", b"<title>engine</title>")
    assert asked(url, "/main.js?v=1")[:2] == (200, "text/javascript; charset=utf-8")
    assert asked(url, "/scenes/s1/cup.glb") == (200, "model/gltf-binary", b"glTF")
    assert asked(url, "/", "HEAD")[2] == b""


@pytest.mark.parametrize(
    "path",
    [
        "/notes.txt",
        "/secret.json",
        "/../secret.json",
        "/%2e%2e/secret.json",
        "/scenes/..%2f..%2f..%2fsecret.json",
        "//etc/passwd",
        "/out.json",
        "/scenes",
        "/main.js%00",
        "/engine",
    ],
)
def test_nothing_else_is(url: str, path: str) -> None:
    status, _, content = asked(url, path)
    assert status == 404
    assert b"for engines" in content


def test_other_pages_and_methods_get_nothing(url: str) -> None:
    assert asked(url, "/", Origin="http://elsewhere.example")[0] == 403
    assert asked(url, "/", Host="elsewhere.example")[0] == 403
    assert asked(url, "/", "DELETE")[0] == 404


def test_without_a_page_nothing_is_there() -> None:
    with open_door() as (_, url):
        assert asked(url, "/")[0] == 404


def test_only_its_own_page_may_dial_in(url: str) -> None:
    from websockets.exceptions import InvalidStatus
    from websockets.sync.client import connect
    from websockets.typing import Origin

    own = Origin(f"http://{urlsplit(url).netloc}")
    with connect(url, origin=own, proxy=None):
        pass
    with pytest.raises(InvalidStatus):
        connect(url, origin=Origin("http://elsewhere.example"), proxy=None)


def test_who_waits_is_told_where_the_page_is(page: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[str] = []
    monkeypatch.setenv(PAGE, str(page))
    waiting = dialled_in("s1", port=0, wait_s=0.1, tell=told.append)
    with pytest.raises(EngineError), waiting:
        pass
    assert told[1].startswith("or open http://127.0.0.1:")


def test_a_folder_without_a_page_is_told(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"has no index\.html; build the page"):
        page_folder(str(tmp_path))
    assert page_folder("") is None
