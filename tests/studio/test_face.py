"""The studio over HTTP: its page, its files, its runs, and who may come in."""

from __future__ import annotations

import gzip
import http.client
import json
import time
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from tests.studio.conftest import TOKEN
from tests.studio.visitor import Visitor
from websockets.exceptions import ConnectionClosed, InvalidStatus

import adamo_vh
from adamo_vh.inference.messages import AIMessage, ToolCall
from adamo_vh.inference.players.scripted import ScriptedModel
from adamo_vh.record.run_folder import EVENTS, MANIFEST

EVIL = "<img src=x onerror=alert(1)><script>alert(1)</script>\u202e"


def raw(url: str, target: str) -> tuple[int, bytes]:
    """A request whose path no client has tidied up."""
    parts = urlsplit(url)
    wire = http.client.HTTPConnection(parts.hostname or "", parts.port, timeout=30)
    wire.putrequest("GET", target, skip_accept_encoding=True)
    wire.endheaders()
    answer = wire.getresponse()
    return answer.status, answer.read()


@pytest.fixture(scope="module")
def recorded(s1_engine, tmp_path_factory) -> Path:
    """A run with markup in every text that a mind or a user writes."""
    folder: Path = tmp_path_factory.mktemp("recorded") / "evil <b>run"
    s1_engine.reset(0)
    call = ToolCall("c1", "Look", {"x": 0.5, "y": 0.0, "z": 0.8, "note": EVIL})
    says = [AIMessage(EVIL, (call,)), AIMessage(EVIL, (ToolCall("c2", EVIL, {EVIL: EVIL}),))]
    model = ScriptedModel("scripted", [*says, AIMessage(EVIL)])
    adamo_vh.run_episode(
        EVIL, model=model, resolution=(160, 90), out=folder, engine=s1_engine
    )  # fmt: skip
    return folder


@pytest.fixture(scope="module")
def shown(serve, recorded):
    return serve(runs=[recorded])


def track(served, name: str) -> dict:
    path = f"/studio/api/runs/{name}/track"
    for _ in range(120):
        status, headers, body = served.get(path)
        if status != 202:
            assert status == 200, body
            told: dict = json.loads(body)
            return told
        assert headers["retry-after"]
        time.sleep(1.0)
    raise AssertionError("the track was never made")


def test_the_page_is_served_safely(served):
    status, headers, body = served.get("/studio/")
    assert status == 200 and b"Studio" in body
    assert headers["content-type"].startswith("text/html")
    assert "default-src 'self'" in headers["content-security-policy"]
    assert "unsafe" not in headers["content-security-policy"]
    assert headers["x-content-type-options"] == "nosniff"
    again = served.get("/studio/", **{"if-none-match": headers["etag"]})
    assert again[0] == 304 and again[2] == b""
    for path in ("/studio", "/"):
        assert served.get(path)[0] == 200  # After the redirect.


def test_files_come_with_their_types_and_packed(served):
    plain = served.get("/studio/assets/main.js")
    packed = served.get("/studio/assets/main.js", **{"accept-encoding": "gzip"})
    assert plain[1]["content-type"].startswith("text/javascript")
    assert packed[1]["content-encoding"] == "gzip" and gzip.decompress(packed[2]) == plain[2]


@pytest.mark.parametrize(
    "target",
    [
        "/studio/assets/../../secret.js",
        "/studio/assets/%2e%2e/%2e%2e/secret.js",
        "/studio/assets/..%2f..%2fsecret.js",
        "/studio/assets//etc/passwd",
        "/studio/assets/%00.js",
        "/studio/assets/main.js%00",
        "/studio/assets/..%5c..%5csecret.js",
        "/studio/assets/../source.txt",
        "/studio/source.txt",
        "/studio/assets/",
        "/studio/api/runs/..%2f..%2fetc/track",
        "/studio/api/rooms/nobody/frames/..%2f..%2fmanifest.json",
        "/studio/api/scenes/..%2fs1.glb",
        "/studio/api/scenes/%2fetc%2fpasswd.glb",
        "/studio/api/figures/..%2fmara.glb",
    ],
)
def test_no_path_leads_out(served, target):
    status, body = raw(served.url, target)
    assert status in (400, 404) and b"root:" not in body and body != b"no"


def test_all_that_may_be_chosen_is_told(shown):
    told = json.loads(shown.get("/studio/api/offer")[2])
    assert [scene["name"] for scene in told["scenes"]] == ["s1", "s2"]
    assert {"baseline", "human"} <= {model["name"] for model in told["models"]}
    assert told["labelings"] == ["sem", "opaq"] and "mara" in told["figures"]
    (run,) = [run for run in told["runs"] if "evil" in run["name"]]
    assert run["model"] == "scripted" and run["when"] and run["completion"] is None
    assert "\u202e" not in json.dumps(run, ensure_ascii=False)


