import { Bone, Box3, BoxGeometry, BufferAttribute, type BufferGeometry, Color, Matrix4, Mesh, MeshBasicMaterial, MeshStandardMaterial, PlaneGeometry, Quaternion, Skeleton, SkinnedMesh, Vector3 } from "three";
import { expect, test } from "vitest";
import { Ambience } from "../src/view/ambience.ts";
import { BodyLight } from "../src/view/bodylight.ts";
import { coded } from "../src/view/coding.ts";
import { Brightness } from "../src/view/brightness.ts";
import { Plain } from "../src/view/plain.ts";
import { Skin } from "../src/view/skin.ts";
import { split } from "../src/view/splitting.ts";
import { Voxels } from "../src/view/voxels.ts";

const SHAPE = { x_min: -2, x_max: 2, y_min: -2, y_max: 2, height_m: 2.5 };
const UP = new Vector3(0, 0, 1);

/** A room with a table top in the middle. */
function brightness(): Brightness {
  const voxels = new Voxels(new Box3(new Vector3(-2, -2, 0), new Vector3(2, 2, 2.5)));
  const table = new Mesh(new BoxGeometry(1.2, 1.2, 0.08), new MeshBasicMaterial());
  table.position.set(0, 0, 0.75);
  voxels.add(table);
  return new Brightness(SHAPE, null, voxels, new Ambience(voxels));
}

const sum = (values: ArrayLike<number>, from: number, to: number): number => Array.from(values).slice(from, to).reduce((a, b) => a + b, 0);

test("it is darker under a table than beside it", () => {
  const light = brightness();
  const [under, beside] = [new Float32Array(6), new Float32Array(6)];
  light.at(new Vector3(0, 0, 0), UP, true, under);
  light.at(new Vector3(-1.2, 0, 0), UP, true, beside);
  expect(sum(under, 0, 3)).toBeLessThan(0.75 * sum(beside, 0, 3));
  expect(sum(under, 3, 6)).toBeLessThan(sum(beside, 3, 6));
});

test("the light on a body is the light of the room", () => {
  const light = brightness();
  const [x, y] = [-1.2, 1];
  const out = new Float32Array(3);
  light.around(x, y, [1, 1]).shade([x, y, 1.2], [0, 0, 1], 0, 1, [1, 1, 1].map(coded), out);
  const told = new Float32Array(6);
  light.at(new Vector3(x, y, 1.2), UP, false, told);
  const root = 127.5 * Math.sqrt(1.05 * (told[0] as number + (told[3] as number)));
  expect(out[0]).toBeGreaterThan(0.85 * root);
  expect(out[0]).toBeLessThan(1.15 * root);
});

test("dimmed lights make everything darker, and bright again", () => {
  const plain = new Plain(brightness());
  const floor = new PlaneGeometry(1, 1);
  plain.light(floor, new MeshStandardMaterial({ color: new Color(1, 1, 1) }), new Matrix4().makeTranslation(-1.2, 1, 0), true);
  const light = floor.getAttribute("light").array;
  const bright = sum(light, 0, 3);
  plain.dim(0.2);
  expect(sum(light, 0, 3)).toBeLessThan(0.75 * bright);
  plain.dim(1);
  expect(sum(light, 0, 3)).toBe(bright);
});

