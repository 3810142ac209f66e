"""A run as one HTML file: all of it inside, and nothing that it holds can leave its place."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

import adamo_vh
from adamo_vh.cli.app import app
from adamo_vh.errors import ConfigError
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.studio.files import PAGE
from adamo_vh.studio.one_page import ELEMENT, one_page

EVIL = "</script><script>alert(1)</script><!-- \u2028 ]]>"
INDEX = """<!doctype html><html><head>
<meta http-equiv="Content-Security-Policy" content="default-src &#39;self&#39;">
<script async src="./assets/early.js"></script>
<script type="module" crossorigin src="./assets/studio.js"></script>
<link rel="modulepreload" crossorigin href="./assets/three.js">
<link rel="stylesheet" crossorigin href="./assets/index.css">
<link rel="icon" href="./assets/icon.svg" type="image/svg+xml" />
</head><body><div id="app"></div></body></html>"""


@pytest.fixture
def page(tmp_path: Path) -> Path:
    folder = tmp_path / "page"
    (folder / "assets").mkdir(parents=True)
    (folder / "index.html").write_text(INDEX)
    script = 'import{a as t}from"./three.js";const e="</script>";t(e);'
    (folder / "assets" / "studio.js").write_text(script)
    (folder / "assets" / "three.js").write_text("export const a = console.log;")
    (folder / "assets" / "early.js").write_text("fetch('api/early');")
    (folder / "assets" / "index.css").write_text("body { margin: 0 }")
    (folder / "assets" / "icon.svg").write_text("<svg/>")
    return folder


def embedded(html: str):
    found = re.search(rf'<script type="application/json" id="{ELEMENT}">(.*?)</script>', html, re.S)
    assert found is not None
    return json.loads(found[1])


def test_page_and_track_are_one_file(page):
    told = {"hello": {"type": "hello"}, "messages": [{"n": 1, "text": EVIL}]}
    html = one_page(told, page)
    assert embedded(html) == told
    assert "./assets" not in html and "<style>body { margin: 0 }</style>" in html
    assert html.count("<script") == html.count("</script>") == 3


def test_its_scripts_alone_may_run_and_nothing_is_fetched(page):
    html = one_page({"hello": {}, "messages": []}, page)
    (policy,) = re.findall(r'Security-Policy" content="([^"]*)"', html)
    assert "default-src 'none'" in policy and "connect-src data: blob:" in policy
    assert html.index("Security-Policy") < html.index("<script")
    for kind in ("importmap", "module"):
        (script,) = re.findall(rf'<script type="{kind}">(.*?)</script>', html, re.S)
        digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
        assert f"'sha256-{digest}'" in policy


def test_what_asks_a_server_is_left_out(page):
    html = one_page({"hello": {}, "messages": []}, page)
    assert "early" not in html and base64.b64encode(b"api/early").decode()[:8] not in html


def test_its_modules_find_each_other(page):
    html = one_page({"hello": {}, "messages": []}, page)
    (imports,) = re.findall(r'<script type="importmap">(.*?)</script>', html, re.S)
    ((name, url),) = json.loads(imports)["imports"].items()
    assert f'from"{name}"' in html
    assert base64.b64decode(url.partition(",")[2]) == b"export const a = console.log;"


def test_without_a_built_page_it_says_how_to_build_it(tmp_path):
    with pytest.raises(ConfigError, match="npm run build"):
        one_page({}, tmp_path)


@pytest.mark.skipif(not (PAGE / "index.html").is_file(), reason="the page is not built here")
def test_a_run_is_exported_with_meshes_and_pictures(s1_engine, tmp_path):
    run, out = tmp_path / "run", tmp_path / "pages"
    s1_engine.reset(0)
    call = ToolCall("c1", "Look", {"x": 0.5, "y": 0.0, "z": 0.8, "note": EVIL})
    model = ScriptedModel("scripted", [AIMessage(EVIL, (call,)), AIMessage(EVIL)])
    adamo_vh.run_episode(EVIL, model=model, resolution=(160, 90), out=run, engine=s1_engine)
    words = ["export", str(run), "--to", "page", "--out", str(out)]
    done = CliRunner().invoke(app, words, catch_exceptions=False)
    assert done.exit_code == 0, done.output
    # The page looks for the track under this name.
    assert ELEMENT in (PAGE / "assets" / "studio.js").read_text(encoding="utf-8")
    (file,) = out.iterdir()
    html = file.read_text(encoding="utf-8")
    told = embedded(html)
    assert file.name == "run.html" and len(html) < 12_000_000
    assert told["hello"]["scene"]["glb"].startswith("data:model/gltf-binary;base64,")
    frames = [m["frame"] for m in told["messages"] if m.get("frame")]
    assert frames and all(frame.startswith("data:image/jpeg;base64,") for frame in frames)
    assert "<script>alert" not in html and 'src="' not in html