@pytest.mark.parametrize(
    ("wish", "word"),
    [
        ({"model": "scripted:/etc/passwd"}, "no model"),
        ({"model": "replay:/tmp"}, "no model"),
        ({"model": "openai:gpt@http://127.0.0.1:1/v1"}, "no model"),
        ({"scene": "/etc/passwd"}, "no scene"),
        ({"scene": "../s1.toml"}, "no scene"),
        ({"figure": "nobody"}, "no figure"),
        ({"task": "T99"}, "no task"),
        ({"profile": "none"}, "profile"),
        ({"labeling": "none"}, "labeling"),
        ({"more": 1}, "more"),
        ({"variation": -1}, "variation"),
    ],
)
def test_what_is_not_on_offer_is_refused_in_a_sentence(served, wish, word):
    status, _, body = served.get("/studio/api/rooms", "POST", wish)
    assert status in (400, 422) and word in json.loads(body)["error"]["message"]


def test_a_recorded_run_is_a_track(shown, recorded):
    name = next(run.name for run in shown.studio.library.runs())
    from urllib.parse import quote

    told = track(shown, quote(name))
    events = [m["event"] for m in told["messages"] if m["type"] == "event"]
    assert events[0]["instruction"].startswith("<img") and events[-1]["type"] == "ended"
    assert "\u202e" not in json.dumps(told, ensure_ascii=False)
    frame = next(m["frame"] for m in told["messages"] if m.get("frame"))
    status, headers, _ = shown.get(frame)
    assert status == 200 and headers["content-type"] == "image/jpeg"
    status, headers, glb = shown.get(told["hello"]["scene"]["glb"])
    assert status == 200 and headers["content-type"] == "model/gltf-binary" and glb[:4] == b"glTF"
    again = shown.get(told["hello"]["scene"]["glb"], **{"if-none-match": headers["etag"]})
    assert again[0] == 304
    assert shown.get(told["hello"]["figure"]["glb"])[2][:4] == b"glTF"


def test_a_hostile_run_folder_takes_nobody_anywhere(serve, recorded, tmp_path):
    import shutil

    folder = tmp_path / "hostile"
    shutil.copytree(recorded, folder)
    head = json.loads((folder / MANIFEST).read_text())
    head["config"] |= {"scene": "/etc/passwd", "figure": "../../x", "instruction": EVIL}
    (folder / MANIFEST).write_text(json.dumps(head))
    lines = [json.loads(line) for line in (folder / EVENTS).read_text().splitlines()]
    for line in lines:
        if "frame" in line:
            line["frame"] = "../manifest.json"
    (folder / EVENTS).write_text("".join(json.dumps(line) + "\n" for line in lines))
    (folder / "frames" / "abcdef0123456789.jpg").symlink_to("/etc/passwd")
    (tmp_path / "empty").mkdir()
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / MANIFEST).write_text("[" * 5000)
    (tmp_path / "broken" / EVENTS).write_text('{"type":')
    served = serve(runs=[tmp_path])
    runs = {run["name"] for run in json.loads(served.get("/studio/api/offer")[2])["runs"]}
    assert {"hostile", "broken"} <= runs
    told = track(served, "hostile")
    assert {m["frame"] for m in told["messages"] if m["type"] == "event"} == {""}
    assert any(m["type"] == "notice" for m in told["messages"])
    assert served.get("/studio/api/runs/hostile/scene.glb")[0] == 400
    assert served.get("/studio/api/runs/hostile/frames/abcdef0123456789.jpg")[0] == 404
    assert served.get("/studio/api/runs/hostile/frames/..%2fmanifest.json")[0] == 404
    status, _, body = served.get("/studio/api/runs/broken/track")
    while status == 202:
        time.sleep(0.5)
        status, _, body = served.get("/studio/api/runs/broken/track")
    assert status in (400, 409) and json.loads(body)["error"]["message"]


def test_with_a_token_a_browser_comes_in_by_the_address_and_then_by_a_cookie(serve):
    served = serve(token=TOKEN)
    assert served.get("/studio/")[0] == 401
    assert served.get("/studio/?token=wrong-wrong-wrong")[0] == 401
    wire = http.client.HTTPConnection(urlsplit(served.url).netloc, timeout=30)
    wire.request("GET", f"/studio/?token={TOKEN}")
    answer = wire.getresponse()
    answer.read()
    assert answer.status == 303 and answer.headers["location"] == "/studio/"
    cookie = answer.headers["set-cookie"]
    for word in ("HttpOnly", "SameSite=strict", "Path=/studio"):
        assert word in cookie
    kept = {"cookie": cookie.partition(";")[0]}
    assert served.get("/studio/", **kept)[0] == 200
    assert served.get("/studio/api/offer", **kept)[0] == 200
    assert served.get("/studio/api/offer", cookie="adamo_token=wrong")[0] == 401
    assert served.get("/studio/api/offer", authorization=f"Bearer {TOKEN}")[0] == 200
    # Neither opens any other door, nor does the address of anything but the page.
    assert served.get("/openapi.json", **kept)[0] == 401
    assert served.get(f"/studio/api/offer?token={TOKEN}")[0] == 401
    with pytest.raises(InvalidStatus):
        Visitor(served.url, "nobody")
    with Visitor(served.url, "nobody", headers=kept) as visitor, pytest.raises(ConnectionClosed):
        visitor.next()


def test_pages_of_others_may_not_ask(served):
    assert served.get("/studio/api/offer", origin="http://evil.example")[0] == 403
    with pytest.raises(InvalidStatus):
        Visitor(served.url, "nobody", headers={"origin": "http://evil.example"})
