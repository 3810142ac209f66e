"""The people look like people: whole, light enough to draw, well bound, and in allowed colours."""

from __future__ import annotations

import colorsys
import json
import math
import struct
from importlib.resources import files

import numpy as np
import pytest
from tools.figures.variant import PEOPLE

from adamo_vh.errors import ConfigError
from adamo_vh.geometry import Camera, Vec3
from adamo_vh.runtime.assets.glb_writing import linear
from adamo_vh.runtime.human.anatomy import FINGER_AXIS, turned
from adamo_vh.runtime.human.clips import Clip
from adamo_vh.runtime.human.face import moving_face
from adamo_vh.runtime.human.glb import write_glb
from adamo_vh.runtime.human.hand import AXES, FINGERS
from adamo_vh.runtime.human.looks import HEAD_GARMENTS, VARIANTS, load_figure
from adamo_vh.runtime.human.rotations import about
from adamo_vh.runtime.human.skeleton import EYES, INDEX, JOINTS, REST, Pose, joint_frames
from adamo_vh.runtime.human.skin_mujoco import add_human, body_name, pose_human
from adamo_vh.runtime.rendering import SceneRenderer

CLOTHES = ("top", "collar", "trousers", "shoes")


def picture(garment):
    texture = garment.material.texture
    assert texture is not None
    return texture


@pytest.fixture(scope="module", params=VARIANTS)
def figure(request):
    return load_figure(request.param)


def skinned(garment, places, rotations):
    """The garment's vertices for joint frames, as MuJoCo and glTF compute them."""
    local = garment.vertices[:, None] - REST[garment.bone_ids]
    moved = np.einsum("nbij,nbj->nbi", rotations[garment.bone_ids], local)
    return np.einsum("nb,nbi->ni", garment.weights, moved + places[garment.bone_ids])


def turned_about_y(joint_angles):
    rotations = np.tile(np.eye(3), (len(JOINTS), 1, 1))
    for joint, angle in joint_angles.items():
        c, s = np.cos(angle), np.sin(angle)
        rotations[INDEX[joint]] = [[c, 0, s], [0, 1, 0], [-s, 0, c]]
    return Pose(rotations)


def edges(garment, points):
    corners = points[garment.faces]
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)


def test_an_unknown_person_is_refused_by_name():
    with pytest.raises(ConfigError, match="mara"):
        load_figure("nobody")


def test_loading_twice_gives_the_same(figure):
    again = load_figure(figure.variant)
    for one, other in zip(figure.garments, again.garments, strict=True):
        assert one.name == other.name
        for key in ("vertices", "normals", "uvs", "faces", "bone_ids", "weights"):
            np.testing.assert_array_equal(getattr(one, key), getattr(other, key))
        np.testing.assert_array_equal(one.material.texture, other.material.texture)


def test_a_person_is_light_enough_to_draw(figure):
    assert 10_000 < figure.triangle_count <= 25_000


def test_a_person_takes_little_room_in_the_package(figure):
    path = files("adamo_vh.runtime.human") / "data" / f"{figure.variant}.npz"
    assert len(path.read_bytes()) < 600_000


def test_everybody_that_is_modelled_is_shipped():
    assert tuple(PEOPLE) == VARIANTS


def test_a_person_is_a_whole_person(figure):
    names = {garment.name for garment in figure.garments}
    assert names >= {*HEAD_GARMENTS, "hands", *CLOTHES}
    points = np.concatenate([garment.vertices for garment in figure.garments])
    assert points[:, 2].min() == pytest.approx(0.0, abs=0.005)
    assert 1.68 < points[:, 2].max() < 1.78
    # Left and right are there, and the eyes are where the skeleton says.
    assert points[:, 1].min() < -0.6 < 0.6 < points[:, 1].max()
    middle = figure["eyes"].vertices.mean(axis=0)
    np.testing.assert_allclose(middle, EYES, atol=0.02)


def test_meshes_are_well_formed(figure):
    for garment in figure.garments:
        assert garment.faces.min() == 0 and garment.faces.max() == len(garment.vertices) - 1
        np.testing.assert_allclose(np.linalg.norm(garment.normals, axis=1), 1.0, atol=1e-5)
        assert garment.uvs.min() >= 0 and garment.uvs.max() <= 1
        # Faces wind counter-clockwise: normals of faces and vertices agree.
        a, b, c = np.moveaxis(garment.vertices[garment.faces], 1, 0)
        across = np.cross(b - a, c - a)
        agree = np.einsum("ij,ij->i", across, garment.normals[garment.faces].sum(axis=1))
        assert (agree >= 0).mean() > 0.95, garment.name


def test_weights_are_shares_of_real_joints(figure):
    for garment in figure.garments:
        np.testing.assert_allclose(garment.weights.sum(axis=1), 1.0, atol=1e-5)
        assert garment.weights.min() >= 0
        assert garment.bone_ids.max() < len(JOINTS)


