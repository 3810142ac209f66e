import { Box3, Vector3 } from "three";
import { beforeAll, expect, test, vi } from "vitest";
import type { BodyShape, SceneShape } from "../src/protocol.ts";
import type { Moment } from "../src/track/track.ts";
import { Cameras } from "../src/view/cameras.ts";
import type { Figure } from "../src/view/figure.ts";
import { Voxels } from "../src/view/voxels.ts";

const SCENE = { x_min: -3, x_max: 3, y_min: -3, y_max: 3, height_m: 3 } as unknown as SceneShape;
const BODY = { fov_y_rad: 1.2 } as unknown as BodyShape;
const NOBODY = null as unknown as Figure;
const at = (x: number, y: number): Moment => ({ body: [x, y, 0] }) as unknown as Moment;

beforeAll(() => {
  vi.stubGlobal("matchMedia", () => ({ matches: false }));
});

function begun(): Cameras {
  const cameras = new Cameras(SCENE, BODY, new Voxels(new Box3(new Vector3(-3, -3, 0), new Vector3(3, 3, 3))));
  cameras.resize(800, 600);
  cameras.begin(at(-2, -1));
  cameras.update(at(-2, -1), NOBODY, 0.1);
  return cameras;
}

/** How far her chest is from the middle of the picture; 1 is its edge. */
function aside(cameras: Cameras, x: number, y: number): number {
  const seen = new Vector3(x, y, 1.1).project(cameras.camera);
  return Math.max(Math.abs(seen.x), Math.abs(seen.y));
}

test("the free camera keeps her in view until somebody takes it", () => {
  const cameras = begun();
  const place = cameras.camera.position.clone();
  for (const [x, y] of [
    [1.5, 1.5],
    [2, -2],
    [-2, 2],
  ] as const) {
    for (let i = 0; i < 40; i++) cameras.update(at(x, y), NOBODY, 0.1);
    expect(aside(cameras, x, y)).toBeLessThan(0.9);
    expect(cameras.camera.position.distanceTo(place)).toBeLessThan(0.01);
  }
});

test("a camera that was taken stays where it was turned to", () => {
  const cameras = begun();
  const before = cameras.camera.quaternion.clone();
  cameras.zoom(1);
  for (let i = 0; i < 40; i++) cameras.update(at(2, 2), NOBODY, 0.1);
  expect(cameras.camera.quaternion.angleTo(before)).toBeLessThan(0.01);
});
