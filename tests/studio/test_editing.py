"""Scenes that are made on the page: checked at every change, and saved where nothing else lies."""

from __future__ import annotations

import json

import pytest
from tests.studio.visitor import Visitor

from adamo_vh.session.editing import examine


def asked(served, path, body):
    status, _, answer = served.get(f"/studio/api/{path}", "POST", body)
    return status, json.loads(answer)


@pytest.fixture(scope="module")
def s1(served):
    return json.loads(served.get("/studio/api/scenes/s1")[2])


def test_a_scene_is_told_as_text_and_as_data_which_are_the_same(s1):
    assert examine(s1["toml"]).data == examine(s1["data"]).data
    assert s1["data"]["title"] == "Tabletop" and s1["findings"] == []


def test_what_is_wrong_is_told_with_its_place(served, s1):
    data = json.loads(json.dumps(s1["data"]))
    data["objects"][0]["position"] = [99.0, 0.0]
    status, told = asked(served, "scenes/check", {"data": data})
    assert status == 200
    assert any("objects[0]" in finding["where"] for finding in told["findings"])
    status, told = asked(served, "scenes/check", {"toml": "name = ["})
    assert status == 200 and told["findings"][0]["severity"] == "error" and told["data"] is None


def test_a_scene_is_saved_once_and_played_in(served, s1):
    data = json.loads(json.dumps(s1["data"]))
    data["title"] = "My own room"
    data["objects"] = [item for item in data["objects"] if item["asset"] in ("plate", "cup")]
    status, told = asked(served, "scenes", {"name": "my-room", "data": data})
    assert status == 201 and told["scene"] == "my-room.toml"
    assert asked(served, "scenes", {"name": "my-room", "data": data})[0] == 400
    assert asked(served, "scenes", {"name": "my-room", "data": data, "replace": True})[0] == 201
    offer = json.loads(served.get("/studio/api/offer")[2])
    assert {"name": "my-room.toml", "title": "My own room"} in offer["scenes"]
    room = served.room(scene="my-room.toml")
    with Visitor(served.url, room) as visitor:
        hello = visitor.next()
        assert hello["scene"]["title"] == "My own room"
        assert len(hello["scene"]["objects"]) == len(data["objects"])
        assert served.get(hello["scene"]["glb"])[2][:4] == b"glTF"
    served.close(room)


@pytest.mark.parametrize(
    "draft",
    [
        {},
        {"name": "../evil", "toml": "x"},
        {"name": "a/b", "toml": "x"},
        {"name": ".hidden", "toml": "x"},
        {"name": "Big", "toml": "x"},
        {"name": "x" * 50, "toml": "x"},
        {"name": "fine", "toml": "no scene"},
        {"name": "fine", "data": {"objects": []}},
    ],
)
def test_what_is_no_scene_or_no_name_is_not_saved(served, draft):
    status, told = asked(served, "scenes", draft)
    assert status == 400 and told["error"]["message"]
    assert not (served.out / "scenes" / "fine.toml").exists()


def test_the_catalog_has_what_can_stand_in_a_scene(served):
    told = json.loads(served.get("/studio/api/catalog")[2])
    names = {item["name"] for item in told["furniture"]}
    assert {"sofa", "dining_table"} <= names
    assert all(len(item["size"]) == 3 for item in (*told["furniture"], *told["objects"]))
    shelf = next(item for item in told["furniture"] if item["name"] == "tall_shelf")
    heights = {surface["name"]: surface["center"][2] for surface in shelf["surfaces"]}
    assert list(heights) == ["lower", "middle", "top"] and heights["lower"] < heights["top"] < 2
    assert served.get("/studio/api/assets/plate.glb")[2][:4] == b"glTF"
    assert served.get("/studio/api/assets/..%2fplate.glb")[0] in (400, 404)