test("large triangles are cut, without cracks and without more surface", () => {
  const whole = new PlaneGeometry(2, 1);
  const cut = split(whole, 0.3);
  const [places, index] = [cut.getAttribute("position"), cut.getIndex()];
  const at = (n: number): Vector3 => new Vector3().fromBufferAttribute(places, index?.getX(n) ?? 0);
  let area = 0;
  const edges = new Map<string, number>();
  for (let i = 0; i < (index?.count ?? 0); i += 3) {
    const corners = [at(i), at(i + 1), at(i + 2)] as const;
    area += new Vector3().subVectors(corners[1], corners[0]).cross(new Vector3().subVectors(corners[2], corners[0])).length() / 2;
    corners.forEach((a, n) => {
      const b = corners[(n + 1) % 3] as Vector3;
      expect(a.distanceTo(b)).toBeLessThanOrEqual(0.3001);
      const key = [a, b].map((p) => p.toArray().map((v) => v.toFixed(4)).join()).sort().join(" ");
      edges.set(key, (edges.get(key) ?? 0) + 1);
    });
  }
  expect(area).toBeCloseTo(2);
  const rim = [...edges].filter(([, count]) => count === 1).flatMap(([key]) => key.split(" "));
  // What belongs to one triangle alone is at the rim of the whole.
  for (const [x, y] of rim.map((p) => p.split(",").map(Number))) expect(Math.abs(x ?? 0) === 1 || Math.abs(y ?? 0) === 0.5).toBe(true);
});

test("what is small enough stays as it is", () => {
  const small = new PlaneGeometry(0.1, 0.1);
  expect(split(small, 0.3)).toBe(small);
});

function skinned(): SkinnedMesh {
  const shape: BufferGeometry = new PlaneGeometry(1, 1);
  shape.setAttribute("skinIndex", new BufferAttribute(Uint8Array.from([0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0]), 4));
  shape.setAttribute("skinWeight", new BufferAttribute(Float32Array.from([1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0.5, 0, 0, 1, 0, 0, 0]), 4));
  shape.morphAttributes.position = [new BufferAttribute(Float32Array.from([0, 0, 0.25, 0, 0, 0, 0, 0, 0, 0, 0, 0]), 3)];
  shape.morphTargetsRelative = true;
  const mesh = new SkinnedMesh(shape, new MeshStandardMaterial());
  const bones = [new Bone(), new Bone()] as const;
  bones[1].position.set(0.2, 0, 0);
  mesh.add(...bones);
  mesh.updateMatrixWorld(true);
  mesh.bind(new Skeleton([...bones]));
  bones[0].position.set(0, 0, 1);
  bones[1].quaternion.copy(new Quaternion().setFromAxisAngle(UP, 0.5));
  mesh.updateMatrixWorld(true);
  mesh.skeleton.update();
  return mesh;
}

test("a body is bent and shaped as the graphics card would do it", () => {
  const meshes = [skinned(), skinned()];
  const skin = new Skin(meshes, new Plain(brightness()));
  const light = new BodyLight([], [], () => 1);
  expect(skin.shown.geometry.groups).toEqual([{ start: 0, count: 6, materialIndex: 0 }, { start: 6, count: 6, materialIndex: 1 }]);
  expect(Array.from(skin.shown.geometry.getIndex()?.array ?? []).slice(6)).toEqual([4, 6, 5, 6, 7, 5]);
  for (const shares of [[0, 0], [1, 0], [0, 1]]) {
    meshes.forEach((mesh, n) => (mesh.morphTargetInfluences = [shares[n] as number]));
    skin.update(light);
    const places = skin.shown.geometry.getAttribute("position");
    for (let i = 0; i < 8; i++) {
      const wished = (meshes[Math.floor(i / 4)] as SkinnedMesh).getVertexPosition(i % 4, new Vector3());
      expect(new Vector3().fromBufferAttribute(places, i).distanceTo(wished)).toBeLessThan(1e-5);
    }
  }
});

test("a body is worked out again only for another pose or another face", () => {
  const mesh = skinned();
  const skin = new Skin([mesh], new Plain(brightness()));
  const light = new BodyLight([], [], () => 1);
  const versions = (): number => (skin.shown.geometry.getAttribute("position") as BufferAttribute).version;
  skin.update(light);
  const first = versions();
  skin.update(light);
  expect(versions()).toBe(first);
  skin.isStale = true;
  skin.update(light);
  mesh.morphTargetInfluences = [0.5];
  skin.update(light);
  expect(versions()).toBe(first + 2);
});