def test_the_rest_pose_leaves_every_vertex_in_place(figure):
    places, rotations = joint_frames(Pose())
    for garment in figure.garments:
        np.testing.assert_allclose(skinned(garment, places, rotations), garment.vertices, atol=1e-5)


def test_no_vertex_hangs_on_a_far_joint(figure):
    for garment in figure.garments:
        away = np.linalg.norm(garment.vertices[:, None] - REST[garment.bone_ids], axis=2)
        assert (np.where(garment.weights > 0.3, away, 0)).max() < 0.5, garment.name


@pytest.mark.parametrize(
    ("bend", "garment"),
    [
        ({"forearm_l": -1.6, "forearm_r": -1.6}, "top"),
        ({"upper_arm_l": -1.5, "upper_arm_r": 0.6}, "top"),
        ({"thigh_l": -1.7, "thigh_r": -0.5, "shin_l": 1.8, "shin_r": 0.9}, "trousers"),
    ],
)
def test_bending_far_tears_and_collapses_nothing(figure, bend, garment):
    cloth = figure[garment]
    rest = edges(cloth, cloth.vertices)
    bent = skinned(cloth, *joint_frames(turned_about_y(bend)))
    longest = edges(cloth, bent) / np.maximum(rest, 0.004)
    assert np.quantile(longest, 0.99) < 3.5
    assert longest.max() < 10.0


@pytest.mark.parametrize("finger", FINGERS[1:])
def test_each_finger_curls_alone_and_the_palm_stays(figure, finger):
    hands = figure["hands"]
    left = hands.vertices[:, 1] > 0
    bend = about(tuple(FINGER_AXIS["l"]), 1.0)
    pose = turned(Pose(), {f"{finger}_{k}_l": bend for k in (1, 2)})
    moved = skinned(hands, *joint_frames(pose)) - hands.vertices
    distance = np.linalg.norm(moved, axis=1)
    assert distance[left].max() > 0.045
    assert distance[~left].max() < 1e-5
    local = (hands.vertices - REST[INDEX["hand_l"]]) @ AXES["l"].T
    palm = left & (local[:, 0] < 0.06)
    assert distance[palm].max() < 0.002
    # Its neighbours are not drawn along: no skin is stretched from one to the other.
    longest = edges(hands, hands.vertices + moved) / np.maximum(edges(hands, hands.vertices), 0.003)
    assert np.quantile(longest, 0.995) < 2.5
    assert longest.max() < 8.0


def test_people_differ():
    figures = [load_figure(name) for name in VARIANTS]
    assert len(figures) >= 3
    tops = {tuple(picture(f["top"])[0, 0]) for f in figures}
    skins = {tuple(picture(f["hands"])[0, 0]) for f in figures}
    hair = {(f["hair"].vertices.shape, f["hair"].vertices.tobytes()) for f in figures}
    assert len(tops) == len(skins) == len(figures)
    assert len(hair) >= 3


def test_no_garment_is_blue_or_white(figure):
    for name in (*CLOTHES, "hair", "hands"):
        for red, green, blue in picture(figure[name]).reshape(-1, 3) / 255.0:
            hue, saturation, value = colorsys.rgb_to_hsv(red, green, blue)
            assert not (0.46 < hue < 0.75 and saturation > 0.12), (name, "blue")
            assert not (value > 0.8 and saturation < 0.25), (name, "white")


def test_in_mujoco_a_person_adds_no_degree_of_freedom_and_nothing_to_collide(figure):
    import mujoco

    spec = mujoco.MjSpec()
    add_human(spec, figure)
    model = spec.compile()
    assert model.nv == model.ngeom == 0
    assert model.nmocap == len(JOINTS)
    assert model.nskin == len(figure.garments)


def test_in_mujoco_a_person_is_drawn_where_it_stands():
    import mujoco

    spec = mujoco.MjSpec()
    spec.visual.global_.offwidth, spec.visual.global_.offheight = 240, 320
    spec.worldbody.add_light(pos=(3, 0, 4), dir=(-3, 0, -4))
    add_human(spec, load_figure())
    model = spec.compile()
    data = mujoco.MjData(model)
    renderer = SceneRenderer(model, np.empty(0, np.int16))
    camera = Camera(Vec3(3.0, 0.0, 0.9), math.pi, 0.0, math.radians(45), 240, 320)

    def drawn(shift=(0.0, 0.0, 0.0), *, head=True):
        places, rotations = joint_frames(Pose())
        pose_human(model, data, places + np.array(shift), rotations)
        mujoco.mj_forward(model, data)
        return renderer.color(data, camera, head=head).astype(int).max(axis=2) > 20

    try:
        body = drawn()
        rows = np.flatnonzero(body.any(axis=1))
        assert body.mean() > 0.06
        assert rows[-1] - rows[0] > 170
        # Half a metre to its left is to the right in the picture.
        moved = drawn((0.0, 0.5, 0.0))
        assert np.nonzero(moved)[1].mean() - np.nonzero(body)[1].mean() > 30
        headless = drawn(head=False)
        assert np.flatnonzero(headless.any(axis=1))[0] > rows[0] + 10
    finally:
        renderer.close()


