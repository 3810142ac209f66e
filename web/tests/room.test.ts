import { Box3, BoxGeometry, Mesh, MeshBasicMaterial, Quaternion, Vector3 } from "three";
import { expect, test } from "vitest";
import { boxAt } from "../src/mind/frame.ts";
import { Ambience } from "../src/view/ambience.ts";
import { halfExtents } from "../src/view/contact.ts";
import { layOut } from "../src/view/overlay.ts";
import { LEVELS, Quality } from "../src/view/quality.ts";
import { Voxels } from "../src/view/voxels.ts";

const room = (): Voxels => new Voxels(new Box3(new Vector3(-2, -2, 0), new Vector3(2, 2, 2.5)));

function withBox(): Voxels {
  const voxels = room();
  const box = new Mesh(new BoxGeometry(0.6, 0.6, 0.8), new MeshBasicMaterial());
  box.position.set(1, 0, 0.4);
  voxels.add(box);
  return voxels;
}

test("what stands in the way ends a line of sight", () => {
  const voxels = withBox();
  const seen = voxels.free(new Vector3(-1, 0, 0.5), new Vector3(1, 0, 0), 3);
  expect(seen).toBeGreaterThan(1.2);
  expect(seen).toBeLessThan(1.7);
  expect(voxels.free(new Vector3(-1, 0, 1.5), new Vector3(1, 0, 0), 2.5)).toBe(2.5);
});

test("what the point itself is in does not count", () => {
  expect(withBox().free(new Vector3(0.72, 0, 0.5), new Vector3(-1, 0, 0), 2)).toBe(2);
});

test("nobody stands in furniture or in a wall", () => {
  const voxels = withBox();
  const free = voxels.standing(0.25);
  const at = (x: number, y: number): number => free[Math.floor((x + 2) * 10) + voxels.nx * Math.floor((y + 2) * 10)] ?? -1;
  expect(at(1, 0)).toBe(0);
  expect(at(0.55, 0)).toBe(0);
  expect(at(-1, 0)).toBe(1);
  expect(at(-1.95, 0)).toBe(0);
});

test("corners are less open than the middle", () => {
  const voxels = room();
  const ambience = new Ambience(voxels);
  expect(ambience.at(0, 0, 1.2)).toBeGreaterThan(0.94);
  expect(ambience.at(-1.95, -1.95, 0.05)).toBeLessThan(0.4);
  const all = ambience.uniforms.uOpenness.value.image.data as Uint8Array;
  expect(all[voxels.index(0, 0, 1.2)]).toBe(ambience.of(20, 20, 12));
});

test("labels never cover each other", () => {
  const anchors = Array.from({ length: 30 }, (_, i) => ({ x: 200 + (i % 6) * 12, y: 200 + Math.floor(i / 6) * 6, w: 80 }));
  const placed = layOut(anchors, 640, 400).filter((spot) => spot !== null);
  expect(placed.length).toBeGreaterThan(12);
  for (const a of placed) {
    for (const b of placed) {
      if (a === b) continue;
      const apart = a.x + a.w <= b.x || b.x + b.w <= a.x || a.y + a.h <= b.y || b.y + b.h <= a.y;
      expect(apart).toBe(true);
    }
  }
});

test("the smaller of two boxes is the one that is pointed at", () => {
  const boxes = [{ box: [0, 0, 100, 100] as const, tag: "table" }, { box: [40, 40, 60, 60] as const, tag: "cup" }];
  expect(boxAt(boxes, 50, 50)?.tag).toBe("cup");
  expect(boxAt(boxes, 10, 10)?.tag).toBe("table");
  expect(boxAt(boxes, 300, 10)).toBeUndefined();
});

test("a box that lies on its side is as high as it is thick", () => {
  const half = halfExtents([0.2, 0.1, 0.4], new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), Math.PI / 2));
  expect(half.z).toBeCloseTo(0.1);
  expect(half.x).toBeCloseTo(0.2);
});

test("quality falls where frames are slow and does not swing back", () => {
  const quality = new Quality();
  for (let i = 0; i < 60; i++) quality.note(200);
  expect(quality.level).toBe(0);
  for (let i = 0; i < 60; i++) quality.note(5);
  expect(quality.level).toBeLessThan(LEVELS.length - 1);
});

test("a small picture stays sharp however slow it is", () => {
  const quality = new Quality(true);
  for (let i = 0; i < 60; i++) quality.note(300);
  expect(quality.share(370 * 380)).toBe(1);
  expect(quality.share(1280 * 720)).toBeCloseTo(0.51, 2);
});
