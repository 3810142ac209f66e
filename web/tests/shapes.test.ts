import { Box3, BoxGeometry, type BufferGeometry, Euler, Mesh, MeshBasicMaterial, type Texture, Vector3 } from "three";
import type { GLTFParser } from "three/addons/loaders/GLTFLoader.js";
import { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
import { afterEach, expect, test, vi } from "vitest";
import { meshesIn } from "../src/view/loading.ts";
import { merged } from "../src/view/merging.ts";
import { Pictures } from "../src/view/pictures.ts";
import { Voxels } from "../src/view/voxels.ts";

const look = new MeshBasicMaterial();

function box(x: number, turn: number, material = look): Mesh {
  const mesh = new Mesh(new BoxGeometry(0.4, 0.6, 0.8), material);
  mesh.position.set(x, 0.3, 0.4);
  mesh.setRotationFromEuler(new Euler(0.2, turn, 1));
  mesh.scale.set(1, 2, 1);
  mesh.updateMatrixWorld(true);
  return mesh;
}

test("what never moves is joined where it stands, one mesh a material", () => {
  const boxes = [box(-1, 0.4), box(1, 0.9)];
  const group = merged([...boxes, box(0, 0, new MeshBasicMaterial())], (_, geometry) => geometry);
  const [joined, other] = meshesIn(group).map(({ geometry }) => geometry as BufferGeometry);
  const wished = mergeGeometries(boxes.map(({ geometry, matrixWorld }) => geometry.clone().applyMatrix4(matrixWorld)));
  expect(other?.getAttribute("position").count).toBe(24);
  expect(joined?.getIndex()?.array).toEqual(wished.getIndex()?.array);
  for (const name of ["position", "normal", "uv"]) expect(joined?.getAttribute(name).array).toEqual(wished.getAttribute(name).array);
});

test("cubes are filled alike, whether corners are shared or not", () => {
  const room = (): Voxels => new Voxels(new Box3(new Vector3(-2, -2, 0), new Vector3(2, 2, 2.5)));
  const [shared, single] = [room(), room()];
  const mesh = box(0.5, 0.3);
  shared.add(mesh);
  single.add(Object.assign(mesh.clone(), { geometry: mesh.geometry.toNonIndexed() }));
  expect(shared.filled.some((cell) => cell === 1)).toBe(true);
  expect(single.filled).toEqual(shared.filled);
  expect(single.top).toBe(shared.top);
});

afterEach(() => vi.unstubAllGlobals());

test("a picture is unpacked while the rest goes on", async () => {
  const picture = { width: 4, height: 2 };
  let unpack = (): void => undefined;
  vi.stubGlobal("createImageBitmap", () => new Promise((done) => (unpack = () => done(picture))));
  const json = {
    textures: [{ source: 0, sampler: 0 }, { source: 0, extensions: { EXT_texture_webp: {} } }],
    images: [{ bufferView: 3, mimeType: "image/png" }],
    samplers: [{ minFilter: 9729, wrapS: 33071 }],
  };
  const asked: unknown[] = [];
  const parser = { json, associations: new Map(), getDependency: (...what: unknown[]) => (asked.push(what), Promise.resolve(new ArrayBuffer(8))) };
  const pictures = new Pictures(parser as unknown as GLTFParser);
  const texture = (await pictures.loadTexture(0)) as Texture;
  const copy = texture.clone();
  expect(pictures.loadTexture(1)).toBeNull();
  expect(texture.image).toBeNull();
  expect([texture.flipY, texture.generateMipmaps]).toEqual([false, false]);
  unpack();
  await pictures.ready;
  expect(asked).toEqual([["bufferView", 3]]);
  expect(copy.image).toBe(picture);
  expect(texture.version).toBeGreaterThan(0);
});