def test_posing_writes_each_joint_by_name():
    import mujoco

    spec = mujoco.MjSpec()
    spec.worldbody.add_body(name="other", mocap=True)
    add_human(spec, load_figure())
    model = spec.compile()
    data = mujoco.MjData(model)
    places, rotations = joint_frames(turned_about_y({"neck": 0.4}))
    pose_human(model, data, places, rotations)
    mujoco.mj_kinematics(model, data)
    np.testing.assert_allclose(data.body(body_name("head")).xpos, places[INDEX["head"]])
    turned = data.body(body_name("head")).xmat.reshape(3, 3)
    np.testing.assert_allclose(turned, rotations[INDEX["head"]], atol=1e-9)
    np.testing.assert_array_equal(data.body("other").xpos, 0.0)


AS_IN_VRM = [
    *("hips", "spine", "chest", "neck", "head", "eyelids"),
    *("leftShoulder", "leftUpperArm", "leftLowerArm", "leftHand"),
    *("leftUpperLeg", "leftLowerLeg", "leftFoot", "leftToes"),
    *("leftThumbMetacarpal", "leftThumbProximal", "leftThumbDistal"),
    *(
        f"left{finger}{part}"
        for finger in ("Index", "Middle", "Ring", "Little")
        for part in ("Proximal", "Intermediate", "Distal")
    ),
]
"""Of the trunk and the left side, as the specification spells them; `eyelids` is ours."""


def read_glb(path):
    raw = path.read_bytes()
    magic, version, total = struct.unpack_from("<4sII", raw)
    assert (magic, version, total) == (b"glTF", 2, len(raw))
    length, kind = struct.unpack_from("<I4s", raw, 12)
    assert kind == b"JSON" and length % 4 == 0
    return json.loads(raw[20 : 20 + length]), raw[28 + length :]


def test_a_glb_holds_the_meshes_the_skeleton_and_the_clips(tmp_path, figure):
    times = np.linspace(0, 1, 5)
    rotations = np.stack([turned_about_y({"forearm_l": -t}).rotations for t in times])
    clip = Clip("bend", times, rotations, REST[0] + 0.01 * times[:, None] * [0, 0, 1])
    path = tmp_path / "person.glb"
    write_glb(path, figure, [clip])
    gltf, binary = read_glb(path)
    face = moving_face(figure)
    assert [mesh["name"] for mesh in gltf["meshes"]] == [g.name for g in face.figure.garments]
    for mesh in gltf["meshes"]:
        names = mesh.get("extras", {}).get("targetNames", [])
        assert names == list(face.shapes.get(mesh["name"], {}))
        assert len(mesh["primitives"][0].get("targets", [])) == len(names)
    bones = [gltf["nodes"][n]["name"] for n in gltf["skins"][0]["joints"]]
    assert len(set(bones)) == len(JOINTS)
    assert [bone for bone in bones if not bone.startswith("right")] == AS_IN_VRM
    assert {f"right{bone[4:]}" for bone in AS_IN_VRM if bone.startswith("left")} <= {*bones}
    assert [a["name"] for a in gltf["animations"]] == ["bend"]
    bends = {c["target"]["node"]: c for c in gltf["animations"][0]["channels"]}
    channel = gltf["skins"][0]["joints"][INDEX["forearm_l"]]
    sampler = gltf["animations"][0]["samplers"][bends[channel]["sampler"]]
    accessor = gltf["accessors"][sampler["output"]]
    view = gltf["bufferViews"][accessor["bufferView"]]
    values = np.frombuffer(binary, "<f4", accessor["count"] * 4, view["byteOffset"]).reshape(-1, 4)
    np.testing.assert_allclose(values[-1], [0, -np.sin(0.5), 0, np.cos(0.5)], atol=1e-6)


def test_a_glb_stands_upright_and_looks_along_z(tmp_path):
    import trimesh

    path = tmp_path / "person.glb"
    figure = load_figure()
    write_glb(path, figure)
    scene = trimesh.load_scene(path)
    assert {name: len(mesh.faces) for name, mesh in scene.geometry.items()} == {
        garment.name: len(garment.faces) for garment in moving_face(figure).figure.garments
    }
    # In the rest pose the root's turn is all that a skin adds to its vertices.
    turn = scene.graph.get("human")[0]
    x, y, z = (turn @ [*figure["eyes"].vertices.mean(axis=0), 1.0])[:3]
    assert abs(x) < 0.01 and y == pytest.approx(1.60, abs=0.02) and z > 0.05
    x, y, z = (scene.graph.get("leftHand")[0] @ [0.0, 0.0, 0.0, 1.0])[:3]
    assert x > 0.5 and y == pytest.approx(REST[INDEX["hand_l"], 2])


def test_colours_go_from_srgb_to_linear():
    assert linear(0.0) == 0.0
    assert linear(1.0) == pytest.approx(1.0)
    assert linear(0.5) == pytest.approx(0.214, abs=1e-3)
